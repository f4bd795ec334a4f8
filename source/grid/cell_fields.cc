// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/cell_fields.h>

#include <utility>

namespace limber
{
  template <int dim>
  CellFields<dim>::CellFields(const BackgroundGrid<dim> &grid,
                              const unsigned int         stride)
    : stride(stride)
    , grid(grid)
  {
    reinit();
  }



  template <int dim>
  void
  CellFields<dim>::reinit()
  {
    const std::size_t size = std::size_t(grid.n_cells()) * stride;
    now.reinit(size);
    next.reinit(size);
    turn_of.reinit(grid.n_cells());
    turn = 1;
  }



  template <int dim>
  CellSums<dim>
  CellFields<dim>::view()
  {
    return {now.data(), next.data(), turn_of.data(), turn, stride};
  }



  template <int dim>
  void
  CellFields<dim>::start_completion(const ExchangePlan &plan)
  {
    // Receivers add to these sums even if this rank has gathered none.
    const CellSums<dim> sums = view();
    for (const auto &neighbour : plan.neighbours)
      for (const auto *const cells : {&neighbour.send, &neighbour.receive})
        for (const std::uint32_t cell : *cells)
          sums.open(cell);
    exchange.start(plan, next.data(), 0, stride);
  }



  template <int dim>
  void
  CellFields<dim>::finish_completion()
  {
    exchange.finish(next.data());
    std::swap(now, next);
    ++turn;
  }



  template class CellFields<2>;
  template class CellFields<3>;
} // namespace limber
