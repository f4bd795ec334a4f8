// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/materials/law_list.h>
#include <limber/problem/acceleration.h>
#include <limber/problem/obstacle_way.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/words.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  namespace
  {
    // Share gamma of the compact Laplacian in the pressure equation: enough for
    // a solver whose work does not grow with the grid, too little to affect
    // motions visibly
    constexpr double compact_share = 0.1;

    // Speed of sound over all other speeds from which 'auto' is semi-implicit:
    // such a run takes about a quarter of the time
    constexpr double fast_sound = 30;

    // Cost of a semi-implicit step over that of an explicit one, as measured in
    // doc/theory/implicit_pressure.md (7 to 12); of a short one, that viscosity
    // or waves in solids limit, in which the pressure hardly changes, 3
    constexpr double cost_of_step       = 10;
    constexpr double cost_of_short_step = 3;

    // Saving of time from which short steps are worth it
    constexpr double worthwhile = 2;



    /** What the choice of 'auto' depends on; SI units. */
    struct Speeds
    {
      double sound        = 0; // in liquids, the fastest
      double motion       = 0; // of liquids at first, sides and obstacles
      double surface      = 0; // sqrt(g H), H the height of the liquid
      double acceleration = 0; // g, of liquids, m/s^2
      double waves        = 0; // in solids
      double viscosity    = 0; // of liquids, kinematic, m^2/s
    };



    template <int dim>
    Speeds
    speeds_of(const Problem<dim> &problem)
    {
      constexpr unsigned int n = 9; // places along each edge
      Speeds                 result;
      for (const Body<dim> &body : problem.bodies)
        {
          const Moduli moduli = moduli_of(body.law, body.material);
          const double speed =
            std::sqrt((moduli.bulk + 4. / 3. * moduli.shear) / body.density());
          (body.is_liquid ? result.sound : result.waves) =
            std::max(body.is_liquid ? result.sound : result.waves, speed);
          if (body.is_liquid)
            result.viscosity =
              std::max(result.viscosity,
                       body.material[NewtonianFluid<true>::viscosity_entry] /
                         body.density());
          const auto box = body.shape->bounding_box();
          if (!body.initial_velocity.empty() &&
              !body.initial_velocity.is_zero())
            for_each_place(box, n, [&](const dealii::Point<dim> &place) {
              if (body.shape->contains(place))
                result.motion =
                  std::max(result.motion,
                           body.initial_velocity.vector(place, 0).norm());
            });
          if (const auto a = largest_acceleration(problem, body);
              body.is_liquid && a.norm() > 0)
            {
              double fall = 0; // |a| times the height along it
              for (unsigned int d = 0; d < dim; ++d)
                fall += a[d] * (box.second[d] - box.first[d]);
              result.surface      = std::max(result.surface, std::sqrt(fall));
              result.acceleration = std::max(result.acceleration, a.norm());
            }
        }
      constexpr unsigned int n_times = 33;
      Corners<dim>           grid;
      grid.first  = problem.grid.lower;
      grid.second = problem.grid.upper;
      for (const auto &side : problem.sides)
        for (unsigned int t = 0; t < n_times; ++t)
          for_each_place(grid, n, [&](const dealii::Point<dim> &place) {
            dealii::Tensor<1, dim> velocity;
            for (unsigned int d = 0; d < dim; ++d)
              velocity[d] =
                side.prescribed_velocity(place,
                                         problem.end_time * t / (n_times - 1.),
                                         d);
            result.motion = std::max(result.motion, velocity.norm());
          });
      for (const Obstacle<dim> &obstacle : problem.obstacles)
        for (unsigned int t = 0; t + 1 < n_times; ++t)
          {
            const double step = problem.end_time / (n_times - 1);
            if (const double way =
                  way_of_obstacle(obstacle, problem.grid, t * step, step);
                std::isfinite(way))
              result.motion = std::max(result.motion, way / step);
          }
      return result;
    }



    /** What in the scene does not go with 'semi-implicit'; empty: nothing. */
    template <int dim>
    std::string
    obstacle_to_implicit_pressure(const Section      &root,
                                  const Problem<dim> &problem)
    {
      if (problem.grid.kernel != KernelKind::linear)
        return "the kernel is not 'linear'";
      if (!root.subsection("Contact").list("Pairs").empty())
        return "bodies touch by 'Contact/Pairs'";
      for (const std::string &name : root.list("Obstacles"))
        if (root.subsection("Obstacle " + name).text("Law") != "slip")
          return "liquids do not slide on obstacle " + in_quotes(name);
      if (!root.list("Obstacles").empty() &&
          !std::all_of(problem.bodies.begin(),
                       problem.bodies.end(),
                       [](const auto &body) { return body.is_liquid; }))
        return "solids may meet obstacles";
      if (problem.method.order != StressUpdateOrder::automatic &&
          problem.method.order != StressUpdateOrder::usl)
        return "the stress update is neither 'auto' nor 'usl'";
      for (const Body<dim> &body : problem.bodies)
        if (body.is_liquid)
          {
            const Section     section = root.subsection("Body " + body.name);
            const std::string of_body = " of body " + in_quotes(body.name);
            if (body.treatment != Treatment::cell)
              return "the locking treatment" + of_body + " is not 'cell'";
            if (body.history != HistoryTreatment::keep)
              return "the history" + of_body + " is not kept";
          }
      return "";
    }



    /**
     * Why explicit steps are needed although sound is fast; empty: they are
     * not.
     */
    template <int dim>
    std::string
    need_for_explicit_steps(const Problem<dim> &problem,
                            const double        longest_explicit_step)
    {
      // A sudden load excites sound, which an implicit pressure damps at once
      for (const auto &load : problem.loads.faces)
        for (const Body<dim> &body : problem.bodies)
          if (body.is_liquid && body.name == load.body)
            return "face load " + in_quotes(load.name) +
                   " acts on a liquid, in which it may make sound";
      if (problem.method.time_step > 0 &&
          problem.method.time_step <= longest_explicit_step)
        return "'Time step' is short enough for sound";
      return "";
    }



    /** Resolves 'auto', and says in the log what it is and why, if there is a
     * choice at all. */
    template <int dim>
    void
    choose_automatically(const Section &root, Problem<dim> &problem)
    {
      if (std::none_of(problem.bodies.begin(),
                       problem.bodies.end(),
                       [](const auto &body) { return body.is_liquid; }))
        return;
      const auto say = [&](const std::string &choice) {
        problem.notes.push_back("Time integration 'auto' is " + choice + ".");
      };
      const Speeds speeds = speeds_of(problem);
      const double other =
        std::max(speeds.motion + speeds.surface, speeds.waves);
      // neither motion nor weight: nothing to compare with
      if (!(other > 0))
        return say("'explicit', as nothing moves at first and nothing weighs");
      const bool waves_limit = speeds.waves > speeds.motion + speeds.surface;
      const std::string ratio =
        "sound in the liquid is " + brief(speeds.sound / other) +
        " times as fast as " +
        (waves_limit ? "waves in solids" : "what moves (|v| + sqrt(g h))");
      const double fast =
        waves_limit ? worthwhile * cost_of_short_step : fast_sound;
      if (!(speeds.sound > fast * other))
        return say("'explicit', as " + ratio + "; other steps pay from " +
                   brief(fast) + " times on");

      double edge = 1e300; // of the finest cells
      for (unsigned int d = 0; d < dim; ++d)
        edge = std::min(edge, problem.grid.finest_edge(d));
      const double C            = problem.method.courant_number;
      const double former_steps = (speeds.sound + speeds.motion) / (C * edge);
      const double of_viscosity = 4 * speeds.viscosity / (C * edge * edge);
      const double steps        = std::max({other / (C * edge),
                                            5 * std::sqrt(speeds.acceleration / edge),
                                            of_viscosity});
      if (!(former_steps > worthwhile * cost_of_short_step * of_viscosity))
        return say("'explicit', as viscosity would limit other steps as well");
      const double      cost = waves_limit || !(steps > of_viscosity) ?
                                 cost_of_short_step :
                                 cost_of_step;
      const std::string gain = "about " + brief(former_steps / steps) +
                               " times fewer steps, which take some " +
                               brief(cost) + " times as long";
      const std::string obstacle = obstacle_to_implicit_pressure(root, problem);
      if (!obstacle.empty())
        return say("'explicit', as " + obstacle +
                   ". 'semi-implicit' would take " + gain);
      const std::string need =
        need_for_explicit_steps(problem, edge / (speeds.sound + speeds.motion));
      if (!need.empty())
        return say("'explicit', as " + need + "; 'semi-implicit' would take " +
                   gain);
      problem.method.integration = TimeIntegration::semi_implicit;
      say("'semi-implicit', as " + ratio + ": " + gain +
          "; they do not resolve sound");
    }



    [[noreturn]] void
    refuse(const std::string &cause, const std::string &remedy)
    {
      throw InputError("Time integration 'semi-implicit' does not go with " +
                       cause + ". Set " + remedy +
                       ", or 'Time integration = explicit'.");
    }



    /**
     * Whether the pressure of a solid can be implicit along with that of
     * liquids: one pressure per cell (treatment 'cell'), and a stress that
     * follows from the strain.
     */
    template <int dim>
    bool
    has_pressure_of_cells(const Section &section, const Body<dim> &body)
    {
      return read_word(section, "Material", law_words()).is_elastic &&
             body.treatment == Treatment::cell &&
             body.frame == Frame::current &&
             body.history == HistoryTreatment::keep;
    }



    /**
     * Throws InputError for what keeps the pressure of a liquid from being
     * implicit.
     */
    template <int dim>
    void
    check_liquid(const Section &section, const Body<dim> &body)
    {
      if (body.treatment != Treatment::cell)
        refuse("the locking treatment " +
                 in_quotes(section.text("Locking treatment")) + " in " +
                 section.where("Locking treatment") +
                 ": an implicit pressure is one for each cell",
               "'Locking treatment = cell'");
      if (body.history != HistoryTreatment::keep)
        refuse("the history " + in_quotes(section.text("History")) + " in " +
                 section.where("History") +
                 ": with one pressure in a cell its scatter does nothing",
               "'History = keep'");
    }



    /** Leave the tension cut-off to the pressure system instead of the law. */
    template <int dim>
    void
    give_tension_to_system(Body<dim> &body)
    {
      double &of_law    = body.material[NewtonianFluid<true>::tension_entry];
      body.cuts_tension = of_law != 0;
      of_law            = 0;
    }
  } // namespace



  template <int dim>
  void
  choose_time_integration(const Section &root, Problem<dim> &problem)
  {
    if (root.subsection("Method").text("Time integration") == "auto")
      choose_automatically(root, problem);
    if (is_solved_by_newton(problem.method.integration))
      return check_newton_scene(root, problem);
    if (!problem.loads.factor.empty())
      throw InputError("The entry " +
                       in_quotes(root.subsection("Loads").text("Load factor")) +
                       " in " + root.subsection("Loads").where("Load factor") +
                       " is for 'Method/Time integration = quasi-static'; in "
                       "motion loads are as their formulas say. Set 'Load "
                       "factor = auto'.");
    if (problem.method.integration == TimeIntegration::explicit_steps)
      return;

    const Section method = root.subsection("Method");
    const auto    where  = [&](const std::string &entry) {
      return in_quotes(method.text(entry)) + " in " + method.where(entry);
    };
    const auto section_of = [&](const Body<dim> &body) {
      return root.subsection("Body " + body.name);
    };
    const bool with_solids = std::all_of(
      problem.bodies.begin(), problem.bodies.end(), [&](const auto &body) {
        return body.is_liquid || has_pressure_of_cells(section_of(body), body);
      });
    for (auto &body : problem.bodies)
      body.implicit_pressure = body.is_liquid || with_solids;
    if (std::none_of(problem.bodies.begin(),
                     problem.bodies.end(),
                     [](const auto &body) { return body.implicit_pressure; }))
      refuse("this scene: no liquid and no elastic solid with 'cell' in the "
             "current frame",
             "'newtonian fluid', or 'Frame = current' and 'Locking treatment = "
             "cell'");
    if (problem.grid.kernel != KernelKind::linear)
      refuse("the kernel " + where("Kernel"), "'Kernel = linear'");
    if (problem.method.order != StressUpdateOrder::automatic &&
        problem.method.order != StressUpdateOrder::usl)
      refuse("the stress update " + where("Stress update") +
               ", as the velocity that it finds strains",
             "'Stress update = usl'");
    problem.method.order = StressUpdateOrder::usl;

    for (auto &body : problem.bodies)
      if (body.implicit_pressure)
        {
          const Section section = section_of(body);
          if (body.is_liquid)
            {
              check_liquid(section, body);
              give_tension_to_system(body);
            }
          if (section.text("Checkerboard control") == "auto")
            body.checkerboard_control = compact_share;
        }
  }



  template void
  choose_time_integration(const Section &, Problem<2> &);
  template void
  choose_time_integration(const Section &, Problem<3> &);
} // namespace limber
