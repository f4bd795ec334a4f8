// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/filter_bound.h>
#include <limber/problem/from_file.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/read_problem.h>
#include <limber/problem/side_contact.h>

#include <algorithm>

namespace limber
{
  namespace
  {
    /**
     * Points of a solid that cross cells gain or lose energy at first order in
     * the step if the strain increment uses a single nodal velocity
     * (doc/theory/energy_balance.md); for a liquid it makes no difference.
     */
    template <int dim>
    void
    choose_stress_update(Problem<dim> &problem)
    {
      if (problem.method.order != StressUpdateOrder::automatic)
        return;
      if (filters_velocity(problem.method.transfer))
        {
          problem.method.order = StressUpdateOrder::usl;
          problem.notes.push_back(
            "Stress update 'auto' is 'usl', with the velocity that the "
            "transfer filters.");
          return;
        }
      if (has_domains(problem.grid.kernel))
        {
          problem.method.order = StressUpdateOrder::musl;
          problem.notes.push_back(
            "Stress update 'auto' is 'musl', which keeps the energy and moves "
            "domains by the velocity that strains them.");
          return;
        }
      const auto solid =
        std::find_if(problem.bodies.begin(),
                     problem.bodies.end(),
                     [](const auto &body) { return !body.is_liquid; });
      if (solid == problem.bodies.end())
        {
          problem.method.order = StressUpdateOrder::musl;
          problem.notes.push_back("Stress update 'auto' is 'musl', as liquids "
                                  "gain nothing from 'usavg'.");
        }
      else if (solid->frame == Frame::initial)
        {
          problem.method.order = StressUpdateOrder::usavg;
          problem.notes.push_back(
            "Stress update 'auto' is 'usavg', which is of second order and in "
            "the initial frame costs no more than 'musl'.");
        }
      else if (is_spline(problem.grid.kernel))
        {
          problem.method.order = StressUpdateOrder::musl;
          problem.notes.push_back(
            "Stress update 'auto' is 'musl', which with splines keeps the "
            "energy of solids as 'usavg' does, in two thirds of the time.");
        }
      else
        {
          problem.method.order = StressUpdateOrder::usavg;
          problem.notes.push_back(
            "Stress update 'auto' is 'usavg', which keeps the energy of solids "
            "like body " +
            in_quotes(solid->name) + "; 'musl' takes two thirds of the time.");
        }
    }



    /**
     * Half of the force of 'usavg' acts with the gradients at the former
     * places, so that what turns in the current frame gains angular momentum at
     * first order in the step.
     */
    template <int dim>
    void
    warn_of_spin_from_usavg(Problem<dim> &problem)
    {
      constexpr double a_tenth_of_a_turn = 0.6; // rad
      if (problem.method.order != StressUpdateOrder::usavg ||
          problem.method.integration != TimeIntegration::explicit_steps)
        return;
      for (const Body<dim> &body : problem.bodies)
        if (!body.is_liquid && body.frame == Frame::current &&
            initial_rotation(body, problem.end_time) > a_tenth_of_a_turn)
          problem.notes.push_back(
            "Body " + in_quotes(body.name) +
            " turns in the current frame: with 'usavg' it gains pi w dt of its "
            "spin in each turn, with the angular velocity w and the time step "
            "dt. 'Method/Stress update = musl' does not.");
    }
  } // namespace



  namespace
  {
    // A resumed run may have another end time and other output, but must remain
    // the same run: its end time is fixed if loads grow until then. A file may
    // have been moved, but its content must be the same.
    template <int dim>
    std::vector<std::string>
    fixed_entries(const Parameters &parameters, const Problem<dim> &problem)
    {
      const auto is_path = [](const std::string &name) {
        const std::string end = "/File";
        return name.size() > end.size() &&
               name.compare(name.size() - end.size(), end.size(), end) == 0;
      };
      std::vector<std::string> result;
      for (const Body<dim> &body : problem.bodies)
        if (const auto *file = dynamic_cast<const FromFile *>(body.shape.get()))
          result.push_back("File of body " + body.name + " = " +
                           file->checksum);
      for (const Obstacle<dim> &obstacle : problem.obstacles)
        if (const auto *file =
              dynamic_cast<const FromFile *>(obstacle.shape.get()))
          result.push_back("File of obstacle " + obstacle.name + " = " +
                           file->checksum);
      for (const auto &[name, value] : parameters.entries())
        if (!is_path(name) && name != "End time" && name != "End step" &&
            name != "Memory limit" && name.rfind("Output/", 0) != 0 &&
            name.rfind("Checkpoint/", 0) != 0 &&
            name.rfind("Reference/", 0) != 0 &&
            name.rfind("Exact solution/", 0) != 0)
          result.push_back(
            name + " = " +
            (name == "Loads/Load factor" && problem.loads_grow_until_the_end() ?
               problem.factor_until_the_end() :
               value));
      return result;
    }



