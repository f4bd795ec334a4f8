// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/corners_of_nodes.h>

namespace limber
{
  template <int dim>
  void
  CornersOfNodes<dim>::reinit(const RunParts<dim> &parts)
  {
    const NodeTable<dim> &table = parts.nodes.table;
    corners.clear();
    first.assign(table.n() + 1, 0);
    hanging.assign(table.n(), nullptr);
    if (table.hanging.empty())
      return;
    for (const HangingNode &node : table.hanging)
      hanging[node.node] = &node;

    const auto for_each_corner = [&](const auto &work) {
      for (std::uint32_t cell = 0; cell < parts.grid.n_cells(); ++cell)
        for (std::uint32_t a = 0; a < 1 << dim; ++a)
          for_each_master(parts.grid.geometry[cell].node[a] /
                            NodeLayout<dim>::stride,
                          [&](const Master &master) {
                            work(master.node, Corner{cell, a, master.share});
                          });
    };
    for_each_corner(
      [&](const std::uint32_t node, const Corner &) { ++first[node + 1]; });
    for (std::size_t node = 0; node < table.n(); ++node)
      first[node + 1] += first[node];
    corners.resize(first.back());
    std::vector<std::size_t> next(first);
    for_each_corner([&](const std::uint32_t node, const Corner &corner) {
      corners[next[node]++] = corner;
    });
  }



  template class CornersOfNodes<2>;
  template class CornersOfNodes<3>;
} // namespace limber
