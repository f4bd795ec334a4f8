// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/convected_motion.h>
#include <limber/interpolation/domain_means.h>
#include <limber/stress/convected_sweep.h>

namespace limber
{
  template <int dim>
  StressSummary
  strain_domains(const PointView<dim> &points,
                 const GridView<dim>  &grid,
                 const CellSums<dim> *,
                 const StressSweep     &what,
                 const StrainTreatment &treatment,
                 const PackStrain<dim> &law,
                 PackFindings<dim>     &found)
  {
    using Number         = PointPack<dim>;
    using Layout         = NodeLayout<dim>;
    const Treatment kind = treatment.kind;
    check_treatment_of_domains(kind);
    VelocityFindings<dim> taken;
    Number                displacement{};
    for_each_batch(points, [&](const CellBatch &batch) {
      const CellGeometry<dim> &cell = grid.cells[batch.cell];
      const DomainMean<dim>    divergence(kind,
                                       what.projected_divergence,
                                       cell,
                                       batch.cell);
      for_each_pack<dim>(batch, [&](const auto &lanes) {
        ConvectedPack<dim> domains(points, grid, batch.cell, lanes);
        const auto         inverse = domains.inverse();
        FieldOnPack<dim>   velocity; // that strains
        domains.take_field(what.remapped ? Layout::remapped : Layout::velocity,
                           velocity);
        if (what.flip_share && !what.remapped)
          {
            domains.find_means();
            const auto increment =
              domains.template take<dim>(Layout::increment);
            take_velocity<dim>(points,
                               lanes,
                               &increment[0],
                               &velocity.value[0],
                               *what.flip_share,
                               taken);
          }

        MotionIncrement<dim, Number> motion;
        motion.step   = what.step;
        motion.square = what.square;
        for (int d = 0; d < dim; ++d)
          for (int e = 0; e < dim; ++e)
            motion.gradient[d][e] = what.step * velocity.slope(inverse, d, e);
        motion.volumetric =
          divergence.is_averaged() ?
            what.step * divergence.value(lanes.natural(points, cell)) :
            motion.trace();
        law.strain_pack(points, lanes, motion, HistoryChange(), found);
        if (what.move > 0)
          {
            if (what.remapped)
              domains.take_field(Layout::moving_velocity, velocity);
            displacement = larger(
              displacement,
              move_domains<dim>(domains, lanes, inverse, velocity, what.move));
          }
      });
    });
    StressSummary result;
    result.displacement  = maximum(displacement);
    result.speed_squared = maximum(taken.speed_squared);
    result.removed       = sum(taken.removed);
    return result;
  }



  template StressSummary
  strain_domains(const PointView<2> &,
                 const GridView<2> &,
                 const CellSums<2> *,
                 const StressSweep &,
                 const StrainTreatment &,
                 const PackStrain<2> &,
                 PackFindings<2> &);
  template StressSummary
  strain_domains(const PointView<3> &,
                 const GridView<3> &,
                 const CellSums<3> *,
                 const StressSweep &,
                 const StrainTreatment &,
                 const PackStrain<3> &,
                 PackFindings<3> &);
} // namespace limber
