// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/read_parts.h>

#include <algorithm>

namespace limber
{
  namespace
  {
    void
    declare_face_load(Parameters        &parameters,
                      const unsigned int dim,
                      const std::string &name)
    {
      parameters.enter_subsection("Face load " + name);
      parameters.declare("Body",
                         "",
                         admissible::text("name of a body", "beam"),
                         "The body, which must be a box or a block.");
      parameters.declare("Face",
                         "",
                         admissible::one_of(side_names(dim)).or_empty(),
                         "The face of the box or block, at the start. The load "
                         "moves with the material.");
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
                       "Force per mass b beside gravity, m/s^2.");
    declare_constants(parameters);
    parameters.declare_list("Face loads",
                            "",
                            "Face load ",
                            "Names of pressures and tractions on faces of "
                            "bodies; each has a section 'Face load NAME' "
                            "within 'Loads'.");
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
    if (!formula.is_zero())
      problem.loads.body_force = formula;
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

      const Body<dim> &body =
        *std::find_if(problem.bodies.begin(),
                      problem.bodies.end(),
                      [&](const Body<dim> &b) { return b.name == name; });
      if (dynamic_cast<const BlockShape<dim> *>(body.shape.get()) == nullptr)
        throw InputError("The face load on body " + in_quotes(name) + " in " +
                         section.where("Body") +
                         " is refused, because only a box or a block has "
                         "faces. Give the body 'Shape = block' or use 'Body "
                         "force' instead.");
      return body;
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
      load.face        = side_index(section.required_text("Face"));
      load.is_pressure = has_pressure;
      load.formula     = read_formula<dim>(section,
                                       has_pressure ? "Pressure" : "Traction",
                                       has_pressure ? 1 : dim,
                                       read_constants(section),
                                       body.shape->bounding_box());
      return load;
    }
  } // namespace



  template <int dim>
  void
  read_face_loads(const Section &section, Problem<dim> &problem)
  {
    for (const std::string &name : section.list("Face loads"))
      problem.loads.faces.push_back(
        read_face_load(section.subsection("Face load " + name), name, problem));
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
