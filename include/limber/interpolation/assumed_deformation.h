// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_assumed_deformation_h
#define limber_interpolation_assumed_deformation_h

#include <limber/interpolation/pulled_back_stress.h>
#include <limber/materials/treatment.h>

/**
 * @file The assumed strain in the initial frame (total Lagrangian). The law
 * gets, instead of the deformation gradient F of a point,
 *
 *   F_a = R A(R^T F),   <F> = R U the polar decomposition of the cell's mean,
 *
 *   (A G)_dd = <G_dd> + e1 G_dd' + e2 G_ee',  (A G)_de = <G_de>  (2d),
 *
 * where brackets are means over the points of the cell, weighted by mass,
 * primes the deviations from them, and d, e, f different axes. So a cell in
 * bending has no (parasitic) shear, and its transverse strain is given by
 * (e1, e2); the corotational frame R makes this objective for any rotation.
 * In 3d, with the slopes G_dd,f = <xi_f' G_dd> / <xi_f'^2> of bending cells and
 * the rest, G_dd" = G_dd' - sum_f G_dd,f xi_f', of trilinear modes,
 *
 *   (A G)_dd = <G_dd> + e1 sum_f G_dd,f xi_f'
 *                     + e2 sum_e (G_ee,d xi_d' + G_ee,e xi_e')
 *                     + t1 G_dd" + t2 sum_e G_ee",
 *   (A G)_de = <G_de> + G_de,f xi_f'.
 *
 * So strains that vary along f have their transverse strain along f alone, as
 * those of a plate: the others are free to give one. (The terms G_ee,e vanish,
 * but make A symmetric.)
 *
 * The determinant of F_a varies in a bent cell by the product of curvature and
 * stretch, which locks if K is large. So the law gets the volume ratio
 *
 *   J_a = det U (1 + tr X),   X = A(G) - U,
 *
 * that of the mean and the trace of the bending strains, which (e1, e2) make
 * small.
 *
 * A is its own transpose with masses as weights. Hence the energy sum V W(F_a,
 * J_a) has the derivative
 *
 *   sum V A(P^) : (g - S G)  +  M : (<g> - S U),   g = R^T dF,
 *   P^ = R^T dW/dF_a + dW/dJ_a det U 1,
 *   M  = sum V dW/dJ_a ((1 + tr X) cof U - det U 1),
 *   S  = R^T dR, the spin with axis 2 (tr(U) 1 - U)^-1 axis(<g>),
 *
 * which gives the nodal forces. Without the terms with S, which are quadratic
 * in the strain, a body at rest would not conserve its angular momentum. With
 * laws for small strain R = 1 and J_a = 1 + tr(F_a - 1): it is the operator of
 * strain_operator.h.
 */
namespace limber
{
  /** F_a of the points of a body in a cell, for packs or single points. */
  template <int dim, bool finite_strain, class Number = PointPack<dim>>
  class AssumedDeformation
  {
  public:
    using Matrix = SmallMatrix<dim, Number>;
    using Mean   = SmallMatrix<dim, double>;

    /** Means of a field G over the points, and in 3d its slopes: of G_de along
     * the third coordinate ("torsion"), and of G_dd along f ("bending"). */
    struct Means
    {
      Mean mean{}, torsion{}, bending{};
    };

    explicit AssumedDeformation(const StrainTreatment &treatment)
      : own(treatment.own)
      , mate(treatment.mate)
      , trilinear_own(treatment.trilinear_own)
      , trilinear_mate(treatment.trilinear_mate)
    {
      set_zero(sums);
    }

    /**
     * Add points with F at natural coordinates xi; @p mass zero in idle lanes.
     */
    __attribute__((always_inline)) void
    add(const Matrix &F, const std::array<Number, dim> &xi, const Number &mass)
    {
      sums[0] += mass;
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
        {
          sums[place_sum(d)] += mass * xi[d];
#pragma GCC unroll 8
          for (int e = 0; e < dim; ++e)
            sums[F_sum(d, e)] += mass * F[d][e];
          if constexpr (dim == 3)
            {
              const Number moment = mass * xi[d];
              sums[square_sum(d)] += moment * xi[d];
#pragma GCC unroll 8
              for (int c = 0; c < dim; ++c)
#pragma GCC unroll 8
                for (int e = 0; e < dim; ++e)
                  sums[slope_sum(d, c, e)] += moment * F[c][e];
            }
        }
    }

