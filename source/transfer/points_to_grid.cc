// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/assumed_deformation.h>
#include <limber/interpolation/strain_operator.h>
#include <limber/transfer/add_to_nodes.h>
#include <limber/transfer/convected_transfer.h>
#include <limber/transfer/points_to_grid.h>
#include <limber/transfer/points_to_splines.h>
#include <limber/transfer/sum_momentum.h>

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



    template <Projection kind, bool deviator>
    struct StressForce
    {
      static constexpr bool any = true;

      template <int dim>
      __attribute__((always_inline)) static auto
      of(const PointView<dim>    &points,
         const CellBatch         &batch,
         const CellGeometry<dim> &cell,
         const GiveToGrid        &what,
         const CellSums<dim>     *sums)
      {
        const CellMeans<Linear<dim>>        means(sums, batch.cell);
        const NodalMean<dim, kind>          nodal(what.nodal_pressure, cell);
        StressOperator<dim, kind, deviator> stress(cell,
                                                   what.projection,
                                                   means,
                                                   nodal);
        constexpr std::size_t               width = 1 << dim;
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
        return stress.forces();
      }
    };



    /** In the frame of the initial configuration. */
    template <bool finite_strain>
    struct PulledBackForce
    {
      static constexpr bool any = true;

      template <int dim>
      __attribute__((always_inline)) static auto
      of(const PointView<dim>    &points,
         const CellBatch         &batch,
         const CellGeometry<dim> &cell,
         const GiveToGrid        &what,
         const CellSums<dim> *)
      {
        StressOnNodes<dim> stress(cell);
        for_each_pack<dim>(
          batch, [&](const auto &lanes) __attribute__((always_inline)) {
            const auto V =
              what.inverse_density * lanes.only_active(lanes.load(points.mass));
            auto VP = piola_kirchhoff_stress<dim, finite_strain>(
              points, lanes, deformation_gradient<dim>(points, lanes));
            for (auto &row : VP)
              for (auto &entry : row)
                entry *= V;
            stress.add(VP, lanes.natural(points, cell));
          });
        return stress.forces();
      }
    };



    /** The same with the assumed strain. */
    template <bool finite_strain>
    struct AssumedPulledBackForce
    {
      static constexpr bool any = true;

      template <int dim>
      static auto
      of(const PointView<dim>    &points,
         const CellBatch         &batch,
         const CellGeometry<dim> &cell,
         const GiveToGrid        &what,
         const CellSums<dim> *)
      {
        using Number = PointPack<dim>;
        AssumedDeformation<dim, finite_strain> assumed(
          what.initial_frame->projection);
        for_each_pack<dim>(
          batch, [&](const auto &lanes) __attribute__((always_inline)) {
            assumed.add(deformation_gradient<dim>(points, lanes),
                        lanes.natural(points, cell),
                        lanes.only_active(lanes.load(points.mass)));
          });
        assumed.finish();

        // Points are met twice. The first packs, mostly all there are, are
        // kept in between.
        struct KeptPack
        {
          SmallMatrix<dim, Number> F, P;
          std::array<Number, dim>  xi;
          Number                   V;
        };
        constexpr std::size_t        n_kept = 4;
        std::array<KeptPack, n_kept> kept;
        KeptPack                     other;
        const auto stressed = [&](const auto &lanes, KeptPack &pack)
          __attribute__((always_inline))
        {
          pack.xi = lanes.natural(points, cell);
          pack.F  = deformation_gradient<dim>(points, lanes);
          pack.P =
            assumed.turned_back(piola_kirchhoff_stress<dim, finite_strain>(
              points, lanes, assumed.evaluate(pack.F, pack.xi)));
          pack.V =
            what.inverse_density * lanes.only_active(lanes.load(points.mass));
        };

        AssumedDeformationStress<dim, finite_strain> stress(cell, assumed);
        std::size_t                                  n = 0;
        for_each_pack<dim>(
          batch, [&](const auto &lanes) __attribute__((always_inline)) {
            KeptPack &pack = n < n_kept ? kept[n] : other;
            ++n;
            stressed(lanes, pack);
            stress.add_to_means(pack.P, pack.xi, pack.V);
          });
        stress.finish_means();
        n = 0;
        for_each_pack<dim>(
          batch, [&](const auto &lanes) __attribute__((always_inline)) {
            const bool is_kept = n < n_kept;
            KeptPack  &pack    = is_kept ? kept[n] : other;
            ++n;
            if (rarely(!is_kept))
              stressed(lanes, pack);
            stress.add(pack.P, pack.F, pack.xi, pack.V);
          });
        return stress.forces();
      }
    };



    template <int dim, bool momentum, bool affine, class Force>
    std::size_t
    sweep(const PointView<dim> &points,
          const GridView<dim>  &grid,
          const GiveToGrid     &what,
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
                const GiveToGrid     &what,
                const CellSums<dim>  *sums)
    {
      if constexpr (Force::any)
        if (!what.momentum)
          return sweep<dim, false, false, Force>(points, grid, what, sums);
      return what.affine ?
               sweep<dim, true, true, Force>(points, grid, what, sums) :
               sweep<dim, true, false, Force>(points, grid, what, sums);
    }



    template <int dim>
    std::size_t
    choose_initial_frame(const PointView<dim> &points,
                         const GridView<dim>  &grid,
                         const GiveToGrid     &what)
    {
      const bool finite = what.initial_frame->finite_strain;
      if (what.initial_frame->projection.kind == Projection::assumed_strain)
        return finite ? choose_sums<dim, AssumedPulledBackForce<true>>(
                          points, grid, what, nullptr) :
                        choose_sums<dim, AssumedPulledBackForce<false>>(
                          points, grid, what, nullptr);
      return finite ? choose_sums<dim, PulledBackForce<true>>(points,
                                                              grid,
                                                              what,
                                                              nullptr) :
                      choose_sums<dim, PulledBackForce<false>>(points,
                                                               grid,
                                                               what,
                                                               nullptr);
    }



    template <int dim, bool deviator>
    std::size_t
    choose_projection(const PointView<dim> &points,
                      const GridView<dim>  &grid,
                      const GiveToGrid     &what,
                      const CellSums<dim>  *sums)
    {
      switch (what.projection.kind)
        {
          case Projection::automatic: // has been chosen long before
          case Projection::none:
            return choose_sums<dim, StressForce<Projection::none, deviator>>(
              points, grid, what, sums);
          case Projection::cell:
            return choose_sums<dim, StressForce<Projection::cell, deviator>>(
              points, grid, what, sums);
          case Projection::cell_shear:
            return choose_sums<dim,
                               StressForce<Projection::cell_shear, deviator>>(
              points, grid, what, sums);
          case Projection::cell_full:
            return choose_sums<dim,
                               StressForce<Projection::cell_full, deviator>>(
              points, grid, what, sums);
          case Projection::assumed_strain:
            return choose_sums<
              dim,
              StressForce<Projection::assumed_strain, deviator>>(points,
                                                                 grid,
                                                                 what,
                                                                 sums);
          case Projection::node:
            return choose_sums<dim, StressForce<Projection::node, deviator>>(
              points, grid, what, sums);
          case Projection::hybrid:
            return choose_sums<dim, StressForce<Projection::hybrid, deviator>>(
              points, grid, what, sums);
        }
      return 0;
    }
  } // namespace



  template <int dim>
  std::size_t
  points_to_grid(const PointView<dim> &points,
                 const GridView<dim>  &grid,
                 const GiveToGrid     &what,
                 const CellSums<dim>  *sums)
  {
    if (points.has_domains())
      return domains_to_grid(points, grid, what);
    if (grid.splines != nullptr)
      return points_to_splines(points, grid, what, sums);
    if (!what.force)
      return what.momentum ?
               choose_sums<dim, NoForce>(points, grid, what, sums) :
               0;
    if (what.initial_frame)
      return choose_initial_frame<dim>(points, grid, what);
    return points.deviator[0] != nullptr ?
             choose_projection<dim, true>(points, grid, what, sums) :
             choose_projection<dim, false>(points, grid, what, sums);
  }



  template std::size_t
  points_to_grid(const PointView<2> &,
                 const GridView<2> &,
                 const GiveToGrid &,
                 const CellSums<2> *);
  template std::size_t
  points_to_grid(const PointView<3> &,
                 const GridView<3> &,
                 const GiveToGrid &,
                 const CellSums<3> *);
} // namespace limber
