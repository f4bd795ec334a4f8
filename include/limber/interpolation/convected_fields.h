// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_convected_fields_h
#define limber_interpolation_convected_fields_h

#include <limber/grid/record_window.h>
#include <limber/interpolation/convected.h>

namespace limber
{
  /**
   * Fields of the grid on the domain of a point: slots of the nodal records as
   * lanes, as a window (record_window.h) shows them.
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
#pragma GCC unroll 8
      for (int c = 0; c < Domain::n_corners; ++c)
        {
          const auto              &corner = domain.corners[c];
          const CellGeometry<dim> &cell   = grid.cells[corner.cell];
          Lanes                    value{};
#pragma GCC unroll 8
          for (int i = 0; i < Linear<dim>::n_nodes; ++i)
            value += corner.weights[i] *
                     load<Lanes>(grid.nodes + cell.node[i] + Window::start);
          value *= Domain::share;
          mean += value;
#pragma GCC unroll 8
          for (int k = 0; k < dim; ++k)
            along[k] += Domain::sign(c, k) * value;
        }
    }

    /** u of the field in that slot. */
    double
    value(const unsigned int slot) const
    {
      return mean[Window::lane_of(slot)];
    }

    /** u,k: half of its change along edge k, from one end to the other. */
    double
    change(const unsigned int slot, const int k) const
    {
      return along[k][Window::lane_of(slot)];
    }

    /** Derivative of the field in that slot along axis e. */
    double
    slope(const Domain &domain, const unsigned int slot, const int e) const
    {
      double result = 0;
#pragma GCC unroll 8
      for (int k = 0; k < dim; ++k)
        result += change(slot, k) * domain.inverse[k][e];
      return result;
    }

  private:
    Lanes                  mean{};
    std::array<Lanes, dim> along;
  };



  /** What a point gives to a corner, to the nodes around that. */
  template <class Window, int dim>
  __attribute__((always_inline)) inline void
  give_to_corner(const GridView<dim>                         &grid,
                 const typename ConvectedDomain<dim>::Corner &corner,
                 const typename Window::Lanes                &what)
  {
    using Lanes                   = typename Window::Lanes;
    const CellGeometry<dim> &cell = grid.cells[corner.cell];
#pragma GCC unroll 8
    for (int i = 0; i < Linear<dim>::n_nodes; ++i)
      {
        double *const record = grid.nodes + cell.node[i] + Window::start;
        store(load<Lanes>(record) + corner.weights[i] * what, record);
      }
  }



  /** Carry the domain of point p along: R += @p step grad v R, step in s. */
  template <class Fields, int dim>
  __attribute__((always_inline)) inline void
  carry_domain(const PointView<dim> &points,
               const std::size_t     p,
               const Fields         &fields,
               const double          step)
  {
#pragma GCC unroll 8
    for (int d = 0; d < dim; ++d)
#pragma GCC unroll 8
      for (int k = 0; k < dim; ++k)
        points.domain[d * dim + k][p] +=
          step * fields.change(NodeLayout<dim>::velocity + d, k);
  }



  /** Have the cells that corners of these points have entered take part. */
  template <int dim>
  void
  enter_corners(const PointView<dim> &points,
                const GridView<dim>  &grid,
                const std::size_t     begin,
                const std::size_t     end)
  {
    for (std::size_t p = begin; p < end; ++p)
      {
        if (points.cell[p] == invalid_cell)
          continue;
        const ConvectedDomain<dim> domain(points, grid, points.cell[p], p);
        for (const auto &corner : domain.corners)
          if (!grid.occupied[corner.cell])
            {
              grid.occupied[corner.cell] = 1;
              grid.entered->push_back(corner.cell);
            }
      }
  }
} // namespace limber

#endif