    /** After all points of the cell have been added: means and rotation. */
    __attribute__((always_inline)) void
    finish()
    {
      const auto   total        = sums_of_lanes();
      const double inverse_mass = 1 / total[0];
      Mean         mean;
      for (int d = 0; d < dim; ++d)
        {
          centroid[d] = total[place_sum(d)] * inverse_mass;
          for (int e = 0; e < dim; ++e)
            mean[d][e] = total[F_sum(d, e)] * inverse_mass;
        }
      if constexpr (finite_strain)
        rotation = rotation_of<dim>(mean);
      stretch = turned_back(mean);
      if constexpr (finite_strain)
        {
          volume           = determinant<dim>(stretch);
          trace_of_stretch = 0;
          for (int d = 0; d < dim; ++d)
            trace_of_stretch += stretch[d][d];
        }
      if constexpr (dim == 3)
        for (int f = 0; f < dim; ++f)
          {
            const double variance =
              total[square_sum(f)] * inverse_mass - centroid[f] * centroid[f];
            // points in one plane cannot resolve a torsion of the cell
            inverse_variance[f] = variance > 1e-12 ? 1 / variance : 0;
            for (int e = 0; e < dim; ++e)
              {
                std::array<double, dim> slope;
                for (int c = 0; c < dim; ++c)
                  slope[c] = inverse_variance[f] *
                             (total[slope_sum(f, c, e)] * inverse_mass -
                              centroid[f] * mean[c][e]);
                const auto turned = [&](const int d) {
                  if constexpr (finite_strain)
                    return rotation[0][d] * slope[0] +
                           rotation[1][d] * slope[1] +
                           rotation[2][d] * slope[2];
                  else
                    return slope[d];
                };
                of_points.bending[e][f] = turned(e);
                if (e != f)
                  of_points.torsion[3 - e - f][e] = turned(3 - e - f);
              }
          }
      of_points.mean = stretch;
    }

    /** R^T F, of packs or means */
    template <class Any>
    __attribute__((always_inline)) Any
    turned_back(const Any &F) const
    {
      if constexpr (finite_strain)
        return transpose_times<dim>(rotation, F);
      else
        return F;
    }

    /** R G */
    __attribute__((always_inline)) Matrix
    turned(const Matrix &G) const
    {
      if constexpr (finite_strain)
        return times<dim>(rotation, G);
      else
        return G;
    }

    /** A(R^T F) from F, at natural coordinates xi; F_a is R times this. */
    __attribute__((always_inline)) Matrix
    evaluate(const Matrix &F, const std::array<Number, dim> &xi) const
    {
      return assume(turned_back(F), of_points, xi);
    }

    /** J_a of what evaluate() returns. */
    __attribute__((always_inline)) Number
    volume_ratio(const Matrix &assumed) const
    {
      Number result = assumed[0][0];
#pragma GCC unroll 8
      for (int d = 1; d < dim; ++d)
        result += assumed[d][d];
      if constexpr (finite_strain)
        return volume * (result + (1. - trace_of_stretch));
      else
        return result - (dim - 1.);
    }

    /** A G, with the known means of G. */
    __attribute__((always_inline)) Matrix
    assume(const Matrix                  &G,
           const Means                   &means,
           const std::array<Number, dim> &xi) const
    {
      const Mean &mean = means.mean;
      Matrix      result;
      if constexpr (dim == 2)
        {
          const Number x = G[0][0] - mean[0][0], y = G[1][1] - mean[1][1];
          result[0][0] = mean[0][0] + own * x + mate * y;
          result[1][1] = mean[1][1] + own * y + mate * x;
          result[0][1] = broadcast<Number>(mean[0][1]);
          result[1][0] = broadcast<Number>(mean[1][0]);
          return result;
        }
      else
        {
          const auto             &slope = means.bending;
          std::array<Number, dim> x, bent, rest;
          Number                  all{};
#pragma GCC unroll 8
          for (int d = 0; d < dim; ++d)
            x[d] = xi[d] - centroid[d];
#pragma GCC unroll 8
          for (int d = 0; d < dim; ++d)
            {
              bent[d] =
                slope[d][0] * x[0] + slope[d][1] * x[1] + slope[d][2] * x[2];
              rest[d] = G[d][d] - mean[d][d] - bent[d];
              all += rest[d];
            }
#pragma GCC unroll 8
          for (int d = 0; d < dim; ++d)
            {
              const int e = (d + 1) % 3, f = (d + 2) % 3;
              result[d][d] = mean[d][d] + own * bent[d] +
                             mate * ((slope[e][d] + slope[f][d]) * x[d] +
                                     slope[e][e] * x[e] + slope[f][f] * x[f]) +
                             (trilinear_own - trilinear_mate) * rest[d] +
                             trilinear_mate * all;
              result[d][e] = mean[d][e] + means.torsion[d][e] * x[f];
              result[d][f] = mean[d][f] + means.torsion[d][f] * x[e];
            }
          return result;
        }
    }

