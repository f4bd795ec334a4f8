// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/read_parts.h>

#include <algorithm>

namespace limber
{
  std::vector<std::string>
  side_names(const unsigned int dim)
  {
    std::vector<std::string> names = {"left", "right", "bottom", "top"};
    if (dim == 3)
      names.insert(names.end(), {"back", "front"});
    return names;
  }



  unsigned int
  side_index(const std::string &name)
  {
    const auto names = side_names(3);
    return std::find(names.begin(), names.end(), name) - names.begin();
  }



  template <int dim>
  std::vector<dealii::Point<dim>>
  places_in_side(const unsigned int side, const GridDescription<dim> &grid)
  {
    constexpr unsigned int          n = dim == 2 ? 9 : 5; // along each edge
    std::vector<dealii::Point<dim>> result;
    for (unsigned int i = 0; i < dealii::Utilities::pow(n, dim - 1); ++i)
      {
        dealii::Point<dim> place;
        for (unsigned int d = 0, rest = i; d < dim; ++d)
          if (d == side / 2)
            place[d] = side % 2 == 0 ? grid.lower[d] : grid.upper[d];
          else
            {
              place[d] = grid.lower[d] + (rest % n) / (n - 1.) *
                                           (grid.upper[d] - grid.lower[d]);
              rest /= n;
            }
        result.push_back(place);
      }
    return result;
  }



  std::string
  for_each_direction(const unsigned int dim,
                     const std::string &text,
                     const std::string &separator)
  {
    return join(std::vector<std::string>(dim, text), separator);
  }



  std::string
  variable_names(const unsigned int dim)
  {
    return dim == 2 ? "x, y, t" : "x, y, z, t";
  }



  void
  declare_constants(Parameters &parameters)
  {
    parameters.declare(
      "Constants",
      "",
      admissible::text("list of 'name = number'", "L = 8, v0 = 0.01"),
      "Numbers that formulas may use by name, separated by commas. Those of "
      "the top level hold everywhere, those of a section within it.");
  }



  namespace
  {
    void
    add_constants(const Section &section, Constants &constants)
    {
      for (const std::string &definition : section.list("Constants"))
        {
          const auto parts = split(definition, '=');
          const auto number =
            parts.size() == 2 ? to_number(parts[1]) : std::nullopt;
          if (!number || parts[0].empty())
            throw InputError("The constant " + in_quotes(definition) + " in " +
                             section.where("Constants") +
                             " is not of the form 'name = number'. Usually a "
                             "comma or a number is missing. Write 'L = 8, "
                             "v0 = 0.01', for instance.");
          constants[parts[0]] = *number;
        }
      check_constants(constants, section.where("Constants"));
    }
  } // namespace



  Constants
  read_constants(const Section &section)
  {
    Constants constants;
    add_constants(section.root(), constants);
    if (section.has_entry("Constants"))
      add_constants(section, constants);
    return constants;
  }



  template <int dim>
  dealii::Point<dim>
  read_point(const Section &section, const std::string &entry)
  {
    const std::vector<double> values = section.numbers(entry);
    dealii::Point<dim>        point;
    for (unsigned int d = 0; d < dim; ++d)
      point[d] = values[d];
    return point;
  }



  template <int dim>
  Formula<dim>
  read_formula(const Section      &section,
               const std::string  &entry,
               const unsigned int  n_components,
               const Constants    &constants,
               const Corners<dim> &box)
  {
    const Formula<dim> formula(section.required_text(entry),
                               constants,
                               n_components,
                               section.where(entry));

    // Not the centre of the box, where formulas in polar coordinates often have
    // their pole.
    const double       share[3] = {0.437, 0.391, 0.413};
    dealii::Point<dim> place;
    for (unsigned int d = 0; d < dim; ++d)
      place[d] = box.first[d] + share[d] * (box.second[d] - box.first[d]);

    if (!formula.is_finite(place, 0.))
      throw InputError("The formula " + in_quotes(formula.expression()) +
                       " is not finite at " + to_text(place) + ", time 0, " +
                       "in " + section.where(entry) +
                       ". Usually something is divided by zero. Guard it, " +
                       "as in 'if(x > 0, 1/x, 0)'.");
    return formula;
  }



  template <int dim>
  Corners<dim>
  corners(const GridDescription<dim> &grid)
  {
    return {grid.lower, grid.upper};
  }



  template <int dim>
  std::string
  to_text(const dealii::Point<dim> &point)
  {
    std::vector<std::string> parts;
    for (unsigned int d = 0; d < dim; ++d)
      parts.push_back(to_text(point[d]));
    return "(" + join(parts, ", ") + ")";
  }



  template <int dim>
  std::string
  brief(const dealii::Point<dim> &point)
  {
    std::vector<std::string> parts;
    for (unsigned int d = 0; d < dim; ++d)
      parts.push_back(brief(point[d]));
    return "(" + join(parts, ", ") + ")";
  }



  void
  check_name(const std::string              &kind,
             const std::string              &name,
             const std::vector<std::string> &known,
             const std::string              &where)
  {
    if (std::find(known.begin(), known.end(), name) != known.end())
      return;
    const auto meant = nearest(name, known);
    throw InputError(
      "The " + kind + " " + in_quotes(name) + " is asked for in " + where +
      ", but the scene has none of this name. Usually it is misspelt or not " +
      "listed. " +
      (meant         ? "Did you mean " + in_quotes(*meant) + "?" :
       known.empty() ? "The scene lists none at all." :
                       "Known are: " + join(known, ", ") + "."));
  }



#define INSTANTIATE(dim)                                                  \
  template dealii::Point<dim> read_point<dim>(const Section &,            \
                                              const std::string &);       \
  template Formula<dim>       read_formula<dim>(const Section &,          \
                                          const std::string &,      \
                                          const unsigned int,       \
                                          const Constants &,        \
                                          const Corners<dim> &);    \
  template Corners<dim>       corners<dim>(const GridDescription<dim> &); \
  template std::vector<dealii::Point<dim>> places_in_side<dim>(           \
    const unsigned int, const GridDescription<dim> &);                    \
  template std::string to_text<dim>(const dealii::Point<dim> &);          \
  template std::string brief<dim>(const dealii::Point<dim> &);

  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace limber
