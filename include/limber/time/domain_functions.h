// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_domain_functions_h
#define limber_time_domain_functions_h

#include <limber/interpolation/convected.h>


namespace limber
{
  /**
   * The functions of points that have domains (ConvectedDomain), with the
   * interface of CellFunctions: for the few points near what they touch. A node
   * may come more than once.
   */
  template <int dim>
  class DomainFunctions
  {
  public:
    DomainFunctions(const GridView<dim> &grid, const std::uint32_t cell)
      : grid(grid)
      , cell(cell)
    {}

    /** Go to point p, which is in the cell. */
    void
    go_to(const PointView<dim> &points, const std::size_t p)
    {
      const ConvectedDomain<dim> domain(points, grid, cell, p);
      const auto                 inverse = domain.inverse();
      n                                  = 0;
      for (int piece = 0; piece < domain.n_pieces; ++piece)
        {
          const auto &there = domain.pieces[piece];
          for (int i = 0; i < Linear<dim>::n_nodes; ++i, ++n)
            {
              nodes[n] =
                grid.cells[there.cell].node[i] / NodeLayout<dim>::stride;
              values[n] = there.weight[i];
              for (int d = 0; d < dim; ++d)
                {
                  slopes[n][d] = 0;
                  for (int k = 0; k < dim; ++k)
                    slopes[n][d] += there.along[k][i] * inverse[k][d];
                }
            }
        }
    }

    /** The number of node k. */
    std::uint32_t
    node(const int k) const
    {
      return nodes[k];
    }

    /** Mean of its function over the domain. */
    double
    value(const int k) const
    {
      return values[k];
    }

    /** Mean of the derivative along d of its function, 1/m. */
    double
    slope(const int k, const int d) const
    {
      return slopes[k][d];
    }

    int n = 0; // nodes of the point

  private:
    static constexpr int most =
      ConvectedDomain<dim>::n_corners * Linear<dim>::n_nodes;

    const GridView<dim>                      &grid;
    const std::uint32_t                       cell;
    std::array<std::uint32_t, most>           nodes;
    std::array<double, most>                  values;
    std::array<std::array<double, dim>, most> slopes;
  };
} // namespace limber

#endif
