// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_pulled_back_stress_h
#define limber_interpolation_pulled_back_stress_h

#include <limber/base/small_matrix.h>
#include <limber/interpolation/batch_lanes.h>

/**
 * @file Stress in the initial frame (total Lagrangian). The nodal forces are
 *
 *   f_i = - sum (m / rho_0) P grad_X N_i,
 *   P   = dev(tau) F^-T + (J_p / J) (-J p) F^-T,
 *
 * with J_p = det F and J the volume ratio that the law was given, which is
 * that of the cell if the volumetric part is averaged (F-bar). This is the
 * derivative of the energy sum (m / rho_0) (U(J) + W(F)) with respect to the
 * nodal positions: J = <J_p> depends on F by J_p F^-T, so the stress needs
 * no averaging of its own (Simo, Taylor and Pister, CMAME 51, 1985). A law
 * for small strain has P = sigma.
 */
namespace limber
{
  /** F of a pack of points. */
  template <int dim, class Lanes>
  __attribute__((always_inline)) inline SmallMatrix<dim, PointPack<dim>>
  deformation_gradient(const PointView<dim> &points, const Lanes &lanes)
  {
    SmallMatrix<dim, PointPack<dim>> F;
#pragma GCC unroll 8
    for (int d = 0; d < dim; ++d)
#pragma GCC unroll 8
      for (int e = 0; e < dim; ++e)
        F[d][e] = lanes.load(points.deformation[d * dim + e]);
    return F;
  }



  /**
   * P (first Piola-Kirchhoff stress, Pa) of points whose law was given F and
   * the volume ratio J, from its result: the deviator of J sigma and J p.
   */
  template <int dim, bool finite_strain, class Number>
  __attribute__((always_inline)) inline SmallMatrix<dim, Number>
  piola_kirchhoff_stress(const Deviator<dim, Number>    &deviator,
                         const Number                   &pressure,
                         const SmallMatrix<dim, Number> &F,
                         const Number                   &J)
  {
    SmallMatrix<dim, Number> t = rows_of<dim>(deviator);
    Number                   p = pressure;
    if constexpr (finite_strain)
      {
        // divided by J_p, as the cofactor is J_p F^-T
        const Number inverse = 1. / determinant<dim>(F);
#pragma GCC unroll 8
        for (int d = 0; d < dim; ++d)
#pragma GCC unroll 8
          for (int e = 0; e < dim; ++e)
            t[d][e] *= inverse;
        p /= J;
      }
#pragma GCC unroll 8
    for (int d = 0; d < dim; ++d)
      t[d][d] -= p;
    if constexpr (finite_strain)
      return times<dim>(t, cofactor<dim>(F));
    else
      return t;
  }



  /** Sums over the points of a cell of V times each monomial. */
  template <int dim>
  class MonomialSums
  {
  public:
    using Number                     = PointPack<dim>;
    static constexpr int n_monomials = 1 << dim;

    MonomialSums()
    {
      set_zero(sums);
    }

    /**
     * Add points of volume V (m^dim, zero in idle lanes) at natural coordinates
     * xi.
     */
    __attribute__((always_inline)) void
    add(const std::array<Number, dim> &xi, const Number &V)
    {
      std::array<Number, n_monomials> monomials;
      monomials[0] = V;
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
#pragma GCC unroll 8
        for (int k = 0; k < 1 << d; ++k)
          monomials[k | 1 << d] = monomials[k] * xi[d];
#pragma GCC unroll 8
      for (int k = 0; k < n_monomials; ++k)
        sums[k] += monomials[k];
    }

    /** The sums over all points. */
    std::array<double, n_monomials>
    total() const
    {
      return all_sums(sums);
    }

  private:
    std::array<Number, n_monomials> sums;
  };



  /** Sums up the forces of the P of the points of a cell on its nodes. */
  template <int dim>
  class StressOnNodes
  {
  public:
    using Number = PointPack<dim>;
    using Nodes  = typename Linear<dim>::Nodes;

    explicit StressOnNodes(const CellGeometry<dim> &cell)
      : cell(cell)
    {
      set_zero(on_coefficients);
    }

    /** Add P times volume (J, zero in idle lanes) at natural coordinates xi. */
    __attribute__((always_inline)) void
    add(const SmallMatrix<dim, Number> &VP, const std::array<Number, dim> &xi)
    {
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
        {
          std::array<Number, dim> s; // conjugate to natural derivatives
#pragma GCC unroll 8
          for (int e = 0; e < dim; ++e)
            {
              s[e] = VP[d][e] * cell.inverse_edge[e];
              on_coefficients[d][1 << e] += s[e];
            }
#pragma GCC unroll 8
          for (int e = 0; e < dim; ++e)
#pragma GCC unroll 8
            for (int f = 0; f < e; ++f)
              on_coefficients[d][1 << e | 1 << f] +=
                s[e] * xi[f] + s[f] * xi[e];
          if constexpr (dim == 3)
            on_coefficients[d][7] += s[0] * (xi[1] * xi[2]) +
                                     s[1] * (xi[0] * xi[2]) +
                                     s[2] * (xi[0] * xi[1]);
        }
    }

    /**
     * The forces on the nodes, one lane each, for each direction, including
     * those of a uniform P (Pa) at all points, given by their summed monomials.
     */
    __attribute__((always_inline)) std::array<Nodes, dim>
    forces(const SmallMatrix<dim, double>     &P,
           const std::array<double, 1 << dim> &monomials) const
    {
      std::array<Nodes, dim> result;
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
        {
          Nodes uniform{}; // lane k acts on c_k
#pragma GCC unroll 8
          for (int k = 1; k < 1 << dim; ++k)
            {
              double total = 0;
#pragma GCC unroll 8
              for (int e = 0; e < dim; ++e)
                if (k >> e & 1)
                  total +=
                    P[d][e] * cell.inverse_edge[e] * monomials[k ^ (1 << e)];
              uniform[k] = total;
            }
          result[d] = -Linear<dim>::to_nodes(
            sums_over_lanes(on_coefficients[d]) + uniform);
        }
      return result;
    }

    /** The forces without a uniform P. */
    __attribute__((always_inline)) std::array<Nodes, dim>
    forces() const
    {
      std::array<Nodes, dim> result;
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
        result[d] = -Linear<dim>::to_nodes(sums_over_lanes(on_coefficients[d]));
      return result;
    }

  private:
    const CellGeometry<dim>                      &cell;
    std::array<std::array<Number, 1 << dim>, dim> on_coefficients;
  };
} // namespace limber

#endif
