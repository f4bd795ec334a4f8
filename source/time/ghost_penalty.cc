// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/spline_factors.h>
#include <limber/time/ghost_penalty.h>

#include <algorithm>
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
     * Coefficients of the values at the four nodes in a line across a face in
     * the jump of the second derivative times h^2.
     */
    std::array<double, 4>
    difference_of(const Ends &own, const Ends &next)
    {
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
          at_surface[c] |= nodes.neighbours(c, d, step).any_is_empty;

    for (std::size_t c = 0; c < n_cells; ++c)
      for (int d = 0; d < dim; ++d)
        for (const int step : {-1, 1})
          for (const std::size_t other : nodes.neighbours(c, d, step).cells)
            {
              const unsigned int size   = nodes.size_of_cell(c),
                                 beyond = nodes.size_of_cell(other);
              // once, by the smaller cell or the lower one of two alike
              if (!(at_surface[c] || at_surface[other]) || size > beyond ||
                  (size == beyond && step < 0))
                continue;
              Face face = along == 2 ?
                            face_of_vertices(nodes, c, other, d, step) :
                            face_of_splines(nodes, c, other, d);
              // h^(2p-1) / ((2p+1) p!^2) area / h^2p: jumps are times h^p
              double area = 1;
              for (int e = 0, k = 0; e < dim; ++e)
                if (e != d)
                  {
                    area *= nodes.edge(c, e);
                    face.mass[k++] = mass_along(along, ends_of(nodes, c, e));
                  }
              face.stiffness = std::min(moduli[c], moduli[other]) * area /
                               nodes.edge(other, d) / (along == 2 ? 3 : 20);
              of_surface.push_back(std::move(face));
            }
  }



  // The upper face of a cell along d, with the nodes in lines across it.
  template <int dim>
  typename GhostPenalty<dim>::Face
  GhostPenalty<dim>::face_of_splines(const NumberedNodes<dim> &nodes,
                                     const std::size_t         cell,
                                     const std::size_t         other,
                                     const int                 d) const
  {
    const auto own = nodes.of_cell(cell), next = nodes.of_cell(other);
    const auto difference =
      difference_of(ends_of(nodes, cell, d), ends_of(nodes, other, d));
    const unsigned int stride = dealii::Utilities::pow(along, d);
    const unsigned int n = n_lines<dim>(along), n_nodes = n * (along + 1);
    Face               face;
    face.jumps.assign(n * n_nodes, 0.);
    for (unsigned int i = 0, line = 0; i < own.size(); ++i)
      if (i / stride % along == 0)
        {
          std::copy(difference.begin(),
                    difference.end(),
                    &face.jumps[line++ * n_nodes + face.nodes.size()]);
          for (unsigned int k = 0; k < along; ++k)
            face.nodes.push_back(own[i + k * stride]);
          face.nodes.push_back(next[i + (along - 1) * stride]);
        }
    return face;
  }



  // The face of a cell along d to one of the same size or larger, whose edge is
  // h. The slope of a linear function along d is a difference of corners, and
  // linear along the face.
  template <int dim>
  typename GhostPenalty<dim>::Face
  GhostPenalty<dim>::face_of_vertices(const NumberedNodes<dim> &nodes,
                                      const std::size_t         cell,
                                      const std::size_t         other,
                                      const int                 d,
                                      const int                 step)
  {
    constexpr unsigned int n_corners = 1 << dim;
    const auto own = nodes.of_cell(cell), next = nodes.of_cell(other);
    const auto place           = nodes.place_of_cell(cell),
               place_of_other  = nodes.place_of_cell(other);
    const double size          = nodes.size_of_cell(cell),
                 size_of_other = nodes.size_of_cell(other);
    Face face;
    face.nodes.assign(own.begin(), own.end());
    std::array<unsigned int, n_corners> at; // in face.nodes, of next
    for (unsigned int j = 0; j < n_corners; ++j)
      {
        const auto found =
          std::find(face.nodes.begin(), face.nodes.end(), next[j]);
        at[j] = found - face.nodes.begin();
        if (found == face.nodes.end())
          face.nodes.push_back(next[j]);
      }
    for (unsigned int i = 0; i < n_corners; ++i)
      if ((i >> d & 1) == 0)
        {
          // slopes times h at the corner of the own face
          std::array<double, n_corners> of_own{}, of_next{};
          of_own[i]            = -size_of_other / size;
          of_own[i | (1 << d)] = size_of_other / size;
          for (unsigned int j = 0; j < n_corners; ++j)
            {
              of_next[j] = (j >> d & 1) != 0 ? 1 : -1;
              for (int e = 0; e < dim; ++e)
                if (e != d)
                  {
                    const double xi = (double(place[e]) + (i >> e & 1) * size -
                                       double(place_of_other[e])) /
                                      size_of_other;
                    of_next[j] *= (j >> e & 1) != 0 ? xi : 1 - xi;
                  }
            }
          nodes.hanging_corners(cell).condense(of_own.data(), 1);
          nodes.hanging_corners(other).condense(of_next.data(), 1);
          const std::size_t row = face.jumps.size();
          face.jumps.resize(row + face.nodes.size());
          for (unsigned int j = 0; j < n_corners; ++j)
            {
              face.jumps[row + j] -= step * of_own[j];
              face.jumps[row + at[j]] += step * of_next[j];
            }
        }
    return face;
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
    const unsigned int  n      = n_lines<dim>(along);
    double              energy = 0;
    std::vector<double> jump(n);
    for (const Face &face : of_surface)
      for (int d = 0; d < dim; ++d)
        {
          const std::size_t n_nodes = face.nodes.size();
          for (unsigned int i = 0; i < n; ++i)
            {
              jump[i] = 0;
              for (std::size_t k = 0; k < n_nodes; ++k)
                jump[i] += face.jumps[i * n_nodes + k] *
                           displacement[std::size_t(face.nodes[k]) * dim + d];
            }
          for (unsigned int i = 0; i < n; ++i)
            {
              double force = 0;
              for (unsigned int j = 0; j < n; ++j)
                force += face.stiffness * mass(face, i, j, along) * jump[j];
              energy += 0.5 * force * jump[i];
              for (std::size_t k = 0; k < n_nodes; ++k)
                forces[std::size_t(face.nodes[k]) * dim + d] +=
                  face.jumps[i * n_nodes + k] * force;
            }
        }
    return energy;
  }



  template <int dim>
  void
  GhostPenalty<dim>::add_tangent(const Add &add) const
  {
    const unsigned int  n_rows = n_lines<dim>(along);
    std::vector<double> block, of_row;
    for (const Face &face : of_surface)
      {
        const std::size_t n_nodes = face.nodes.size(), n = n_nodes * dim;
        block.assign(n * n, 0.);
        for (unsigned int i = 0; i < n_rows; ++i)
          {
            of_row.assign(n_nodes, 0.);
            for (unsigned int j = 0; j < n_rows; ++j)
              for (std::size_t k = 0; k < n_nodes; ++k)
                of_row[k] += face.stiffness * mass(face, i, j, along) *
                             face.jumps[j * n_nodes + k];
            for (std::size_t k = 0; k < n_nodes; ++k)
              if (const double jump = face.jumps[i * n_nodes + k]; jump != 0)
                for (std::size_t l = 0; l < n_nodes; ++l)
                  for (int d = 0; d < dim; ++d)
                    block[(k * dim + d) * n + l * dim + d] += jump * of_row[l];
          }
        add(face.nodes.data(), n_nodes, block.data());
      }
  }



  template class GhostPenalty<2>;
  template class GhostPenalty<3>;
} // namespace limber
