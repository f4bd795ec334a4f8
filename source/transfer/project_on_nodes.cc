// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/basis.h>
#include <limber/interpolation/batch_lanes.h>
#include <limber/interpolation/domain_means.h>
#include <limber/transfer/convected_transfer.h>
#include <limber/transfer/dual_domain_transfer.h>
#include <limber/transfer/project_on_nodes.h>

namespace limber
{
  namespace
  {
    /** Sums of a quantity given at points, with weights. */
    template <int dim, class Quantity, class Weight>
    void
    sweep(const PointView<dim> &points,
          const GridView<dim>  &grid,
          const Weight         &weight,
          const Quantity       &quantity,
          double *const         records)
    {
      for_each_batch(points, [&](const CellBatch &batch) {
        if (batch.cell == invalid_cell)
          return;
        const CellGeometry<dim> &cell = grid.cells[batch.cell];
        NodalSums<dim>           sums;
        for (std::size_t p = batch.begin; p < batch.end; ++p)
          sums.add(natural_place(points, cell, p), weight(p), quantity(p));
        sums.add_to_nodes(cell, records);
      });
    }



    /** The divergence of the velocity in slots from @p first on. */
    template <class Basis, unsigned int first>
    void
    sweep_divergence(const PointView<Basis::dim> &points,
                     const GridView<Basis::dim>  &grid,
                     double *const                records)
    {
      constexpr int dim = Basis::dim;
      using Number      = PointPack<dim>;
      for_each_batch(points, [&](const CellBatch &batch) {
        const CellGeometry<dim> &cell = grid.cells[batch.cell];
        const NodalCoefficients<Basis, first, dim> velocity(grid, batch.cell);
        NodalSums<dim>                             sums;
        for_each_pack<dim>(
          batch, [&](const auto &lanes) __attribute__((always_inline)) {
            const auto xi = lanes.natural(points, cell);
            Number     divergence{};
            for (int d = 0; d < dim; ++d)
              divergence +=
                cell.inverse_edge[d] *
                Basis::template gradient<Number>(velocity.component(d), xi)[d];
            for (int k = 0; k < lanes.n; ++k)
              sums.add(natural_place(points, cell, lanes.first + k),
                       points.mass[lanes.first + k],
                       divergence[k]);
          });
        sums.add_to_nodes(cell, records);
      });
    }
  } // namespace



  template <int dim>
  void
  sum_divergence(const PointView<dim> &points,
                 const GridView<dim>  &grid,
                 const bool            remapped,
                 double *const         records)
  {
    using Layout = NodeLayout<dim>;
    if (points.has_domains())
      return sum_divergence_of_domains<NodalMeanSums<dim>>(points,
                                                           grid,
                                                           remapped,
                                                           records);
    if (grid.dual_domain != nullptr)
      return sum_divergence_of_dual_domain<NodalMeanSums<dim>>(points,
                                                               grid,
                                                               remapped,
                                                               records);
    with_basis(grid, [&](const auto basis) {
      using Basis = std::decay_t<decltype(basis)>;
      if (remapped)
        sweep_divergence<Basis, Layout::remapped>(points, grid, records);
      else
        sweep_divergence<Basis, Layout::velocity>(points, grid, records);
    });
  }



  template <int dim>
  void
  sum_pressure(const PointView<dim> &points,
               const GridView<dim>  &grid,
               double *const         records)
  {
    sweep(
      points,
      grid,
      [&](const std::size_t p) { return points.mass[p]; },
      [&](const std::size_t p) { return points.pressure[p]; },
      records);
  }



  template <int dim>
  void
  sum_weighted(const PointView<dim> &points,
               const GridView<dim>  &grid,
               const double *const   ratio,
               const double *const   value,
               double *const         records)
  {
    sweep(
      points,
      grid,
      [&](const std::size_t p) { return points.mass[p] * ratio[p]; },
      [&](const std::size_t p) { return value[p]; },
      records);
  }



  template void
  sum_divergence(const PointView<2> &, const GridView<2> &, bool, double *);
  template void
  sum_divergence(const PointView<3> &, const GridView<3> &, bool, double *);
  template void
  sum_pressure(const PointView<2> &, const GridView<2> &, double *);
  template void
  sum_pressure(const PointView<3> &, const GridView<3> &, double *);
  template void
  sum_weighted(const PointView<2> &,
               const GridView<2> &,
               const double *,
               const double *,
               double *);
  template void
  sum_weighted(const PointView<3> &,
               const GridView<3> &,
               const double *,
               const double *,
               double *);
} // namespace limber
