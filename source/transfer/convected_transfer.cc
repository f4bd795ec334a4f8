// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/cell_means.h>
#include <limber/interpolation/convected_fields.h>
#include <limber/interpolation/nodal_means.h>
#include <limber/transfer/convected_transfer.h>

#include <algorithm>
#include <stdexcept>

namespace limber
{
  namespace
  {
    /** J sigma of a point, Pa, with that pressure in it. */
    template <int dim, bool deviator>
    SmallMatrix<dim, double>
    kirchhoff_stress(const PointView<dim> &points,
                     const std::size_t     p,
                     const double          pressure)
    {
      SmallMatrix<dim, double> t{};
      if constexpr (deviator)
        {
          const auto s = [&](const int k) { return points.deviator[k][p]; };
          t[0][0]      = s(0);
          t[1][1]      = s(1);
          t[0][1] = t[1][0] = s(2);
          if constexpr (dim == 3)
            {
              t[2][2] = -(s(0) + s(1));
              t[2][1] = t[1][2] = s(3);
              t[2][0] = t[0][2] = s(4);
            }
        }
      for (int d = 0; d < dim; ++d)
        t[d][d] -= pressure;
      return t;
    }



    struct NoForceOfDomains
    {
      static constexpr bool any = false;
    };

    template <Projection projection, bool has_deviator>
    struct ForceOfDomains
    {
      static constexpr bool       any      = true;
      static constexpr bool       deviator = has_deviator;
      static constexpr Projection kind     = projection;
    };



    template <int dim, bool momentum, class Force>
    std::size_t
    give(const PointView<dim> &points,
         const GridView<dim>  &grid,
         const GiveToGrid     &what)
    {
      using Layout = NodeLayout<dim>;
      using Domain = ConvectedDomain<dim>;
      // mass, force and momentum lie next to each other
      using Window = RecordWindow<dim,
                                  momentum ? Layout::mass : Layout::force,
                                  momentum ? 1 + 2 * dim : dim>;
      using Lanes  = typename Window::Lanes;

      return for_each_batch(points, [&](const CellBatch &batch) {
        const CellGeometry<dim> &cell = grid.cells[batch.cell];
        for (std::size_t p = batch.begin; p < batch.end; ++p)
          {
            const Domain           domain(points, grid, batch.cell, p);
            const double           mass = points.mass[p];
            Lanes                  alike{};
            std::array<Lanes, dim> along;
            set_zero(along);
            if constexpr (momentum)
              {
                alike[Window::lane_of(Layout::mass)] = mass;
                for (int d = 0; d < dim; ++d)
                  alike[Window::lane_of(Layout::momentum + d)] =
                    mass * points.velocity[d][p];
              }
            if constexpr (Force::any)
              {
                double pressure;
                if constexpr (averages_around_nodes(Force::kind))
                  pressure =
                    NodalMean<dim, Force::kind>(what.nodal_pressure, cell)
                      .template value<double>(natural_place(points, cell, p));
                else
                  pressure = points.pressure[p];
                const auto t =
                  kirchhoff_stress<dim, Force::deviator>(points, p, pressure);
                const auto   inverse = domain.inverse();
                const double V       = what.inverse_density * mass;
#pragma GCC unroll 8
                for (int k = 0; k < dim; ++k)
#pragma GCC unroll 8
                  for (int d = 0; d < dim; ++d)
                    {
                      double force = 0;
#pragma GCC unroll 8
                      for (int e = 0; e < dim; ++e)
                        force -= t[d][e] * inverse[k][e];
                      along[k][Window::lane_of(Layout::force + d)] = V * force;
                    }
              }
            give_to_nodes<Window>(grid,
                                  domain,
                                  alike,
                                  Force::any ? along.data() : nullptr);
          }
      });
    }



    template <int dim, bool deviator>
    std::size_t
    choose_force(const PointView<dim> &points,
                 const GridView<dim>  &grid,
                 const GiveToGrid     &what)
    {
      const auto with = [&](const auto kind) {
        using Force = ForceOfDomains<decltype(kind)::value, deviator>;
        return what.momentum ? give<dim, true, Force>(points, grid, what) :
                               give<dim, false, Force>(points, grid, what);
      };
      using P = Projection;
      switch (what.projection.kind)
        {
          case P::none:
            return with(std::integral_constant<P, P::none>());
          case P::node:
            return with(std::integral_constant<P, P::node>());
          default:
            throw std::logic_error("no such projection with domains");
        }
    }
  } // namespace



  template <int dim>
  std::size_t
  domains_to_grid(const PointView<dim> &points,
                  const GridView<dim>  &grid,
                  const GiveToGrid     &what)
  {
    if (!what.force)
      return what.momentum ?
               give<dim, true, NoForceOfDomains>(points, grid, what) :
               0;
    return points.deviator[0] != nullptr ?
             choose_force<dim, true>(points, grid, what) :
             choose_force<dim, false>(points, grid, what);
  }



