// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/domain_means.h>
#include <limber/interpolation/dual_domain.h>
#include <limber/stress/dual_domain_sweep.h>


namespace limber
{
  namespace
  {
    /** Strain by the velocity field whose first component is @p strained. */
    template <int dim, bool averaged, unsigned int strained>
    StressSummary
    strain_dual_domain(const PointView<dim>  &points,
                       const GridView<dim>   &grid,
                       const StressSweep     &what,
                       const Treatment        kind,
                       const PackStrain<dim> &law,
                       PackFindings<dim>     &found)
    {
      using Number = PointPack<dim>;
      Number displacement{};
      for_each_batch(points, [&](const CellBatch &batch) {
        const CellGeometry<dim> &cell = grid.cells[batch.cell];
        const DomainMean<dim>    divergence(kind,
                                         what.projected_divergence,
                                         cell,
                                         batch.cell);
        const DualDomainGradient<dim, NodeLayout<dim>::velocity, strained>
          gradient(grid, batch.cell);
        for_each_pack<dim>(batch, [&](const auto &lanes) {
          const auto                   xi = lanes.natural(points, cell);
          MotionIncrement<dim, Number> motion;
          motion.step     = what.step;
          motion.square   = what.square;
          motion.gradient = gradient.at(xi);
          for (auto &row : motion.gradient)
            for (Number &component : row)
              component *= what.step;
          motion.volumetric =
            averaged ? what.step * divergence.value(xi) : motion.trace();
          law.strain_pack(points, lanes, motion, HistoryChange(), found);
          if (what.move > 0)
            {
              std::array<Number, dim> shift;
              for (int d = 0; d < dim; ++d)
                shift[d] =
                  what.move *
                  Linear<dim>::template value<Number>(gradient.component(d),
                                                      xi);
              displacement =
                larger(displacement,
                       move_points<dim>(points, grid, batch.cell, lanes, shift)
                         .displacement);
            }
        });
      });
      StressSummary result;
      result.displacement = maximum(displacement);
      return result;
    }
  } // namespace



  template <int dim>
  StressSummary
  strain_by_dual_domain(const PointView<dim> &points,
                        const GridView<dim>  &grid,
                        const CellSums<dim> *,
                        const StressSweep     &what,
                        const StrainTreatment &treatment,
                        const PackStrain<dim> &law,
                        PackFindings<dim>     &found)
  {
    const Treatment kind = treatment.kind;
    const auto      with = [&](const auto averaged) {
      return what.remapped ? strain_dual_domain<dim, averaged(), dim>(
                               points, grid, what, kind, law, found) :
                                  strain_dual_domain<dim, averaged(), 0>(
                               points, grid, what, kind, law, found);
    };
    check_treatment_of_domains(kind);
    return kind == Treatment::none ? with(std::false_type()) :
                                     with(std::true_type());
  }



  template StressSummary
  strain_by_dual_domain(const PointView<2> &,
                        const GridView<2> &,
                        const CellSums<2> *,
                        const StressSweep &,
                        const StrainTreatment &,
                        const PackStrain<2> &,
                        PackFindings<2> &);
  template StressSummary
  strain_by_dual_domain(const PointView<3> &,
                        const GridView<3> &,
                        const CellSums<3> *,
                        const StressSweep &,
                        const StrainTreatment &,
                        const PackStrain<3> &,
                        PackFindings<3> &);
} // namespace limber
