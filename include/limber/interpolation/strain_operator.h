// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_strain_operator_h
#define limber_interpolation_strain_operator_h

#include <limber/interpolation/cell_means.h>
#include <limber/interpolation/nodal_means.h>
#include <limber/materials/law.h>
#include <limber/materials/treatment.h>

/**
 * @file The strain operator B of each locking treatment (B-bar) and its
 * transpose. B maps the velocities of the nodes of a cell to the rate of
 * deformation at the points of a body in it; its transpose maps their stresses
 * to internal nodal forces. Both are in one file because a treatment is
 * consistent (conserves energy in space) if and only if one is the transpose
 * of the other with the same weights: sum f_i v_i = - sum V (stress : B v),
 * for all v and stresses.
 *
 * Both use the coefficients c_k of the monomials of a component of velocity,
 * u = c_0 + c_1 xi + c_2 eta + c_3 xi eta + ... (bits of k: coordinates), and
 * the means over the points of the derivatives of these monomials. Brackets are
 * such a mean, a prime the deviation from it; d, e, f are different axes.
 *
 *   none            D = grad v
 *   cell            dev D = dev grad v,  tr D = <div v>
 *   cell_shear      as cell, but D_de = <D_de>
 *   cell_full       D = <grad v>
 *   assumed_strain  D_dd = <D_dd> + sum_e (e1 c^d_de/h_d xi_e' +
 *                                          e2 c^e_de/h_e xi_d')
 *                          + trilinear terms in the same way (3d),
 *                 2 D_de = <2 D_de> + (c^d_ef/h_e + c^e_df/h_d) xi_f' (3d)
 *   node            dev D = dev grad v,  tr D = S div v
 *   hybrid          as node, but D_de = <D_de>
 *
 * with S the projection on nodes of nodal_means.h. It is its own transpose
 * with masses as weights, so that the force is formed with S p instead of the
 * pressure p.
 *
 * Derivation and proofs: doc/theory/treatments.md.
 *
 * Loops over directions are unrolled by pragmas: GCC does not do it in function
 * bodies as large as these, and arrays with variable indices then live in
 * memory, which makes the sweeps half as slow again in 3d.
 */
namespace limber
{
  /** Whether the shear strain of points is replaced (by a mean, or assumed). */
  inline constexpr bool
  replaces_shear(const Treatment kind)
  {
    return averages_shear_in_cells(kind) || kind == Treatment::assumed_strain;
  }



  /**
   * The strain operator B of a cell, applied to one velocity field, times dt.
   */
  template <class Basis, Treatment kind, class Coefficients>
  class StrainOperator
  {
  public:
    static constexpr int dim = Basis::dim;

    /**
     * @p velocity is a NodalCoefficients::VectorField of m/s; @p nodal is
     * S div v, 1/s; @p step in s.
     */
    __attribute__((always_inline))
    StrainOperator(const Coefficients         &velocity,
                   const CellGeometry<dim>    &cell,
                   const CellMeans<Basis>     &means,
                   const NodalMean<dim, kind> &nodal,
                   const StrainTreatment      &treatment,
                   const double                step)
      : velocity(velocity)
      , nodal(nodal)
      , step(step)
    {
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
        scale[d] = step * cell.inverse_edge[d];
      if constexpr (kind == Treatment::none || kind == Treatment::node)
        return;
      else if constexpr (kind == Treatment::cell)
#pragma GCC unroll 8
        for (int d = 0; d < dim; ++d)
          divergence += scale[d] * means.derivative(velocity(d), d);
      else
        {
          const auto derivatives = means.derivatives_of(velocity);
#pragma GCC unroll 8
          for (int d = 0; d < dim; ++d)
            mean_gradient[d] = scale[d] * derivatives[d];
          read_from_memory<dim>(mean_gradient);
          if constexpr (averages_volume_in_cells(kind))
#pragma GCC unroll 8
            for (int d = 0; d < dim; ++d)
              divergence += mean_gradient[d][lane + d];
          if constexpr (kind == Treatment::assumed_strain)
            set_hourglass(means, treatment);
        }
    }

