// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/read_parts.h>

namespace limber
{
  void
  declare_checks(Parameters &parameters, const std::vector<std::string> &names)
  {
    for (const std::string &name : names)
      {
        parameters.enter_subsection("Check " + name);
        parameters.declare("Observable",
                           "",
                           admissible::text("name of an observable", "tip"),
                           "The observable whose value is compared.");
        parameters.declare("At time",
                           "",
                           admissible::non_negative_number("1").or_empty(),
                           "When it is compared, s; empty: at the end.");
        parameters.declare(
          "Reference",
          "",
          admissible::number("1").or_empty(),
          "The value expected, in the unit of the observable.");
        parameters.declare("Tolerance",
                           "",
                           admissible::non_negative_number("0.01").or_empty(),
                           "Largest absolute difference, in the same unit; "
                           "beyond it the program returns 4.");
        parameters.leave_subsection();
      }
  }



  template <int dim>
  void
  read_checks(const Section &root, Problem<dim> &problem)
  {
    for (const std::string &name : root.list("Checks"))
      {
        const Section section = root.subsection("Check " + name);
        Check         check;
        check.name       = name;
        check.observable = section.required_text("Observable");
        check_name("observable",
                   check.observable,
                   root.list("Observables"),
                   section.where("Observable"));
        check.reference = section.number("Reference");
        check.tolerance = section.number("Tolerance");

        if (!section.is_empty("At time"))
          check.at_time = section.number("At time");
        if (check.at_time && *check.at_time > problem.end_time)
          throw InputError("The check is due at " + section.text("At time") +
                           " s in " + section.where("At time") +
                           ", after the end time " + root.text("End time") +
                           " s. Usually one of them was changed alone. Set "
                           "'End time = " +
                           section.text("At time") + "' or check earlier.");
        problem.checks.push_back(check);
      }
  }



  template void
  read_checks<2>(const Section &, Problem<2> &);
  template void
  read_checks<3>(const Section &, Problem<3> &);
} // namespace limber
