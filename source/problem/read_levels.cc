// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/materials/plastic_strain.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/words.h>

#include <algorithm>

namespace limber
{
  namespace
  {
    constexpr unsigned int most_levels = 4;

    // Deepest level of a tree of p4est, in two and in three dimensions
    constexpr unsigned int deepest_level[] = {29, 18};
  } // namespace



  void
  declare_levels(Parameters                     &parameters,
                 const unsigned int              dim,
                 const std::vector<std::string> &refinements)
  {
    parameters.declare("Levels",
                       "0",
                       admissible::integer_from_to(0, most_levels, "2"),
                       "How often cells may be halved where 'Refine' wants "
                       "finer ones; 0: all cells are equal.");
    parameters.declare_list("Refine",
                            "",
                            "Refine ",
                            "Names of criteria for finer cells; each has a "
                            "section 'Refine NAME' within 'Grid'. Where "
                            "several meet, the finest wins.");
    parameters.declare(
      "Adapt every",
      "auto",
      admissible::positive_integer("200").or_word("auto"),
      "Steps after which criteria are asked again at the latest; they are "
      "whenever a point may have moved by 1.5 of the smallest cells (11.5, in "
      "three dimensions 5.5, where 'body' wants all bodies fine and nothing "
      "else is asked). 'auto': only then, but formulas of the time and "
      "criteria with a scale after 50.");
    parameters.declare("Join points",
                       "false",
                       admissible::flag(),
                       "Whether points that are finer than their cells become "
                       "one where that changes little: inside a body, in slow "
                       "and even motion and stress. The energy that goes is "
                       "'energy removed by adaptation'.");
    for (const std::string &name : refinements)
      {
        parameters.enter_subsection("Refine " + name);
        declare_word(parameters,
                     "Criterion",
                     "region",
                     criterion_words(),
                     "Which cells of the region given below are to be fine.");
        parameters.declare(
          "Level",
          "finest",
          admissible::integer_from_to(1, most_levels, "1").or_word("finest"),
          "How often cells are halved there; 'finest' is "
          "'Levels'.");
        parameters.declare(
          "Lower corner",
          "",
          admissible::numbers(dim, for_each_direction(dim, "0")).or_empty(),
          "Corner of a box, m; empty: that of the grid.");
        parameters.declare(
          "Upper corner",
          "",
          admissible::numbers(dim, for_each_direction(dim, "1")).or_empty(),
          "The opposite corner, m; empty: that of the grid.");
        parameters.declare(
          "Where",
          "",
          admissible::text("formula of " + variable_names(dim), "x - 0.5")
            .or_empty(),
          "Formula that is positive in the part of the box that is meant; "
          "empty: all of it. It is looked at in the corners of quarters of "
          "cells.");
        parameters.declare("Bodies",
                           "",
                           admissible::names("block"),
                           "Names of bodies that are asked: for the criterion "
                           "'body', and those with a scale; empty: all, with "
                           "'plastic strain' those that have one.");
        parameters.declare("Obstacles",
                           "",
                           admissible::names("step"),
                           "Names of obstacles for the criterion 'obstacle'; "
                           "empty: all.");
        parameters.declare("Scale",
                           "",
                           admissible::positive_number("0.01").or_empty(),
                           "For the criteria 'stress' (Pa), 'rate' and "
                           "'plastic strain' (without dimension): cells beyond "
                           "it are divided, those below a quarter of it are "
                           "joined.");
        parameters.declare("Distance",
                           "1",
                           admissible::integer_from_to(1, 8, "2"),
                           "For the criteria 'surface', 'obstacle' and "
                           "'contact': how many cells away, of the size of the "
                           "one that asks, an empty one, the obstacle or the "
                           "other body counts.");
        declare_constants(parameters);
        parameters.leave_subsection();
      }
  }



  namespace
  {
    /**
     * Levels of the mesh as deal.II builds it: common factors of two in the
     * numbers of cells become refinement levels.
     */
    template <int dim>
    unsigned int
    levels_of_lattice(std::array<unsigned int, dim> cells)
    {
      unsigned int levels = 0;
      while (std::all_of(cells.begin(), cells.end(), [](const unsigned int n) {
        return n > 0 && n % 2 == 0;
      }))
        {
          for (unsigned int &n : cells)
            n /= 2;
          ++levels;
        }
      return levels;
    }



