// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/words.h>

namespace limber
{
  namespace
  {
    /** The entry of a side's own section that a word needs. */
    enum class SideDetail
    {
      none,
      friction, // its coefficient
      velocity  // its formula
    };



    /** The boundary condition that a word stands for. */
    struct SideKind
    {
      HeldComponents held;
      SideDetail     detail    = SideDetail::none;
      bool           one_sided = false;
    };



    /** The list of side conditions. */
    const Words<SideKind> &
    side_words()
    {
      using Held                         = HeldComponents;
      using Detail                       = SideDetail;
      static const Words<SideKind> words = {
        {"free", SideKind{Held::none}, "nothing is prescribed"},
        {"slip",
         SideKind{Held::normal},
         "no velocity through the side; solids that come to it later may leave it again"},
        {"no slip", SideKind{Held::all}, "no velocity"},
        {"separating",
         SideKind{Held::normal, Detail::none, true},
         "slip, and the material may leave"},
        {"friction",
         SideKind{Held::normal, Detail::friction, true},
         "separating, with Coulomb friction"},
        {"velocity",
         SideKind{Held::all, Detail::velocity},
         "prescribed by a formula"},
        {"normal velocity",
         SideKind{Held::normal, Detail::velocity},
         "that through the side is prescribed by a formula, as of a smooth platen"}};
      return words;
    }
  } // namespace



  const Words<std::string> &
  side_condition_words()
  {
    static const Words<std::string> words = without_values(side_words());
    return words;
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
                   side_words(),
                   "What the side of the grid at the " +
                     meanings[side_index(side)] + " does to the velocity.");
    const SectionPath around = parameters.present_section();
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
          "Velocity of the side, m/s, for 'velocity' and 'normal velocity'.");
        parameters.only_with("Friction coefficient",
                             {"friction"},
                             side,
                             around);
        parameters.only_with("Velocity",
                             {"velocity", "normal velocity"},
                             side,
                             around);
        declare_constants(parameters);
        parameters.leave_subsection();
      }
    parameters.leave_subsection();
  }



  namespace
  {
    /** Throws InputError where a side lacks the entry that its word needs. */
    void
    require(const Section     &boundaries,
            const std::string &side,
            const Section     &details,
            const std::string &entry,
            const std::string &example)
    {
      if (details.is_empty(entry))
        throw InputError("The condition " + in_quotes(boundaries.text(side)) +
                         " in " + boundaries.where(side) + " lacks its " +
                         in_quotes(entry) +
                         ". Usually the section of the details was forgotten. "
                         "Add 'set " +
                         entry + " = " + example + "' in section 'Boundaries/" +
                         "Side " + side + "'.");
    }



    /** Throws InputError where a side with 'normal velocity' is given a
     * velocity along itself; looked for at some places and times. */
    template <int dim>
    void
    refuse_velocity_along(const unsigned int  side,
                          const Section      &boundaries,
                          const Section      &details,
                          const Problem<dim> &problem)
    {
      const Formula<dim> &velocity = problem.sides[side].velocity;
      for (const auto &place : places_in_side(side, problem.grid))
        for (const double share : {0., 0.37, 1.})
          for (unsigned int d = 0; d < dim; ++d)
            if (const double time = share * problem.end_time;
                d != side / 2 && velocity.is_finite(place, time) &&
                velocity.value(place, time, d) != 0)
              throw InputError(
                "The velocity " + in_quotes(details.text("Velocity")) + " in " +
                details.where("Velocity") +
                " has a component along the side, where 'normal velocity' "
                "prescribes none. Usually components are interchanged. Set it "
                "to 0, or " +
                boundaries.where(side_names(dim)[side]) + " to 'velocity'.");
    }
  } // namespace



  template <int dim>
  void
  read_boundaries(const Section &section, Problem<dim> &problem)
  {
    const auto names = side_names(dim);
    for (unsigned int s = 0; s < names.size(); ++s)
      {
        const Section  details = section.subsection("Side " + names[s]);
        const SideKind kind    = read_word(section, names[s], side_words());
        Side<dim>     &side    = problem.sides[s];
        side.word              = section.text(names[s]);
        side.held              = kind.held;
        side.one_sided         = kind.one_sided;
        if (kind.detail == SideDetail::friction)
          {
            require(section, names[s], details, "Friction coefficient", "0.3");
            side.friction = details.number("Friction coefficient");
          }
        if (kind.detail == SideDetail::velocity)
          {
            require(section,
                    names[s],
                    details,
                    "Velocity",
                    for_each_direction(dim, "0", "; "));
            side.velocity = read_formula<dim>(details,
                                              "Velocity",
                                              dim,
                                              read_constants(details),
                                              corners(problem.grid));
            if (kind.held == HeldComponents::normal)
              refuse_velocity_along(s, section, details, problem);
          }
      }
  }



  template void
  read_boundaries<2>(const Section &, Problem<2> &);
  template void
  read_boundaries<3>(const Section &, Problem<3> &);
} // namespace limber
