// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/ghost_penalty.h>

namespace limber
{
  template <int dim>
  void
  GhostPenalty<dim>::find(const NumberedNodes<dim> &nodes, const double modulus)
  {
    clear();
    const auto                &cells = nodes.cells();
    std::vector<unsigned char> at_surface(cells.size());
    for (std::size_t c = 0; c < cells.size(); ++c)
      for (int d = 0; d < dim; ++d)
        for (const int step : {-1, 1})
          if (const auto next = nodes.neighbour(c, d, step);
              next.in_box && !next.cell)
            at_surface[c] = 1;

    for (std::size_t c = 0; c < cells.size(); ++c)
      for (int d = 0; d < dim; ++d)
        {
          const auto other = nodes.neighbour(c, d, 1).cell;
          if (!other || !(at_surface[c] || at_surface[*other]))
            continue;
          const auto &own = cells[c], &next = cells[*other];
          Face        face;
          double      area = 1;
          for (int e = 0; e < dim; ++e)
            if (e != d)
              area *= nodes.edge(e);
          // h/3 area / h^2: jumps are differences over h
          face.stiffness    = modulus * area / nodes.edge(d) / 3;
          unsigned int line = 0;
          for (unsigned int i = 0; i < own.size(); ++i)
            if ((i >> d & 1) == 0)
              face.lines[line++] = {
                {own[i], own[i | 1u << d], next[i | 1u << d]}};
          of_surface.push_back(face);
        }
  }



  namespace
  {
    /** Entry of the mass matrix of linear functions on the unit face. */
    template <int dim>
    double
    face_mass(const unsigned int i, const unsigned int j)
    {
      double result = 1;
      for (int d = 0; d < dim - 1; ++d)
        result *= (i >> d & 1) == (j >> d & 1) ? 1. / 3. : 1. / 6.;
      return result;
    }

    constexpr std::array<double, 3> second_difference{{1, -2, 1}};
  } // namespace



  template <int dim>
  double
  GhostPenalty<dim>::add_forces(const std::vector<double> &displacement,
                                std::vector<double>       &forces) const
  {
    constexpr unsigned int n      = n_lines;
    double                 energy = 0;
    for (const Face &face : of_surface)
      for (int d = 0; d < dim; ++d)
        {
          std::array<double, n> jump{};
          for (unsigned int i = 0; i < n; ++i)
            for (unsigned int k = 0; k < 3; ++k)
              jump[i] += second_difference[k] *
                         displacement[std::size_t(face.lines[i][k]) * dim + d];
          for (unsigned int i = 0; i < n; ++i)
            {
              double force = 0;
              for (unsigned int j = 0; j < n; ++j)
                force += face.stiffness * face_mass<dim>(i, j) * jump[j];
              energy += 0.5 * force * jump[i];
              for (unsigned int k = 0; k < 3; ++k)
                forces[std::size_t(face.lines[i][k]) * dim + d] +=
                  second_difference[k] * force;
            }
        }
    return energy;
  }



  template <int dim>
  void
  GhostPenalty<dim>::add_tangent(const Add &add) const
  {
    constexpr unsigned int                 n = 3 * n_lines * dim;
    std::vector<double>                    block(n * n);
    std::array<std::uint32_t, 3 * n_lines> numbers;
    for (const Face &face : of_surface)
      {
        for (unsigned int i = 0; i < n_lines; ++i)
          for (unsigned int k = 0; k < 3; ++k)
            {
              numbers[3 * i + k] = face.lines[i][k];
              for (unsigned int j = 0; j < n_lines; ++j)
                for (unsigned int l = 0; l < 3; ++l)
                  for (int d = 0; d < dim; ++d)
                    block[((3 * i + k) * dim + d) * n + (3 * j + l) * dim + d] =
                      face.stiffness * face_mass<dim>(i, j) *
                      second_difference[k] * second_difference[l];
            }
        add(numbers.data(), 3 * n_lines, block.data());
      }
  }



  template class GhostPenalty<2>;
  template class GhostPenalty<3>;
} // namespace limber