    template <int dim>
    void
    read_scale(const Section &section, Refinement<dim> &refinement)
    {
      const bool given = !section.is_empty("Scale");
      if (given != has_scale(refinement.criterion))
        throw InputError(
          "The criterion " + in_quotes(section.text("Criterion")) + " in " +
          section.where("Criterion") +
          (given ?
             " has no use for a scale. Usually it was not changed along "
             "with the scale. Leave 'Scale' empty, or set 'Criterion = "
             "stress', 'rate' or 'plastic strain'." :
             " has no scale, so no cell would be divided. Set 'Scale' " +
               std::string(refinement.criterion == RefinementCriterion::stress ?
                             "to a stress in Pa." :
                             "to a number without dimension, as 0.01.")));
      if (given)
        refinement.scale = section.number("Scale");
    }



    template <int dim>
    Refinement<dim>
    read_refinement(const Section                  &section,
                    const std::string              &name,
                    const std::vector<std::string> &bodies,
                    const GridDescription<dim>     &grid)
    {
      Refinement<dim> result;
      result.name      = name;
      result.criterion = read_word(section, "Criterion", criterion_words());
      result.level     = section.text("Level") == "finest" ?
                           grid.levels :
                           static_cast<unsigned int>(section.number("Level"));
      if (result.level > grid.levels)
        throw InputError("The level " + section.text("Level") + " in " +
                         section.where("Level") +
                         " is beyond the finest one of the grid, 'Grid/Levels "
                         "= " +
                         std::to_string(grid.levels) +
                         "'. Set 'Level = finest', or more 'Levels'.");
      if (result.criterion == RefinementCriterion::region &&
          section.is_empty("Lower corner") &&
          section.is_empty("Upper corner") && section.is_empty("Where"))
        throw InputError("The refinement " + in_quotes(name) +
                         " has no bounds, so all cells would be fine: all of " +
                         section.where("Where") +
                         " and its corners are empty. Set 'Lower corner' and "
                         "'Upper corner', or 'Where'.");
      result.box = read_corners<dim>(section, corners(grid));
      if (!section.is_empty("Where"))
        result.where = read_formula<dim>(
          section, "Where", 1, read_constants(section), result.box);
      result.depends_on_time = asks_for_time(section.text("Where"));

      result.bodies    = split(section.text("Bodies"), ',');
      result.obstacles = split(section.text("Obstacles"), ',');
      result.distance  = static_cast<int>(section.number("Distance"));
      read_scale(section, result);
      const bool by_body = result.criterion == RefinementCriterion::body;
      if (by_body ? result.bodies.empty() :
                    !result.bodies.empty() && !has_scale(result.criterion))
        throw InputError(
          (by_body ? "The criterion 'body' in " + section.where("Criterion") +
                       " has no bodies. Set 'Bodies' to a name of the list at "
                       "the top." :
                     "The bodies in " + section.where("Bodies") +
                       " have no effect with the criterion " +
                       in_quotes(section.text("Criterion")) +
                       ". Usually that was not changed along with them. Set "
                       "'Criterion = body'."));
      if (result.criterion != RefinementCriterion::obstacle &&
          !result.obstacles.empty())
        throw InputError("The obstacles in " + section.where("Obstacles") +
                         " have no effect with the criterion " +
                         in_quotes(section.text("Criterion")) +
                         ". Usually that was not changed along with them. Set "
                         "'Criterion = obstacle'.");
      for (const std::string &body : result.bodies)
        check_name("body", body, bodies, section.where("Bodies"));
      return result;
    }
  } // namespace



