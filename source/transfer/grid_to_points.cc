// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/basis.h>
#include <limber/interpolation/cell_means.h>
#include <limber/transfer/add_to_nodes.h>
#include <limber/transfer/convected_transfer.h>
#include <limber/transfer/give_to_splines.h>
#include <limber/transfer/grid_to_points.h>
#include <limber/transfer/light_nodes.h>
#include <limber/transfer/sum_momentum.h>

/** @file G2P: velocities from the nodes to the points. */
namespace limber
{
  namespace
  {
    /** MUSL: map the momentum of the points of a batch back to the nodes. */
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



    /** Velocity gradients of the grid at the points of a pack, 1/s. */
    template <int dim>
    struct NodalGradients
    {
      using Number = PointPack<dim>;

      std::array<Number, dim>       D;        // APIC sum_i N_i (x_i - x)^2, m^2
      std::array<Number, dim * dim> velocity; // row-major
      std::array<Number, dim * dim> change;   // of the increments
    };



    /** APIC with linear functions: the gradient of the grid velocity ... */
    template <int dim, class Nodal>
    __attribute__((always_inline)) inline NodalGradients<dim>
    nodal_gradients(const Linear<dim>,
                    const GridView<dim>                   &grid,
                    const std::uint32_t                    cell,
                    const std::array<PointPack<dim>, dim> &xi,
                    const Nodal                           &nodal)
    {
      using Number                      = PointPack<dim>;
      const CellGeometry<dim> &geometry = grid.cells[cell];
      NodalGradients<dim>      result;
      for (int e = 0; e < dim; ++e)
        {
          const double inverse = geometry.inverse_edge[e];
          result.D[e]          = xi[e] * (1. - xi[e]) / (inverse * inverse);
        }
      for (int d = 0; d < dim; ++d)
        {
          const auto velocity =
            Linear<dim>::template gradient<Number>(nodal.component(dim + d),
                                                   xi);
          const auto change =
            Linear<dim>::template gradient<Number>(nodal.component(d), xi);
          for (int e = 0; e < dim; ++e)
            {
              const double inverse         = geometry.inverse_edge[e];
              result.velocity[d * dim + e] = velocity[e] * inverse;
              result.change[d * dim + e]   = change[e] * inverse;
            }
        }
      return result;
    }



    /**
     * ... and with splines, where that would not conserve angular momentum, B
     * D^-1 with the moments B = sum N_i v_i (x_i - x) of the velocity and D =
     * sum N_i (x_i - x) (x_i - x), which is diagonal (Jiang et al. 2015, sec.
     * 5.3).
     */
    template <int dim, int degree, class Nodal>
    inline NodalGradients<dim>
    nodal_gradients(const Spline<dim, degree>,
                    const GridView<dim>                   &grid,
                    const std::uint32_t                    cell,
                    const std::array<PointPack<dim>, dim> &xi,
                    const Nodal &)
    {
      using Number                               = PointPack<dim>;
      using Basis                                = Spline<dim, degree>;
      const CellGeometry<dim>          &geometry = grid.cells[cell];
      const auto                       &nodes    = Basis::nodes_of(grid, cell);
      const SplineWeights<Basis, false> weights(geometry, nodes, xi);
      NodalGradients<dim>               result;
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
          // B = D = 0 for a point that lies in a side of the grid.
          const double edge_inverse = geometry.inverse_edge[e];
          const Number inverse =
            edge_inverse / larger(D, broadcast<Number>(1e-30));
          result.D[e] = D / (edge_inverse * edge_inverse);
          for (int d = 0; d < dim; ++d)
            {
              result.velocity[d * dim + e] = B[d] * inverse;
              result.change[d * dim + e]   = change[d] * inverse;
            }
        }
      return result;
    }



    /** The light nodes of a cell, with linear functions. */
    template <class Basis, bool affine>
    inline LightNodes<Basis::dim>
    light_nodes(const GridView<Basis::dim> &grid,
                const std::uint32_t         cell,
                const double                light_density)
    {
      constexpr int dim = Basis::dim;
      if constexpr (affine && std::is_same_v<Basis, Linear<dim>>)
        if (light_density > 0)
          {
            double least_mass = light_density;
            for (const double inverse : grid.cells[cell].inverse_edge)
              least_mass /= inverse;
            return LightNodes<dim>(grid.cells[cell], grid.nodes, least_mass);
          }
      return {};
    }



