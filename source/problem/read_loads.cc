// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/point_list.h>
#include <limber/problem/read_parts.h>

#include <algorithm>

namespace limber
{
  namespace
  {
    /** The word of the entry 'Face' that stands for the whole surface. */
    const std::string whole_surface = "surface";

    /** The words of the entry 'Body force at'. */
    const std::vector<std::string> body_force_places = {"present place",
                                                        "initial place"};



    void
    declare_face_load(Parameters        &parameters,
                      const unsigned int dim,
                      const std::string &name)
    {
      parameters.enter_subsection("Face load " + name);
      parameters.declare("Body",
                         "",
                         admissible::text("name of a body", "beam"),
                         "The body.");
      std::vector<std::string> faces = side_names(dim);
      faces.push_back(whole_surface);
      parameters.declare("Face",
                         "",
                         admissible::one_of(faces).or_empty(),
                         "The face of the box or block, at the start, or "
                         "'surface': all of the free surface of a body of any "
                         "shape, that is what does not lie in a side of the "
                         "grid. The load moves with the material.");
      parameters.declare("Where",
                         "",
                         admissible::text("formula of " +
                                            std::string(dim == 2 ? "x, y" :
                                                                   "x, y, z") +
                                            ", or empty",
                                          "y - 0.9"),
                         "The load acts on that part of the face or surface "
                         "where this is positive at the start; empty: on all "
                         "of it.");
      parameters.declare("Pressure",
                         "",
                         admissible::text("formula of " + variable_names(dim) +
                                            ", or empty",
                                          "1000"),
                         "Pressure p, Pa, positive when it presses: force -p "
                         "per present area along the present normal, at the "
                         "present place.");
      parameters.declare("Traction",
                         "",
                         admissible::text("formula of " + variable_names(dim) +
                                            " with " + std::to_string(dim) +
                                            " components, or empty",
                                          for_each_direction(dim, "0", "; ")),
                         "Force per initial area, Pa, at the initial place, "
                         "whatever the deformation. Exactly one of 'Pressure' "
                         "and 'Traction' is given.");
      declare_constants(parameters);
      parameters.leave_subsection();
    }
  } // namespace



  void
  declare_loads(Parameters                     &parameters,
                const unsigned int              dim,
                const std::vector<std::string> &face_loads)
  {
    parameters.enter_subsection("Loads");
    parameters.declare(
      "Gravity",
      for_each_direction(dim, "0"),
      admissible::numbers(dim, dim == 2 ? "0, -9.81" : "0, 0, -9.81"),
      "Acceleration g, m/s^2.");
    parameters.declare("Body force",
                       for_each_direction(dim, "0", "; "),
                       admissible::text("formula of " + variable_names(dim) +
                                          " with " + std::to_string(dim) +
                                          " components",
                                        for_each_direction(dim, "0", "; ")),
                       "Force per mass b beside gravity, m/s^2; a constant one "
                       "counts as part of gravity.");
    parameters.declare("Body force at",
                       "present place",
                       admissible::one_of(body_force_places),
                       "Place of a point, x of the formula, that 'Body force' "
                       "refers to. initial place: a field of the material, as "
                       "manufactured solutions in Lagrangian form need it.");
    parameters.declare("Load factor",
                       "auto",
                       admissible::text("formula of t, or auto", "t / 2"),
                       "Of a quasi-static run: share of gravity, body force "
                       "and face loads that acts at time t, no unit; auto: 1 "
                       "if a load is a formula of t, else t / 'End time'.");
    declare_constants(parameters);
    parameters.declare_list("Face loads",
                            "",
                            "Face load ",
                            "Names of pressures and tractions on faces or "
                            "surfaces of bodies; each has a section 'Face "
                            "load NAME' within 'Loads'.");
    for (const std::string &name : face_loads)
      declare_face_load(parameters, dim, name);
    parameters.leave_subsection();
  }



  template <int dim>
  void
  read_volume_loads(const Section &section, Problem<dim> &problem)
  {
    problem.loads.gravity      = read_point<dim>(section, "Gravity");
    const Formula<dim> formula = read_formula<dim>(section,
                                                   "Body force",
                                                   dim,
                                                   read_constants(section),
                                                   corners(problem.grid));
    problem.loads.body_force_at_start =
      section.text("Body force at") == body_force_places[1];
    // A constant force is gravity: liquids at rest under it need the same
    // corrections (HydrostaticLoad).
    if (formula.is_uniform() && !asks_for_time(section.text("Body force")))
      problem.loads.gravity += formula.vector({}, 0);
    else if (!formula.is_zero())
      problem.loads.body_force = formula;
    if (section.text("Load factor") == "auto")
      return;
    problem.loads.factor = read_formula<dim>(section,
                                             "Load factor",
                                             1,
                                             read_constants(section),
                                             corners(problem.grid));
    for (const double share : {0., 0.5, 1.})
      {
        const double time = share * problem.end_time;
        if (problem.loads.factor.is_finite(problem.grid.lower, time) &&
            problem.loads.factor.is_finite(problem.grid.upper, time) &&
            problem.loads.factor.value(problem.grid.lower, time) !=
              problem.loads.factor.value(problem.grid.upper, time))
          throw InputError(
            "The formula " + in_quotes(problem.loads.factor.expression()) +
            " in " + section.where("Load factor") +
            " differs from place to place, but one factor is for all loads. "
            "Write a formula of t alone.");
      }
  }



