// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_point_support_h
#define limber_interpolation_point_support_h

#include <limber/interpolation/convected.h>
#include <limber/interpolation/support.h>

namespace limber
{
  namespace internal
  {
    /**
     * For a point with a domain; a node occurs once for each cell of the
     * domain.
     */
    template <int dim>
    Support<dim>
    support_of_domain(const GridView<dim>  &grid,
                      const PointView<dim> &points,
                      const std::size_t     p)
    {
      const ConvectedDomain<dim> domain(points, grid, points.cell[p], p);
      const auto                 inverse = domain.inverse();
      Support<dim>               result;
      static_assert(Support<dim>::most >=
                    ConvectedDomain<dim>::n_corners * Linear<dim>::n_nodes);
      for (int k = 0; k < domain.n_pieces; ++k)
        {
          const auto              &piece = domain.pieces[k];
          const CellGeometry<dim> &cell  = grid.cells[piece.cell];
          for (int i = 0; i < Linear<dim>::n_nodes; ++i)
            {
              const int n     = result.n++;
              result.node[n]  = cell.node[i] / NodeLayout<dim>::stride;
              result.value[n] = piece.weight[i];
              for (int d = 0; d < dim; ++d)
                {
                  result.gradient[n][d] = 0;
                  for (int e = 0; e < dim; ++e)
                    result.gradient[n][d] += piece.along[e][i] * inverse[e][d];
                }
            }
        }
      return result;
    }
  } // namespace internal



  /**
   * The shape functions of point @p p for P2G and G2P: those at its position,
   * or their means over its domain.
   */
  template <int dim, bool gradients = true>
  Support<dim>
  support_of_point(const GridView<dim>  &grid,
                   const PointView<dim> &points,
                   const std::size_t     p)
  {
    if (points.has_domains())
      return internal::support_of_domain(grid, points, p);
    std::array<double, dim> x;
    for (int d = 0; d < dim; ++d)
      x[d] = points.place[d][p];
    return support_at<dim, gradients>(grid, points.cell[p], x);
  }
} // namespace limber

#endif
