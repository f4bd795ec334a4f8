// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/words.h>

namespace limber
{
  void
  declare_grid(Parameters &parameters, const unsigned int dim)
  {
    parameters.enter_subsection("Grid");
    parameters.declare("Lower corner",
                       for_each_direction(dim, "0"),
                       admissible::numbers(dim, for_each_direction(dim, "0")),
                       "Corner of the box of cells, m. Material must not leave "
                       "the box.");
    parameters.declare("Upper corner",
                       for_each_direction(dim, "1"),
                       admissible::numbers(dim, for_each_direction(dim, "1")),
                       "The opposite corner, m.");
    parameters.declare(
      "Cells",
      for_each_direction(dim, "10"),
      admissible::positive_integers(dim, false, for_each_direction(dim, "10")),
      "Number of cells in each direction; their edges are h = (upper - lower) "
      "/ cells, m.");
    parameters.leave_subsection();
  }



  template <int dim>
  GridDescription<dim>
  read_grid(const Section &section)
  {
    GridDescription<dim> grid;
    grid.lower = read_point<dim>(section, "Lower corner");
    grid.upper = read_point<dim>(section, "Upper corner");

    const std::vector<double> cells = section.numbers("Cells");
    for (unsigned int d = 0; d < dim; ++d)
      {
        grid.cells[d] = static_cast<unsigned int>(cells[d]);
        if (grid.upper[d] <= grid.lower[d])
          throw InputError("The grid ends at " + to_text(grid.upper) +
                           ", not beyond its lower corner " +
                           to_text(grid.lower) + ", in " +
                           section.where("Upper corner") +
                           ". Usually the corners are swapped. Increase every "
                           "component, for instance by 1.");
      }
    return grid;
  }



  void
  declare_boundaries(Parameters &parameters, const unsigned int dim)
  {
    const std::vector<std::string> meanings = {"lowest x",
                                               "highest x",
                                               "lowest y",
                                               "highest y",
                                               "lowest z",
                                               "highest z"};

    parameters.enter_subsection("Boundaries");
    for (const std::string &side : side_names(dim))
      declare_word(parameters,
                   side,
                   "slip",
                   side_condition_words(),
                   "What the side of the grid at the " +
                     meanings[side_index(side)] + " does to the velocity.");
    for (const std::string &side : side_names(dim))
      {
        parameters.enter_subsection("Side " + side);
        parameters.declare(
          "Friction coefficient",
          "",
          admissible::non_negative_number("0.3").or_empty(),
          "Coulomb's coefficient mu, no unit, for 'friction'.");
        parameters.declare(
          "Velocity",
          "",
          admissible::text("formula of " + variable_names(dim) + " with " +
                             std::to_string(dim) + " components, or empty",
                           for_each_direction(dim, "0", "; ")),
          "Velocity of the side, m/s, for 'velocity'.");
        declare_constants(parameters);
        parameters.leave_subsection();
      }
    parameters.leave_subsection();
  }



  namespace
  {
    [[noreturn]] void
    refuse_missing_detail(const Section     &boundaries,
                          const std::string &side,
                          const std::string &entry,
                          const std::string &example)
    {
      throw InputError("The condition " + in_quotes(boundaries.text(side)) +
                       " in " + boundaries.where(side) + " lacks its " +
                       in_quotes(entry) +
                       ". Usually the section of the details was forgotten. "
                       "Add 'set " +
                       entry + " = " + example + "' in section 'Boundaries/" +
                       "Side " + side + "'.");
    }
  } // namespace



  template <int dim>
  void
  read_boundaries(const Section &section, Problem<dim> &problem)
  {
    const auto names = side_names(dim);
    for (unsigned int s = 0; s < names.size(); ++s)
      {
        const Section details = section.subsection("Side " + names[s]);
        Side<dim>    &side    = problem.sides[s];
        side.condition = read_word(section, names[s], side_condition_words());

        if (side.condition == SideCondition::friction)
          {
            if (details.is_empty("Friction coefficient"))
              refuse_missing_detail(section,
                                    names[s],
                                    "Friction coefficient",
                                    "0.3");
            side.friction = details.number("Friction coefficient");
          }
        if (side.condition == SideCondition::velocity)
          {
            if (details.is_empty("Velocity"))
              refuse_missing_detail(section,
                                    names[s],
                                    "Velocity",
                                    for_each_direction(dim, "0", "; "));
            side.velocity = read_formula<dim>(details,
                                              "Velocity",
                                              dim,
                                              read_constants(details),
                                              corners(problem.grid));
          }
      }
  }



  template GridDescription<2>
  read_grid<2>(const Section &);
  template GridDescription<3>
  read_grid<3>(const Section &);
  template void
  read_boundaries<2>(const Section &, Problem<2> &);
  template void
  read_boundaries<3>(const Section &, Problem<3> &);
} // namespace limber
