// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/convected_motion.h>
#include <limber/interpolation/domain_means.h>
#include <limber/transfer/convected_transfer.h>

#include <algorithm>

namespace limber
{
  namespace
  {
    /**
     * Kirchhoff stress of a pack of points, Pa, with the averaged pressure of
     * the treatment.
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



    /**
     * -V J sigma R^-T, which acts on the changes of functions along the edges
     * k, by [k].
     */
    template <int dim>
    __attribute__((always_inline)) inline auto
    forces_along_edges(const SmallMatrix<dim, PointPack<dim>> &t,
                       const SmallMatrix<dim, PointPack<dim>> &inverse,
                       const PointPack<dim>                   &V)
    {
      std::array<std::array<PointPack<dim>, dim>, dim> result;
#pragma GCC unroll 3
      for (int k = 0; k < dim; ++k)
#pragma GCC unroll 3
        for (int d = 0; d < dim; ++d)
          {
            PointPack<dim> sum = t[d][0] * inverse[k][0];
#pragma GCC unroll 3
            for (int e = 1; e < dim; ++e)
              sum += t[d][e] * inverse[k][e];
            result[k][d] = -V * sum;
          }
      return result;
    }



    template <int dim, bool momentum, bool force>
    std::size_t
    give(const PointView<dim> &points,
         const GridView<dim>  &grid,
         const P2GOptions     &what)
    {
      using Layout = NodeLayout<dim>;
      using Window =
        std::conditional_t<momentum, MotionWindow<dim>, ForceWindow<dim>>;

      return for_each_batch(points, [&](const CellBatch &batch) {
        const CellGeometry<dim> &cell = grid.cells[batch.cell];
        for_each_pack<dim>(
          batch, [&](const auto &lanes) __attribute__((always_inline)) {
            ConvectedPack<dim>   domains(points, grid, batch.cell, lanes);
            const PointPack<dim> mass =
              lanes.only_active(lanes.load(points.mass));
            std::array<PointPack<dim>, Window::width> given;
            set_zero(given);
            if constexpr (momentum)
              {
                given[Window::lane_of(Layout::mass)] = mass;
                for (int d = 0; d < dim; ++d)
                  given[Window::lane_of(Layout::momentum + d)] =
                    mass * lanes.load(points.velocity[d]);
              }
            if constexpr (force)
              {
                const DomainMean<dim> projected_pressure(
                  what.treatment.kind,
                  what.projected_pressure,
                  cell,
                  batch.cell);
                const auto t = kirchhoff_stress<dim>(points,
                                                     cell,
                                                     projected_pressure,
                                                     lanes);
                domains.template give_with_changes<Window>(
                  given,
                  forces_along_edges<dim>(t,
                                          domains.inverse(),
                                          what.inverse_density * mass));
              }
            else
              {
                domains.find_means();
                domains.template give<Window>(given);
              }
          });
      });
    }
  } // namespace



  template <int dim>
  std::size_t
  domains_to_grid(const PointView<dim> &points,
                  const GridView<dim>  &grid,
                  const P2GOptions     &what)
  {
    check_treatment_of_domains(what.treatment.kind);
    if (!what.force)
      return what.momentum ? give<dim, true, false>(points, grid, what) : 0;
    return what.momentum ? give<dim, true, true>(points, grid, what) :
                           give<dim, false, true>(points, grid, what);
  }



  template <int dim>
  VelocitySummary
  grid_to_domains(const PointView<dim> &points,
                  const GridView<dim>  &grid,
                  const G2POptions     &what)
  {
    using Layout = NodeLayout<dim>;
    using Number = PointPack<dim>;
    using Remap  = RemapWindow<dim>;
    static_assert(Layout::velocity == Layout::increment + dim);
    VelocityFindings<dim> found;
    Number                displacement{};
    for_each_batch(points, [&](const CellBatch &batch) {
      for_each_pack<dim>(
        batch, [&](const auto &lanes) __attribute__((always_inline)) {
          ConvectedPack<dim> domains(points, grid, batch.cell, lanes);
          domains.find_means();
          const auto fields = domains.template take<2 * dim>(Layout::increment);
          take_velocity<dim>(
            points, lanes, &fields[0], &fields[dim], what.flip_share, found);
          if (what.remap)
            {
              const Number mass = lanes.only_active(lanes.load(points.mass));
              std::array<Number, Remap::width> momentum;
              set_zero(momentum);
              for (int d = 0; d < dim; ++d)
                momentum[Remap::lane_of(Layout::remapped + d)] =
                  mass * lanes.load(points.velocity[d]);
              domains.template give<Remap>(momentum);
            }
          if (what.move != 0)
            {
              FieldOnPack<dim> velocity;
              domains.take_field(Layout::moving_velocity, velocity);
              displacement = larger(displacement,
                                    move_domains<dim>(domains,
                                                      lanes,
                                                      domains.inverse(),
                                                      velocity,
                                                      what.move));
            }
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
    using Layout            = NodeLayout<dim>;
    const unsigned int slot = remapped ? Layout::remapped : Layout::velocity;
    for_each_batch(points, [&](const CellBatch &batch) {
      const CellGeometry<dim> &cell = grid.cells[batch.cell];
      Sums                     sums;
      for_each_pack<dim>(batch, [&](const auto &lanes) {
        const ConvectedPack<dim> domains(points, grid, batch.cell, lanes);
        FieldOnPack<dim>         velocity;
        domains.take_field(slot, velocity);
        const auto     inverse = domains.inverse();
        PointPack<dim> divergence{};
        for (int d = 0; d < dim; ++d)
          divergence += velocity.slope(inverse, d, d);
        for (int i = 0; i < lanes.n; ++i)
          sums.add(natural_place(points, cell, lanes.first + i),
                   points.mass[lanes.first + i],
                   divergence[i]);
      });
      sums.add_to(cell, batch.cell, records);
    });
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
                  const P2GOptions &);
  template std::size_t
  domains_to_grid(const PointView<3> &,
                  const GridView<3> &,
                  const P2GOptions &);
  template VelocitySummary
  grid_to_domains(const PointView<2> &,
                  const GridView<2> &,
                  const G2POptions &);
  template VelocitySummary
  grid_to_domains(const PointView<3> &,
                  const GridView<3> &,
                  const G2POptions &);
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