    /**
     * Remove from the gradients the part L of the increments of light nodes,
     * except for a spin that conserves their angular momentum, W_de = (S_de -
     * S_ed) / (D_d + D_e), S = L D.
     */
    template <int dim, class Nodal>
    __attribute__((noinline)) void
    leave_out(const LightNodes<dim>                 &light,
              const CellGeometry<dim>               &cell,
              const std::array<PointPack<dim>, dim> &xi,
              const Nodal                           &nodal,
              NodalGradients<dim>                   &gradients)
    {
      using Number = PointPack<dim>;
      std::array<Number, dim * dim> left_out; // 1/s
      for (int d = 0; d < dim; ++d)
        {
          const auto slope = light.gradient(
            d, Linear<dim>::template value<Number>(nodal.component(d), xi), xi);
          for (int e = 0; e < dim; ++e)
            left_out[d * dim + e] = slope[e] * cell.inverse_edge[e];
        }
      for (int d = 0; d < dim; ++d)
        for (int e = 0; e < dim; ++e)
          {
            const int de = d * dim + e, ed = e * dim + d;
            Number    part = left_out[de];
            if (d != e)
              part -= (left_out[de] * gradients.D[e] -
                       left_out[ed] * gradients.D[d]) /
                      larger(gradients.D[d] + gradients.D[e],
                             broadcast<Number>(1e-300));
            gradients.velocity[de] -= part;
            gradients.change[de] -= part;
          }
    }



    /**
     * Set the gradient C of the points of a pack: that of the grid (APIC) and,
     * with the FLIP share alpha (AFLIP), a spin W that restores the angular
     * momentum which would be lost: what the points gave to the grid and what
     * the increments of the nodes add,
     *
     *   (D_d + D_e) W_de = alpha (S_de - S_ed),  S = (C + dC - C_nodes) D.
     *
     * So FLIP, which loses no velocity, loses no spin either.
     *
     * Returns twice the work, per mass (J/kg), that the increments of the nodes
     * do on the affine velocity, old and new: sum_i N_i dv_i . (x_i - x)
     * C / 2 of both. It is part of the motion that strains, but not of the
     * velocity of the points.
     */
    template <int dim, class Lanes>
    __attribute__((always_inline)) inline PointPack<dim>
    set_affine(const PointView<dim>      &points,
               const Lanes               &lanes,
               const double               flip_share,
               const NodalGradients<dim> &nodes)
    {
      using Number = PointPack<dim>;
      Number                        energy{};
      std::array<Number, dim * dim> forgotten; // S, m^2/s
      for (int d = 0; d < dim; ++d)
        for (int e = 0; e < dim; ++e)
          {
            const int    k = d * dim + e;
            const Number C = lanes.load(points.affine[k]);
            forgotten[k] =
              nodes.D[e] * (C + nodes.change[k] - nodes.velocity[k]);
          }
      for (int d = 0; d < dim; ++d)
        for (int e = 0; e < dim; ++e)
          {
            const int    k   = d * dim + e;
            const Number old = lanes.load(points.affine[k]);
            Number       C   = nodes.velocity[k];
            if (flip_share != 0. && d != e)
              C += flip_share *
                   (forgotten[d * dim + e] - forgotten[e * dim + d]) /
                   larger(nodes.D[d] + nodes.D[e], broadcast<Number>(1e-300));
            energy += nodes.D[e] * nodes.change[k] * (old + C);
            lanes.store(C, points.affine[k]);
          }
      return energy;
    }



    /**
     * The G2P sweep. With @p take_velocity the nodal velocities are read
     * besides their increments (PIC share, affine, or motion).
     */
    template <class Basis,
              bool affine,
              bool remap,
              bool moves,
              bool take_velocity>
    VelocitySummary
    sweep(const PointView<Basis::dim> &points,
          const GridView<Basis::dim>  &grid,
          const G2POptions            &what,
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
          [[maybe_unused]] const auto light =
            light_nodes<Basis, affine>(grid, batch.cell, what.light_density);

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
                  if constexpr (take_velocity)
                    {
                      if (affine && what.flip_share == 0.)
                        velocity = of_grid();
                      else if (what.flip_share != 1.)
                        velocity += (1. - what.flip_share) * (of_grid() - flip);
                    }
                  lanes.store(velocity, points.velocity[d]);
                  kept_squared += flip * flip;
                  squared += velocity * velocity;
                  if constexpr (moves)
                    shift[d] = what.move * of_grid();
                }
              if constexpr (affine)
                {
                  auto gradients =
                    nodal_gradients<dim>(Basis(), grid, batch.cell, xi, nodal);
                  if constexpr (std::is_same_v<Basis, Linear<dim>>)
                    if (light.any())
                      leave_out<dim>(light, cell, xi, nodal, gradients);
                  kept_squared +=
                    set_affine<dim>(points, lanes, what.flip_share, gradients);
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
                 const G2POptions     &what,
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
                 const G2POptions &,
                 const CellSums<2> *);
  template VelocitySummary
  grid_to_points(const PointView<3> &,
                 const GridView<3> &,
                 const G2POptions &,
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