  template <int dim>
  void
  read_levels(const Section                  &section,
              const std::vector<std::string> &bodies,
              GridDescription<dim>           &grid)
  {
    grid.levels = static_cast<unsigned int>(section.number("Levels"));
    const std::vector<std::string> names = section.list("Refine");
    if (grid.levels == 0 && !names.empty())
      throw InputError("The refinement " + in_quotes(names.front()) +
                       " has no effect, as the grid has one level only (" +
                       section.where("Levels") +
                       " is 0). Usually the entry was forgotten. Set 'Levels = "
                       "1', or leave 'Refine' empty.");
    if (grid.levels > 0 && names.empty())
      throw InputError(
        "The grid has " + std::to_string(grid.levels) +
        " finer levels, but nothing says where: " + section.where("Refine") +
        " is empty. Write 'set Refine = tip' and a section "
        "'Refine tip', or set 'Levels = 0'.");
    const unsigned int own = levels_of_lattice<dim>(grid.cells);
    if (grid.levels > 0 && own + grid.levels > deepest_level[dim - 2])
      throw InputError("'Levels = " + std::to_string(grid.levels) + "' in " +
                       section.where("Levels") +
                       " is more than the mesh can have: 'Cells' take " +
                       std::to_string(own) + " of the " +
                       std::to_string(deepest_level[dim - 2]) +
                       " halvings of p4est. Set fewer 'Levels', or 'Cells' "
                       "with fewer factors of two.");
    for (const std::string &name : names)
      grid.refinements.push_back(read_refinement(
        section.subsection("Refine " + name), name, bodies, grid));
    if (section.text("Adapt every") != "auto")
      grid.adapt_every =
        static_cast<unsigned int>(section.number("Adapt every"));
    grid.joins_points = section.flag("Join points");
    if (grid.levels == 0 && grid.joins_points)
      throw InputError("Points cannot be joined (" +
                       section.where("Join points") +
                       "), as the grid has one level only and none is split. "
                       "Usually 'Levels' was forgotten. Set 'Levels = 1', or "
                       "'Join points = false'.");
  }



  namespace
  {
    [[noreturn]] void
    refuse(const Section     &section,
           const std::string &entry,
           const std::string &reason,
           const std::string &remedy)
    {
      throw InputError("The entry " + in_quotes(section.text(entry)) + " in " +
                       section.where(entry) +
                       " does not go with cells of several sizes: " + reason +
                       ". Set " + remedy + ", or 'Grid/Levels = 0'.");
    }
  } // namespace



  namespace
  {
    template <int dim>
    bool
    has_plastic_strain(const Body<dim> &body)
    {
      return plastic_strain_of(body.law, body.material).has_value();
    }



    /**
     * Every body that the criterion names must have plastic strain, or any body
     * if it names none.
     */
    template <int dim>
    void
    check_plastic_strains(const Section &grid, const Problem<dim> &problem)
    {
      for (const Refinement<dim> &refinement : problem.grid.refinements)
        if (refinement.criterion == RefinementCriterion::plastic_strain)
          {
            unsigned int n = 0;
            for (const Body<dim> &body : problem.bodies)
              {
                const auto &names = refinement.bodies;
                const bool  named =
                  std::find(names.begin(), names.end(), body.name) !=
                  names.end();
                n += has_plastic_strain(body);
                if (named && !has_plastic_strain(body))
                  throw InputError(
                    "The criterion 'plastic strain' in " +
                    grid.subsection("Refine " + refinement.name)
                      .where("Bodies") +
                    " names the body " + in_quotes(body.name) +
                    ", whose material " + in_quotes(body.law) +
                    " has none. Remove it, or set its 'Material' to 'j2' or "
                    "'drucker prager'.");
              }
            if (n == 0)
              throw InputError(
                "The criterion 'plastic strain' in " +
                grid.subsection("Refine " + refinement.name)
                  .where("Criterion") +
                " has nothing to look at: no body's material has one. Set a "
                "'Material' to 'j2' or 'drucker prager', or 'Criterion = "
                "rate'.");
          }
    }
  } // namespace



  namespace
  {
    /** The criterion 'contact' needs bodies that may part. */
    template <int dim>
    void
    check_contacts(const Section &grid, const Problem<dim> &problem)
    {
      if (std::any_of(problem.bodies.begin(),
                      problem.bodies.end(),
                      [](const auto &body) { return body.nodal_field > 0; }))
        return;
      for (const Refinement<dim> &refinement : problem.grid.refinements)
        if (refinement.criterion == RefinementCriterion::contact)
          throw InputError(
            "The criterion 'contact' in " +
            grid.subsection("Refine " + refinement.name).where("Criterion") +
            " has nothing to look at: no bodies may part. Usually the list "
            "'Contact/Pairs' was forgotten. Write it, or set 'Criterion = "
            "surface'.");
    }
  } // namespace



