// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_tests_unit_output_sample_run_h
#define limber_tests_unit_output_sample_run_h

#include <limber/output/totals.h>
#include <limber/state/material_body.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>

namespace limber::test
{
  /** The least that output can look at: one body on four cells per axis. */
  template <int dim>
  struct SampleRun
  {
    /**
     * A unit box; points in the lower half along x, two along each edge of a
     * cell, of an elastic body with K = 1e6 / 1.2 Pa and rho = 1000 kg/m^3.
     */
    explicit SampleRun(const bool projected)
      : SampleRun(projected ? Treatment::cell : Treatment::none)
    {}

    explicit SampleRun(const Treatment treatment)
      : problem(describe(treatment))
      , grid(problem.grid, MPI_COMM_WORLD)
      , nodes(grid)
      , state{problem, grid, nodes, bodies, 0, 0, 0, {}}
    {
      PointLayout layout;
      layout.deviator  = true;
      layout.reference = true;
      bodies.emplace_back(new MaterialBody<dim>{
        problem.bodies[0],
        make_stress_update<dim>(problem.bodies[0].law,
                                problem.bodies[0].material,
                                problem.bodies[0].treatment,
                                HourglassResponse::bending),
        MaterialPoints<dim>(grid, layout),
        std::nullopt,
        std::nullopt,
        std::nullopt});
      if (needs_cell_means(treatment))
        bodies[0]->cell_sums.emplace(grid);
      if (averages_around_nodes(treatment))
        bodies[0]->nodal_means.emplace(grid.vertices);
      seed();
      nodes.set_occupied(points().sort_by_cell());
      totals.bodies.resize(1);
    }

    MaterialPoints<dim> &
    points()
    {
      return bodies[0]->points;
    }

    static constexpr double       bulk_modulus = 1e6 / 1.2;
    static constexpr double       spacing      = 0.125;
    static constexpr double       point_mass   = dim == 2 ? 15.625 : 1.953125;
    static constexpr unsigned int n_points     = dim == 2 ? 32 : 256;

    Problem<dim>                                    problem;
    BackgroundGrid<dim>                             grid;
    NodalFields<dim>                                nodes;
    std::vector<std::unique_ptr<MaterialBody<dim>>> bodies;
    State<dim>                                      state;
    Totals<dim> totals; // all zero, where only points matter

  private:
    static Problem<dim>
    describe(const Treatment treatment)
    {
      Problem<dim> problem;
      for (unsigned int d = 0; d < dim; ++d)
        {
          problem.grid.upper[d] = 1;
          problem.grid.cells[d] = 4;
        }
      Body<dim> body;
      body.name     = "block";
      body.law      = "linear elastic";
      body.material = {1000, 1e6, 0.3};
      body.points_per_cell_edge.fill(2);
      body.treatment = treatment;
      problem.bodies.push_back(body);
      return problem;
    }

    void
    seed()
    {
      for (const auto &cell : grid.triangulation.active_cell_iterators())
        if (cell->is_locally_owned() && cell->center()[0] < 0.5)
          for (unsigned int i = 0; i < 1 << dim; ++i)
            {
              dealii::Point<dim> place = cell->vertex(0);
              for (unsigned int d = 0; d < dim; ++d)
                place[d] += ((i >> d & 1) + 0.5) * spacing;
              points().add(grid.cell_number(cell), place, point_mass);
            }
      points().finish_adding();
    }
  };



  /** A folder in the working folder, empty at first; all ranks see it. */
  inline std::string
  fresh_folder(const std::string &name)
  {
    MPI_Barrier(MPI_COMM_WORLD); // somebody may still read the former one
    if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      {
        std::filesystem::remove_all(name);
        std::filesystem::create_directories(name);
      }
    MPI_Barrier(MPI_COMM_WORLD);
    return name;
  }



  inline std::string
  content(const std::string &path)
  {
    std::ifstream     file(path, std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
  }
} // namespace limber::test

#endif
