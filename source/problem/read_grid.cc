// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/read_parts.h>

namespace limber
{
  void
  declare_grid(Parameters                     &parameters,
               const unsigned int              dim,
               const std::vector<std::string> &refinements)
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
      "Resolution: number of cells in each direction; their edges are h = "
      "(upper - lower) / cells, m.");
    declare_levels(parameters, dim, refinements);
    parameters.leave_subsection();
  }



  template <int dim>
  GridDescription<dim>
  read_grid(const Section &section, const std::vector<std::string> &bodies)
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
    read_levels(section, bodies, grid);
    return grid;
  }



  template GridDescription<2>
  read_grid<2>(const Section &, const std::vector<std::string> &);
  template GridDescription<3>
  read_grid<3>(const Section &, const std::vector<std::string> &);
} // namespace limber
