// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_points_to_splines_sweep_h
#define limber_transfer_points_to_splines_sweep_h

#include <limber/interpolation/cell_means.h>
#include <limber/interpolation/nodal_means.h>
#include <limber/transfer/give_to_splines.h>
#include <limber/transfer/points_to_splines.h>

#include <stdexcept>

namespace limber
{
  namespace internal
  {
    /** P2G without forces. */
    struct NoForce
    {
      static constexpr bool any = false;
    };



    template <int dim>
    using StressSums = SmallMatrix<dim, PointPack<dim>>;



    /**
     * Stress of the points of a body for internal forces: B^T of the treatment
     * (strain_operator.h). Stress that the treatment @p averages over a cell
     * acts on the mean gradients, and is summed up over a batch first. The
     * treatment is a run-time choice, once per pack, which is negligible with
     * so many nodes: the sweeps, slow to compile, exist once for all
     * treatments.
     */
    template <bool averages>
    struct StressForce
    {
      static constexpr bool any       = true;
      static constexpr bool has_means = averages;

      StressForce(const Treatment kind, const bool has_deviator)
        : has_deviator(has_deviator)
        , mean_pressure(averages_volume_in_cells(kind))
        , mean_shear(averages_shear_in_cells(kind))
        , mean_normals(kind == Treatment::cell_full)
        , around_nodes(averages_around_nodes(kind))
      {}

      /**
       * V times stress of a pack, J: returns what acts at points, adds what
       * acts on means.
       */
      template <int dim, class Lanes>
      __attribute__((always_inline)) SmallMatrix<dim, PointPack<dim>>
      at_points(const PointView<dim>                  &points,
                const CellGeometry<dim>               &cell,
                const Lanes                           &lanes,
                const std::array<PointPack<dim>, dim> &xi,
                const P2GOptions                      &what,
                StressSums<dim>                       &on_means) const
      {
        using Number = PointPack<dim>;
        const Number V =
          lanes.only_active(what.inverse_density * lanes.load(points.mass));
        SmallMatrix<dim, Number> result;
        for (auto &row : result)
          set_zero(row);

        if (has_deviator)
          {
            const auto s = stress_deviator<dim>(points, lanes);
            for (int d = 0; d < dim; ++d)
              for (int e = 0; e < dim; ++e)
                if (averages && (d == e ? mean_normals : mean_shear))
                  on_means[d][e] += V * s[d][e];
                else
                  result[d][e] = V * s[d][e];
          }
        Number p;
        if (around_nodes)
          p = V * NodalMean<dim, Treatment::node>(what.projected_pressure, cell)
                    .template value<Number>(xi);
        else
          p = V * lanes.load(points.pressure);
        for (int d = 0; d < dim; ++d)
          if (averages && mean_pressure)
            on_means[d][d] -= p;
          else
            result[d][d] -= p;
        return result;
      }

      const bool has_deviator;
      const bool mean_pressure, mean_shear, mean_normals, around_nodes;
    };



    /** Add the forces of stress that acts on the mean gradients over a cell. */
    template <class Basis, class Sums>
    __attribute__((always_inline)) inline void
    add_means(const CellGeometry<Basis::dim> &cell,
              const typename Basis::Cell     &nodes,
              const CellMeans<Basis>         &means,
              const StressSums<Basis::dim>   &stress,
              Sums                           &sums)
    {
      constexpr int dim = Basis::dim;
      using Record      = typename Sums::ForceRecord;
      std::array<Record, dim> columns{};
      for (int d = 0; d < dim; ++d)
        for (int e = 0; e < dim; ++e)
          columns[e][Sums::lane_of(NodeLayout<dim>::force + d)] -=
            sum(stress[d][e]) * cell.inverse_edge[e];
      std::array<Record, Basis::n_nodes> on_coefficients;
      set_zero(on_coefficients);
#pragma GCC unroll 27
      for (int k = 0; k < Basis::n_nodes; ++k)
#pragma GCC unroll 3
        for (int e = 0; e < dim; ++e)
          if (Basis::power(k, e) > 0)
            on_coefficients[k] += means.derivative_of(k, e) * columns[e];
      Basis::to_nodes(on_coefficients, nodes);
      for (int i = 0; i < Basis::n_nodes; ++i)
        sums.sums[i] += on_coefficients[i];
    }



