// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_convected_sweep_h
#define limber_stress_convected_sweep_h

#include <limber/interpolation/convected_fields.h>
#include <limber/interpolation/nodal_means.h>
#include <limber/stress/law_on_points.h>

#include <stdexcept>

namespace limber
{
  /**
   * StressUpdate of points with convected domains: strained by the differences
   * of the velocity between their corners. The projection is 'none' or 'node'.
   */
  template <int dim, class Law, Projection kind>
  class ConvectedSweep final : public LawOnPoints<dim, Law>
  {
    using Base = LawOnPoints<dim, Law>;
    using Base::law;
    using Number = PointPack<dim>;
    using Layout = NodeLayout<dim>;
    using Domain = ConvectedDomain<dim>;
    // new velocity and, right behind it, the re-mapped one
    using Window = RecordWindow<dim, Layout::velocity, 2 * dim>;
    using Fields = FieldsOnDomain<dim, Window>;

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
      const bool              measure_waves = !law.has_constant_wave_speed();
      typename Base::Findings found;
      Number                  displacement{};
      for_each_batch(points, [&](const CellBatch &batch) {
        const CellGeometry<dim>   &cell = grid.cells[batch.cell];
        const NodalMean<dim, kind> divergence(what.nodal_divergence, cell);
        for_each_pack<dim>(batch, [&](const auto &lanes) {
          MotionIncrement<dim, Number> motion;
          std::array<Number, dim>      shift;
          motion.step = what.step;
          set_motion(points, grid, batch.cell, lanes, what, motion, shift);
          if constexpr (averages_around_nodes(kind))
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
            {
              displacement =
                larger(displacement,
                       move_points<dim>(points, grid, batch.cell, lanes, shift)
                         .displacement);
              enter_corners(points, grid, lanes.first, lanes.first + lanes.n);
            }
        });
      });
      StressSummary result = this->summary(found, measure_waves);
      result.displacement  = maximum(displacement);
      return result;
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
    /** dt grad v and how far points move; carries domains that move along. */
    template <class Lanes>
    static void
    set_motion(const PointView<dim>         &points,
               const GridView<dim>          &grid,
               const std::uint32_t           cell,
               const Lanes                  &lanes,
               const StressSweep            &what,
               MotionIncrement<dim, Number> &motion,
               std::array<Number, dim>      &shift)
    {
      constexpr int      width                      = pack_width<Number>;
      alignas(64) double gradient[dim * dim][width] = {};
      alignas(64) double moved[dim][width]          = {};
      const unsigned int strained =
        what.remapped ? Layout::remapped : Layout::velocity;
      for (int i = 0; i < lanes.n; ++i)
        {
          const std::size_t p = lanes.first + i;
          const Domain      domain(points, grid, cell, p);
          const Fields      fields(domain, grid);
          const auto        inverse = domain.inverse();
          for (int d = 0; d < dim; ++d)
            {
              for (int e = 0; e < dim; ++e)
                gradient[d * dim + e][i] =
                  what.step * fields.slope(inverse, strained + d, e);
              moved[d][i] = what.move * fields.value(Layout::velocity + d);
            }
          if (what.move > 0)
            carry_domain<Fields, dim>(points, p, fields, inverse, what.move);
        }
      for (int d = 0; d < dim; ++d)
        {
          for (int e = 0; e < dim; ++e)
            motion.gradient[d][e] = load<Number>(gradient[d * dim + e]);
          shift[d] = load<Number>(moved[d]);
        }
    }

    const StrainProjection strain_projection;
  };
} // namespace limber

#endif
