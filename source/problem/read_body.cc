// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/materials/law_list.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/side_contact.h>
#include <limber/problem/words.h>

namespace limber
{
  namespace
  {
    void
    declare_points_and_state(Parameters &parameters, const unsigned int dim)
    {
      parameters.declare(
        "Points per cell edge",
        "auto",
        admissible::positive_integers(dim, true, "2").or_word("auto"),
        "Number of points along the edge of a cell, for all "
        "directions or for each; auto: 2, but 3 of liquids, "
        "and of solids in the current frame with splines or with implicit and "
        "quasi-static steps.");
      declare_word(parameters,
                   "Placement",
                   "auto",
                   placement_words(),
                   "How the points are placed at the start.");
      parameters.declare(
        "Points along edges",
        "",
        admissible::positive_integers(dim,
                                      false,
                                      dim == 2 ? "40, 10" : "40, 10, 10")
          .or_empty(),
        "With the placement 'fitted', which 'auto' then is: "
        "number of points along the edges of the box or block in each of its "
        "directions; empty: as many as the longest edge "
        "needs for 'Points per cell edge'.");
      declare_constants(parameters);
      parameters.declare("Initial velocity",
                         for_each_direction(dim, "0", "; "),
                         admissible::text("formula of " + variable_names(dim) +
                                            " with " + std::to_string(dim) +
                                            " components",
                                          for_each_direction(dim, "0", "; ")),
                         "v at time 0, m/s.");
      declare_initial_state(parameters, dim);
    }



    void
    declare_body(Parameters                     &parameters,
                 const unsigned int              dim,
                 const std::vector<std::string> &union_parts)
    {
      declare_shape(parameters);
      declare_points_and_state(parameters, dim);
      declare_word(parameters,
                   "Material",
                   "linear elastic",
                   law_words(),
                   "The law of the stress; the section of the same name holds "
                   "its constants.");
      declare_word(parameters,
                   "Frame",
                   "auto",
                   frame_words(),
                   "At which places of the points the functions of the grid "
                   "are taken.");
      declare_treatment(parameters);
      declare_shape_sections(parameters, dim, union_parts);
      declare_material_sections(parameters);
    }
  } // namespace



  void
  declare_bodies(Parameters        &parameters,
                 const unsigned int dim,
                 const SceneNames  &names)
  {
    for (const std::string &name : names.bodies)
      {
        parameters.enter_subsection("Body " + name);
        declare_body(parameters, dim, names.shapes.at(name));
        parameters.leave_subsection();
      }
  }



  namespace
  {
    template <int dim>
    void
    check_inside_grid(const Section              &section,
                      const Body<dim>            &body,
                      const GridDescription<dim> &grid)
    {
      const Corners<dim> box = body.shape->bounding_box();
      for (unsigned int d = 0; d < dim; ++d)
        {
          // Decimal fractions may differ by round-off.
          const double tolerance = 1e-10 * (grid.upper[d] - grid.lower[d]);
          if (box.first[d] < grid.lower[d] - tolerance ||
              box.second[d] > grid.upper[d] + tolerance)
            throw InputError("Body " + in_quotes(body.name) + " reaches from " +
                             to_text(box.first) + " to " + to_text(box.second) +
                             " (" + section.where("Shape") +
                             "), beyond the grid. Enlarge the grid: it ranges "
                             "from " +
                             to_text(grid.lower) + " to " +
                             to_text(grid.upper) + "; or move the body.");
        }
    }



    /**
     * Throws InputError where a formula of the initial state asks for the time.
     */
    void
    refuse_time(const Section &section, const std::string &entry)
    {
      if (asks_for_time(section.text(entry)))
        throw InputError("The formula '" + section.text(entry) + "' in " +
                         section.where(entry) +
                         " depends on the time t, but it is that of the start "
                         "alone. Usually a 'Body force' or a side with "
                         "'velocity' is meant. Leave out t.");
    }



    template <int dim>
    Body<dim>
    read_body(const Section     &root,
              const std::string &name,
              Problem<dim>      &problem)
    {
      const Section   section   = root.subsection("Body " + name);
      const Constants constants = read_constants(section);

      Body<dim> body;
      body.name  = name;
      body.shape = read_shape(section, constants, corners(problem.grid));
      check_inside_grid(section, body, problem.grid);
      refuse_time(section, "Initial velocity");
      body.initial_velocity = read_formula(section,
                                           "Initial velocity",
                                           dim,
                                           constants,
                                           body.shape->bounding_box());
      read_material(section, body, problem);
      const LawDescription law = read_word(section, "Material", law_words());
      body.is_liquid           = law.takes_pressure;
      body.is_plastic          = law.is_plastic;
      body.keeps_surface =
        !body.is_liquid &&
        (!body.is_plastic || flows_like_metal(body.law, body.material));
      read_initial_state(section, constants, problem, body);
      body.frame = read_word(section, "Frame", frame_words());
      return body;
    }



    template <int dim>
    void
    warn_of_unbounded_gradients(Problem<dim> &problem)
    {
      if (problem.method.transfer != Transfer::aflip)
        return;
      for (const Body<dim> &body : problem.bodies)
        if (!bounds_gradients(body, problem.grid))
          problem.notes.push_back(
            "Warning: 'Transfer = aflip' with linear functions is unstable "
            "where points come near the edges of cells, as those of body " +
            in_quotes(body.name) + " may. Set " +
            (problem.grid.against_splines.empty() ?
               "'Method/Kernel = quadratic' or " :
               "") +
            "'Transfer = flip'.");
    }
  } // namespace



  template <int dim>
  void
  read_bodies(const Section &root, Problem<dim> &problem)
  {
    for (const std::string &name : root.list("Bodies"))
      problem.bodies.push_back(read_body(root, name, problem));
    choose_frames(root, problem);
    choose_kernel(root, problem);
    Meetings meets;
    meets.obstacles = !root.list("Obstacles").empty();
    meets.bodies    = !root.subsection("Contact").list("Pairs").empty();
    bool any_hit    = false; // of the sides
    for (unsigned int side = 0; side < 2 * dim; ++side)
      any_hit = any_hit ||
                may_be_hit(side,
                           !root.subsection("Loads").list("Face loads").empty(),
                           problem);
    for (auto &body : problem.bodies)
      {
        const Section section = root.subsection("Body " + body.name);
        read_treatment(section, body, problem);
        meets.sides = any_hit && why_at_nodes(body, problem).empty();
        read_placement(section, meets, body, problem);
      }
    warn_of_solid_motion(root, problem);
    warn_of_unbounded_gradients(problem);
  }



  template void
  read_bodies<2>(const Section &, Problem<2> &);
  template void
  read_bodies<3>(const Section &, Problem<3> &);
} // namespace limber
