// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/nodal_projection.h>

#include <algorithm>

namespace limber
{
  template <int dim>
  NodalProjection<dim>::NodalProjection(const NodeTable<dim> &table)
    : table(table)
  {
    reinit();
  }



  template <int dim>
  void
  NodalProjection<dim>::reinit()
  {
    records.reinit(std::size_t(table.n()) * Layout::stride);
  }



  template <int dim>
  void
  NodalProjection<dim>::clear(const std::vector<std::uint32_t> &nodes)
  {
    for (const std::uint32_t node : nodes)
      std::fill_n(record(node), Layout::stride, 0.);
    for (const HangingNode &hanging : table.hanging)
      std::fill_n(record(hanging.node), Layout::stride, 0.);
  }



  template <int dim>
  void
  NodalProjection<dim>::start_completion(const ExchangePlan &plan)
  {
    table.give_to_masters(records.data(), Layout::stride, 0, Layout::stride);
    exchange.start(plan, records.data(), 0, Layout::stride);
  }



  // Sums of positive terms: the mean is accurate for any tiny mass; no point
  // uses a node without mass.
  template <int dim>
  void
  NodalProjection<dim>::finish_completion(
    const std::vector<std::uint32_t> &nodes)
  {
    exchange.finish(records.data());
    for (const std::uint32_t node : nodes)
      {
        double *const sums  = record(node);
        const double  mass  = sums[Layout::mass];
        sums[Layout::value] = mass > 0 ? sums[Layout::value] / mass : 0;
      }
    table.take_from_masters(records.data(),
                            Layout::stride,
                            Layout::value,
                            Layout::value + 1);
  }



  template class NodalProjection<2>;
  template class NodalProjection<3>;
} // namespace limber
