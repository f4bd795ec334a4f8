// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_tests_support_solid_scene_h
#define limber_tests_support_solid_scene_h

#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <limber/fem/reference_solver.h>
#include <limber/problem/read_problem.h>

#include <string>
#include <vector>

namespace limber
{
  template <int dim>
  Problem<dim>
  problem_from(const std::string              &text,
               const std::vector<std::string> &overrides = {})
  {
    return read_problem<dim>(
      SceneFile(ParameterText{text, FileFormat::prm, "scene"}, overrides));
  }



  inline const std::vector<std::string> reference_elements = {"Q1",
                                                              "Q2",
                                                              "Q1-P0-P0",
                                                              "Q2-P1-P1"};



  /** Move the vertices inside the unit square or cube; for one rank. */
  template <int dim>
  void
  distort(Mesh<dim> &mesh, const double size)
  {
    std::vector<bool> seen(mesh.n_vertices(), false);
    for (const auto &cell : mesh.active_cell_iterators())
      for (const unsigned int v : cell->vertex_indices())
        {
          dealii::Point<dim> &x = cell->vertex(v);
          if (seen[cell->vertex_index(v)])
            continue;
          seen[cell->vertex_index(v)]    = true;
          const dealii::Point<dim> place = x;
          double                   inner = 1;
          for (unsigned int d = 0; d < dim; ++d)
            inner *= place[d] * (1 - place[d]) > 1e-12;
          for (unsigned int d = 0; d < dim; ++d)
            x[d] += inner * size *
                    std::sin(7.3 * place[0] + 3.1 * (d + 1) * place[dim - 1] +
                             2. * d);
        }
  }
} // namespace limber

#endif