    /**
     * dt D + dt W at natural coordinates xi, with the spin W not averaged;
     * optionally without W if averages make that cheaper.
     */
    template <class Number, bool with_spin = true>
    __attribute__((always_inline)) void
    evaluate(const std::array<Number, dim> &xi,
             MotionIncrement<dim, Number>  &motion) const
    {
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
        {
          const auto derivatives =
            Basis::template gradient<Number>(velocity(d), xi);
#pragma GCC unroll 8
          for (int e = 0; e < dim; ++e)
            motion.gradient[d][e] = scale[e] * derivatives[e];
        }
      if constexpr (replaces_shear(kind))
        {
          [[maybe_unused]] std::array<Number, dim> deviation;
          if constexpr (kind == Treatment::assumed_strain)
#pragma GCC unroll 8
            for (int d = 0; d < dim; ++d)
              deviation[d] = xi[d] - centroid[d];
#pragma GCC unroll 8
          for (int d = 0; d < dim; ++d)
            {
              if constexpr (kind == Treatment::cell_full)
                motion.gradient[d][d] =
                  broadcast<Number>(mean_gradient[d][lane + d]);
#pragma GCC unroll 8
              for (int e = 0; e < d; ++e)
                {
                  Number shear =
                    broadcast<Number>(0.5 * (mean_gradient[d][lane + e] +
                                             mean_gradient[e][lane + d]));
                  if constexpr (kind == Treatment::assumed_strain && dim == 3)
                    {
                      const int f = 3 - d - e;
                      shear += torsion[f] * deviation[f];
                    }
                  Number spin{};
                  if constexpr (with_spin)
                    spin =
                      0.5 * (motion.gradient[d][e] - motion.gradient[e][d]);
                  motion.gradient[d][e] = shear + spin;
                  motion.gradient[e][d] = shear - spin;
                }
            }
          if constexpr (kind == Treatment::assumed_strain)
            set_assumed_normals(deviation, motion);
        }
      if constexpr (kind == Treatment::none ||
                    kind == Treatment::assumed_strain)
        motion.volumetric = motion.trace();
      else if constexpr (averages_around_nodes(kind))
        motion.volumetric = step * nodal.template value<Number>(xi);
      else
        motion.volumetric = broadcast<Number>(divergence);
    }

  private:
    // With components as lanes: this work is per cell, not per point, and with
    // eight points per cell scalar code would be noticeable.
    __attribute__((always_inline)) void
    set_hourglass(const CellMeans<Basis> &means,
                  const StrainTreatment  &treatment)
    {
      Components scales{};
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
        {
          centroid[d]      = means[1 << d];
          scales[lane + d] = scale[d];
        }
      if constexpr (dim == 2)
        {
          const Components mode = scales * velocity.components(3);
          modes.own[0]          = treatment.own * mode;
          modes.mate[0]         = treatment.mate * mode;
        }
      else
        {
          // The coefficients of the bilinear modes (f: the axis not in them) in
          // monomials of deviations from the centroid. Monomials of the cell
          // have their origin in one of its corners, which would give mirrored
          // motions strains that are not mirrored.
          const Components trilinear = velocity.components(7);
#pragma GCC unroll 8
          for (int f = 0; f < dim; ++f)
            {
              modes.bilinear[f] =
                velocity.components(7 ^ (1 << f)) + trilinear * centroid[f];
              modes.own[f]  = (treatment.own * scales) * modes.bilinear[f];
              modes.mate[f] = (treatment.mate * scales) * modes.bilinear[f];
            }
          modes.own[dim]  = (treatment.trilinear_own * scales) * trilinear;
          modes.mate[dim] = (treatment.trilinear_mate * scales) * trilinear;
        }
      read_from_memory<dim>(modes);
      if constexpr (dim == 3)
#pragma GCC unroll 8
        for (int d = 0; d < dim; ++d)
          {
            const int e = (d + 1) % 3, f = (d + 2) % 3;
            product_mean[d] =
              means[1 << e | 1 << f] - centroid[e] * centroid[f];
            torsion[d] = 0.5 * (scale[f] * modes.bilinear[e][lane + e] +
                                scale[e] * modes.bilinear[f][lane + f]);
          }
    }

