// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/spline.h>
#include <limber/interpolation/strain_operator.h>
#include <limber/transfer/add_to_nodes.h>
#include <limber/transfer/convected_transfer.h>
#include <limber/transfer/dual_domain_transfer.h>
#include <limber/transfer/points_to_grid.h>
#include <limber/transfer/points_to_splines.h>
#include <limber/transfer/sum_momentum.h>

/** @file P2G: mass, momentum and force from the points to the nodes. */
namespace limber
{
  namespace
  {
    template <int dim>
    using ToNodes =
      std::array<typename Linear<dim>::Nodes, 1 + 2 * dim>; // m, f, p



    // The internal forces of a batch; each has the points as lanes.

    struct NoForce
    {
      static constexpr bool any = false;
    };



    template <Treatment kind, bool deviator>
    struct StressForce
    {
      static constexpr bool any = true;

      template <int dim>
      __attribute__((always_inline)) static auto
      of(const PointView<dim>    &points,
         const CellBatch         &batch,
         const CellGeometry<dim> &cell,
         const P2GOptions        &what,
         const CellSums<dim>     *sums)
      {
        const CellMeans<Linear<dim>> means(sums, batch.cell);
        const NodalMean<dim, kind>   nodal(what.projected_pressure, cell);
        StressOperator<dim, kind, deviator> stress(cell,
                                                   what.treatment,
                                                   means,
                                                   nodal);
        constexpr std::size_t               width = pack_width<PointPack<dim>>;
        const auto add = [&](const auto begins, const std::size_t p)
          __attribute__((always_inline))
        {
          stress.template add<begins>(points,
                                      p,
                                      batch.end - p,
                                      what.inverse_density);
        };
        add(std::true_type(), batch.begin);
        for (std::size_t p = batch.begin + width; rarely(p < batch.end);
             p += width)
          add(std::false_type(), p);
        if constexpr (kind == Treatment::cell)
          {
            if (!what.pressure)
              stress.scale_pressure(0);
            else if (rarely(what.volume_shares != nullptr))
              stress.scale_pressure(what.volume_shares[batch.cell]);
          }
        return stress.forces();
      }
    };



    template <int dim, bool momentum, bool affine, class Force>
    std::size_t
    sweep(const PointView<dim> &points,
          const GridView<dim>  &grid,
          const P2GOptions     &what,
          const CellSums<dim>  *sums)
    {
      return for_each_batch(
        points, [&](const CellBatch &batch) __attribute__((always_inline)) {
          const CellGeometry<dim> &cell = grid.cells[batch.cell];
          ToNodes<dim>             to_nodes{};
          if constexpr (momentum)
            sum_momentum<dim, affine>(points,
                                      batch,
                                      cell,
                                      to_nodes[NodeLayout<dim>::mass],
                                      &to_nodes[NodeLayout<dim>::momentum]);
          if constexpr (Force::any)
            {
              const auto forces =
                Force::template of<dim>(points, batch, cell, what, sums);
              for (int d = 0; d < dim; ++d)
                to_nodes[NodeLayout<dim>::force + d] = forces[d];
            }
          add_to_nodes<dim, NodeLayout<dim>::mass>(cell, to_nodes, grid.nodes);
        });
    }



    // From run-time switches to template arguments, a few at a time.
    template <int dim, class Force>
    std::size_t
    choose_sums(const PointView<dim> &points,
                const GridView<dim>  &grid,
                const P2GOptions     &what,
                const CellSums<dim>  *sums)
    {
      if constexpr (Force::any)
        if (!what.momentum)
          return sweep<dim, false, false, Force>(points, grid, what, sums);
      return what.affine ?
               sweep<dim, true, true, Force>(points, grid, what, sums) :
               sweep<dim, true, false, Force>(points, grid, what, sums);
    }



    template <int dim, bool deviator>
    std::size_t
    choose_treatment(const PointView<dim> &points,
                     const GridView<dim>  &grid,
                     const P2GOptions     &what,
                     const CellSums<dim>  *sums)
    {
      switch (what.treatment.kind)
        {
          case Treatment::automatic: // has been chosen long before
          case Treatment::none:
            return choose_sums<dim, StressForce<Treatment::none, deviator>>(
              points, grid, what, sums);
          case Treatment::cell:
            return choose_sums<dim, StressForce<Treatment::cell, deviator>>(
              points, grid, what, sums);
          case Treatment::cell_shear:
            return choose_sums<dim,
                               StressForce<Treatment::cell_shear, deviator>>(
              points, grid, what, sums);
          case Treatment::cell_full:
            return choose_sums<dim,
                               StressForce<Treatment::cell_full, deviator>>(
              points, grid, what, sums);
          case Treatment::assumed_strain:
            return choose_sums<
              dim,
              StressForce<Treatment::assumed_strain, deviator>>(points,
                                                                grid,
                                                                what,
                                                                sums);
          case Treatment::node:
            return choose_sums<dim, StressForce<Treatment::node, deviator>>(
              points, grid, what, sums);
          case Treatment::hybrid:
            return choose_sums<dim, StressForce<Treatment::hybrid, deviator>>(
              points, grid, what, sums);
        }
      return 0;
    }
  } // namespace



  template <int dim>
  std::size_t
  points_to_grid(const PointView<dim> &points,
                 const GridView<dim>  &grid,
                 const P2GOptions     &what,
                 const CellSums<dim>  *sums)
  {
    if (points.has_domains())
      return domains_to_grid(points, grid, what);
    if (grid.quadratics != nullptr)
      return points_to_splines<Quadratic<dim>>(points, grid, what, sums);
    if (grid.cubics != nullptr)
      return points_to_splines<Cubic<dim>>(points, grid, what, sums);
    if (!what.force)
      return what.momentum ?
               choose_sums<dim, NoForce>(points, grid, what, sums) :
               0;
    if (grid.dual_domain != nullptr)
      {
        if (what.momentum)
          choose_sums<dim, NoForce>(points, grid, what, sums);
        return stress_to_dual_domain(points, grid, what);
      }
    return points.deviator[0] != nullptr ?
             choose_treatment<dim, true>(points, grid, what, sums) :
             choose_treatment<dim, false>(points, grid, what, sums);
  }



  template std::size_t
  points_to_grid(const PointView<2> &,
                 const GridView<2> &,
                 const P2GOptions &,
                 const CellSums<2> *);
  template std::size_t
  points_to_grid(const PointView<3> &,
                 const GridView<3> &,
                 const P2GOptions &,
                 const CellSums<3> *);
} // namespace limber
