// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/convected_motion.h>
#include <limber/interpolation/domain_means.h>
#include <limber/transfer/convected_transfer.h>

#include <algorithm>

namespace limber
{
  namespace
  {
    /** J sigma of a pack of points, Pa, with the pressure that does the work.
     */
    template <int dim, class Lanes>
    __attribute__((always_inline)) inline SmallMatrix<dim, PointPack<dim>>
    kirchhoff_stress(const PointView<dim>    &points,
                     const CellGeometry<dim> &cell,
                     const DomainMean<dim>   &projected_pressure,
                     const Lanes             &lanes)
    {
      auto                 t = stress_deviator<dim>(points, lanes);
      const PointPack<dim> pressure =
        projected_pressure.is_averaged() ?
          projected_pressure.value(lanes.natural(points, cell)) :
          lanes.load(points.pressure);
      for (int d = 0; d < dim; ++d)
        t[d][d] -= pressure;
      return t;
    }



    template <int dim, bool momentum, bool force>
    std::size_t
    give(const PointView<dim> &points,
         const GridView<dim>  &grid,
         const GiveToGrid     &what)
    {
      using Layout = NodeLayout<dim>;
      using Number = PointPack<dim>;
      // mass, force and momentum lie next to each other
      using Window = RecordWindow<dim,
                                  momentum ? Layout::mass : Layout::force,
                                  momentum ? 1 + 2 * dim : dim>;
      using Record = typename Window::Lanes;
      using Slots  = std::array<Number, Window::width>;

      return for_each_batch(points, [&](const CellBatch &batch) {
        const CellGeometry<dim> &cell = grid.cells[batch.cell];
        for_each_pack<dim>(
          batch, [&](const auto &lanes) __attribute__((always_inline)) {
            const ConvectedPack<dim> domains(points, grid, batch.cell, lanes);
            const Number             mass = lanes.load(points.mass);
            std::array<Record, ConvectedPack<dim>::n_points> alike;
            std::array<decltype(alike), dim>                 along;
            if constexpr (momentum)
              {
                Slots slots;
                set_zero(slots);
                slots[Window::lane_of(Layout::mass)] = mass;
                for (int d = 0; d < dim; ++d)
                  slots[Window::lane_of(Layout::momentum + d)] =
                    mass * lanes.load(points.velocity[d]);
                alike = records_of<Record>(slots);
              }
            else
              set_zero(alike);
            if constexpr (force)
              {
                const DomainMean<dim> projected_pressure(
                  what.projection.kind,
                  what.projected_pressure,
                  cell,
                  batch.cell);
                const auto   t = kirchhoff_stress<dim>(points,
                                                     cell,
                                                     projected_pressure,
                                                     lanes);
                const Number V = what.inverse_density * mass;
#pragma GCC unroll 3
                for (int k = 0; k < dim; ++k)
                  {
                    Slots slots;
                    set_zero(slots);
#pragma GCC unroll 3
                    for (int d = 0; d < dim; ++d)
                      {
                        Number sum{};
#pragma GCC unroll 3
                        for (int e = 0; e < dim; ++e)
                          sum -= t[d][e] * domains.inverse[k][e];
                        slots[Window::lane_of(Layout::force + d)] = V * sum;
                      }
                    along[k] = records_of<Record>(slots);
                  }
              }
            domains.template give<Window, momentum, force>(alike, along);
          });
      });
    }
  } // namespace



  template <int dim>
  std::size_t
  domains_to_grid(const PointView<dim> &points,
                  const GridView<dim>  &grid,
                  const GiveToGrid     &what)
  {
    check_projection_of_domains(what.projection.kind);
    if (!what.force)
      return what.momentum ? give<dim, true, false>(points, grid, what) : 0;
    return what.momentum ? give<dim, true, true>(points, grid, what) :
                           give<dim, false, true>(points, grid, what);
  }



  template <int dim>
  VelocitySummary
  grid_to_domains(const PointView<dim> &points,
                  const GridView<dim>  &grid,
                  const TakeFromGrid   &what)
  {
    using Layout = NodeLayout<dim>;
    using Number = PointPack<dim>;
    using Pack   = ConvectedPack<dim>;
    // velocity increment and, right behind it, the new velocity
    using Window = RecordWindow<dim, Layout::increment, 2 * dim>;
    using Remap  = RecordWindow<dim, Layout::remapped, dim>;
    using Fields = FieldsOnPack<dim, Window>;
    VelocityFindings<dim> found;
    Number                displacement{};
    for_each_batch(points, [&](const CellBatch &batch) {
      for_each_pack<dim>(
        batch, [&](const auto &lanes) __attribute__((always_inline)) {
          const Pack   domains(points, grid, batch.cell, lanes);
          const Fields fields(domains);
          take_velocity<dim>(points, lanes, fields, what.flip_share, found);
          if (what.remap)
            {
              std::array<Number, Remap::width> momentum;
              set_zero(momentum);
              for (int d = 0; d < dim; ++d)
                momentum[Remap::lane_of(Layout::remapped + d)] =
                  lanes.load(points.mass) * lanes.load(points.velocity[d]);
              const auto given = records_of<typename Remap::Lanes>(momentum);
              domains.template give<Remap, true, false>(given, {});
            }
          if (what.move != 0)
            displacement =
              larger(displacement,
                     move_domains(domains, lanes, fields, what.move));
        });
    });
    VelocitySummary result;
    result.speed_squared = maximum(found.speed_squared);
    result.displacement  = maximum(displacement);
    result.removed       = sum(found.removed);
    return result;
  }



