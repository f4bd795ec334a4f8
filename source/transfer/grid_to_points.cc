// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/cell_means.h>
#include <limber/transfer/add_to_nodes.h>
#include <limber/transfer/grid_to_points.h>
#include <limber/transfer/sum_momentum.h>

namespace limber
{
  namespace
  {
    /** Momentum of the points of a batch, to the nodes of their cell. */
    template <int dim, bool affine>
    __attribute__((always_inline)) inline void
    remap_momentum(const PointView<dim>    &points,
                   const CellBatch         &batch,
                   const CellGeometry<dim> &cell,
                   double *const            nodes)
    {
      using Nodes = typename Linear<dim>::Nodes;
      Nodes                  mass{};
      std::array<Nodes, dim> momentum{};
      sum_momentum<dim, affine>(points, batch, cell, mass, momentum.data());
      add_to_nodes<dim, NodeLayout<dim>::remapped>(cell, momentum, nodes);
    }



    template <int dim, bool affine, bool remap, bool moves>
    VelocitySummary
    sweep(const PointView<dim> &points,
          const GridView<dim>  &grid,
          const TakeFromGrid   &what,
          const CellSums<dim>  *sums)
    {
      using Number = PointPack<dim>;
      using Kernel = Linear<dim>;
      using Layout = NodeLayout<dim>;

      Number speed_squared{}, displacement{}, removed{};

      for_each_batch(
        points, [&](const CellBatch &batch) __attribute__((always_inline)) {
          const CellGeometry<dim> &cell = grid.cells[batch.cell];
          // velocity increment and, right behind it, the new velocity
          const NodalCoefficients<dim, Layout::increment, 2 * dim> nodal(
            cell, grid.nodes);

          for_each_pack<dim>(
            batch, [&](const auto &lanes) __attribute__((always_inline)) {
              const auto xi = lanes.natural(points, cell);

              Number squared{}, kept_squared{};
              [[maybe_unused]] std::array<Number, dim> shift;
              for (int d = 0; d < dim; ++d)
                {
                  const auto   grid_velocity = nodal.component(dim + d);
                  const Number flip =
                    lanes.load(points.velocity[d]) +
                    Kernel::template value<Number>(nodal.component(d), xi);
                  Number velocity = flip;
                  if constexpr (affine)
                    {
                      velocity =
                        Kernel::template value<Number>(grid_velocity, xi);
                      const auto gradient =
                        Kernel::template gradient<Number>(grid_velocity, xi);
                      for (int e = 0; e < dim; ++e)
                        lanes.store(gradient[e] * cell.inverse_edge[e],
                                    points.affine[d * dim + e]);
                    }
                  else if (what.flip_share != 1.)
                    velocity +=
                      (1. - what.flip_share) *
                      (Kernel::template value<Number>(grid_velocity, xi) -
                       flip);
                  lanes.store(velocity, points.velocity[d]);
                  kept_squared += flip * flip;
                  squared += velocity * velocity;
                  if constexpr (moves)
                    shift[d] =
                      what.move *
                      Kernel::template value<Number>(grid_velocity, xi);
                }
              speed_squared = larger(speed_squared, lanes.only_active(squared));
              if (affine || what.flip_share != 1.)
                removed += lanes.only_active(lanes.load(points.mass)) *
                           (kept_squared - squared);
              if constexpr (moves)
                {
                  const auto moved =
                    move_points<dim>(points, grid, batch.cell, lanes, shift);
                  displacement = larger(displacement, moved.displacement);
                  if (sums && moved.inside)
                    CellGatherer<dim>(*sums).add(batch.cell,
                                                 moved.xi,
                                                 lanes.only_active(
                                                   lanes.load(points.mass)),
                                                 lanes.load(points.volumetric));
                  else if (sums)
                    CellGatherer<dim>(*sums).add_one_by_one(
                      points, grid, lanes.first, lanes.first + lanes.n);
                }
            });

          if constexpr (remap)
            remap_momentum<dim, affine>(points, batch, cell, grid.nodes);
        });
      return {maximum(speed_squared),
              maximum(displacement),
              0.5 * sum(removed)};
    }
  } // namespace



  template <int dim>
  VelocitySummary
  grid_to_points(const PointView<dim> &points,
                 const GridView<dim>  &grid,
                 const TakeFromGrid   &what,
                 const CellSums<dim>  *sums)
  {
    const auto choose = [&](const auto affine) {
      return what.remap ?
               sweep<dim, affine, true, false>(points, grid, what, sums) :
             what.move != 0 ?
               sweep<dim, affine, false, true>(points, grid, what, sums) :
               sweep<dim, affine, false, false>(points, grid, what, sums);
    };
    return what.affine ? choose(std::true_type()) : choose(std::false_type());
  }



  template <int dim>
  void
  gather_cell_sums(const PointView<dim> &points,
                   const GridView<dim>  &grid,
                   const CellSums<dim>  &sums)
  {
    CellGatherer<dim>(sums).add_one_by_one(points, grid, 0, points.size);
  }



  template VelocitySummary
  grid_to_points(const PointView<2> &,
                 const GridView<2> &,
                 const TakeFromGrid &,
                 const CellSums<2> *);
  template VelocitySummary
  grid_to_points(const PointView<3> &,
                 const GridView<3> &,
                 const TakeFromGrid &,
                 const CellSums<3> *);
  template void
  gather_cell_sums(const PointView<2> &,
                   const GridView<2> &,
                   const CellSums<2> &);
  template void
  gather_cell_sums(const PointView<3> &,
                   const GridView<3> &,
                   const CellSums<3> &);
} // namespace limber
