// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/basis.h>
#include <limber/transfer/surface_points.h>

#include <algorithm>

namespace limber
{
  namespace
  {
    using Number = Pack<4>;

    constexpr int lanes = pack_width<Number>;



    /** Points as lanes, idle ones repeat the last, with functions that are 0.
     */
    template <class BasisOfGrid>
    struct SurfacePack
    {
      using Basis = BasisOfGrid;

      static constexpr int dim   = Basis::dim;
      static constexpr int along = Basis::power(Basis::n_nodes - 1, 0) + 1;

      std::array<std::uint32_t, lanes>   p;
      std::array<Number, dim>            xi; // natural coordinates
      std::array<Number, Basis::n_nodes> functions;

      __attribute__((always_inline))
      SurfacePack(const PointView<dim>      &points,
                  const GridView<dim>       &grid,
                  const std::uint32_t        cell_number,
                  const std::uint32_t *const first,
                  const int                  n_left)
      {
        const CellGeometry<dim> &cell = grid.cells[cell_number];
        for (int k = 0; k < lanes; ++k)
          p[k] = first[std::min(k, n_left - 1)];
        std::array<std::array<Number, along>, dim> factors;
#pragma GCC unroll 3
        for (int d = 0; d < dim; ++d)
          {
            xi[d] =
              (at(points.place[d]) - cell.origin[d]) * cell.inverse_edge[d];
            if constexpr (along == 2)
              factors[d] = {{1. - xi[d], xi[d]}};
            else
              factors[d] =
                Basis::weights(Basis::nodes_of(grid, cell_number), d, xi[d])
                  .value;
          }
        const Number active =
          first_lanes<Number>(n_left) ? broadcast<Number>(1.) : Number{};
        for (Number &factor : factors[0])
          factor *= active;
#pragma GCC unroll 64
        for (int i = 0; i < Basis::n_nodes; ++i)
          {
            functions[i] = factors[0][Basis::power(i, 0)];
#pragma GCC unroll 2
            for (int d = 1; d < dim; ++d)
              functions[i] *= factors[d][Basis::power(i, d)];
          }
      }

      /** Values of the points. */
      __attribute__((always_inline)) Number
      at(const double *const values) const
      {
        Number result;
#pragma GCC unroll 4
        for (int k = 0; k < lanes; ++k)
          result[k] = values[p[k]];
        return result;
      }
    };



    /** Call work(pack, batch, first) for all packs of points. */
    template <int dim, class Work>
    __attribute__((always_inline)) inline void
    for_each_surface_pack(const PointView<dim>     &points,
                          const GridView<dim>      &grid,
                          const SurfacePoints<dim> &surface,
                          const Work               &work)
    {
      with_basis(grid, [&](const auto basis) {
        for (const SurfaceBatch &some : surface.batches)
          for (std::size_t i = some.begin; i < some.end; i += lanes)
            work(SurfacePack<decltype(basis)>(points,
                                              grid,
                                              some.cell,
                                              &surface.points[i],
                                              static_cast<int>(some.end - i)),
                 some,
                 i);
      });
    }
  } // namespace



  template <int dim>
  void
  SurfacePoints<dim>::find(const PointView<dim> &of_body,
                           const MeetingBatches &meeting)
  {
    batches.clear();
    points.clear();
    if (of_body.reach == nullptr)
      return;
    for (const MeetingBatch *some = meeting.begin; some != meeting.end; ++some)
      {
        const std::size_t begin = points.size();
        for (std::size_t p = some->batch.begin; p < some->batch.end; p += lanes)
          {
            if (usually(all(load<Number>(of_body.reach + p) <= 0.)))
              continue;
            for (std::size_t q = p; q < p + lanes && q < some->batch.end; ++q)
              if (is_at_surface(of_body, q))
                points.push_back(static_cast<std::uint32_t>(q));
          }
        if (points.size() > begin)
          batches.push_back(
            {some->batch.cell, some->first, some->last, begin, points.size()});
      }
    // Packs may end beyond the last point.
    for (auto &component : upwards)
      component.resize(points.size() + lanes);
    stretch.resize(points.size() + lanes);
  }



  template <int dim>
  void
  SurfacePoints<dim>::turn(const PointView<dim>        &of_body,
                           const GridView<dim>         &grid,
                           const MeetingCorner *const   corners,
                           const SurfaceFit<dim> *const fits)
  {
    for_each_surface_pack(
      of_body,
      grid,
      *this,
      [&](const auto &pack, const SurfaceBatch &some, const std::size_t i)
        __attribute__((always_inline)) {
          std::array<Number, dim> mean{};
          for (std::uint32_t c = some.first; c < some.last; ++c)
            for (int d = 0; d < dim; ++d)
              mean[d] +=
                pack.functions[corners[c].k] * fits[corners[c].slot].guess()[d];
          Number square = mean[0] * mean[0];
          for (int d = 1; d < dim; ++d)
            square += mean[d] * mean[d];
          const Number scale =
            square > 0. ? 1. / square_root(square) : Number{};
          for (int d = 0; d < dim; ++d)
            store(scale * mean[d], &upwards[d][i]);
        });
  }



  template <int dim>
  void
  SurfacePoints<dim>::add_to_fits(const PointView<dim>      &of_body,
                                  const GridView<dim>       &grid,
                                  const MeetingCorner *const corners,
                                  SurfaceFit<dim> *const     fits) const
  {
    for_each_surface_pack(
      of_body,
      grid,
      *this,
      [&](const auto &pack, const SurfaceBatch &some, const std::size_t i)
        __attribute__((always_inline)) {
          using Basis = typename std::decay_t<decltype(pack)>::Basis;
          std::array<double, dim> edge;
          std::array<Number, dim> place; // from the first corner of the cell
          Number                  square{};
          for (int d = 0; d < dim; ++d)
            {
              edge[d]              = 1 / grid.cells[some.cell].inverse_edge[d];
              place[d]             = pack.xi[d] * edge[d];
              const auto component = load<Number>(&upwards[d][i]);
              square += component * component;
            }
          const Number reach =
            pack.at(of_body.reach) * load<Number>(&stretch[i]);
          for (std::uint32_t c = some.first; c < some.last; ++c)
            {
              const MeetingCorner &corner = corners[c];
              if (corner.is_of_hanging_node())
                continue; // a master counts only in its own cells
              std::array<Number, dim> from_node;
              for (int d = 0; d < dim; ++d)
                from_node[d] = place[d] - Basis::power(corner.k, d) * edge[d];
              const Number weight = pack.functions[corner.k];
              fits[corner.slot].add(from_node,
                                    reach,
                                    square > 0. ? weight : Number{});
            }
        });
  }



  template struct SurfacePoints<2>;
  template struct SurfacePoints<3>;
} // namespace limber
