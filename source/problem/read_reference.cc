// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/words.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace limber
{
  void
  declare_reference(Parameters &parameters, const unsigned int dim)
  {
    parameters.enter_subsection("Reference");
    declare_word(parameters,
                 "Element",
                 "Q2-P1-P1",
                 reference_element_words(),
                 "Finite element of 'limber reference'; those of three "
                 "fields do not lock near incompressibility.");
    declare_word(parameters,
                 "Method",
                 "auto",
                 reference_method_words(),
                 "How the finite elements are led to the end time.");
    parameters.declare("Elements over depth",
                       "4",
                       admissible::positive_integer("8"),
                       "Elements over the shortest edge of a box, no unit; "
                       "along the others as many as make them square.");
    parameters.declare(
      "Elements",
      "",
      admissible::positive_integers(dim, false, dim == 2 ? "32, 32" : "8, 8, 8")
        .or_empty(),
      "Elements along each edge of the body, no unit; empty: from 'Elements "
      "over depth'.");
    parameters.declare("Mesh file",
                       "",
                       admissible::text("path of a mesh file, or empty",
                                        "panel.msh"),
                       "Mesh of quadrilaterals or hexahedra that fits the "
                       "body: msh (Gmsh 2 or 4.1, ASCII), inp (UCD) or vtk "
                       "(legacy, ASCII), by ending, relative to the folder of "
                       "the scene; empty: a box.");
    parameters.declare("Refinements",
                       "0",
                       admissible::non_negative_integer("1"),
                       "How often every element is cut in half along each "
                       "edge, no unit.");
    parameters.declare("Time step",
                       "0",
                       admissible::non_negative_number("1e-3"),
                       "dt, s; 0: 'explicit' takes 0.8 of the longest stable "
                       "one, 'implicit' that in which shear waves cross the "
                       "smallest element. Loads and sides that move faster "
                       "than the body vibrates need a shorter one.");
    parameters.declare("Load steps",
                       "auto",
                       admissible::positive_integer("10").or_word("auto"),
                       "Equal parts of the time in which 'quasi-static' "
                       "applies the loads, no unit; auto: as many as steps of "
                       "a quasi-static run, else 1.");
    parameters.declare("Tolerance",
                       "1e-8",
                       admissible::number_between(0, 1, "1e-8"),
                       "Residual force over the largest of internal, external "
                       "and inertial force at which Newton's method ends, no "
                       "unit; it also ends where it changes displacements by "
                       "no more than 1e-11 of them.");
    parameters.declare("Frequencies",
                       "0",
                       admissible::non_negative_integer("3"),
                       "How many natural frequencies of the body at rest are "
                       "computed instead of a motion, no unit; 0: none.");
    parameters.leave_subsection();
  }



  namespace
  {
    // Number of steps of the run, not counting halved ones.
    unsigned int
    steps_of_run(const Method &method, const double end_time)
    {
      if (method.integration != TimeIntegration::quasi_static)
        return 1;
      constexpr double most = std::numeric_limits<int>::max();
      if (method.time_step == 0)
        return default_load_steps;
      const double n = std::ceil(end_time / method.time_step * (1 - 1e-9));
      return static_cast<unsigned int>(std::clamp(n, 1., most));
    }
  } // namespace



  ReferenceRequest
  read_reference(const Section &section,
                 const Method  &method,
                 const double   end_time)
  {
    ReferenceRequest request;
    request.element = read_word(section, "Element", reference_element_words());
    request.method  = read_word(section, "Method", reference_method_words());
    if (section.text("Method") == "auto" &&
        method.integration == TimeIntegration::quasi_static)
      request.method = ReferenceMethod::quasi_static;
    request.over_depth  = section.number("Elements over depth");
    request.mesh_file   = section.text("Mesh file");
    request.refinements = section.number("Refinements");
    request.time_step   = section.number("Time step");
    request.load_steps  = section.text("Load steps") == "auto" ?
                            steps_of_run(method, end_time) :
                            section.number("Load steps");
    request.tolerance   = section.number("Tolerance");
    request.frequencies = section.number("Frequencies");
    if (!section.is_empty("Elements"))
      for (const double n : section.numbers("Elements"))
        request.elements.push_back(static_cast<unsigned int>(n));
    if (!request.mesh_file.empty() && !request.elements.empty())
      throw InputError("There is both a mesh file and " +
                       section.where("Elements") +
                       ". Usually one of them is left over from another "
                       "scene. Empty one; a mesh from a file is made finer "
                       "with 'Refinements'.");
    return request;
  }



  void
  declare_exact_solution(Parameters &parameters, const unsigned int dim)
  {
    const auto declare = [&](const std::string &name,
                             const unsigned int n_components,
                             const std::string &text) {
      parameters.declare(
        name,
        "",
        admissible::text(
          "formula of " + variable_names(dim) +
            (n_components > 1 ?
               " with " + std::to_string(n_components) + " components" :
               "") +
            ", or empty",
          n_components > 1 ? for_each_direction(dim, "0", "; ") : "0"),
        text);
    };
    parameters.enter_subsection("Exact solution");
    declare("Displacement",
            dim,
            "u, m, of the point that was at x, y at the start, at time t; for "
            "'limber compare RUN exact'.");
    declare("Velocity", dim, "v, m/s, of that point.");
    declare("Pressure", 1, "p, Pa, of that point, positive in compression.");
    declare_constants(parameters);
    parameters.leave_subsection();
  }



  template <int dim>
  void
  read_exact_solution(const Section &section, Problem<dim> &problem)
  {
    const Constants constants = read_constants(section);
    const auto      read = [&](const std::string &name, const unsigned int n) {
      return section.is_empty(name) ?
                    Formula<dim>() :
                    read_formula<dim>(
                 section, name, n, constants, corners(problem.grid));
    };
    problem.exact.displacement = read("Displacement", dim);
    problem.exact.velocity     = read("Velocity", dim);
    problem.exact.pressure     = read("Pressure", 1);
  }



  template void
  read_exact_solution<2>(const Section &, Problem<2> &);
  template void
  read_exact_solution<3>(const Section &, Problem<3> &);
} // namespace limber