  namespace
  {
    /**
     * Whether the kernel is composed of the linear shape functions of single
     * cells, so that it works with hanging nodes.
     */
    bool
    goes_with_levels(const KernelKind kernel)
    {
      return kernel == KernelKind::linear || kernel == KernelKind::gimp ||
             kernel == KernelKind::cpgimp || kernel == KernelKind::cpdi;
    }
  } // namespace



  namespace
  {
    /** Splitting of points needs to know how far they are stretched. */
    template <int dim>
    void
    check_stretched(const Section      &section,
                    const Body<dim>    &body,
                    const Problem<dim> &problem)
    {
      const auto refuse = [&](const std::string &reason,
                              const std::string &remedy) {
        throw InputError(
          "Points of body " + in_quotes(body.name) + " cannot be halved (" +
          section.where("Split stretched points") + "): " + reason + ". Set " +
          remedy + ", or 'Split stretched points = false'.");
      };
      const KernelKind kernel = problem.grid.kernel;
      const bool       follows =
        kernel == KernelKind::cpgimp || kernel == KernelKind::cpdi;
      if (body.is_liquid)
        refuse("a liquid keeps no shape that could be stretched",
               "'Density control' in semi-implicit steps");
      if (body.frame == Frame::initial)
        refuse("in the initial frame nothing comes apart", "'Frame = current'");
      if (is_solved_by_newton(problem.method.integration))
        refuse("Newton steps keep the points of the start",
               "'Method/Time integration = explicit'");
      if (has_domains(kernel) && !follows)
        refuse("domains of this kernel do not become halves",
               "'Method/Kernel = cpgimp' or 'cpdi'");
      if (body.is_plastic && !follows)
        refuse("what has flowed plastically does not know its whole stretch",
               "'Method/Kernel = cpgimp' or 'cpdi', whose domains do");
    }
  } // namespace



  template <int dim>
  void
  check_levels(const Section &root, const Problem<dim> &problem)
  {
    for (const Body<dim> &body : problem.bodies)
      if (body.splits_stretched_points)
        check_stretched(root.subsection("Body " + body.name), body, problem);
    if (problem.grid.levels == 0)
      return;
    check_plastic_strains(root.subsection("Grid"), problem);
    check_contacts(root.subsection("Grid"), problem);
    const Section method = root.subsection("Method");
    if (!goes_with_levels(problem.grid.kernel))
      refuse(method,
             "Kernel",
             has_domains(problem.grid.kernel) ?
               "points whose corners move one by one cannot be split" :
             is_spline(problem.grid.kernel) ?
               "splines need a lattice" :
               "means around nodes need a lattice",
             "'Kernel = linear', 'gimp', 'cpgimp' or 'cpdi'");
    if (problem.grid.joins_points && has_domains(problem.grid.kernel))
      refuse(method,
             "Kernel",
             "joined points ('Grid/Join points') have no domain",
             "'Kernel = linear', or 'Join points = false'");
    for (const Body<dim> &body : problem.bodies)
      {
        const Section section = root.subsection("Body " + body.name);
        if (body.placement == Placement::fitted)
          refuse(section,
                 "Placement",
                 "its points would not follow the size of cells",
                 "'Placement = cut' or 'regular'");
        for (const std::string entry : {"History", "Deviatoric history"})
          if (read_word(section, entry, volume_history_words()) ==
              HistoryTreatment::crossing)
            refuse(section,
                   entry,
                   "the time to cross a cell is not one time",
                   "'" + entry + " = relax'");
      }
  }



  template void
  read_levels<2>(const Section &,
                 const std::vector<std::string> &,
                 GridDescription<2> &);
  template void
  read_levels<3>(const Section &,
                 const std::vector<std::string> &,
                 GridDescription<3> &);
  template void
  check_levels(const Section &, const Problem<2> &);
  template void
  check_levels(const Section &, const Problem<3> &);
} // namespace limber
