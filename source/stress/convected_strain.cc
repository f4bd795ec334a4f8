// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/convected_motion.h>
#include <limber/interpolation/domain_means.h>
#include <limber/stress/convected_sweep.h>

namespace limber
{
  namespace
  {
    /**
     * With the two fields of velocities from slot @p first on, that from
     * @p strained on strains the points.
     */
    template <int dim, unsigned int first, unsigned int strained>
    StressSummary
    strain_by(const PointView<dim>  &points,
              const GridView<dim>   &grid,
              const StressSweep     &what,
              const Projection       kind,
              const PackStrain<dim> &law,
              PackFindings<dim>     &found)
    {
      using Number = PointPack<dim>;
      using Layout = NodeLayout<dim>;
      using Fields = FieldsOnPack<dim, RecordWindow<dim, first, 2 * dim>>;
      VelocityFindings<dim> taken;
      Number                displacement{};
      for_each_batch(points, [&](const CellBatch &batch) {
        const CellGeometry<dim> &cell = grid.cells[batch.cell];
        const DomainMean<dim>    divergence(kind,
                                         what.projected_divergence,
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
          motion.volumetric =
            divergence.is_averaged() ?
              what.step * divergence.value(lanes.natural(points, cell)) :
              motion.trace();
          law.strain_pack(points, lanes, motion, HistoryChange(), found);
          if (what.move > 0)
            displacement =
              larger(displacement,
                     move_domains(domains, lanes, fields, what.move));
        });
      });
      StressSummary result;
      result.displacement  = maximum(displacement);
      result.speed_squared = maximum(taken.speed_squared);
      result.removed       = sum(taken.removed);
      return result;
    }
  } // namespace



  template <int dim>
  StressSummary
  strain_domains(const PointView<dim>  &points,
                 const GridView<dim>   &grid,
                 const StressSweep     &what,
                 const Projection       kind,
                 const PackStrain<dim> &law,
                 PackFindings<dim>     &found)
  {
    using Layout = NodeLayout<dim>;
    check_projection_of_domains(kind);
    return what.remapped ? strain_by<dim, Layout::velocity, Layout::remapped>(
                             points, grid, what, kind, law, found) :
                           strain_by<dim, Layout::increment, Layout::velocity>(
                             points, grid, what, kind, law, found);
  }



  template StressSummary
  strain_domains(const PointView<2> &,
                 const GridView<2> &,
                 const StressSweep &,
                 Projection,
                 const PackStrain<2> &,
                 PackFindings<2> &);
  template StressSummary
  strain_domains(const PointView<3> &,
                 const GridView<3> &,
                 const StressSweep &,
                 Projection,
                 const PackStrain<3> &,
                 PackFindings<3> &);
} // namespace limber