    template <class Number>
    __attribute__((always_inline)) void
    set_assumed_normals(const std::array<Number, dim> &deviation,
                        MotionIncrement<dim, Number>  &motion) const
    {
      [[maybe_unused]] std::array<Number, dim> product;
      if constexpr (dim == 3)
#pragma GCC unroll 8
        for (int d = 0; d < dim; ++d)
          product[d] =
            deviation[(d + 1) % 3] * deviation[(d + 2) % 3] - product_mean[d];
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
        {
          const int e = (d + 1) % dim, f = (d + 2) % dim;
          Number    normal = broadcast<Number>(mean_gradient[d][lane + d]);
          if constexpr (dim == 2)
            normal += modes.own[0][lane + d] * deviation[e] +
                      modes.mate[0][lane + e] * deviation[d];
          else
            {
              normal += modes.own[f][lane + d] * deviation[e];
              normal += modes.own[e][lane + d] * deviation[f];
              normal += modes.mate[f][lane + e] * deviation[d];
              normal += modes.mate[e][lane + f] * deviation[d];
              normal += modes.own[dim][lane + d] * product[d];
              normal += modes.mate[dim][lane + e] * product[e];
              normal += modes.mate[dim][lane + f] * product[f];
            }
          motion.gradient[d][d] = normal;
        }
    }

    using Components          = typename Coefficients::Components;
    static constexpr int lane = Coefficients::first_lane; // of component 0

    const Coefficients         &velocity;
    const NodalMean<dim, kind> &nodal;
    const double                step;
    std::array<double, dim>     scale;
    double                      divergence = 0;
    std::array<Components, dim> mean_gradient; // <du/dx_d>
    // Assumed strain, times dt. In 3d bilinear modes are numbered by the axis
    // that is not in them; the last mode is trilinear.
    struct Modes
    {
      // contribution of a mode to the normal strain along the axis of the
      // component, and along the other axes of the mode
      std::array<Components, dim == 2 ? 1 : 4> own, mate;
      std::array<Components, dim == 2 ? 0 : 3> bilinear; // about the centroid
    };
    Modes                   modes;
    std::array<double, dim> centroid;
    std::array<double, dim> product_mean; // <xi_e' xi_f'> of the two other axes
    std::array<double, dim> torsion; // slope along d of the shear normal to it
  };



  /**
   * The transpose B^T: sums up what the stress of the points of a batch
   * contributes to the coefficients c_k, and maps these to nodal forces.
   */
  template <int dim, Treatment kind, bool deviator>
  class StressOperator
  {
  public:
    using Number = PointPack<dim>;
    using Nodes  = typename Linear<dim>::Nodes;

    /** @p nodal is the projected pressure S p, Pa. */
    StressOperator(const CellGeometry<dim>      &cell,
                   const StrainTreatment        &treatment,
                   const CellMeans<Linear<dim>> &means,
                   const NodalMean<dim, kind>   &nodal)
      : cell(cell)
      , treatment(treatment)
      , means(means)
      , nodal(nodal)
    {}

    /**
     * Add the points from @p first on, at most a pack and at most @p n; lanes
     * beyond are read as well but have zero weight. With @p begins the sums
     * need not be initialised: few batches have more than one pack.
     */
    template <bool begins>
    __attribute__((always_inline)) void
    add(const PointView<dim> &points,
        const std::size_t     first,
        const std::size_t     n,
        const double          inverse_density)
    {
      const auto read = [first](const double *const array) {
        return load<Number>(array + first);
      };
      Number volume = inverse_density * read(points.mass);
      if (n < std::size_t(pack_width<Number>))
        volume = first_lanes<Number>(n) ? volume : Number{};
      std::array<Number, dim> xi;
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
        xi[d] = (read(points.place[d]) - cell.origin[d]) * cell.inverse_edge[d];

      Number p;
      if constexpr (averages_around_nodes(kind))
        p = volume * nodal.template value<Number>(xi);
      else
        p = volume * read(points.pressure);
      if constexpr (mean_pressure)
        accumulate<begins>(pressure, p);
      if constexpr (deviator || !mean_pressure)
        {
          std::array<std::array<Number, dim>, dim> t{};
          if constexpr (deviator)
            {
              t[0][0] = volume * read(points.deviator[0]);
              t[1][1] = volume * read(points.deviator[1]);
              t[1][0] = t[0][1] = volume * read(points.deviator[2]);
              if constexpr (dim == 3)
                {
                  t[2][2] = -(t[0][0] + t[1][1]);
                  t[2][1] = t[1][2] = volume * read(points.deviator[3]);
                  t[2][0] = t[0][2] = volume * read(points.deviator[4]);
                }
            }
          if constexpr (!mean_pressure)
#pragma GCC unroll 8
            for (int d = 0; d < dim; ++d)
              t[d][d] -= p;
#pragma GCC unroll 8
          for (int d = 0; d < dim; ++d)
#pragma GCC unroll 8
            for (int e = 0; e <= d; ++e)
              if (deviator || d == e)
                accumulate<begins>(stress[d][e], t[d][e]);
          add_hourglass<begins>(t, xi);
        }
    }