  template <class Sums, int dim>
  void
  sum_divergence_of_domains(const PointView<dim> &points,
                            const GridView<dim>  &grid,
                            const bool            remapped,
                            double *const         records)
  {
    using Layout     = NodeLayout<dim>;
    using Number     = PointPack<dim>;
    const auto sweep = [&](const auto first) {
      using Fields =
        FieldsOnPack<dim, RecordWindow<dim, decltype(first)::value, dim>>;
      for_each_batch(points, [&](const CellBatch &batch) {
        const CellGeometry<dim> &cell = grid.cells[batch.cell];
        Sums                     sums;
        for_each_pack<dim>(batch, [&](const auto &lanes) {
          const ConvectedPack<dim> domains(points, grid, batch.cell, lanes);
          const Fields             fields(domains);
          Number                   divergence{};
          for (int d = 0; d < dim; ++d)
            divergence += fields.slope(domains.inverse, first() + d, d);
          for (int i = 0; i < lanes.n; ++i)
            sums.add(natural_place(points, cell, lanes.first + i),
                     points.mass[lanes.first + i],
                     divergence[i]);
        });
        sums.add_to(cell, batch.cell, records);
      });
    };
    using Slot = unsigned int;
    if (remapped)
      sweep(std::integral_constant<Slot, Layout::remapped>());
    else
      sweep(std::integral_constant<Slot, Layout::velocity>());
  }



  template <int dim>
  void
  sum_pressure_over_cells(const PointView<dim> &points, double *const records)
  {
    for_each_batch(points, [&](const CellBatch &batch) {
      CellMeanSums<dim> sums;
      for (std::size_t p = batch.begin; p < batch.end; ++p)
        sums.add({}, points.mass[p], points.pressure[p]);
      sums.add_to({}, batch.cell, records);
    });
  }



  template <int dim>
  std::vector<std::uint32_t>
  cells_of_corners(const PointView<dim> &points, const GridView<dim> &grid)
  {
    std::vector<std::uint32_t> result;
    for_each_batch(points, [&](const CellBatch &batch) {
      for (std::size_t p = batch.begin; p < batch.end; ++p)
        {
          const DomainShape<dim> domain(points, grid, batch.cell, p);
          if (!domain.is_at_home)
            for (int c = 0; c < domain.n_corners; ++c)
              result.push_back(domain.cell_at(grid, domain.corner(c)));
        }
    });
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }



  template std::size_t
  domains_to_grid(const PointView<2> &,
                  const GridView<2> &,
                  const GiveToGrid &);
  template std::size_t
  domains_to_grid(const PointView<3> &,
                  const GridView<3> &,
                  const GiveToGrid &);
  template VelocitySummary
  grid_to_domains(const PointView<2> &,
                  const GridView<2> &,
                  const TakeFromGrid &);
  template VelocitySummary
  grid_to_domains(const PointView<3> &,
                  const GridView<3> &,
                  const TakeFromGrid &);
  template void
  sum_divergence_of_domains<NodalMeanSums<2>>(const PointView<2> &,
                                              const GridView<2> &,
                                              bool,
                                              double *);
  template void
  sum_divergence_of_domains<NodalMeanSums<3>>(const PointView<3> &,
                                              const GridView<3> &,
                                              bool,
                                              double *);
  template void
  sum_divergence_of_domains<CellMeanSums<2>>(const PointView<2> &,
                                             const GridView<2> &,
                                             bool,
                                             double *);
  template void
  sum_divergence_of_domains<CellMeanSums<3>>(const PointView<3> &,
                                             const GridView<3> &,
                                             bool,
                                             double *);
  template void
  sum_pressure_over_cells(const PointView<2> &, double *);
  template void
  sum_pressure_over_cells(const PointView<3> &, double *);
  template std::vector<std::uint32_t>
  cells_of_corners(const PointView<2> &, const GridView<2> &);
  template std::vector<std::uint32_t>
  cells_of_corners(const PointView<3> &, const GridView<3> &);
} // namespace limber
