// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/adaptation/cell_values.h>
#include <limber/adaptation/stretched_points.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  namespace
  {
    constexpr double longest = 2. / 3.; // edge of a point over that of its cell

    /** b from the squared stretches along axes and diagonals (polarisation). */
    template <int dim>
    dealii::SymmetricTensor<2, dim>
    left_cauchy_green(const StressUpdate<dim> &stress,
                      const PointView<dim>    &points,
                      const std::size_t        p)
    {
      const auto square = [&](const std::array<double, dim> &direction) {
        const double stretch = stress.stretch_along(points, p, direction);
        return stretch * stretch;
      };
      dealii::SymmetricTensor<2, dim> b;
      for (int d = 0; d < dim; ++d)
        {
          std::array<double, dim> axis{};
          axis[d] = 1;
          b[d][d] = square(axis);
        }
      for (int d = 0; d < dim; ++d)
        for (int e = 0; e < d; ++e)
          {
            std::array<double, dim> diagonal{};
            diagonal[d] = diagonal[e] = std::sqrt(0.5);
            b[d][e] = square(diagonal) - 0.5 * (b[d][d] + b[e][e]);
          }
      return b;
    }



    /** Whether the point is to be divided, and along which edge. */
    template <int dim>
    bool
    is_stretched(const BackgroundGrid<dim> &grid,
                 const MaterialBody<dim>   &body,
                 const PointView<dim>      &points,
                 const std::size_t          p,
                 Division<dim>             &division)
    {
      const CellGeometry<dim> &cell   = grid.geometry[points.cell[p]];
      double                   length = longest;
      const auto               consider = [&](const unsigned int            direction,
                                const dealii::Tensor<1, dim> &half_edge) {
        double own = 0; // over the edge of the cell
        for (int d = 0; d < dim; ++d)
          own =
            std::max(own, 2 * std::abs(half_edge[d]) * cell.inverse_edge[d]);
        if (own > length)
          {
            length   = own;
            division = {p, half_edge, direction, 2};
          }
      };
      if (points.has_domains())
        for (int k = 0; k < dim; ++k)
          {
            dealii::Tensor<1, dim> half_edge;
            for (int d = 0; d < dim; ++d)
              half_edge[d] = points.domain[d * dim + k][p];
            if (points.has_boxes()) // see half_box()
              {
                double square = 0;
                for (int e = 0; e < dim; ++e)
                  square += points.domain[k * dim + e][p] *
                            points.domain[k * dim + e][p];
                half_edge    = 0;
                half_edge[k] = std::sqrt(square);
              }
            consider(k, half_edge);
          }
      else
        {
          auto C = left_cauchy_green(*body.stress, points, p);
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e <= d; ++e)
              C[d][e] *= 0.25 * points.edge[d][p] * points.edge[e][p];
          for (int axis = 0; axis < dim; ++axis)
            {
              dealii::Tensor<1, dim> half_edge;
              for (int d = 0; d < dim; ++d)
                half_edge[d] = C[axis][d] / std::sqrt(C[axis][axis]);
              consider(axis, half_edge);
            }
        }
      return length > longest;
    }



    /** Linear fit over the points in a cell and those around it, 1/s. */
    template <int dim>
    dealii::Tensor<2, dim>
    velocity_gradient(const BackgroundGrid<dim>          &grid,
                      const std::vector<MotionSums<dim>> &motion,
                      const std::uint32_t                 cell)
    {
      const CellGeometry<dim>   &geometry = grid.geometry[cell];
      MotionSums<dim>            sums;
      std::vector<std::uint32_t> seen; // a larger cell is in several directions
      for (unsigned int n = 0; n < (dim == 2 ? 9 : 27); ++n)
        {
          std::array<double, dim> x;
          for (int d = 0, k = n; d < dim; ++d, k /= 3)
            x[d] =
              geometry.origin[d] + (k % 3 - 0.5) / geometry.inverse_edge[d];
          const std::uint32_t other = grid.bins.cell_at(x);
          if (other == invalid_cell ||
              std::find(seen.begin(), seen.end(), other) != seen.end())
            continue;
          seen.push_back(other);
          const CellGeometry<dim> &theirs = grid.geometry[other];
          dealii::Tensor<1, dim>   shift;
          std::array<double, dim>  scale;
          for (int d = 0; d < dim; ++d)
            {
              scale[d] = geometry.inverse_edge[d] / theirs.inverse_edge[d];
              shift[d] = (theirs.origin[d] - geometry.origin[d]) *
                           geometry.inverse_edge[d] +
                         0.5 * (scale[d] - 1);
            }
          sums.add(motion[other], shift, scale);
        }
      dealii::Tensor<2, dim> result = sums.motion().gradient;
      for (int d = 0; d < dim; ++d)
        for (int e = 0; e < dim; ++e)
          result[d][e] *= geometry.inverse_edge[e];
      return result;
    }
  } // namespace



  template <int dim>
  std::vector<Division<dim>>
  stretched_points(const BackgroundGrid<dim>               &grid,
                   const MaterialBody<dim>                 &body,
                   const std::unordered_set<std::uint64_t> &kept)
  {
    std::vector<Division<dim>> result;
    const PointView<dim>       points = body.points.view();
    for (std::size_t p = 0; p < points.size; ++p)
      if (Division<dim> division; is_stretched(grid, body, points, p, division))
        {
          if (kept.count(body.points.id(p)) > 0)
            division.parts = 3;
          result.push_back(division);
        }
    if (dealii::Utilities::MPI::sum(result.size(), grid.communicator) == 0)
      return result;
    const auto motion = motion_of_cells(grid, body);
    for (Division<dim> &division : result)
      {
        const auto &along = division.half_edge;
        const auto  gradient =
          velocity_gradient(grid, motion, points.cell[division.point]);
        division.rate = along * (gradient * along) / along.norm_square();
      }
    return result;
  }



  template std::vector<Division<2>>
  stretched_points(const BackgroundGrid<2> &,
                   const MaterialBody<2> &,
                   const std::unordered_set<std::uint64_t> &);
  template std::vector<Division<3>>
  stretched_points(const BackgroundGrid<3> &,
                   const MaterialBody<3> &,
                   const std::unordered_set<std::uint64_t> &);
} // namespace limber
