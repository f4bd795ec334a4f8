// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_convected_sweep_h
#define limber_stress_convected_sweep_h

#include <limber/interpolation/convected_motion.h>
#include <limber/interpolation/domain_means.h>
#include <limber/stress/law_on_points.h>

#include <stdexcept>

namespace limber
{
  /**
   * StressUpdate of points with domains: strained by the means of the velocity
   * gradient over them, or by its differences between their corners. The
   * projection is 'none', 'cell' or 'node'.
   */
  template <int dim, class Law, Projection kind>
  class ConvectedSweep final : public LawOnPoints<dim, Law>
  {
    using Base = LawOnPoints<dim, Law>;
    using Base::law;
    using Number = PointPack<dim>;
    using Layout = NodeLayout<dim>;

  public:
    ConvectedSweep(const Law &law, const StrainProjection &projection)
      : Base(law)
      , strain_projection(projection)
    {}

    StressSummary
    update(const PointView<dim> &points,
           const GridView<dim>  &grid,
           const CellSums<dim> *,
           const StressSweep &what) const override
    {
      return what.remapped ?
               sweep<Layout::velocity, Layout::remapped>(points, grid, what) :
               sweep<Layout::increment, Layout::velocity>(points, grid, what);
    }

    bool
    takes_velocity() const override
    {
      return true;
    }

    void
    sum_deviators(const PointView<dim> &, const CellSums<dim> &) const override
    {
      throw std::logic_error("histories are not averaged with domains");
    }

    double
    relax_deviators(const PointView<dim> &,
                    const double *,
                    double) const override
    {
      throw std::logic_error("histories are not averaged with domains");
    }

    const StrainProjection &
    projection() const override
    {
      return strain_projection;
    }

  private:
    /**
     * With the two fields of velocities from slot @p first on, the second of
     * which strains the points.
     */
    template <unsigned int first, unsigned int strained>
    StressSummary
    sweep(const PointView<dim> &points,
          const GridView<dim>  &grid,
          const StressSweep    &what) const
    {
      using Fields = FieldsOnPack<dim, RecordWindow<dim, first, 2 * dim>>;
      const bool              measure_waves = !law.has_constant_wave_speed();
      typename Base::Findings found;
      VelocityFindings<dim>   taken;
      Number                  displacement{};
      for_each_batch(points, [&](const CellBatch &batch) {
        const CellGeometry<dim>    &cell = grid.cells[batch.cell];
        const DomainMean<dim, kind> divergence(what.projected_divergence,
                                               cell,
                                               batch.cell);
        for_each_pack<dim>(batch, [&](const auto &lanes) {
          const ConvectedPack<dim> domains(points, grid, batch.cell, lanes);
          const Fields             fields(domains);
          if constexpr (first == Layout::increment)
            if (what.flip_share)
              take_velocity<dim>(
                points, lanes, fields, *what.flip_share, taken);

          MotionIncrement<dim, Number> motion;
          motion.step   = what.step;
          motion.square = what.square;
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e)
              motion.gradient[d][e] =
                what.step * fields.slope(domains.inverse, strained + d, e);
          if constexpr (kind != Projection::none)
            motion.volumetric = what.step * divergence.template value<Number>(
                                              lanes.natural(points, cell));
          else
            motion.volumetric = motion.trace();
          this->strain(
            points,
            lanes,
            motion,
            [](auto &, const Number &) {},
            measure_waves,
            found);
          if (what.move > 0)
            displacement =
              larger(displacement,
                     move_domains(domains, lanes, fields, what.move));
        });
      });
      StressSummary result = this->summary(found, measure_waves);
      result.displacement  = maximum(displacement);
      result.speed_squared = maximum(taken.speed_squared);
      result.removed       = sum(taken.removed);
      return result;
    }

    const StrainProjection strain_projection;
  };
} // namespace limber

#endif
