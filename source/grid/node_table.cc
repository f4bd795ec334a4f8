// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/node_table.h>

#include <algorithm>

namespace limber
{
  template <int dim>
  void
  NodeTable<dim>::give_to_masters(double *const      records,
                                  const unsigned int stride,
                                  const unsigned int first,
                                  const unsigned int last) const
  {
    for (const HangingNode &node : hanging)
      {
        double *const from = records + std::size_t(node.node) * stride;
        for (const auto &[master, weight] : node.masters)
          for (unsigned int k = first; k < last; ++k)
            records[std::size_t(master) * stride + k] += weight * from[k];
        std::fill(from + first, from + last, 0.);
      }
  }



  template <int dim>
  void
  NodeTable<dim>::take_from_masters(double *const      records,
                                    const unsigned int stride,
                                    const unsigned int first,
                                    const unsigned int last) const
  {
    for (const HangingNode &node : hanging)
      {
        double *const to = records + std::size_t(node.node) * stride;
        std::fill(to + first, to + last, 0.);
        for (const auto &[master, weight] : node.masters)
          for (unsigned int k = first; k < last; ++k)
            to[k] += weight * records[std::size_t(master) * stride + k];
      }
  }



  template struct NodeTable<2>;
  template struct NodeTable<3>;
} // namespace limber
