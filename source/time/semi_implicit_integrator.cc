// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/text.h>
#include <limber/problem/acceleration.h>
#include <limber/problem/time_scale.h>
#include <limber/time/semi_implicit_integrator.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  namespace
  {
    // Of sqrt(h / g): half as much loses a percent of the height of a wave in
    // each swing less, five times as much is unstable.
    constexpr double share_of_swing = 0.2;

    constexpr double step_growth = 1.5; // of steps, from one to the next

    // Of the time in which what drives the scene changes: 25 steps a period
    constexpr double share_of_change = 0.25;

    constexpr unsigned int most_shorter_steps = 10; // that are tried for one

    // Of the mass of a full node: less is light
    constexpr double light = 0.3;

    // A node that a cell filled to this share has at the surface is thrown by
    // the viscosity of the new velocity when nu dt / h^2 is larger.
    constexpr double smallest_filling = 1e-3;



    /** The smallest density of bodies that bear shear, kg/m^3; 0: there are
     * none. */
    template <int dim>
    double
    lightest_solid_of(const RunParts<dim> &parts)
    {
      double result = 0;
      for (const auto &body : parts.bodies)
        if (!body->description.is_liquid)
          {
            const double density = body->stress->density();
            result = result > 0 ? std::min(result, density) : density;
          }
      return result;
    }



    template <int dim>
    double
    largest_acceleration_of(const Problem<dim> &problem)
    {
      double result = 0;
      for (const Body<dim> &body : problem.bodies)
        result = std::max(result, largest_acceleration(problem, body).norm());
      return result;
    }
  } // namespace



  template <int dim>
  SemiImplicitIntegrator<dim>::SemiImplicitIntegrator(
    const RunParts<dim> &parts)
    : Base(parts)
    , pressure(parts,
               Base::boundaries,
               Base::cut_cells ? &*Base::cut_cells : nullptr,
               Base::obstacles ? &*Base::obstacles : nullptr)
    , hourglass(std::size_t(parts.nodes.table.n()) * dim)
    , acceleration(largest_acceleration_of(parts.problem))
    , time_of_change(time_scale_of_formulas(parts.problem))
    , viscosity_acts(!this->full_mass && is_viscous())
    , remaps(
        viscosity_acts ||
        (!this->full_mass && std::any_of(parts.bodies.begin(),
                                         parts.bodies.end(),
                                         [](const auto &body) {
                                           return !body->description.is_liquid;
                                         })))
    , lightest_solid(lightest_solid_of(parts))
  {}



  template <int dim>
  void
  SemiImplicitIntegrator<dim>::reinit()
  {
    Base::reinit();
    pressure.reinit();
    hourglass.reinit(std::size_t(this->parts.nodes.table.n()) * dim);
  }



  template <int dim>
  std::string
  SemiImplicitIntegrator<dim>::effort() const
  {
    const auto &spent = pressure.effort();
    return "implicit pressure: " +
           brief(double(spent.iterations) / std::max(1ul, spent.steps)) +
           " iterations a step, at most " +
           std::to_string(spent.most_iterations) +
           (spent.solutions > spent.steps ?
              "; solved " +
                brief(double(spent.solutions) / double(spent.steps)) +
                " times a step, until tension is cut off and sides and obstacles "
                "hold what presses on them" :
              "") +
           (spent.for_density > 0 ?
              "; for the density control " +
                brief(double(spent.for_density) / double(spent.steps)) :
              "");
  }



  // As an explicit step, but for the pressure of its end. What is set in motion
  // at once, as by a piston or an impact, may be faster than anything before:
  // the step was too long, and nothing but nodes and ledger knows of it yet.
  template <int dim>
  void
  SemiImplicitIntegrator<dim>::do_scheme()
  {
    const Ledger<dim> before = this->parts.ledger;
    find_velocity();
    for (unsigned int n = 0; n < most_shorter_steps && is_too_long(); ++n)
      {
        this->step *= this->parts.problem.method.courant_number / too_far;
        this->history_time = this->step;
        this->parts.ledger = before;
        this->parts.nodes.clear();
        find_velocity();
      }
    this->check_nodes();
    if (viscosity_acts)
      pressure.complete_dilations(this->step);
    if (remaps)
      update_all();
    else
      update_liquids();
  }



  // Whether nodes move by more than a cell.
  template <int dim>
  bool
  SemiImplicitIntegrator<dim>::is_too_long()
  {
    const double cells = this->way_of_fastest_node();
    if (!(cells > 1 && cells < 1e300))
      return false;
    too_far = cells;
    return true;
  }



  template <int dim>
  std::string
  SemiImplicitIntegrator<dim>::reason_for_shorter_step() const
  {
    return "nodes would move by " + brief(too_far) + " cells";
  }



  template <int dim>
  void
  SemiImplicitIntegrator<dim>::find_velocity()
  {
    this->p2g();
    resist_hourglass();
    this->damp();
    this->add_loads();
    this->advance_nodes();
    this->smooth_surfaces(1);
    solve_pressure();
    this->exchange_between_bodies();
    this->apply_boundaries();
    this->interpolate_hanging();
    this->measure_nodes();
  }



  // The pressure belongs to the new velocity, which strains the liquids.
  template <int dim>
  void
  SemiImplicitIntegrator<dim>::update_liquids()
  {
    account(Layout::velocity);
    this->filter_velocity();
    const double expected = energy_to_points();
    this->g2p();
    const double weighs = correct_density();
    this->update_stress_and_move(this->step, Layout::velocity);
    this->parts.ledger.lose_by_steps(expected - weighs - energy_of_points());
  }



  // When points have got their velocities. Returns the work of gravity, which
  // is on record as removed by a change of state.
  template <int dim>
  double
  SemiImplicitIntegrator<dim>::correct_density()
  {
    double work = 0;
    for (const std::uint32_t node : this->parts.nodes.active_nodes())
      if (this->parts.nodes.owns(node))
        for (int d = 0; d < dim; ++d)
          work += this->parts.nodes.record(node)[Layout::mass] *
                  this->parts.problem.loads.gravity[d] *
                  pressure.density_displacement(node, d);
    this->parts.ledger.history += work;
    pressure.correct_density(this->step);
    return work;
  }



  // Whether viscosity does anything in a step as long as motion allows.
  template <int dim>
  bool
  SemiImplicitIntegrator<dim>::is_viscous() const
  {
    const double h = this->parts.grid.smallest_edge;
    return this->viscosity * share_of_swing >
           smallest_filling * h * std::sqrt(h * acceleration);
  }



  // Solids and viscous liquids are strained by the velocity that points give
  // back: the new one makes stresses of its own in cells that are hardly
  // filled. The pressure of liquids alone works along the new one in any case.
  template <int dim>
  void
  SemiImplicitIntegrator<dim>::update_all()
  {
    const bool   any_solid = lightest_solid > 0;
    const double expected  = any_solid ? 0 : energy_to_points();
    this->clear_remapped();
    this->g2p_and_remap();
    account(any_solid ? Layout::strain_velocity : Layout::velocity);
    if (any_solid)
      strain_by_heavy_nodes();
    this->interpolate_hanging();
    const double weighs = correct_density();
    this->update_stress_and_move(this->step, Layout::strain_velocity);
    if (!any_solid)
      this->parts.ledger.lose_by_steps(expected - weighs - energy_of_points());
  }



  // The pressures of solids work along the new velocity v1: so do the stresses
  // that resist them, or work would come from the difference to what points
  // give back (in bending both are large and opposite), the more the longer
  // steps are. Nor do points give back the velocity that a liquid below has
  // just been allowed, and a soft solid that is strained by another one bounces
  // on it higher and higher. But nodes that are light fly off with what stress
  // makes of them in a step of full ones. Points give back less of short waves
  // than lumped nodes have got: the work of stress on that is lost.
  template <int dim>
  void
  SemiImplicitIntegrator<dim>::strain_by_heavy_nodes()
  {
    for (const std::uint32_t node : this->parts.nodes.active_nodes())
      {
        double full =
          lightest_solid * std::pow(this->parts.grid.smallest_edge, dim);
        for (unsigned int side = 0; side < 2 * dim; ++side)
          if (this->parts.nodes.table.sides[node] >> side & 1)
            full *= 0.5;
        double *const record = this->parts.nodes.record(node);
        if (!(record[Layout::mass] > light * full))
          continue;
        for (int d = 0; d < dim; ++d)
          {
            const double change = record[Layout::velocity + d] -
                                  record[Layout::strain_velocity + d];
            if (this->parts.nodes.owns(node))
              this->parts.ledger.lose_by_steps(change *
                                               impulse_of_stress(node, d));
            record[Layout::strain_velocity + d] += change;
          }
      }
  }



  // What is neither pressure, weight nor resistance, N s; nothing where a side
  // holds the node, whose force is not known.
  template <int dim>
  double
  SemiImplicitIntegrator<dim>::impulse_of_stress(const std::uint32_t node,
                                                 const int           d) const
  {
    if (pressure.is_held(node, d))
      return 0;
    const double *const record = this->parts.nodes.record(node);
    return record[Layout::mass] *
             (record[Layout::increment + d] -
              this->step * this->parts.problem.loads.gravity[d]) -
           this->step * (pressure.force_on(node, d) +
                         hourglass[std::size_t(node) * dim + d]);
  }



  // That of the points after the step if nothing were lost on the way to them:
  // kinetic energy as lumped nodes have gained it, and gravity that works along
  // the new velocity, while points follow curves and take short waves with
  // their full mass.
  template <int dim>
  double
  SemiImplicitIntegrator<dim>::energy_to_points() const
  {
    double result = energy_of_points();
    for (const std::uint32_t node : this->parts.nodes.active_nodes())
      {
        const double *const record = this->parts.nodes.record(node);
        if (!this->parts.nodes.owns(node))
          continue;
        for (int d = 0; d < dim; ++d)
          result += record[Layout::mass] *
                    (record[Layout::increment + d] *
                       (record[Layout::velocity + d] -
                        0.5 * record[Layout::increment + d]) -
                     this->step * this->parts.problem.loads.gravity[d] *
                       record[Layout::velocity + d]);
      }
    return result;
  }



  // Kinetic energy and that of gravity on this rank, and what is on record as
  // removed from it, J.
  template <int dim>
  double
  SemiImplicitIntegrator<dim>::energy_of_points() const
  {
    const auto &gravity = this->parts.problem.loads.gravity;
    double      result  = this->parts.ledger.transfer;
    for (const auto &body : this->parts.bodies)
      {
        const PointView<dim> points = body->points.view();
        for (int d = 0; d < dim; ++d)
          for (std::size_t p = 0; p < points.size; ++p)
            result += points.mass[p] *
                      (0.5 * points.velocity[d][p] * points.velocity[d][p] -
                       gravity[d] * points.position[d][p]);
      }
    return result;
  }



  // The forces against hourglass motion, which are added to others, are kept.
  template <int dim>
  void
  SemiImplicitIntegrator<dim>::resist_hourglass()
  {
    const auto add = [this](const double factor) {
      for (const std::uint32_t node : this->parts.nodes.active_nodes())
        for (int d = 0; d < dim; ++d)
          hourglass[std::size_t(node) * dim + d] +=
            factor * this->parts.nodes.record(node)[Layout::force + d];
    };
    for (const std::uint32_t node : this->parts.nodes.active_nodes())
      std::fill_n(&hourglass[std::size_t(node) * dim], dim, 0.);
    add(-1);
    Base::resist_hourglass();
    add(1);
  }



  // The heat of hourglass motion is on record as if the velocity did not change
  // in the step. On what a side holds, forces work with its velocity (see
  // BoundaryConditions), else with the mean of the step.
  template <int dim>
  void
  SemiImplicitIntegrator<dim>::account(const unsigned int velocity_after)
  {
    this->account_loads(velocity_after);
    pressure.account(this->step, velocity_after);
    for (const std::uint32_t node : this->parts.nodes.active_nodes())
      if (this->parts.nodes.owns(node))
        for (int d = 0; d < dim; ++d)
          {
            const double *const record = this->parts.nodes.record(node);
            const double        before =
              record[Layout::velocity + d] - record[Layout::increment + d];
            const double share = pressure.is_held(node, d) ? 1 : 0.5;
            this->parts.ledger.viscous -=
              share * this->step * hourglass[std::size_t(node) * dim + d] *
              (record[velocity_after + d] - before);
          }
  }



  template <int dim>
  void
  SemiImplicitIntegrator<dim>::solve_pressure()
  {
    pressure.solve(this->time + this->step,
                   this->step,
                   std::min(1., this->step / step_of_motion()));
    this->lap(Verb::solve_pressure);
  }



  // In which points move by the Courant number in cells, and surface waves of
  // the length of a cell do not swing far.
  template <int dim>
  double
  SemiImplicitIntegrator<dim>::step_of_motion() const
  {
    const Problem<dim> &problem = this->parts.problem;
    const double        h       = this->parts.grid.smallest_edge;
    return std::min(problem.method.courant_number * h /
                      std::max(this->point_speed, 1e-300),
                    share_of_swing *
                      std::sqrt(h / std::max(acceleration, 1e-300)));
  }



  template <int dim>
  double
  SemiImplicitIntegrator<dim>::longest_step() const
  {
    const Problem<dim> &problem = this->parts.problem;
    if (problem.method.time_step > 0)
      return Base::longest_step();
    const double longest =
      std::min(Base::longest_step(), share_of_change * time_of_change);
    if (acceleration > 0)
      return std::min(longest, step_of_motion());
    // Nothing says how fast it will become what other loads set in motion.
    return std::min(longest,
                    this->step > 0 ? step_growth * this->step :
                                     pressure.time_of_sound());
  }



  template class SemiImplicitIntegrator<2>;
  template class SemiImplicitIntegrator<3>;
} // namespace limber