    /** Scale the contribution of the pressure of the points. */
    void
    scale_pressure(const double share)
    {
      static_assert(mean_pressure);
      pressure *= share;
    }

    /** The forces on the nodes, one lane each, for each direction. */
    __attribute__((always_inline)) std::array<Nodes, dim>
    forces() const
    {
      std::array<Nodes, dim> result{};
      double                 total_pressure = 0;
      if constexpr (mean_pressure && !pressure_in_lane)
        total_pressure = sum(pressure);
      if constexpr (deviator || !mean_pressure)
        {
#pragma GCC unroll 8
          for (int d = 0; d < dim; ++d)
            {
              result[d] = on_coefficients(d);
              if (pressure_in_lane && d == 0)
                total_pressure = result[d][0];
            }
          if constexpr (replaces_shear(kind))
            distribute(result);
          else
            {
              Nodes scale = broadcast<Nodes>(1.);
              scale[0]    = 0; // c_0 has no force; its lane may be in use
#pragma GCC unroll 8
              for (int e = 0; e < dim; ++e)
                scale[1 << e] = cell.inverse_edge[e];
#pragma GCC unroll 8
              for (int d = 0; d < dim; ++d)
                result[d] *= scale;
            }
        }
      if constexpr (mean_pressure)
#pragma GCC unroll 8
        for (int d = 0; d < dim; ++d)
          result[d] -=
            means.derivatives(d, total_pressure * cell.inverse_edge[d]);
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
        result[d] = -Linear<dim>::to_nodes(result[d]);
      return result;
    }

  private:
    static constexpr bool mean_pressure = averages_volume_in_cells(kind);
    // No force acts on c_0, so that its lane can be used for the sum of the
    // pressures. Faster with eight lanes only.
    static constexpr bool pressure_in_lane =
      mean_pressure && deviator && dim == 3;
    static constexpr bool normal_as_is =
      kind == Treatment::cell_shear || kind == Treatment::hybrid;

    template <bool begins>
    __attribute__((always_inline)) static void
    accumulate(Number &sum, const Number &value)
    {
      if constexpr (begins)
        sum = value;
      else
        sum += value;
    }

    /**
     * The forces on the coefficients c_k of component d, in lane k; for linear
     * modes the summed stress alone.
     */
    __attribute__((always_inline)) Nodes
    on_coefficients(const int d) const
    {
      std::array<Number, 1 << dim> a{};
#pragma GCC unroll 8
      for (int e = 0; e < dim; ++e)
        a[1 << e] = e <= d ? stress[d][e] : stress[e][d];
      if constexpr (kind != Treatment::cell_full)
#pragma GCC unroll 8
        for (int k = 3; k < 1 << dim; ++k)
          if (k & (k - 1))
            a[k] = hourglass[d][k];
      if (pressure_in_lane && d == 0)
        a[0] = pressure;
      return sums_over_lanes(a);
    }

    /**
     * Stress that is work conjugate to mean gradients acts on all modes. Done
     * for all components after their sums, in two dependency chains: with one
     * chain each, right after its sum, the processor stalled.
     */
    __attribute__((always_inline)) void
    distribute(std::array<Nodes, dim> &on_coefficients) const
    {
      std::array<Nodes, dim>                  slopes;
      [[maybe_unused]] std::array<Nodes, dim> of_trilinear;
#pragma GCC unroll 8
      for (int e = 0; e < dim; ++e)
        {
          slopes[e] = means.derivatives(e, cell.inverse_edge[e]);
          if constexpr (dim == 3)
            of_trilinear[e] = Linear<dim>::last() * means[1 << e];
        }
      std::array<Nodes, dim> single = on_coefficients;
      read_from_memory<dim>(single);
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
        {
          on_coefficients[d] *= Linear<dim>::bilinear();
          // bilinear modes about the centroid contain part of c_7
          if constexpr (kind == Treatment::assumed_strain && dim == 3)
#pragma GCC unroll 8
            for (int f = 0; f < dim; ++f)
              on_coefficients[d] += single[d][7 ^ (1 << f)] * of_trilinear[f];
          Nodes of_means{};
#pragma GCC unroll 8
          for (int e = 0; e < dim; ++e)
            if (normal_as_is && d == e)
              of_means += (single[d][1 << e] * cell.inverse_edge[e]) *
                          Linear<dim>::linear(e);
            else
              of_means += single[d][1 << e] * slopes[e];
          on_coefficients[d] += of_means;
        }
    }

