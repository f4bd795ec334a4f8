// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_convected_fields_h
#define limber_interpolation_convected_fields_h

#include <limber/grid/record_window.h>
#include <limber/interpolation/convected.h>

namespace limber
{
  /**
   * Fields of the grid on the domain of a point: slots of the nodal records as
   * lanes, as in a window (record_window.h).
   */
  template <int dim, class Window>
  struct FieldsOnDomain
  {
    using Domain = ConvectedDomain<dim>;
    using Lanes  = typename Window::Lanes;

    __attribute__((always_inline))
    FieldsOnDomain(const Domain &domain, const GridView<dim> &grid)
    {
      set_zero(along);
      for (int n = 0; n < domain.n_pieces; ++n)
        {
          const auto              &piece = domain.pieces[n];
          const CellGeometry<dim> &cell  = grid.cells[piece.cell];
#pragma GCC unroll 8
          for (int i = 0; i < Linear<dim>::n_nodes; ++i)
            {
              const Lanes value =
                load<Lanes>(grid.nodes + cell.node[i] + Window::start);
              mean += piece.weight[i] * value;
#pragma GCC unroll 8
              for (int k = 0; k < dim; ++k)
                along[k] += piece.along[k][i] * value;
            }
        }
    }

    /** Mean u of the field in that slot. */
    double
    value(const unsigned int slot) const
    {
      return mean[Window::lane_of(slot)];
    }

    /** u,k: half of its difference between the ends of edge k. */
    double
    change(const unsigned int slot, const int k) const
    {
      return along[k][Window::lane_of(slot)];
    }

    /** Derivative along axis e of the field in that slot, with given R^-1. */
    double
    slope(const SmallMatrix<dim, double> &inverse,
          const unsigned int              slot,
          const int                       e) const
    {
      double result = 0;
#pragma GCC unroll 8
      for (int k = 0; k < dim; ++k)
        result += change(slot, k) * inverse[k][e];
      return result;
    }

    Lanes                  mean{};
    std::array<Lanes, dim> along;
  };



  /** Mark the cells that corners of these points have entered as occupied. */
  template <int dim>
  __attribute__((noinline)) void
  enter_corners_one_by_one(const PointView<dim> &points,
                           const GridView<dim>  &grid,
                           const std::size_t     begin,
                           const std::size_t     end)
  {
    for (std::size_t p = begin; p < end; ++p)
      {
        const std::uint32_t cell = points.cell[p];
        if (cell == invalid_cell)
          continue;
        const DomainShape<dim> domain(points, grid, cell, p);
        if (domain.is_at_home)
          continue;
        for (int c = 0; c < domain.n_corners; ++c)
          if (const std::uint32_t there =
                domain.cell_at(grid, domain.corner(c));
              !grid.occupied[there])
            {
              grid.occupied[there] = 1;
              grid.entered->push_back(there);
            }
      }
  }
} // namespace limber

#endif
