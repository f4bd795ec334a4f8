// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_tests_support_plain_dealii_h
#define limber_tests_support_plain_dealii_h

#include <deal.II/dofs/dof_handler.h>

#include <deal.II/fe/fe_q.h>

#include <deal.II/lac/vector.h>

#include <deal.II/particles/particle_handler.h>

#include <limber/problem/read_problem.h>
#include <limber/simulation/set_up.h>
#include <limber/time/explicit_integrator.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

/**
 * @file The same steps twice: by Limber, and the way the deal.II tutorials
 * write such a loop. The second is short and easy to check by eye; the first
 * must agree with it.
 */
namespace limber
{
  namespace testing_support
  {
    /** A free elastic block that flies, shears and falls; points cross cells.
     */
    template <int dim>
    SceneFile
    flying_block(const unsigned int n_cells)
    {
      const auto each = [](const double value) {
        std::ostringstream text;
        for (int d = 0; d < dim; ++d)
          text << (d ? ", " : "") << value;
        return text.str();
      };
      std::ostringstream text;
      text << "set Dimension = " << dim << "\n"
           << "set Bodies = block\n"
           << "subsection Body block\n"
           << "  set Shape = box\n"
           << "  subsection Box\n"
           << "    set Lower corner = " << each(3) << "\n"
           << "    set Upper corner = " << each(3. + n_cells) << "\n"
           << "  end\n"
           << "  set Points per cell edge = 2\n"
           << "  set Initial velocity = 80 + 0.4*sin(x/5)*y/" << n_cells
           << "; 80 - 0.3*cos(y/7)" << (dim == 3 ? "; 80 + 0.2*sin(x + z)" : "")
           << "\n"
           << "  set Material = linear elastic\n"
           << "  subsection Linear elastic\n"
           << "    set Density = 1000\n"
           << "    set Young's modulus = 1e6\n"
           << "    set Poisson's ratio = 0.3\n"
           << "  end\n"
           << "  set Locking treatment = none\n"
           << "end\n"
           << "subsection Grid\n"
           << "  set Lower corner = " << each(0) << "\n"
           << "  set Upper corner = " << each(6. + n_cells) << "\n"
           << "  set Cells = " << each(6 + n_cells) << "\n"
           << "end\n"
           << "subsection Loads\n"
           << "  set Gravity = 0, -9.81" << (dim == 3 ? ", 0" : "") << "\n"
           << "end\n"
           << "subsection Method\n"
           << "  set Stress update = usl\n"
           << "  set Kernel = linear\n"
           << "  set Transfer = flip\n"
           << "  set Time step = 5e-4\n"
           << "end\n";
      return SceneFile(ParameterText{text.str(), FileFormat::prm, "block"});
    }



    /**
     * The material point method with a ParticleHandler for the points, virtual
     * shape functions, global vectors, and a sort after every step.
     */
    template <int dim>
    class PlainSolver
    {
    public:
      // Properties of a particle: mass, velocity, J p, deviator
      static constexpr unsigned int velocity     = 1;
      static constexpr unsigned int pressure     = velocity + dim;
      static constexpr unsigned int deviator     = pressure + 1;
      static constexpr unsigned int n_properties = deviator + n_deviator<dim>;

      PlainSolver(const Problem<dim>        &problem,
                  const BackgroundGrid<dim> &grid,
                  const MaterialBody<dim>   &body)
        : grid(grid)
        , gravity(problem.loads.gravity)
        , density(body.stress->density())
        // entries of the law: density, Young's modulus, Poisson's ratio
        , bulk(body.description.material[1] / 3 /
               (1 - 2 * body.description.material[2]))
        , shear(body.description.material[1] / 2 /
                (1 + body.description.material[2]))
        , handler(grid.triangulation, grid.mapping, n_properties)
        , node_handler(grid.triangulation)
      {
        node_handler.distribute_dofs(fe);
        mass.reinit(node_handler.n_dofs());
        momentum.assign(dim, mass);
        force.assign(dim, mass);

        using Cell = typename dealii::Triangulation<dim>::active_cell_iterator;
        std::vector<Cell> cells(grid.n_cells());
        for (const auto &cell : grid.triangulation.active_cell_iterators())
          cells[grid.cell_number(cell)] = cell;

        const PointView<dim> points = body.points.view();
        for (std::size_t p = 0; p < points.size; ++p)
          {
            dealii::Point<dim> place;
            for (int d = 0; d < dim; ++d)
              place[d] = points.position[d][p];
            const Cell &cell     = cells[points.cell[p]];
            auto        particle = handler.insert_particle(
              dealii::Particles::Particle<dim>(
                place,
                grid.mapping.transform_real_to_unit_cell(cell, place),
                body.points.id(p)),
              cell);
            const auto values = particle->get_properties();
            values[0]         = points.mass[p];
            for (int d = 0; d < dim; ++d)
              values[velocity + d] = points.velocity[d][p];
            values[pressure] = points.pressure[p];
            for (unsigned int k = 0; k < n_deviator<dim>; ++k)
              values[deviator + k] = points.deviator[k][p];
          }
        handler.update_cached_numbers();
      }