  template <int dim>
  VelocitySummary
  grid_to_domains(const PointView<dim> &points,
                  const GridView<dim>  &grid,
                  const TakeFromGrid   &what,
                  const CellSums<dim>  *sums)
  {
    using Layout = NodeLayout<dim>;
    using Domain = ConvectedDomain<dim>;
    // velocity increment and, right behind it, the new velocity
    using Window  = RecordWindow<dim, Layout::increment, 2 * dim>;
    using Remap   = RecordWindow<dim, Layout::remapped, dim>;
    using Fields  = FieldsOnDomain<dim, Window>;
    using Squares = VelocitySummary;
    Squares result;
    for_each_batch(points, [&](const CellBatch &batch) {
      for (std::size_t p = batch.begin; p < batch.end; ++p)
        {
          const Domain            domain(points, grid, batch.cell, p);
          const Fields            fields(domain, grid);
          const double            mass = points.mass[p];
          typename Remap::Lanes   momentum{};
          double                  squared = 0, kept_squared = 0;
          [[maybe_unused]] double displacement = 0;
          for (int d = 0; d < dim; ++d)
            {
              const double flip =
                points.velocity[d][p] + fields.value(Layout::increment + d);
              const double velocity =
                flip + (1 - what.flip_share) *
                         (fields.value(Layout::velocity + d) - flip);
              points.velocity[d][p] = velocity;
              kept_squared += flip * flip;
              squared += velocity * velocity;
              momentum[Remap::lane_of(Layout::remapped + d)] = mass * velocity;
            }
          result.speed_squared = std::max(result.speed_squared, squared);
          result.removed += 0.5 * mass * (kept_squared - squared);
          if (what.remap)
            give_to_nodes<Remap>(grid, domain, momentum, nullptr);
          if (what.move != 0)
            {
              const CellGeometry<dim> &cell = grid.cells[batch.cell];
              for (int d = 0; d < dim; ++d)
                {
                  const double shift =
                    what.move * fields.value(Layout::velocity + d);
                  points.position[d][p] += shift;
                  result.displacement =
                    std::max(result.displacement,
                             std::abs(shift) * cell.inverse_edge[d]);
                }
              carry_domain<Fields, dim>(
                points, p, fields, domain.inverse(), what.move);
            }
        }
      if (what.move != 0)
        {
          locate(points, grid, batch.cell, batch.begin, batch.end);
          enter_corners(points, grid, batch.begin, batch.end);
          if (sums)
            CellGatherer<Linear<dim>>(*sums).add_one_by_one(points,
                                                            grid,
                                                            batch.begin,
                                                            batch.end);
        }
    });
    return result;
  }



  template <int dim>
  void
  sum_divergence_of_domains(const PointView<dim> &points,
                            const GridView<dim>  &grid,
                            const bool            remapped,
                            double *const         records)
  {
    using Layout     = NodeLayout<dim>;
    const auto sweep = [&](const auto first) {
      using Fields =
        FieldsOnDomain<dim, RecordWindow<dim, decltype(first)::value, dim>>;
      for_each_batch(points, [&](const CellBatch &batch) {
        const CellGeometry<dim> &cell = grid.cells[batch.cell];
        NodalSums<dim>           sums;
        for (std::size_t p = batch.begin; p < batch.end; ++p)
          {
            const ConvectedDomain<dim> domain(points, grid, batch.cell, p);
            const Fields               fields(domain, grid);
            const auto                 inverse    = domain.inverse();
            double                     divergence = 0;
            for (int d = 0; d < dim; ++d)
              divergence += fields.slope(inverse, first() + d, d);
            sums.add(natural_place(points, cell, p),
                     points.mass[p],
                     divergence);
          }
        sums.add_to_nodes(cell, records);
      });
    };
    using Slot = unsigned int;
    if (remapped)
      sweep(std::integral_constant<Slot, Layout::remapped>());
    else
      sweep(std::integral_constant<Slot, Layout::velocity>());
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
                  const TakeFromGrid &,
                  const CellSums<2> *);
  template VelocitySummary
  grid_to_domains(const PointView<3> &,
                  const GridView<3> &,
                  const TakeFromGrid &,
                  const CellSums<3> *);
  template void
  sum_divergence_of_domains(const PointView<2> &,
                            const GridView<2> &,
                            bool,
                            double *);
  template void
  sum_divergence_of_domains(const PointView<3> &,
                            const GridView<3> &,
                            bool,
                            double *);
  template std::vector<std::uint32_t>
  cells_of_corners(const PointView<2> &, const GridView<2> &);
  template std::vector<std::uint32_t>
  cells_of_corners(const PointView<3> &, const GridView<3> &);
} // namespace limber
