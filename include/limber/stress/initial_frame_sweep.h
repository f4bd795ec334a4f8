// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_initial_frame_sweep_h
#define limber_stress_initial_frame_sweep_h

#include <limber/interpolation/assumed_deformation.h>
#include <limber/interpolation/basis.h>
#include <limber/stress/law_on_points.h>

namespace limber
{
  /**
   * StressUpdate for an elastic law in the frame of the initial configuration
   * (total Lagrangian): the functions are those of the initial places, F
   * grows by dt grad_X v, and the stress follows from F alone, so that no
   * error of a step stays in it.
   *
   * With the projection 'cell' the volumetric part of the stress follows from
   * the mean of the volume ratio over the points of the cell, with
   * 'assumed_strain', which is that of linear functions, all of it from the F_a
   * of assumed_deformation.h. The points never leave their cell, so they always
   * are one batch, on one rank.
   */
  template <class Basis, class Law, Projection kind>
  class InitialFrameSweep final : public LawOnPoints<Basis::dim, Law>
  {
    static constexpr int dim = Basis::dim;
    using Base               = LawOnPoints<dim, Law>;
    using Base::law;
    using Base::store_state;
    using Number = PointPack<dim>;
    using Matrix = SmallMatrix<dim, Number>;

  public:
    InitialFrameSweep(const Law &law, const StrainProjection &projection)
      : Base(law)
      , force{Law::finite_strain, projection}
    {}

    StressSummary
    update(const PointView<dim> &points,
           const GridView<dim>  &grid,
           const CellSums<dim> *,
           const StressSweep &what) const override
    {
      using Layout = NodeLayout<dim>;
      Number waves{};
      for_each_batch(points, [&](const CellBatch &batch) {
        const CellGeometry<dim> &cell = grid.cells[batch.cell];
        // new velocity, then the re-mapped one
        const NodalCoefficients<Basis, Layout::velocity, 2 * dim> nodal(
          grid, batch.cell);
        const auto velocity = nodal.field(what.remapped ? dim : 0);
        const auto deformed = [&](const auto &lanes) {
          return deform(points, cell, velocity, what.step, lanes);
        };
        if constexpr (kind == Projection::none)
          for_each_pack<dim>(batch, [&](const auto &lanes) {
            const Matrix F = deformed(lanes);
            set_stress(points, F, volume_ratio_of(F), lanes, waves);
          });
        else if constexpr (kind == Projection::cell)
          {
            Number mass{}, volume{};
            for_each_pack<dim>(batch, [&](const auto &lanes) {
              const Matrix F = deformed(lanes);
              const Number m = lanes.only_active(lanes.load(points.mass));
              mass += m;
              volume += m * volume_ratio_of(F);
            });
            const Number J = broadcast<Number>(sum(volume) / sum(mass));
            for_each_pack<dim>(batch, [&](const auto &lanes) {
              set_stress(points,
                         deformation_gradient<dim>(points, lanes),
                         J,
                         lanes,
                         waves);
            });
          }
        else
          {
            AssumedDeformation<dim, Law::finite_strain> assumed(
              force.projection);
            for_each_pack<dim>(batch, [&](const auto &lanes) {
              assumed.add(deformed(lanes),
                          lanes.natural(points, cell),
                          lanes.only_active(lanes.load(points.mass)));
            });
            assumed.finish();
            for_each_pack<dim>(batch, [&](const auto &lanes) {
              const Matrix F =
                assumed.evaluate(deformation_gradient<dim>(points, lanes),
                                 lanes.natural(points, cell));
              set_stress(points, F, volume_ratio_of(F), lanes, waves);
            });
          }
        if (what.move > 0)
          for_each_pack<dim>(batch, [&](const auto &lanes) {
            move(points, cell, nodal, what.move, lanes);
          });
      });

      StressSummary result;
      result.wave_speed_squared = maximum(waves);
      return result;
    }

    void
    sum_deviators(const PointView<dim> &, const CellSums<dim> &) const override
    {
      throw std::logic_error("histories are not averaged in this frame");
    }

    double
    relax_deviators(const PointView<dim> &,
                    const double *,
                    double) const override
    {
      throw std::logic_error("histories are not averaged in this frame");
    }

    /** Means are in the stress already: the force needs none. */
    const StrainProjection &
    projection() const override
    {
      static const StrainProjection nothing;
      return nothing;
    }

    std::optional<InitialFrameForce>
    initial_frame() const override
    {
      return force;
    }

  private:
    /** F + dt grad_X v; it is stored. */
    template <class Velocity, class Lanes>
    __attribute__((always_inline)) static Matrix
    deform(const PointView<dim>    &points,
           const CellGeometry<dim> &cell,
           const Velocity          &velocity,
           const double             step,
           const Lanes             &lanes)
    {
      const auto xi = lanes.natural(points, cell);
      Matrix     F;
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
        {
          const auto slope = Basis::template gradient<Number>(velocity(d), xi);
#pragma GCC unroll 8
          for (int e = 0; e < dim; ++e)
            {
              double *const array = points.deformation[d * dim + e];
              F[d][e] =
                lanes.load(array) + (step * cell.inverse_edge[e]) * slope[e];
              lanes.store(F[d][e], array);
            }
        }
      return F;
    }

    static Number
    volume_ratio_of(const Matrix &F)
    {
      if constexpr (Law::finite_strain)
        return determinant<dim>(F);
      Number result = F[0][0];
      for (int d = 1; d < dim; ++d)
        result += F[d][d] - 1.;
      return result;
    }

    template <class Lanes>
    __attribute__((always_inline)) void
    set_stress(const PointView<dim> &points,
               const Matrix         &F,
               const Number         &J,
               const Lanes          &lanes,
               Number               &waves) const
    {
      const auto state = law.template at_deformation<dim>(F, J);
      store_state(points, state, [&](const Number &value, double *const array) {
        lanes.store(value, array);
      });
      Number speed = law.template wave_speed_squared<dim>(state);
      if constexpr (Law::finite_strain)
        speed *= largest_shortening(F);
      waves = larger(waves, lanes.only_active(speed));
    }

    /**
     * A bound (Gershgorin) of the largest eigenvalue of F^-1 F^-T: the square
     * of how many initial lengths a wave passes in one present length. One at
     * rest and in any rotation.
     */
    static Number
    largest_shortening(const Matrix &F)
    {
      const Matrix cof  = cofactor<dim>(F);
      const Number J    = determinant<dim>(F);
      Number       most = Number{};
      for (int i = 0; i < dim; ++i)
        {
          Number row{};
          for (int j = 0; j < dim; ++j)
            {
              Number entry{};
              for (int k = 0; k < dim; ++k)
                entry += cof[k][i] * cof[k][j];
              row += magnitude(entry);
            }
          most = larger(most, row);
        }
      return most / (J * J);
    }

    template <class Nodal, class Lanes>
    __attribute__((always_inline)) static void
    move(const PointView<dim>    &points,
         const CellGeometry<dim> &cell,
         const Nodal             &nodal,
         const double             step,
         const Lanes             &lanes)
    {
      const auto xi = lanes.natural(points, cell);
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
        lanes.store(lanes.load(points.position[d]) +
                      step *
                        Basis::template value<Number>(nodal.component(d), xi),
                    points.position[d]);
    }

    const InitialFrameForce force;
  };
} // namespace limber

#endif