    template <class Basis, bool momentum, bool affine, class Force, int dim>
    std::size_t
    sweep(const PointView<dim>         &points,
          const GridView<dim>          &grid,
          const P2GOptions             &what,
          const CellSums<dim>          *sums,
          [[maybe_unused]] const Force &force)
    {
      using Layout = NodeLayout<dim>;
      using Number = PointPack<dim>;
      // mass, force and momentum lie next to each other
      constexpr unsigned int first   = momentum ? Layout::mass : Layout::force;
      constexpr unsigned int n_slots = momentum ? 1 + 2 * dim : dim;
      using Sums                     = SplineSums<Basis, first, n_slots>;

      return for_each_batch(
        points, [&](const CellBatch &batch) __attribute__((always_inline)) {
          const CellGeometry<dim> &cell  = grid.cells[batch.cell];
          const auto              &nodes = Basis::nodes_of(grid, batch.cell);
          Sums                     of_batch;
          [[maybe_unused]] StressSums<dim> on_means;
          if constexpr (Force::any)
            for (auto &row : on_means)
              set_zero(row);

          for_each_pack<dim>(
            batch, [&](const auto &lanes) __attribute__((always_inline)) {
              const auto               xi = lanes.natural(points, cell);
              SmallMatrix<dim, Number> Vt;
              if constexpr (Force::any)
                Vt = force.template at_points<dim>(
                  points, cell, lanes, xi, what, on_means);
              give_pack<Basis, Given<momentum, affine, Force::any>>(
                points,
                cell,
                nodes,
                lanes,
                xi,
                Layout::momentum,
                Vt,
                lanes.first == batch.begin,
                of_batch);
            });

          if constexpr (Force::any)
            if constexpr (Force::has_means)
              {
                if (rarely(what.volume_shares != nullptr))
                  for (int d = 0; d < dim; ++d)
                    on_means[d][d] *= what.volume_shares[batch.cell];
                add_means<Basis>(cell,
                                 nodes,
                                 CellMeans<Basis>(sums, batch.cell),
                                 on_means,
                                 of_batch);
              }
          of_batch.add_to_nodes(nodes, grid.nodes);
        });
    }



    template <class Basis, class Force, int dim>
    std::size_t
    choose_sums(const PointView<dim> &points,
                const GridView<dim>  &grid,
                const P2GOptions     &what,
                const CellSums<dim>  *sums,
                const Force          &force)
    {
      if constexpr (Force::any)
        if (!what.momentum)
          return sweep<Basis, false, false>(points, grid, what, sums, force);
      return what.affine ?
               sweep<Basis, true, true>(points, grid, what, sums, force) :
               sweep<Basis, true, false>(points, grid, what, sums, force);
    }
  } // namespace internal



  template <class Basis>
  std::size_t
  points_to_splines(const PointView<Basis::dim> &points,
                    const GridView<Basis::dim>  &grid,
                    const P2GOptions            &what,
                    const CellSums<Basis::dim>  *sums)
  {
    using namespace internal;
    if (!what.force)
      return what.momentum ?
               choose_sums<Basis>(points, grid, what, sums, NoForce()) :
               0;
    const Treatment kind = what.treatment.kind;
    if (kind == Treatment::automatic || kind == Treatment::assumed_strain)
      throw std::logic_error("no such treatment with splines");
    const bool has_deviator = points.deviator[0] != nullptr;
    return averages_volume_in_cells(kind) || averages_shear_in_cells(kind) ?
             choose_sums<Basis>(points,
                                grid,
                                what,
                                sums,
                                StressForce<true>(kind, has_deviator)) :
             choose_sums<Basis>(points,
                                grid,
                                what,
                                sums,
                                StressForce<false>(kind, has_deviator));
  }
} // namespace limber

#endif
