// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_cell_functions_h
#define limber_time_cell_functions_h

#include <deal.II/base/tensor.h>

#include <limber/interpolation/spline_factors.h>
#include <limber/points/point_view.h>

#include <cmath>
#include <type_traits>

namespace limber
{
  /**
   * Shape functions of the nodes of a cell, linear or B-splines of degree 2 and
   * 3, evaluated at one point after the other: for the few points in contact.
   * The sweeps over all points have their own (interpolation/linear.h,
   * spline.h).
   */
  template <int dim, int degree>
  class CellFunctions
  {
  public:
    static constexpr int along = degree + 1; // functions in a direction
    static constexpr int n = dim == 2 ? along * along : along * along * along;

    CellFunctions(const GridView<dim> &grid, const std::uint32_t cell)
      : cell(grid.cells[cell])
      , nodes(nodes_of(grid, cell))
    {
      if constexpr (degree > 1)
        spline = &spline_cell(grid, cell);
    }

    /**
     * Offsets of the records of the nodes of a cell. A node beyond a side,
     * whose function is zero there, has the offset of the node in the side.
     */
    static const std::array<std::uint32_t, n> &
    nodes_of(const GridView<dim> &grid, const std::uint32_t cell)
    {
      if constexpr (degree == 1)
        return grid.cells[cell].node;
      else
        return spline_cell(grid, cell).node;
    }

    /** Index along d of node k: which one-dimensional factor it has. */
    static constexpr int
    digit(const int k, const int d)
    {
      return (d == 0 ? k : d == 1 ? k / along : k / (along * along)) % along;
    }

    /** The number of node k. */
    std::uint32_t
    node(const int k) const
    {
      return nodes[k] / NodeLayout<dim>::stride;
    }

    /** Evaluate the functions at a point in the cell. */
    void
    go_to(const PointView<dim> &points, const std::size_t p)
    {
      const auto xi = natural_place(points, cell, p);
      for (int d = 0; d < dim; ++d)
        if constexpr (degree == 1)
          {
            values[d] = {{1 - xi[d], xi[d]}};
            slopes[d] = {{-1, 1}};
          }
        else
          {
            const auto weights =
              SplineFactors<degree>::weights(spline->lower[d],
                                             spline->upper[d],
                                             xi[d]);
            values[d] = weights.value;
            slopes[d] = weights.slope;
          }
    }

    /** N_k at that point. */
    double
    value(const int k) const
    {
      double result = 1;
      for (int d = 0; d < dim; ++d)
        result *= values[d][digit(k, d)];
      return result;
    }

    /**
     * Add to each node k its coefficient weight (N_k + arm . grad N_k) of the
     * value extrapolated to the end of the arm, to first order; and to the
     * sizes the absolute value of this.
     */
    void
    add_at_end_of(const dealii::Tensor<1, dim> &arm,
                  const double                  weight,
                  double *const                 shares,
                  double *const                 sizes) const
    {
      Factors changes;
      for (int d = 0; d < dim; ++d)
        for (int i = 0; i < along; ++i)
          changes[d][i] = arm[d] * cell.inverse_edge[d] * slopes[d][i];
      for (int k = 0; k < n; k += along)
        {
          double others = weight * values[1][digit(k, 1)],
                 change = weight * changes[1][digit(k, 1)];
          if constexpr (dim == 3)
            {
              const int j = digit(k, 2);
              change      = change * values[2][j] + others * changes[2][j];
              others *= values[2][j];
            }
          for (int i = 0; i < along; ++i)
            {
              const double share =
                values[0][i] * (others + change) + changes[0][i] * others;
              shares[k + i] += share;
              sizes[k + i] += std::abs(share);
            }
        }
    }


  private:
    struct NoSpline
    {};
    using Spline =
      std::conditional_t<degree == 1,
                         NoSpline,
                         SplineCell<dim, degree == 1 ? 2 : degree>>;

    static const Spline &
    spline_cell(const GridView<dim> &grid, const std::uint32_t cell)
    {
      if constexpr (degree == 2)
        return grid.quadratics[cell];
      else
        return grid.cubics[cell];
    }

    using Factors = std::array<std::array<double, along>, dim>;

    const CellGeometry<dim>            &cell;
    const std::array<std::uint32_t, n> &nodes;
    const Spline                       *spline = nullptr;
    Factors                             values, slopes;
  };



  /** Call work(std::integral_constant) with the degree of a grid's functions.
   */
  template <int dim, class Work>
  inline void
  with_degree(const GridView<dim> &grid, const Work &work)
  {
    if (grid.quadratics != nullptr)
      work(std::integral_constant<int, 2>());
    else if (grid.cubics != nullptr)
      work(std::integral_constant<int, 3>());
    else
      work(std::integral_constant<int, 1>());
  }
} // namespace limber

#endif