      void
      advance(const double step)
      {
        mass = 0;
        for (int d = 0; d < dim; ++d)
          momentum[d] = force[d] = 0;
        points_to_grid();

        for (unsigned int i = 0; i < mass.size(); ++i)
          if (mass(i) > 0)
            for (int d = 0; d < dim; ++d)
              {
                // from now on increments and new velocities
                force[d](i)    = step * (force[d](i) / mass(i) + gravity[d]);
                momentum[d](i) = momentum[d](i) / mass(i) + force[d](i);
              }

        grid_to_points(step);
        handler.sort_particles_into_subdomains_and_cells();
      }

      /** The largest differences over the scales of the quantities. */
      double
      difference(const MaterialBody<dim> &body) const
      {
        const PointView<dim>     points = body.points.view();
        std::vector<std::size_t> place(points.size);
        for (std::size_t p = 0; p < points.size; ++p)
          place[body.points.id(p)] = p;

        double position_error = 0, velocity_error = 0, stress_error = 0,
               speed = 0, stress = 0;
        for (const auto &particle : handler)
          {
            const std::size_t p      = place[particle.get_id()];
            const auto        values = particle.get_properties();
            for (int d = 0; d < dim; ++d)
              {
                widen(position_error,
                      particle.get_location()[d] - points.position[d][p]);
                widen(velocity_error,
                      values[velocity + d] - points.velocity[d][p]);
                widen(speed, values[velocity + d]);
              }
            widen(stress_error, values[pressure] - points.pressure[p]);
            for (unsigned int k = 0; k < n_deviator<dim>; ++k)
              {
                widen(stress_error,
                      values[deviator + k] - points.deviator[k][p]);
                widen(stress, values[deviator + k]);
              }
          }
        if (handler.n_locally_owned_particles() != points.size || !(stress > 0))
          return 1e300;
        return std::max({position_error, // over the edge of a cell, 1 m
                         velocity_error / speed,
                         stress_error / stress});
      }

    private:
      static void
      widen(double &largest, const double value)
      {
        largest = std::max(largest, std::abs(value));
      }

      void
      points_to_grid()
      {
        std::vector<dealii::types::global_dof_index> dofs(fe.dofs_per_cell);
        for (const auto &cell : node_handler.active_cell_iterators())
          {
            cell->get_dof_indices(dofs);
            const auto extents = extents_of(cell);
            for (auto &particle : handler.particles_in_cell(cell))
              {
                const auto values = particle.get_properties();
                const auto xi     = particle.get_reference_location();
                const auto stress = stress_of(values);
                for (unsigned int i = 0; i < fe.dofs_per_cell; ++i)
                  {
                    const double weight = values[0] * fe.shape_value(i, xi);
                    dealii::Tensor<1, dim> gradient = fe.shape_grad(i, xi);
                    for (int d = 0; d < dim; ++d)
                      gradient[d] /= extents[d];
                    const auto f = -(values[0] / density) * (stress * gradient);
                    mass(dofs[i]) += weight;
                    for (int d = 0; d < dim; ++d)
                      {
                        momentum[d](dofs[i]) += weight * values[velocity + d];
                        force[d](dofs[i]) += f[d];
                      }
                  }
              }
          }
      }



