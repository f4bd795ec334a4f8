// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/basis.h>
#include <limber/interpolation/cell_means.h>
#include <limber/transfer/add_to_nodes.h>
#include <limber/transfer/convected_transfer.h>
#include <limber/transfer/give_to_splines.h>
#include <limber/transfer/grid_to_points.h>
#include <limber/transfer/sum_momentum.h>

/** @file G2P: velocities from the nodes to the points. */
namespace limber
{
  namespace
  {
    /** Momentum of the points of a batch, to the nodes of their cell. */
    template <bool affine, int dim>
    __attribute__((always_inline)) inline void
    remap_momentum(const Linear<dim>,
                   const PointView<dim> &points,
                   const CellBatch      &batch,
                   const GridView<dim>  &grid)
    {
      using Nodes                   = typename Linear<dim>::Nodes;
      const CellGeometry<dim> &cell = grid.cells[batch.cell];
      Nodes                    mass{};
      std::array<Nodes, dim>   momentum{};
      sum_momentum<dim, affine>(points, batch, cell, mass, momentum.data());
      add_to_nodes<dim, NodeLayout<dim>::remapped>(cell, momentum, grid.nodes);
    }



    template <bool affine, int dim, int degree>
    __attribute__((always_inline)) inline void
    remap_momentum(const Spline<dim, degree>,
                   const PointView<dim> &points,
                   const CellBatch      &batch,
                   const GridView<dim>  &grid)
    {
      using Basis                    = Spline<dim, degree>;
      using Layout                   = NodeLayout<dim>;
      const CellGeometry<dim> &cell  = grid.cells[batch.cell];
      const auto              &nodes = Basis::nodes_of(grid, batch.cell);
      using Sums                     = SplineSums<Basis, Layout::remapped, dim>;
      Sums of_batch;
      for_each_pack<dim>(
        batch, [&](const auto &lanes) __attribute__((always_inline)) {
          give_pack<Basis, Given<true, affine, false>>(points,
                                                       cell,
                                                       nodes,
                                                       lanes,
                                                       lanes.natural(points,
                                                                     cell),
                                                       Layout::remapped,
                                                       {},
                                                       lanes.first ==
                                                         batch.begin,
                                                       of_batch);
        });
      of_batch.add_to_nodes(nodes, grid.nodes);
    }



    /**
     * The affine velocity field C of the points of a pack for APIC: with
     * linear functions the gradient of the velocity of the grid ...
     *
     * Returns twice the work, per mass (J/kg), that the increments of the nodes
     * do on the former C: sum_i N_i dv_i . C (x_i - x). It is in the momentum
     * of the nodes but not in the velocity of the points.
     */
    template <int dim, class Lanes, class Nodal>
    __attribute__((always_inline)) inline PointPack<dim>
    set_affine(const Linear<dim>,
               const PointView<dim>                  &points,
               const GridView<dim>                   &grid,
               const std::uint32_t                    cell,
               const Lanes                           &lanes,
               const std::array<PointPack<dim>, dim> &xi,
               const Nodal                           &nodal)
    {
      using Number = PointPack<dim>;
      // sum_i N_i (x_i - x)^2 of each direction, in edges
      std::array<Number, dim> D;
      for (int e = 0; e < dim; ++e)
        D[e] = xi[e] * (1. - xi[e]);
      Number work{};
      for (int d = 0; d < dim; ++d)
        {
          const auto gradient =
            Linear<dim>::template gradient<Number>(nodal.component(dim + d),
                                                   xi);
          const auto change =
            Linear<dim>::template gradient<Number>(nodal.component(d), xi);
          for (int e = 0; e < dim; ++e)
            {
              const double  inverse_edge = grid.cells[cell].inverse_edge[e];
              double *const C            = points.affine[d * dim + e];
              work += lanes.load(C) * D[e] * change[e] / inverse_edge;
              lanes.store(gradient[e] * inverse_edge, C);
            }
        }
      return 2. * work;
    }



    /**
     * ... and with splines, where that would not keep angular momentum,
     * C = B D^-1 with the moments B = sum N_i v_i (x_i - x) of the velocity
     * and D = sum N_i (x_i - x) (x_i - x), which is diagonal (Jiang et al.
     * 2015, sec. 5.3).
     */
    template <int dim, int degree, class Lanes, class Nodal>
    inline PointPack<dim>
    set_affine(const Spline<dim, degree>,
               const PointView<dim>                  &points,
               const GridView<dim>                   &grid,
               const std::uint32_t                    cell,
               const Lanes                           &lanes,
               const std::array<PointPack<dim>, dim> &xi,
               const Nodal &)
    {
      using Number                               = PointPack<dim>;
      using Basis                                = Spline<dim, degree>;
      const CellGeometry<dim>          &geometry = grid.cells[cell];
      const auto                       &nodes    = Basis::nodes_of(grid, cell);
      const SplineWeights<Basis, false> weights(geometry, nodes, xi);
      Number                            work{};
      for (int e = 0; e < dim; ++e)
        {
          const auto              places = Basis::places(nodes, e);
          std::array<Number, dim> B{}, change{};
          Number                  D{};
          for (int i = 0; i < Basis::n_nodes; ++i)
            {
              const Number arm    = places[Basis::power(i, e)] - xi[e];
              const Number weight = arm * load<Number>(weights.value[i]);
              D += weight * arm;
              for (int d = 0; d < dim; ++d)
                {
                  const double *const record = grid.nodes + nodes.node[i];
                  B[d] += weight * record[NodeLayout<dim>::velocity + d];
                  change[d] += weight * record[NodeLayout<dim>::increment + d];
                }
            }
          // No arm is left to a point that lies in a side of the grid.
          const Number inverse =
            geometry.inverse_edge[e] / larger(D, broadcast<Number>(1e-30));
          for (int d = 0; d < dim; ++d)
            {
              double *const C = points.affine[d * dim + e];
              work += lanes.load(C) * change[d] / geometry.inverse_edge[e];
              lanes.store(B[d] * inverse, C);
            }
        }
      return 2. * work;
    }