    const double            own, mate;                     // e1, e2
    const double            trilinear_own, trilinear_mate; // t1, t2, 3d
    std::array<double, dim> centroid;                      // of the points
    Mean                    rotation;         // R, at finite strain
    Mean                    stretch;          // U = R^T <F>
    double                  volume;           // det U, at finite strain
    double                  trace_of_stretch; // tr U, at finite strain
    Means                   of_points;        // of R^T F
    std::array<double, dim> inverse_variance; // of the coordinates, 3d

  private:
    // Indices of the sums over points: masses, coordinates, F; in 3d squares of
    // coordinates and their products with F.
    static constexpr int
    place_sum(const int d)
    {
      return 1 + d;
    }
    static constexpr int
    F_sum(const int d, const int e)
    {
      return 1 + dim + d * dim + e;
    }
    static constexpr int
    square_sum(const int d)
    {
      return 1 + dim + dim * dim + d;
    }
    static constexpr int
    slope_sum(const int d, const int c, const int e)
    {
      return square_sum(dim) + (d * dim + c) * dim + e;
    }

    static constexpr std::size_t n_sums =
      dim == 2 ? F_sum(dim, 0) : slope_sum(dim, 0, 0);

    __attribute__((always_inline)) std::array<double, n_sums>
    sums_of_lanes() const
    {
      if constexpr (pack_width<Number> == 1)
        return sums;
      else
        return all_sums(sums);
    }

    std::array<Number, n_sums> sums;
  };



  /** The transpose of A: from the stress of the points to nodal forces. */
  template <int dim, bool finite_strain>
  class AssumedDeformationStress
  {
  public:
    using Number     = PointPack<dim>;
    using Matrix     = SmallMatrix<dim, Number>;
    using Mean       = SmallMatrix<dim, double>;
    using Assumption = AssumedDeformation<dim, finite_strain>;

    AssumedDeformationStress(const CellGeometry<dim> &cell,
                             const Assumption        &assumed)
      : assumed(assumed)
      , stress(cell)
    {
      set_zero(sums);
      set_zero(torque);
      set_zero(volumetric);
    }

    /**
     * First pass at finite strain: dW/dJ_a (Pa), J_a and volume (zero in idle
     * lanes).
     */
    __attribute__((always_inline)) void
    add_to_mean_volume(const Number &stress, const Number &J, const Number &V)
    {
      const Number weight = V * stress;
      volumetric[0] += weight;
      volumetric[1] += weight * J;
    }

    /** First pass over all points: P^ and volume (zero in idle lanes). */
    __attribute__((always_inline)) void
    add_to_means(const Matrix                  &P,
                 const std::array<Number, dim> &xi,
                 const Number                  &V)
    {
      sums[0] += V;
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
#pragma GCC unroll 8
        for (int e = 0; e < dim; ++e)
          {
            const Number VP = V * P[d][e];
            sums[1 + d * dim + e] += VP;
            if constexpr (dim == 3)
              {
                if (d != e)
                  {
                    const int f = 3 - d - e;
                    sums[torsion_sum(d, e)] +=
                      VP * (xi[f] - assumed.centroid[f]);
                  }
                else
#pragma GCC unroll 8
                  for (int f = 0; f < dim; ++f)
                    sums[bending_sum(d, f)] +=
                      VP * (xi[f] - assumed.centroid[f]);
              }
          }
    }

    __attribute__((always_inline)) void
    finish_means()
    {
      const auto total = all_sums(sums);
      inverse_volume   = 1 / total[0];
      for (int d = 0; d < dim; ++d)
        for (int e = 0; e < dim; ++e)
          {
            means.mean[d][e] = total[1 + d * dim + e] * inverse_volume;
            if constexpr (dim == 3)
              {
                if (d != e)
                  means.torsion[d][e] = total[torsion_sum(d, e)] *
                                        inverse_volume *
                                        assumed.inverse_variance[3 - d - e];
                means.bending[d][e] = total[bending_sum(d, e)] *
                                      inverse_volume *
                                      assumed.inverse_variance[e];
              }
          }
    }

