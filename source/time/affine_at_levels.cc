// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/points/cell_batch.h>
#include <limber/time/affine_at_levels.h>
#include <limber/time/cell_functions.h>

#include <map>

namespace limber
{
  template <int dim>
  void
  AffineAtLevels<dim>::reinit(const BackgroundGrid<dim> &grid)
  {
    const NodeTable<dim> &table = grid.vertices;
    first.assign(table.n() + 1, 0);
    arms.clear();
    has_hanging_node.assign(grid.n_cells(), 0);
    if (table.hanging.empty())
      return;

    // Masters of hanging nodes are corners of coarse cells, which this rank
    // holds (as ghosts) where they are beside its own.
    std::map<std::uint32_t, std::array<double, dim>> places;
    for (const HangingNode &hanging : table.hanging)
      {
        first[hanging.node + 1] =
          static_cast<std::uint32_t>(hanging.masters.size());
        places[hanging.node];
        for (const auto &[master, weight] : hanging.masters)
          places[master];
      }
    for (std::uint32_t cell = 0; cell < grid.n_cells(); ++cell)
      for (unsigned int i = 0; i < 1 << dim; ++i)
        {
          const CellGeometry<dim> &geometry = grid.geometry[cell];
          const std::uint32_t node = geometry.node[i] / NodeLayout<dim>::stride;
          if (first[node + 1] > 0)
            has_hanging_node[cell] = 1;
          if (const auto place = places.find(node); place != places.end())
            for (int d = 0; d < dim; ++d)
              place->second[d] =
                geometry.origin[d] + (i >> d & 1) / geometry.inverse_edge[d];
        }
    for (std::size_t node = 0; node < table.n(); ++node)
      first[node + 1] += first[node];
    arms.resize(first.back());
    for (const HangingNode &hanging : table.hanging)
      {
        const auto   &from = places[hanging.node];
        std::uint32_t k    = first[hanging.node];
        for (const auto &[master, weight] : hanging.masters)
          {
            Arm &arm   = arms[k++];
            arm.master = master;
            arm.weight = weight;
            for (int d = 0; d < dim; ++d)
              arm.arm[d] = places[master][d] - from[d];
          }
      }
  }



  template <int dim>
  void
  AffineAtLevels<dim>::add(const PointView<dim> &points,
                           const GridView<dim>  &grid,
                           const unsigned int    slot) const
  {
    if (arms.empty())
      return;
    for_each_batch(points, [&](const CellBatch &batch) {
      if (!has_hanging_node[batch.cell])
        return;
      CellFunctions<dim, 1> functions(grid, batch.cell);
      // sum_p m_p N_i C_p of the corners
      std::array<std::array<double, dim * dim>, 1 << dim> sums{};
      for (std::size_t p = batch.begin; p < batch.end; ++p)
        {
          functions.go_to(points, p);
          for (int i = 0; i < 1 << dim; ++i)
            for (int k = 0; k < dim * dim; ++k)
              sums[i][k] +=
                points.mass[p] * functions.value(i) * points.affine[k][p];
        }
      for (int i = 0; i < 1 << dim; ++i)
        for (std::uint32_t k = first[functions.node(i)];
             k < first[functions.node(i) + 1];
             ++k)
          {
            double *const momentum =
              grid.nodes +
              std::size_t(arms[k].master) * NodeLayout<dim>::stride + slot;
            for (int d = 0; d < dim; ++d)
              for (int e = 0; e < dim; ++e)
                momentum[d] +=
                  arms[k].weight * sums[i][d * dim + e] * arms[k].arm[e];
          }
    });
  }



  template class AffineAtLevels<2>;
  template class AffineAtLevels<3>;
} // namespace limber