    /**
     * Velocities @p take_velocity of the grid besides their increments; else
     * that is all the points need.
     */
    template <class Basis,
              bool affine,
              bool remap,
              bool moves,
              bool take_velocity>
    VelocitySummary
    sweep(const PointView<Basis::dim> &points,
          const GridView<Basis::dim>  &grid,
          const TakeFromGrid          &what,
          const CellSums<Basis::dim>  *sums)
    {
      constexpr int dim = Basis::dim;
      using Number      = PointPack<dim>;
      using Layout      = NodeLayout<dim>;

      Number speed_squared{}, displacement{}, removed{};

      for_each_batch(
        points, [&](const CellBatch &batch) __attribute__((always_inline)) {
          const CellGeometry<dim> &cell = grid.cells[batch.cell];
          // velocity increment and, right behind it, the new velocity
          const NodalCoefficients<Basis,
                                  Layout::increment,
                                  take_velocity ? 2 * dim : dim>
            nodal(grid, batch.cell);

          for_each_pack<dim>(
            batch, [&](const auto &lanes) __attribute__((always_inline)) {
              const auto xi = lanes.natural(points, cell);

              Number squared{}, kept_squared{};
              [[maybe_unused]] std::array<Number, dim> shift;
              for (int d = 0; d < dim; ++d)
                {
                  const Number flip =
                    lanes.load(points.velocity[d]) +
                    Basis::template value<Number>(nodal.component(d), xi);
                  Number     velocity = flip;
                  const auto of_grid  = [&]() __attribute__((always_inline))
                  {
                    return Basis::template value<Number>(nodal.component(dim +
                                                                         d),
                                                         xi);
                  };
                  if constexpr (affine)
                    velocity = of_grid();
                  else if constexpr (take_velocity)
                    if (what.flip_share != 1.)
                      velocity += (1. - what.flip_share) * (of_grid() - flip);
                  lanes.store(velocity, points.velocity[d]);
                  kept_squared += flip * flip;
                  squared += velocity * velocity;
                  if constexpr (moves)
                    shift[d] = what.move * of_grid();
                }
              if constexpr (affine)
                kept_squared += set_affine<dim>(
                  Basis(), points, grid, batch.cell, lanes, xi, nodal);
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
                    CellGatherer<Basis>(*sums).add(
                      batch.cell,
                      moved.xi,
                      lanes.only_active(lanes.load(points.mass)),
                      lanes.load(points.volumetric));
                  else if (sums)
                    CellGatherer<Basis>(*sums).add_one_by_one(
                      points, grid, lanes.first, lanes.first + lanes.n);
                }
            });

          if constexpr (remap)
            remap_momentum<affine>(Basis(), points, batch, grid);
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
    if (points.has_domains())
      return grid_to_domains(points, grid, what);
    const auto choose = [&](const auto basis, const auto affine) {
      using Basis = std::decay_t<decltype(basis)>;
      if (what.move != 0)
        return sweep<Basis, affine, false, true, true>(points,
                                                       grid,
                                                       what,
                                                       sums);
      if constexpr (!affine)
        if (what.flip_share == 1.)
          return what.remap ? sweep<Basis, false, true, false, false>(points,
                                                                      grid,
                                                                      what,
                                                                      sums) :
                              sweep<Basis, false, false, false, false>(points,
                                                                       grid,
                                                                       what,
                                                                       sums);
      return what.remap ? sweep<Basis, affine, true, false, true>(points,
                                                                  grid,
                                                                  what,
                                                                  sums) :
                          sweep<Basis, affine, false, false, true>(points,
                                                                   grid,
                                                                   what,
                                                                   sums);
    };
    return with_basis(grid, [&](const auto basis) {
      return what.affine ? choose(basis, std::true_type()) :
                           choose(basis, std::false_type());
    });
  }



  template <int dim>
  void
  gather_cell_sums(const PointView<dim> &points,
                   const GridView<dim>  &grid,
                   const CellSums<dim>  &sums)
  {
    with_basis(grid, [&](const auto basis) {
      CellGatherer<std::decay_t<decltype(basis)>>(sums).add_one_by_one(
        points, grid, 0, points.size);
    });
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