    /** Second pass over all points, with F as well. */
    __attribute__((always_inline)) void
    add(const Matrix                  &P,
        const Matrix                  &F,
        const std::array<Number, dim> &xi,
        const Number                  &V)
    {
      Matrix Q = assumed.assume(P, means, xi);
      for (auto &row : Q)
        for (Number &entry : row)
          entry *= V;
      stress.add(assumed.turned(Q), xi);
      if constexpr (finite_strain)
        {
          monomials.add(xi, V);
          // (Q G^T)_fe - (Q G^T)_ef about each axis d; in 2d that of z
          const Matrix G = assumed.turned_back(F);
#pragma GCC unroll 8
          for (int c = 0; c < dim; ++c)
            if constexpr (dim == 2)
              torque[0] += Q[1][c] * G[0][c] - Q[0][c] * G[1][c];
            else
#pragma GCC unroll 8
              for (int d = 0; d < dim; ++d)
                {
                  const int e = (d + 1) % 3, f = (d + 2) % 3;
                  torque[d] += Q[f][c] * G[e][c] - Q[e][c] * G[f][c];
                }
        }
    }

    /** The forces on the nodes, one lane each, for each direction. */
    auto
    forces()
    {
      if constexpr (finite_strain)
        return stress.forces(stress_of_mean(), monomials.total());
      else
        return stress.forces();
    }

  private:
    /**
     * The part of the stress that is conjugate to d<F>, Pa: R (M - S) / sum(V),
     * that of the mean volume and that of the rotation of the frame, with S the
     * spin with axial vector H^-1 torque, H = tr(U) 1 - U (in 2d tr(U)).
     */
    Mean
    stress_of_mean() const
    {
      const Mean &U              = assumed.stretch;
      auto        total          = all_sums(torque);
      const auto  sums_of_volume = all_sums(volumetric);
      Mean        M              = cofactor<dim>(U);
      for (int d = 0; d < dim; ++d)
        {
          for (int e = 0; e < dim; ++e)
            M[d][e] *= sums_of_volume[1] / assumed.volume;
          M[d][d] -= sums_of_volume[0] * assumed.volume;
        }
      for (int c = 0; c < dim; ++c)
        if constexpr (dim == 2)
          total[0] += M[1][c] * U[0][c] - M[0][c] * U[1][c];
        else
          for (int d = 0; d < dim; ++d)
            {
              const int e = (d + 1) % 3, f = (d + 2) % 3;
              total[d] += M[f][c] * U[e][c] - M[e][c] * U[f][c];
            }
      Mean S;
      if constexpr (dim == 2)
        {
          const double w = total[0] / (U[0][0] + U[1][1]);
          S              = {{{{0, -w}}, {{w, 0}}}};
        }
      else
        {
          Mean H;
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e)
              H[d][e] = (d == e ? U[0][0] + U[1][1] + U[2][2] : 0.) - U[d][e];
          const auto            cof = cofactor<dim>(H);
          const double          one = 1 / determinant<dim>(H);
          std::array<double, 3> w{};
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e)
              w[d] += cof[e][d] * one * total[e];
          S = {{{{0, -w[2], w[1]}}, {{w[2], 0, -w[0]}}, {{-w[1], w[0], 0}}}};
        }
      for (int d = 0; d < dim; ++d)
        for (int e = 0; e < dim; ++e)
          S[d][e] = (M[d][e] - S[d][e]) * inverse_volume;
      return times<dim>(assumed.rotation, S);
    }

    const Assumption &assumed;

    static constexpr int
    torsion_sum(const int d, const int e)
    {
      return 1 + dim * dim + d * (dim - 1) + (e < d ? e : e - 1);
    }
    static constexpr int
    bending_sum(const int d, const int f)
    {
      return torsion_sum(dim, 0) + d * dim + f;
    }

    // sums of V, V P^ and, in 3d, first moments of V P^_de along the third
    // axis, and of V P^_dd along all
    std::array<Number, dim == 2 ? 5 : 25> sums;
    double                                inverse_volume = 0;
    typename Assumption::Means            means;
    std::array<Number, dim == 2 ? 1 : 3>  torque;
    std::array<Number, 2> volumetric; // sums of V dW/dJ_a, and times J_a
    StressOnNodes<dim>    stress;
    MonomialSums<dim>     monomials;
  };
} // namespace limber

#endif
