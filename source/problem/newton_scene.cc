// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/materials/law_list.h>
#include <limber/problem/filter_bound.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/words.h>

#include <limits>

namespace limber
{
  namespace
  {
    /** Refuses what does not go with the time integration of the scene. */
    class Refusal
    {
    public:
      explicit Refusal(const Section &method)
        : word(method.text("Time integration"))
      {}

      [[noreturn]] void
      operator()(const Section     &section,
                 const std::string &entry,
                 const std::string &reason,
                 const std::string &remedy) const
      {
        throw InputError("The entry " + in_quotes(section.text(entry)) +
                         " in " + section.where(entry) +
                         " does not go with 'Time integration = " + word +
                         "', " + reason + ". Set " + remedy +
                         ", or 'Time integration = explicit'.");
      }

    private:
      const std::string word;
    };



    void
    check_method(const Section &section,
                 const Method  &method,
                 const Refusal &refuse)
    {
      if (method.order != StressUpdateOrder::automatic)
        refuse(section,
               "Stress update",
               "whose stress is that of the end of the step",
               "'Stress update = auto'");
      if (method.transfer != Transfer::flip)
        refuse(section,
               "Transfer",
               "where points take increments",
               "'Transfer = flip'" + entries_of_filter(method));
      if (method.blend_time > 0)
        refuse(section,
               "Blend time",
               "which has no such damping",
               "'Blend time = 0'");
      if (method.damping_rate > 0)
        refuse(section,
               "Damping rate",
               "which has no such damping",
               "'Damping rate = 0'");
      if (method.integration == TimeIntegration::implicit_steps &&
          method.time_step == 0)
        refuse(section,
               "Time step",
               "whose steps no stability limits",
               "a thirtieth of the period that matters");
    }



    template <int dim>
    void
    check_body(const Section      &section,
               const Problem<dim> &problem,
               Body<dim>          &body,
               const Refusal      &refuse)
    {
      if (const auto &law = read_word(section, "Material", law_words());
          !law.is_elastic && !law.is_plastic)
        refuse(section,
               "Material",
               "which knows solids alone",
               "'Material = neo hookean'");
      if (flows_by_rate(body.law, body.material))
        refuse(section,
               "Material",
               "in which flow has no rate",
               "'Viscosity' or 'Limit friction angle' of the law to 0");
      if (body.treatment != Treatment::none &&
          body.treatment != Treatment::cell &&
          body.treatment != Treatment::assumed_strain)
        refuse(section,
               "Locking treatment",
               "whose tangent knows 'assumed strain', 'cell' and 'none' alone",
               "'Locking treatment = assumed strain'");
      if (body.history != HistoryTreatment::keep)
        refuse(section,
               "History",
               "whose points keep their histories",
               "'History = keep'");
      if (body.deviatoric_history != HistoryTreatment::keep)
        refuse(section,
               "Deviatoric history",
               "whose points keep their histories",
               "'Deviatoric history = keep'");
      for (const std::string entry :
           {"Hourglass control", "Checkerboard control"})
        if (section.text(entry) != "auto" && section.number(entry) > 0)
          refuse(section,
                 entry,
                 "which has no such control",
                 "'" + entry + " = 0'");
      body.hourglass_control    = 0;
      body.checkerboard_control = 0;
      if (problem.method.integration == TimeIntegration::quasi_static &&
          body.initial_stress && problem.loads.factor.empty())
        refuse(section,
               "Initial stress",
               "whose loads grow from nothing, so that they do not balance it "
               "at first",
               "'Loads/Load factor = 1'");
      if (problem.method.integration == TimeIntegration::quasi_static &&
          !body.initial_velocity.empty() && !body.initial_velocity.is_zero())
        refuse(section,
               "Initial velocity",
               "in which nothing has a velocity",
               "it to zero, or 'Time integration = implicit'");
    }
  } // namespace



  template <int dim>
  void
  check_newton_scene(const Section &root, Problem<dim> &problem)
  {
    const Section method = root.subsection("Method");
    const Refusal refuse(method);
    check_method(method, problem.method, refuse);
    if (problem.grid.kernel != KernelKind::linear &&
        problem.grid.kernel != KernelKind::quadratic)
      refuse(method,
             "Kernel",
             "whose tangent knows linear functions and quadratic splines",
             "'Kernel = auto'");
    for (Body<dim> &body : problem.bodies)
      {
        if (problem.grid.kernel == KernelKind::quadratic &&
            body.frame == Frame::current)
          refuse(method,
                 "Kernel",
                 "which knows splines in the initial frame alone ('Body " +
                   body.name + "/Frame')",
                 "'Kernel = linear'");
        check_body(root.subsection("Body " + body.name), problem, body, refuse);
      }

    const Section boundaries = root.subsection("Boundaries");
    for (unsigned int side = 0; side < 2 * dim; ++side)
      if (problem.sides[side].one_sided)
        refuse(boundaries,
               side_names(dim)[side],
               "where a side holds or does not",
               "'" + std::string(side_names(dim)[side]) + " = slip'");
    const Section loads = root.subsection("Loads");
    if (problem.method.integration != TimeIntegration::quasi_static &&
        !problem.loads.factor.empty())
      refuse(loads,
             "Load factor",
             "in whose motion loads are as their formulas say",
             "'Load factor = auto', or 'Time integration = quasi-static'");
    problem.method.order = StressUpdateOrder::usl;
  }



  template void
  check_newton_scene(const Section &, Problem<2> &);
  template void
  check_newton_scene(const Section &, Problem<3> &);
} // namespace limber
