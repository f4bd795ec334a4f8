// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/half_space.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/words.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace limber
{
  using dealii::Point;



  namespace
  {
    enum class ObstacleLaw
    {
      slip,
      friction,
      stick
    };

    const Words<ObstacleLaw> &
    obstacle_law_words()
    {
      static const Words<ObstacleLaw> words = {
        {"slip", ObstacleLaw::slip, "material slides along it and parts"},
        {"friction", ObstacleLaw::friction, "the same with Coulomb friction"},
        {"stick",
         ObstacleLaw::stick,
         "what presses on it does not slide; it parts as well"}};
      return words;
    }



    Words<std::string>
    obstacle_shape_words()
    {
      Words<std::string> words = shape_words();
      const char *const  word  = HalfSpaceShape<2>::word;
      words.push_back({word, word, HalfSpaceShape<2>::text});
      return words;
    }



    void
    declare_motion(Parameters &parameters, const unsigned int dim)
    {
      parameters.declare(
        "Displacement",
        "",
        admissible::text("formula of t with " + std::to_string(dim) +
                           " components",
                         dim == 2 ? "0.1*sin(t); 0" : "0.1*sin(t); 0; 0")
          .or_empty(),
        "u(t), m: how far it has moved; empty: it is not displaced.");
      parameters.declare("Rotation",
                         "",
                         admissible::text("formula of t", "2*pi*t").or_empty(),
                         "Angle about 'Centre' by which it has turned, rad, "
                         "anticlockwise; empty: it does not turn.");
      parameters.declare("Centre",
                         for_each_direction(dim, "0"),
                         admissible::numbers(dim, for_each_direction(dim, "0")),
                         "It turns about this place, which moves with it, and "
                         "moments are taken about it, m.");
      if (dim == 3)
        parameters.declare("Axis",
                           "0, 0, 1",
                           admissible::numbers(3, "0, 0, 1"),
                           "Direction of the axis of the rotation, of any "
                           "length.");
    }



    template <int dim>
    void
    declare_half_space(Parameters &parameters)
    {
      parameters.enter_subsection(HalfSpaceShape<dim>::section);
      HalfSpaceShape<dim>::declare(parameters);
      parameters.leave_subsection();
    }



    void
    declare_obstacle(Parameters                     &parameters,
                     const unsigned int              dim,
                     const std::vector<std::string> &union_parts)
    {
      declare_word(parameters,
                   "Shape",
                   "box",
                   obstacle_shape_words(),
                   "The region that it fills, which may reach beyond the grid; "
                   "the section of the same name holds the measures.");
      declare_word(parameters,
                   "Law",
                   "slip",
                   obstacle_law_words(),
                   "What happens where material presses on it.");
      parameters.declare("Friction coefficient",
                         "",
                         admissible::non_negative_number("0.3").or_empty(),
                         "Coulomb's coefficient mu, no unit, for 'friction'.");
      parameters.only_with("Friction coefficient",
                           {"friction"},
                           "Law",
                           parameters.present_section());
      declare_constants(parameters);
      declare_motion(parameters, dim);
      declare_shape_sections(parameters, dim, union_parts);
      if (dim == 2)
        declare_half_space<2>(parameters);
      else
        declare_half_space<3>(parameters);
    }
  } // namespace



  void
  declare_obstacles(Parameters        &parameters,
                    const unsigned int dim,
                    const SceneNames  &names)
  {
    parameters.declare_list("Obstacles",
                            "",
                            "Obstacle ",
                            "Names of rigid obstacles; each has a section "
                            "'Obstacle NAME'.");
    for (const std::string &name : names.obstacles)
      {
        parameters.enter_subsection("Obstacle " + name);
        declare_obstacle(parameters, dim, names.obstacle_shapes.at(name));
        parameters.leave_subsection();
      }
  }



  namespace
  {
    /**
     * Three times as large as the grid: for shapes whose extent is not given.
     */
    template <int dim>
    Corners<dim>
    beyond(const GridDescription<dim> &grid)
    {
      const dealii::Tensor<1, dim> extent = grid.upper - grid.lower;
      return {grid.lower - extent, grid.upper + extent};
    }



    template <int dim>
    std::shared_ptr<const Shape<dim>>
    read_obstacle_shape(const Section      &section,
                        const Constants    &constants,
                        const Corners<dim> &box)
    {
      using HalfSpace = HalfSpaceShape<dim>;
      if (section.text("Shape") == HalfSpace::word)
        return HalfSpace::read(
          {section, section.subsection(HalfSpace::section), constants, box});
      auto result = read_shape(section, constants, box);
      if (!result->signed_distance(box.first))
        throw InputError("An obstacle cannot have the shape " +
                         in_quotes(section.text("Shape")) + " in " +
                         section.where("Shape") +
                         " yet, as nothing tells how far its surface is. Use "
                         "'stl', 'polygon' or 'formula', for instance.");
      return result;
    }



    double
    read_friction(const Section &section)
    {
      switch (read_word(section, "Law", obstacle_law_words()))
        {
          case ObstacleLaw::slip:
            return 0;
          case ObstacleLaw::stick:
            return std::numeric_limits<double>::infinity();
          case ObstacleLaw::friction:
            break;
        }
      if (section.is_empty("Friction coefficient"))
        throw InputError("The law 'friction' in " + section.where("Law") +
                         " lacks its 'Friction coefficient'. Write 'set "
                         "Friction coefficient = 0.3' beside it, or 'set Law = "
                         "slip' for an obstacle without friction.");
      return section.number("Friction coefficient");
    }



    /**
     * A prescribed motion: empty, or finite in the run and uniform in space.
     */
    template <int dim>
    Formula<dim>
    read_motion(const Section      &section,
                const std::string  &entry,
                const unsigned int  n_components,
                const Constants    &constants,
                const Problem<dim> &problem)
    {
      if (section.is_empty(entry))
        return {};
      const Formula<dim> formula(section.text(entry),
                                 constants,
                                 n_components,
                                 section.where(entry));
      for (const double share : {0., 0.25, 0.5, 0.75, 1.})
        {
          const double time = share * problem.end_time;
          if (!formula.is_finite(problem.grid.upper, time))
            throw InputError("The formula " + in_quotes(formula.expression()) +
                             " in " + section.where(entry) +
                             " is not finite at time " + brief(time) +
                             " s. Usually something is divided by zero. Guard "
                             "it, as in 'if(t > 0, 1/t, 0)'.");
          for (unsigned int c = 0; c < n_components; ++c)
            if (!formula.is_finite(problem.grid.lower, time) ||
                formula.value(problem.grid.lower, time, c) !=
                  formula.value(problem.grid.upper, time, c))
              throw InputError(
                "The formula " + in_quotes(formula.expression()) + " in " +
                section.where(entry) +
                " differs from place to place, but an obstacle is rigid. "
                "Write a formula of t alone.");
        }
      return formula;
    }



    /** The level that the criterion 'obstacle' gives all cells around it. */
    template <int dim>
    unsigned int
    level_around(const Obstacle<dim>        &obstacle,
                 const GridDescription<dim> &grid)
    {
      unsigned int result = 0;
      for (const Refinement<dim> &refinement : grid.refinements)
        if (refinement.looks_at(obstacle.name) && refinement.where.empty() &&
            refinement.box == corners(grid))
          result = std::max(result, refinement.level);
      return result;
    }



    /**
     * Nodes cannot tell the two sides of an obstacle thinner than two cells:
     * the same node would constrain the material on both.
     */
    template <int dim>
    void
    check_thickness(const Section              &section,
                    const Obstacle<dim>        &obstacle,
                    const GridDescription<dim> &grid)
    {
      const unsigned int level        = level_around(obstacle, grid);
      double             longest_edge = 0;
      for (unsigned int d = 0; d < dim; ++d)
        longest_edge = std::max(longest_edge, grid.edge(d) / (1u << level));
      const Corners<dim> box = obstacle.shape->bounding_box();
      for (unsigned int d = 0; d < dim; ++d)
        if (!std::isfinite(box.first[d]) || !std::isfinite(box.second[d]))
          return;
      constexpr unsigned int n = dim == 2 ? 129 : 33; // odd, to sample centres
      double                 deepest = 0;
      for (unsigned int i = 0; i < std::pow(n, dim); ++i)
        {
          Point<dim>   place;
          unsigned int rest = i;
          for (unsigned int d = 0; d < dim; ++d, rest /= n)
            place[d] = box.first[d] +
                       (box.second[d] - box.first[d]) * (rest % n) / (n - 1.);
          const double value = obstacle.shape->signed_distance(place)->value;
          if (value > -1e299) // except where the gradient vanishes
            deepest = std::max(deepest, -value);
        }
      if (deepest < 0.99 * longest_edge)
        throw InputError(
          "Obstacle " + in_quotes(obstacle.name) + " is " + brief(2 * deepest) +
          " m thick (" + section.where("Shape") + "), less than two cells, " +
          brief(2 * longest_edge) +
          " m. The same nodes would hold what is on either "
          "side. Make it thicker, or use more cells" +
          (grid.levels > level ? ", as with a refinement whose criterion is "
                                 "'obstacle'." :
                                 "."));
    }



    template <int dim>
    Obstacle<dim>
    read_obstacle(const Section      &root,
                  const std::string  &name,
                  const Problem<dim> &problem)
    {
      const Section   section   = root.subsection("Obstacle " + name);
      const Constants constants = read_constants(section);
      Obstacle<dim>   obstacle;
      obstacle.name = name;
      obstacle.shape =
        read_obstacle_shape(section, constants, beyond(problem.grid));
      obstacle.friction = read_friction(section);
      obstacle.displacement =
        read_motion(section, "Displacement", dim, constants, problem);
      obstacle.rotation =
        read_motion(section, "Rotation", 1, constants, problem);
      obstacle.centre  = read_point<dim>(section, "Centre");
      obstacle.axis[2] = 1;
      if constexpr (dim == 3)
        {
          obstacle.axis = read_point<dim>(section, "Axis");
          if (!(obstacle.axis.norm() > 0))
            throw InputError("The axis " + section.text("Axis") + " in " +
                             section.where("Axis") +
                             " has no length. Give a direction, for instance "
                             "'0, 0, 1'.");
          obstacle.axis /= obstacle.axis.norm();
        }
      check_thickness(section, obstacle, problem.grid);
      return obstacle;
    }



    [[noreturn]] void
    refuse_with_obstacles(const Section     &section,
                          const std::string &entry,
                          const std::string &remedy)
    {
      throw InputError("Obstacles do not go with " +
                       in_quotes(section.text(entry)) + " in " +
                       section.where(entry) +
                       " yet. Usually an obstacle was added to a scene that "
                       "had none. Set " +
                       remedy + ", or leave 'Obstacles' empty.");
    }



    /**
     * The implicit pressure at obstacles needs liquids that slip on them and
     * cells of one size.
     */
    template <int dim>
    void
    check_implicit_pressure(const Section &root, const Problem<dim> &problem)
    {
      const auto refuse = [&](const std::string &cause,
                              const std::string &remedy) {
        const Section method = root.subsection("Method");
        throw InputError("Obstacles with " +
                         in_quotes(method.text("Time integration")) + " in " +
                         method.where("Time integration") + " do not go with " +
                         cause + " yet. Set " + remedy +
                         ", or 'Time integration = explicit'.");
      };
      for (const Body<dim> &body : problem.bodies)
        if (!body.is_liquid)
          refuse("the solid " + in_quotes(body.name),
                 "'newtonian fluid' for it");
      for (const Obstacle<dim> &obstacle : problem.obstacles)
        if (obstacle.friction > 0)
          refuse("friction on obstacle " + in_quotes(obstacle.name),
                 "'Law = slip'");
    }



    template <int dim>
    void
    check_method_of_obstacles(const Section &root, const Problem<dim> &problem)
    {
      const Section method = root.subsection("Method");
      if (problem.method.integration == TimeIntegration::semi_implicit)
        check_implicit_pressure(root, problem);
      else if (problem.method.integration != TimeIntegration::explicit_steps)
        refuse_with_obstacles(method,
                              "Time integration",
                              "'Time integration = explicit'");
    }



    /**
     * Largest angle, in degrees, between a side and the surface of an obstacle
     * that covers a part of it at the start and faces into the box as it does;
     * 0: none, or the whole side is covered, as by a piston that has advanced.
     */
    template <int dim>
    double
    angle_at_start(const Obstacle<dim> &obstacle,
                   const Problem<dim>  &problem,
                   const unsigned int   side)
    {
      const ObstaclePlace<dim> start(obstacle, 0);
      double                   largest = 0;
      bool                     has_all = true;
      for (const Point<dim> &place : places_in_side(side, problem.grid))
        {
          const auto   from = start.distance(place);
          const double cosine =
            (side % 2 == 0 ? 1 : -1) * from.normal[side / 2];
          if (from.value > 1e-6 * problem.grid.edge(side / 2))
            has_all = false;
          else if (cosine > 0.7)
            largest = std::max(largest, std::acos(std::min(1., cosine)));
        }
      return has_all ? 0 : largest * 180 / dealii::numbers::PI;
    }



    /**
     * A moving obstacle takes over a side face by face (see CoveredSides),
     * which is noisy if it starts there at an angle.
     */
    template <int dim>
    void
    note_oblique_starts(Problem<dim> &problem)
    {
      if (std::none_of(problem.bodies.begin(),
                       problem.bodies.end(),
                       [](const Body<dim> &body) { return body.is_liquid; }))
        return;
      for (const Obstacle<dim> &obstacle : problem.obstacles)
        for (unsigned int side = 0; side < 2 * dim; ++side)
          if (obstacle.changes_place() &&
              problem.sides[side].held != HeldComponents::none)
            if (const double angle = angle_at_start(obstacle, problem, side);
                angle > 0.5)
              problem.notes.push_back(
                "Obstacle " + in_quotes(obstacle.name) + " starts in side " +
                in_quotes(side_names(dim)[side]) + " at an angle of " +
                brief(angle) +
                " degrees: liquid is noisy where it leaves the side. A box "
                "that is two cells larger there, and a half-space at rest in "
                "the place of the side, avoid this.");
    }



    /** Gives the criterion 'obstacle' what it has to know of the obstacles. */
    template <int dim>
    void
    complete_refinements(const Section &root, Problem<dim> &problem)
    {
      const std::vector<std::string> names = root.list("Obstacles");
      for (Refinement<dim> &refinement : problem.grid.refinements)
        if (refinement.criterion == RefinementCriterion::obstacle)
          {
            const Section section =
              root.subsection("Grid").subsection("Refine " + refinement.name);
            if (names.empty())
              throw InputError("The criterion 'obstacle' in " +
                               section.where("Criterion") +
                               " has nothing to look at, as the list "
                               "'Obstacles' is empty. Write 'set Obstacles = "
                               "step' at the top, or set 'Criterion = "
                               "surface'.");
            for (const std::string &name : refinement.obstacles)
              check_name("obstacle", name, names, section.where("Obstacles"));
            for (const Obstacle<dim> &obstacle : problem.obstacles)
              if (obstacle.moves() && refinement.looks_at(obstacle.name))
                refinement.depends_on_time = true;
          }
    }
  } // namespace



  template <int dim>
  void
  read_obstacles(const Section &root, Problem<dim> &problem)
  {
    for (const std::string &name : root.list("Obstacles"))
      problem.obstacles.push_back(read_obstacle(root, name, problem));
    complete_refinements(root, problem);
    note_oblique_starts(problem);
  }



  template <int dim>
  void
  check_obstacles(const Section &root, const Problem<dim> &problem)
  {
    if (!problem.obstacles.empty())
      check_method_of_obstacles(root, problem);
  }



  template void
  read_obstacles<2>(const Section &, Problem<2> &);
  template void
  read_obstacles<3>(const Section &, Problem<3> &);
  template void
  check_obstacles<2>(const Section &, const Problem<2> &);
  template void
  check_obstacles<3>(const Section &, const Problem<3> &);
} // namespace limber