    /** Says once, of all bodies concerned, what several notes say of one. */
    std::vector<std::string>
    joined(const std::vector<std::string> &notes)
    {
      const std::string        begin = "Body ", end = ": ";
      std::vector<std::string> result;
      std::vector<std::string> rests; // of these: what is said, of whom
      std::vector<std::string> bodies;
      for (const std::string &note : notes)
        {
          const std::size_t colon =
            note.rfind(begin, 0) == 0 ? note.find(end) : std::string::npos;
          const bool        is_of_body = colon != std::string::npos;
          const std::string rest       = is_of_body ? note.substr(colon) : note;
          const std::string body =
            is_of_body ? note.substr(begin.size(), colon - begin.size()) : "";
          const std::size_t same =
            std::find(rests.begin(), rests.end(), rest) - rests.begin();
          if (is_of_body && same < rests.size())
            {
              bodies[same] += ", " + body;
              result[same] = "Bodies " + bodies[same] + rest;
              continue;
            }
          result.push_back(note);
          rests.push_back(is_of_body ? rest : "");
          bodies.push_back(body);
        }
      return result;
    }
  } // namespace



  template <int dim>
  Problem<dim>
  read_problem(const SceneFile &scene)
  {
    const Section root  = scene.parameters().root();
    const Section loads = root.subsection("Loads");
    if (root.is_empty("Bodies"))
      throw InputError("The scene has no bodies: " + root.where("Bodies") +
                       " is empty, so there is nothing to move. Usually the "
                       "list was forgotten. Write 'set Bodies = block' and a "
                       "section 'Body block'.");

    // The order matters: each part may use those read before it.
    Problem<dim> problem;
    problem.end_time = root.number("End time");
    problem.end_step = static_cast<unsigned long>(root.number("End step"));
    if (root.text("Memory limit") != "auto")
      problem.memory_limit = 1e9 * root.number("Memory limit");
    problem.grid = read_grid<dim>(root.subsection("Grid"), root.list("Bodies"));
    problem.method = read_method(root.subsection("Method"));
    read_boundaries(root.subsection("Boundaries"), problem);
    read_volume_loads(loads, problem);
    read_bodies(root, problem);
    read_face_loads(loads, problem);
    read_obstacles(root, problem);
    choose_time_integration(root, problem);
    choose_histories(root, problem);
    choose_stress_update(problem);
    warn_of_spin_from_usavg(problem);
    obey_filter(problem);
    read_contact(root, problem);
    check_obstacles(root, problem);
    choose_density_control_and_shifting(root, problem);
    choose_side_contact(problem);
    problem.output     = read_output(root.subsection("Output"));
    problem.checkpoint = read_checkpoint(root.subsection("Checkpoint"));
    problem.reference  = read_reference(root.subsection("Reference"),
                                       problem.method,
                                       problem.end_time);
    read_exact_solution(root.subsection("Exact solution"), problem);
    read_observables(root, problem);
    read_checks(root, problem);
    check_levels(root, problem);
    problem.notes         = joined(problem.notes);
    problem.fixed_entries = fixed_entries(scene.parameters(), problem);
    return problem;
  }



  void
  print_parameters(std::ostream    &out,
                   const PrintStyle style,
                   const SceneFile *scene)
  {
    if (scene != nullptr)
      return scene->parameters().print(out, style);

    ParameterText example;
    example.origin = "template";
    example.text   = R"(
      set Bodies      = block
      set Observables = corner
      set Checks      = corner stays low
      subsection Body block
        subsection Box
          set Lower corner = 0.2, 0
          set Upper corner = 0.8, 0.5
        end
      end
      subsection Grid
        set Levels = 1
        set Refine = corner
        subsection Refine corner
          set Lower corner = 0.6, 0
          set Upper corner = 0.8, 0.5
        end
      end
      subsection Loads
        set Gravity    = 0, -9.81
        set Face loads = weight
        subsection Face load weight
          set Body     = block
          set Face     = top
          set Pressure = 100
        end
      end
      subsection Contact
        set Pairs = meeting
        subsection Pair meeting
          set Bodies = block
        end
      end
      subsection Observable corner
        set Type      = displacement
        set Location  = 0.8, 0.5
        set Direction = y
      end
      subsection Check corner stays low
        set Observable = corner
        set Reference  = 0
        set Tolerance  = 0.05
      end
    )";
    // The table lists entries that do not go together yet; a scene must not.
    if (style == PrintStyle::markdown)
      example.text += R"(
        set Obstacles = floor
        subsection Obstacle floor
          set Shape = half-space
        end
      )";
    SceneFile(example).parameters().print(out, style);
  }



  template Problem<2>
  read_problem<2>(const SceneFile &);
  template Problem<3>
  read_problem<3>(const SceneFile &);
} // namespace limber
