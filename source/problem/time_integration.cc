// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/words.h>

#include <algorithm>

namespace limber
{
  namespace
  {
    // gamma of the compact Laplacian: enough for a solver whose work does not
    // grow with the grid, too little to be seen in motions
    constexpr double compact_share = 0.1;

    // of what nodes hold beyond their room, pushed apart in a step
    constexpr double density_control = 0.2;



    [[noreturn]] void
    refuse(const std::string &cause, const std::string &remedy)
    {
      throw InputError("Time integration 'semi-implicit' does not go with " +
                       cause + ". Set " + remedy +
                       ", or 'Time integration = explicit'.");
    }



    /** The mass of a node that bodies share says nothing about one of them. */
    template <int dim>
    void
    read_density_control(const Section      &section,
                         const Problem<dim> &problem,
                         Body<dim>          &body)
    {
      const bool possible =
        problem.method.integration == TimeIntegration::semi_implicit &&
        body.is_liquid && problem.bodies.size() == 1;
      const bool automatic = section.text("Density control") == "auto";
      body.density_control = !automatic ? section.number("Density control") :
                             possible   ? density_control :
                                          0;
      if (body.density_control > 0 && !possible)
        throw InputError("The entry 'Density control' in " +
                         section.where("Density control") +
                         " is for a scene of one body, a liquid, with time "
                         "integration 'semi-implicit'. Usually one of "
                         "them was changed alone. Set 'Density control = "
                         "auto'.");
    }



    /** What keeps the pressure of a liquid from being implicit. */
    template <int dim>
    void
    check_liquid(const Section &section, const Body<dim> &body)
    {
      if (body.treatment != Projection::cell)
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
      const Section law = section.subsection("Newtonian fluid");
      if (law.flag("Tension cutoff"))
        refuse("a tension cutoff in " + law.where("Tension cutoff") +
                 ", as all cells share in one system",
               "'Tension cutoff = false'");
    }
  } // namespace



  template <int dim>
  void
  choose_time_integration(const Section &root, Problem<dim> &problem)
  {
    for (auto &body : problem.bodies)
      read_density_control(root.subsection("Body " + body.name), problem, body);
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
    if (std::none_of(problem.bodies.begin(),
                     problem.bodies.end(),
                     [](const auto &body) { return body.is_liquid; }))
      refuse(where("Time integration") + ", as the scene has no liquid",
             "the material of a body to 'newtonian fluid'");
    if (problem.grid.kernel != KernelKind::linear)
      refuse("the kernel " + where("Kernel"), "'Kernel = linear'");
    if (problem.method.order != StressUpdateOrder::automatic &&
        problem.method.order != StressUpdateOrder::usl)
      refuse("the stress update " + where("Stress update") +
               ", as the velocity that it finds strains",
             "'Stress update = usl'");
    problem.method.order = StressUpdateOrder::usl;

    for (auto &body : problem.bodies)
      if (body.is_liquid)
        {
          const Section section = root.subsection("Body " + body.name);
          check_liquid(section, body);
          body.implicit_pressure = true;
          if (section.text("Chequerboard control") == "auto")
            body.chequerboard_control = compact_share;
        }
  }



  template void
  choose_time_integration(const Section &, Problem<2> &);
  template void
  choose_time_integration(const Section &, Problem<3> &);
} // namespace limber