    /** Add the forces of the points on coefficients of hourglass modes. */
    template <bool begins>
    __attribute__((always_inline)) void
    add_hourglass(const std::array<std::array<Number, dim>, dim> &t,
                  const std::array<Number, dim>                  &place)
    {
      if constexpr (kind == Treatment::cell_full)
        return;
      const double *const h = cell.inverse_edge.data();
      // coordinates relative to the centroid for the assumed strain
      std::array<Number, dim> xi = place;
      if constexpr (kind == Treatment::assumed_strain)
#pragma GCC unroll 8
        for (int d = 0; d < dim; ++d)
          xi[d] -= means[1 << d];
      if constexpr (kind == Treatment::assumed_strain && dim == 3)
#pragma GCC unroll 8
        for (int d = 0; d < dim; ++d)
          {
            const int    e = (d + 1) % dim, f = (d + 2) % dim;
            const Number product =
              (place[e] - means[1 << e]) * (place[f] - means[1 << f]) -
              (means[1 << e | 1 << f] - means[1 << e] * means[1 << f]);
            accumulate<begins>(hourglass[d][7],
                               (treatment.trilinear_own * t[d][d] +
                                treatment.trilinear_mate *
                                  (t[e][e] + t[f][f])) *
                                 (h[d] * product));
          }

#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
        {
          const int e = (d + 1) % dim, f = (d + 2) % dim;
          add_bilinear<begins>(t, xi, d, e);
          if constexpr (dim == 3)
            {
              add_bilinear<begins>(t, xi, d, f);
              if constexpr (!normal_as_is)
                accumulate<begins>(hourglass[d][1 << e | 1 << f],
                                   t[d][e] * (h[e] * xi[f]) +
                                     t[d][f] * (h[f] * xi[e]));
              if constexpr (normal_as_is)
                accumulate<begins>(hourglass[d][7],
                                   t[d][d] * (h[d] * (xi[e] * xi[f])));
              if constexpr (!replaces_shear(kind))
                accumulate<begins>(hourglass[d][7],
                                   t[d][d] * (h[d] * (xi[e] * xi[f])) +
                                     t[d][e] * (h[e] * (xi[d] * xi[f])) +
                                     t[d][f] * (h[f] * (xi[d] * xi[e])));
            }
        }
    }

    /** For the mode xi_d xi_e of component d. */
    template <bool begins>
    __attribute__((always_inline)) void
    add_bilinear(const std::array<std::array<Number, dim>, dim> &t,
                 const std::array<Number, dim>                  &xi,
                 const int                                       d,
                 const int                                       e)
    {
      const double *const h       = cell.inverse_edge.data();
      Number             &on_mode = hourglass[d][1 << d | 1 << e];
      if constexpr (kind == Treatment::assumed_strain)
        accumulate<begins>(on_mode,
                           (treatment.own * t[d][d] +
                            treatment.mate * t[e][e]) *
                             (h[d] * xi[e]));
      else if constexpr (normal_as_is)
        accumulate<begins>(on_mode, t[d][d] * (h[d] * xi[e]));
      else
        accumulate<begins>(on_mode,
                           t[d][d] * (h[d] * xi[e]) + t[d][e] * (h[e] * xi[d]));
    }

    const CellGeometry<dim>      &cell;
    const StrainTreatment        &treatment;
    const CellMeans<Linear<dim>> &means;
    const NodalMean<dim, kind>   &nodal;

    Number                                        pressure{};
    std::array<std::array<Number, dim>, dim>      stress{};
    std::array<std::array<Number, 1 << dim>, dim> hourglass{};
  };
} // namespace limber

#endif