      void
      grid_to_points(const double step)
      {
        std::vector<dealii::types::global_dof_index> dofs(fe.dofs_per_cell);
        for (const auto &cell : node_handler.active_cell_iterators())
          {
            cell->get_dof_indices(dofs);
            const auto extents = extents_of(cell);
            for (auto &particle : handler.particles_in_cell(cell))
              {
                const auto             values = particle.get_properties();
                const auto             xi = particle.get_reference_location();
                dealii::Point<dim>     place = particle.get_location();
                dealii::Tensor<2, dim> motion; // dt grad v
                for (unsigned int i = 0; i < fe.dofs_per_cell; ++i)
                  {
                    const double N        = fe.shape_value(i, xi);
                    const auto   gradient = fe.shape_grad(i, xi);
                    for (int d = 0; d < dim; ++d)
                      {
                        const double v = momentum[d](dofs[i]);
                        values[velocity + d] += N * force[d](dofs[i]);
                        place[d] += step * N * v;
                        for (int e = 0; e < dim; ++e)
                          motion[d][e] += step * v * gradient[e] / extents[e];
                      }
                  }

                const auto   strain     = dealii::symmetrize(motion);
                const double volumetric = dealii::trace(strain);
                const auto   add = [&](const unsigned int k, int i, int j) {
                  values[deviator + k] +=
                    2 * shear * (strain[i][j] - (i == j ? volumetric / 3 : 0));
                };
                values[pressure] -= bulk * volumetric;
                add(0, 0, 0);
                add(1, 1, 1);
                add(2, 0, 1);
                if constexpr (dim == 3)
                  {
                    add(3, 1, 2);
                    add(4, 0, 2);
                  }
                particle.set_location(place);
              }
          }
      }

      template <class Cell>
      static dealii::Tensor<1, dim>
      extents_of(const Cell &cell)
      {
        dealii::Tensor<1, dim> result;
        for (int d = 0; d < dim; ++d)
          result[d] = cell->extent_in_direction(d);
        return result;
      }

      static dealii::SymmetricTensor<2, dim>
      stress_of(const dealii::ArrayView<double> &values)
      {
        dealii::SymmetricTensor<2, dim> t;
        const double *const             s = &values[deviator];
        t[0][0]                           = s[0] - values[pressure];
        t[1][1]                           = s[1] - values[pressure];
        t[0][1]                           = s[2];
        if constexpr (dim == 3)
          {
            t[2][2] = -s[0] - s[1] - values[pressure];
            t[1][2] = s[3];
            t[0][2] = s[4];
          }
        return t;
      }

      const BackgroundGrid<dim>              &grid;
      const dealii::Tensor<1, dim>            gravity;
      const double                            density;
      const double                            bulk, shear; // K, G, Pa
      dealii::Particles::ParticleHandler<dim> handler;
      const dealii::FE_Q<dim>                 fe{1};
      dealii::DoFHandler<dim>                 node_handler;
      dealii::Vector<double>                  mass;
      std::vector<dealii::Vector<double>>     momentum, force;
    };



    /** The block, by Limber and the plain way, from the same start. */
    template <int dim>
    struct Comparison
    {
      explicit Comparison(const unsigned int n_cells)
        : problem(read_problem<dim>(flying_block<dim>(n_cells)))
        , grid(problem.grid, MPI_COMM_WORLD)
        , bodies(set_up_bodies(problem, grid))
        , nodes(grid)
        , integrator({problem, grid, nodes, bodies, ledger})
        , plain(problem, grid, *bodies[0])
      {}

      void
      advance_limber()
      {
        integrator.reorganise(time);
        integrator.advance(time, problem.method.time_step);
        time += problem.method.time_step;
      }

      void
      advance_plain()
      {
        plain.advance(problem.method.time_step);
      }

      double
      difference() const
      {
        return plain.difference(*bodies[0]);
      }

      const Problem<dim>                              problem;
      BackgroundGrid<dim>                             grid;
      std::vector<std::unique_ptr<MaterialBody<dim>>> bodies;
      NodalFields<dim>                                nodes;
      Ledger<dim>                                     ledger;
      ExplicitIntegrator<dim>                         integrator;
      PlainSolver<dim>                                plain;
      double                                          time = 0; // s
    };
  } // namespace testing_support
} // namespace limber

#endif
