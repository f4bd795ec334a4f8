// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/adaptation/cell_values.h>
#include <limber/adaptation/stretched_points.h>

#include <cmath>
#include <unordered_map>

namespace limber
{
  namespace
  {
    constexpr double longest = 2. / 3.; // over the edge of the cell

    /** The left Cauchy-Green tensor, from stretches along unit vectors. */
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



    /** Whether the point is to be divided, and then where. */
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



    /** The points of a body by cells, for velocity gradients around points. */
    template <int dim>
    class VelocityGradients
    {
    public:
      VelocityGradients(const BackgroundGrid<dim> &grid,
                        const PointView<dim>      &points)
        : grid(grid)
        , points(points)
      {}

      /** Of the points in the cell of point p and those around, 1/s. */
      dealii::Tensor<2, dim>
      around(const std::size_t p)
      {
        if (by_cell.empty())
          for (std::size_t q = 0; q < points.size; ++q)
            by_cell[points.cell[q]].push_back(q);
        const std::uint32_t      cell     = points.cell[p];
        const CellGeometry<dim> &geometry = grid.geometry[cell];
        MotionSums<dim>          sums;
        for (unsigned int n = 0; n < (dim == 2 ? 9 : 27); ++n)
          {
            std::array<double, dim> x;
            for (int d = 0, k = n; d < dim; ++d, k /= 3)
              x[d] =
                geometry.origin[d] + (k % 3 - 0.5) / geometry.inverse_edge[d];
            const auto found = by_cell.find(grid.bins.cell_at(x));
            if (found != by_cell.end())
              for (const std::size_t q : found->second)
                sums.add(points, q, geometry);
          }
        const LinearMotion<dim> motion = sums.motion();
        dealii::Tensor<2, dim>  result = motion.gradient;
        for (int d = 0; d < dim; ++d)
          for (int e = 0; e < dim; ++e)
            result[d][e] *= geometry.inverse_edge[e];
        return result;
      }

    private:
      const BackgroundGrid<dim>                                  &grid;
      const PointView<dim>                                       &points;
      std::unordered_map<std::uint32_t, std::vector<std::size_t>> by_cell;
    };
  } // namespace



  template <int dim>
  std::vector<Division<dim>>
  stretched_points(const BackgroundGrid<dim>               &grid,
                   const MaterialBody<dim>                 &body,
                   const std::unordered_set<std::uint64_t> &kept)
  {
    std::vector<Division<dim>> result;
    const PointView<dim>       points = body.points.view();
    VelocityGradients<dim>     gradients(grid, points);
    for (std::size_t p = 0; p < points.size; ++p)
      if (Division<dim> division; is_stretched(grid, body, points, p, division))
        {
          if (kept.count(body.points.id(p)) > 0)
            division.parts = 3;
          const auto &along = division.half_edge;
          division.rate =
            along * (gradients.around(p) * along) / along.norm_square();
          result.push_back(division);
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