  namespace
  {
    template <int dim>
    const Body<dim> &
    loaded_body(const Section &section, const Problem<dim> &problem)
    {
      const std::string        name = section.required_text("Body");
      std::vector<std::string> known;
      for (const Body<dim> &body : problem.bodies)
        known.push_back(body.name);
      check_name("body", name, known, section.where("Body"));

      return *std::find_if(problem.bodies.begin(),
                           problem.bodies.end(),
                           [&](const Body<dim> &b) { return b.name == name; });
    }



    /** The number of the face; empty for the whole surface. */
    template <int dim>
    std::optional<unsigned int>
    read_face(const Section &section, const Body<dim> &body)
    {
      const std::string face = section.required_text("Face");
      if (face == whole_surface && dynamic_cast<const PointListShape<dim> *>(
                                     body.shape.get()) != nullptr)
        throw InputError("Body " + in_quotes(body.name) +
                         " is a list of points, which has no surface for " +
                         section.where("Face") +
                         ". Let a body with another shape bear the load, or "
                         "use 'Loads/Body force'.");
      if (face == whole_surface)
        return std::nullopt;
      if (dynamic_cast<const BlockShape<dim> *>(body.shape.get()) == nullptr)
        throw InputError("Body " + in_quotes(body.name) + " has no face " +
                         in_quotes(face) + " for " + section.where("Face") +
                         "; only boxes and blocks have faces. Set 'Face = "
                         "surface', with 'Where = y - 0.9' for a part of it.");
      return side_index(face);
    }



    template <int dim>
    FaceLoad<dim>
    read_face_load(const Section      &section,
                   const std::string  &name,
                   const Problem<dim> &problem)
    {
      const Body<dim> &body         = loaded_body(section, problem);
      const bool       has_pressure = !section.is_empty("Pressure");
      if (has_pressure != section.is_empty("Traction"))
        throw InputError(
          std::string("There is ") +
          (has_pressure ? "both a pressure and" : "neither a pressure nor") +
          " a traction in " + section.where("Pressure") +
          ". Usually one of the two lines is left over or forgotten. Give "
          "exactly one, for instance 'set Pressure = 1000'.");

      FaceLoad<dim> load;
      load.name        = name;
      load.body        = body.name;
      load.face        = read_face(section, body);
      load.is_pressure = has_pressure;
      load.formula     = read_formula<dim>(section,
                                       has_pressure ? "Pressure" : "Traction",
                                       has_pressure ? 1 : dim,
                                       read_constants(section),
                                       body.shape->bounding_box());
      if (!section.is_empty("Where"))
        load.where = read_formula<dim>(section,
                                       "Where",
                                       1,
                                       read_constants(section),
                                       body.shape->bounding_box());
      return load;
    }



    /** What in the loads depends on the time, in words; empty if nothing. */
    template <int dim>
    std::string
    load_of_time(const Loads<dim> &loads)
    {
      for (const FaceLoad<dim> &load : loads.faces)
        if (asks_for_time(load.formula.expression()))
          return "face load " + in_quotes(load.name);
      return loads.body_force && asks_for_time(loads.body_force->expression()) ?
               "the body force" :
               "";
    }



    // A load that is written as a formula of t would be multiplied by t / 'End
    // time' besides, and nobody means that.
    template <int dim>
    void
    choose_load_factor(const Section &section, Problem<dim> &problem)
    {
      const std::string load = load_of_time(problem.loads);
      if (!problem.loads_grow_until_the_end() || load.empty())
        return;
      problem.loads.factor =
        Formula<dim>("1", Constants(), 1, section.where("Load factor"));
      problem.notes.push_back("Load factor 'auto' is 1, as " + load +
                              " is a formula of t: all loads act as they are "
                              "written.");
    }
  } // namespace



  template <int dim>
  void
  read_face_loads(const Section &section, Problem<dim> &problem)
  {
    for (const std::string &name : section.list("Face loads"))
      problem.loads.faces.push_back(
        read_face_load(section.subsection("Face load " + name), name, problem));
    choose_load_factor(section, problem);
  }



  template void
  read_volume_loads<2>(const Section &, Problem<2> &);
  template void
  read_volume_loads<3>(const Section &, Problem<3> &);
  template void
  read_face_loads<2>(const Section &, Problem<2> &);
  template void
  read_face_loads<3>(const Section &, Problem<3> &);
} // namespace limber
