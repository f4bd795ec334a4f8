// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/spline_factors.h>
#include <limber/time/ghost_penalty.h>

#include <cmath>

namespace limber
{
  namespace
  {
    /** Factors of the outermost splines of a cell in one direction, which
     * differ at sides; see SplineCell. */
    struct Ends
    {
      double lower, upper;
    };



    template <int dim>
    Ends
    ends_of(const NumberedNodes<dim> &nodes,
            const std::size_t         cell,
            const int                 d)
    {
      const auto at_sides = nodes.at_sides(cell, d);
      return {at_sides[0] ? 1. : 0.5, at_sides[1] ? 1. : 0.5};
    }



    /** Values of the one-dimensional functions of a cell. */
    std::array<double, 3>
    values_at(const unsigned int n, const Ends &ends, const double xi)
    {
      if (n == 2)
        return {{1 - xi, xi}};
      return SplineFactors<2>::weights(ends.lower, ends.upper, xi).value;
    }



    /** One-dimensional mass matrix on the unit interval, by three-point Gauss
     * quadrature. */
    std::array<std::array<double, 3>, 3>
    mass_along(const unsigned int n, const Ends &ends)
    {
      std::array<std::array<double, 3>, 3> result{};
      for (const int k : {-1, 0, 1})
        {
          const auto value = values_at(n, ends, 0.5 + 0.5 * k * std::sqrt(0.6));
          for (unsigned int i = 0; i < n; ++i)
            for (unsigned int j = 0; j < n; ++j)
              result[i][j] += (k == 0 ? 4. : 2.5) / 9. * value[i] * value[j];
        }
      return result;
    }



    /**
     * Coefficients of the values at the p + 2 nodes in a line across a face in
     * the jump of the derivative of order p times h^p.
     */
    std::array<double, 4>
    difference_of(const unsigned int n, const Ends &own, const Ends &next)
    {
      if (n == 2)
        return {{1, -2, 1}};
      // u'' is twice the coefficient of xi^2, see SplineFactors<2>
      return {{-2 * own.lower,
               2 * (own.lower + own.upper + next.lower),
               -2 * (own.upper + next.lower + next.upper),
               2 * next.upper}};
    }



    /** n^(dim - 1) */
    template <int dim>
    unsigned int
    n_lines(const unsigned int n)
    {
      return dim == 2 ? n : n * n;
    }
  } // namespace



  template <int dim>
  void
  GhostPenalty<dim>::find(const NumberedNodes<dim>  &nodes,
                          const std::vector<double> &moduli)
  {
    clear();
    along                              = nodes.n_along();
    const std::size_t          n_cells = nodes.n_cells();
    std::vector<unsigned char> at_surface(n_cells);
    for (std::size_t c = 0; c < n_cells; ++c)
      for (int d = 0; d < dim; ++d)
        for (const int step : {-1, 1})
          if (const auto next = nodes.neighbour(c, d, step);
              next.in_box && !next.cell)
            at_surface[c] = 1;

    for (std::size_t c = 0; c < n_cells; ++c)
      for (int d = 0; d < dim; ++d)
        {
          const auto other = nodes.neighbour(c, d, 1).cell;
          if (!other || !(at_surface[c] || at_surface[*other]))
            continue;
          const auto own = nodes.of_cell(c), next = nodes.of_cell(*other);
          Face       face;
          double     area = 1;
          for (int e = 0, k = 0; e < dim; ++e)
            if (e != d)
              {
                area *= nodes.edge(e);
                face.mass[k++] = mass_along(along, ends_of(nodes, c, e));
              }
          // h^(2p-1) / ((2p+1) p!^2) area / h^2p: jumps are differences over
          // h^p
          face.stiffness = std::min(moduli[c], moduli[*other]) * area /
                           nodes.edge(d) / (along == 2 ? 3 : 20);
          face.difference           = difference_of(along,
                                          ends_of(nodes, c, d),
                                          ends_of(nodes, *other, d));
          const unsigned int stride = dealii::Utilities::pow(along, d);
          for (unsigned int i = 0; i < own.size(); ++i)
            if (i / stride % along == 0)
              {
                for (unsigned int k = 0; k < along; ++k)
                  face.nodes.push_back(own[i + k * stride]);
                face.nodes.push_back(next[i + (along - 1) * stride]);
              }
          of_surface.push_back(std::move(face));
        }
  }



  // Entry of the mass matrix of the unit face, for the lines i and j
  template <int dim>
  double
  GhostPenalty<dim>::mass(const Face        &face,
                          unsigned int       i,
                          unsigned int       j,
                          const unsigned int along)
  {
    double result = 1;
    for (int k = 0; k < dim - 1; ++k, i /= along, j /= along)
      result *= face.mass[k][i % along][j % along];
    return result;
  }



  template <int dim>
  double
  GhostPenalty<dim>::add_forces(const std::vector<double> &displacement,
                                std::vector<double>       &forces) const
  {
    const unsigned int  n = n_lines<dim>(along), n_in_line = along + 1;
    double              energy = 0;
    std::vector<double> jump(n);
    for (const Face &face : of_surface)
      for (int d = 0; d < dim; ++d)
        {
          for (unsigned int i = 0; i < n; ++i)
            {
              jump[i] = 0;
              for (unsigned int k = 0; k < n_in_line; ++k)
                jump[i] +=
                  face.difference[k] *
                  displacement[std::size_t(face.nodes[i * n_in_line + k]) *
                                 dim +
                               d];
            }
          for (unsigned int i = 0; i < n; ++i)
            {
              double force = 0;
              for (unsigned int j = 0; j < n; ++j)
                force += face.stiffness * mass(face, i, j, along) * jump[j];
              energy += 0.5 * force * jump[i];
              for (unsigned int k = 0; k < n_in_line; ++k)
                forces[std::size_t(face.nodes[i * n_in_line + k]) * dim + d] +=
                  face.difference[k] * force;
            }
        }
    return energy;
  }



  template <int dim>
  void
  GhostPenalty<dim>::add_tangent(const Add &add) const
  {
    const unsigned int  n_in_line = along + 1;
    const unsigned int  n_nodes   = n_lines<dim>(along) * n_in_line;
    const unsigned int  n         = n_nodes * dim;
    std::vector<double> block(std::size_t(n) * n);
    for (const Face &face : of_surface)
      {
        for (unsigned int i = 0; i < n_nodes; ++i)
          for (unsigned int j = 0; j < n_nodes; ++j)
            for (int d = 0; d < dim; ++d)
              block[(i * dim + d) * n + j * dim + d] =
                face.stiffness *
                mass(face, i / n_in_line, j / n_in_line, along) *
                face.difference[i % n_in_line] * face.difference[j % n_in_line];
        add(face.nodes.data(), n_nodes, block.data());
      }
  }



  template class GhostPenalty<2>;
  template class GhostPenalty<3>;
} // namespace limber
