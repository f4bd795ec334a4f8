// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/materials/law_list.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/words.h>

#include <algorithm>

namespace limber
{
  void
  declare_initial_state(Parameters &parameters, const unsigned int dim)
  {
    parameters.declare("Initial pressure",
                       "",
                       admissible::text("empty, hydrostatic, or formula of " +
                                          variable_names(dim),
                                        "hydrostatic"),
                       "p at time 0, Pa, positive in compression, only for "
                       "fluids; empty: none; hydrostatic: in balance with "
                       "gravity, the weight of what is above.");
    parameters.declare(
      "Initial stress",
      "",
      admissible::text("K0: formula, or components: formulas of " +
                         variable_names(dim),
                       "K0: 0.5"),
      "Cauchy stress at time 0, Pa, only for solids. 'K0: formula' is "
      "geostatic: along gravity the weight of what is above, with an "
      "'overburden: formula' (Pa) in the place of other bodies; "
      "across it K0 times that. 'xx: formula; yy: formula' and so on give "
      "components, positive in tension; others are zero. Empty: none.");
    parameters.declare(
      "Initial state",
      "",
      admissible::text("formulas of " + variable_names(dim) +
                         " for variables of the material",
                       "equivalent plastic strain: 0.01*x"),
      "What the points of the material have been through before time 0: "
      "'name: formula', several with ';' between them; variables that are "
      "not named are zero. Materials without memory have none.");
  }



  namespace
  {
    template <int dim>
    void
    read_initial_pressure(const Section      &section,
                          const Constants    &constants,
                          const Problem<dim> &problem,
                          Body<dim>          &body)
    {
      const std::string entry = "Initial pressure";
      if (section.is_empty(entry))
        return;

      if (!read_word(section, "Material", law_words()).takes_pressure)
        throw InputError("The pressure " + in_quotes(section.text(entry)) +
                         " in " + section.where(entry) +
                         " is for fluids only. Set 'Initial stress = K0: 0.5' "
                         "for a solid, or 'Material = newtonian fluid'.");

      body.hydrostatic = section.text(entry) == "hydrostatic";
      if (!body.hydrostatic)
        body.initial_pressure = read_formula(
          section, entry, 1, constants, body.shape->bounding_box());
      else if (problem.loads.gravity.norm() == 0)
        throw InputError("The pressure 'hydrostatic' in " +
                         section.where(entry) +
                         " has nothing to balance, as gravity is zero. "
                         "Usually section 'Loads' was forgotten. Set there "
                         "'Gravity = " +
                         for_each_direction(dim - 1, "0") + ", -9.81'.");
    }



    /** A part "name: formula" of an entry that has several. */
    struct NamedFormula
    {
      std::string name, formula;
    };



    /** @p example shows how the entry is written. */
    NamedFormula
    named_formula(const std::string &part,
                  const std::string &where,
                  const std::string &example)
    {
      const std::string what  = "The part " + in_quotes(part) + " in " + where;
      const std::size_t colon = part.find(':');
      if (colon == std::string::npos)
        throw InputError(what +
                         " has no ':' between a name and a formula. "
                         "Write " +
                         example + ", for instance.");
      const std::string formula = part.substr(colon + 1);
      // '?' and ':' make a choice in a formula
      if (formula.find(':') != std::string::npos &&
          formula.find('?') == std::string::npos)
        throw InputError(what +
                         " has a second ':'. Usually parts were "
                         "separated by ','. Write ';' between them: " +
                         example + ", for instance.");
      return {trimmed(part.substr(0, colon)), formula};
    }



    /** One variable of 'Initial state', "name: formula". */
    template <int dim>
    void
    read_variable(const std::string                &part,
                  const std::vector<StateVariable> &variables,
                  const Section                    &section,
                  const Constants                  &constants,
                  Body<dim>                        &body)
    {
      const std::string where = section.where("Initial state");
      const auto [name, formula] =
        named_formula(part, where, "'equivalent plastic strain: 0.01'");
      std::vector<std::string> names;
      for (const StateVariable &variable : variables)
        names.push_back(variable.name);
      if (names.empty())
        throw InputError("The variable " + in_quotes(name) + " in " + where +
                         " has no meaning for the material " +
                         in_quotes(section.text("Material")) +
                         ", which has no memory. Usually the material was "
                         "changed. Remove the entry.");
      check_name("variable of the material", name, names, where);
      const unsigned int k =
        std::find(names.begin(), names.end(), name) - names.begin();
      body.initial_state[k] = Formula<dim>(formula, constants, 1, where);
    }



    template <int dim>
    void
    read_variables(const Section   &section,
                   const Constants &constants,
                   Body<dim>       &body)
    {
      const auto variables = variables_of(body.law, body.material);
      for (const std::string &part : split(section.text("Initial state"), ';'))
        read_variable(part, variables, section, constants, body);
    }



    /** The names of the components in the order of InitialStress. */
    template <int dim>
    std::vector<std::string>
    names_of_components()
    {
      if (dim == 2)
        return {"xx", "yy", "zz", "xy"};
      return {"xx", "yy", "zz", "xy", "yz", "zx"};
    }



    /** One component of 'Initial stress', "name: formula". */
    template <int dim>
    void
    read_stress(const std::string  &part,
                const Constants    &constants,
                const std::string  &where,
                InitialStress<dim> &stress)
    {
      const auto [name, text] =
        named_formula(part,
                      where,
                      "'K0: 0.5; overburden: 1e4', or 'xx: -1e4*(1 - y)'");
      const auto               components = names_of_components<dim>();
      std::vector<std::string> names      = components;
      names.insert(names.end(), {"K0", "overburden"});
      check_name("initial stress", name, names, where);
      const Formula<dim> formula(text, constants, 1, where);
      const auto found = std::find(components.begin(), components.end(), name);
      if (found != components.end())
        stress.components[found - components.begin()] = formula;
      else
        (name == "K0" ? stress.lateral_ratio : stress.overburden) = formula;
    }



    template <int dim>
    void
    read_initial_stress(const Section      &section,
                        const Constants    &constants,
                        const Problem<dim> &problem,
                        Body<dim>          &body)
    {
      const std::string entry = "Initial stress";
      if (section.is_empty(entry))
        return;
      const std::string what = "The initial stress " +
                               in_quotes(section.text(entry)) + " in " +
                               section.where(entry);
      if (body.is_liquid)
        throw InputError(what + " is for solids only. Usually the material "
                                "was changed. Set 'Initial pressure = "
                                "hydrostatic' for a fluid.");
      body.initial_stress.emplace();
      for (const std::string &part : split(section.text(entry), ';'))
        read_stress(part,
                    constants,
                    section.where(entry),
                    *body.initial_stress);
      const bool geostatic = !body.initial_stress->lateral_ratio.empty();
      bool       any       = false;
      for (const auto &component : body.initial_stress->components)
        any = any || !component.empty();
      if (geostatic && any)
        throw InputError(what + " gives both K0 and components, which would "
                                "contradict each other. Usually one is left "
                                "over. Remove either.");
      if (!geostatic && !body.initial_stress->overburden.empty())
        throw InputError(what + " has an overburden but no K0, so nothing "
                                "says what acts across it. Add 'K0: 0.5', for "
                                "instance.");
      if (geostatic && problem.loads.gravity.norm() == 0)
        throw InputError(what +
                         " has nothing to balance, as gravity is "
                         "zero. Usually section 'Loads' was forgotten. "
                         "Set there 'Gravity = " +
                         for_each_direction(dim - 1, "0") + ", -9.81'.");
    }
  } // namespace



  template <int dim>
  void
  read_initial_state(const Section      &section,
                     const Constants    &constants,
                     const Problem<dim> &problem,
                     Body<dim>          &body)
  {
    read_initial_pressure(section, constants, problem, body);
    read_initial_stress(section, constants, problem, body);
    read_variables(section, constants, body);
  }



  template void
  read_initial_state(const Section &,
                     const Constants &,
                     const Problem<2> &,
                     Body<2> &);
  template void
  read_initial_state(const Section &,
                     const Constants &,
                     const Problem<3> &,
                     Body<3> &);
} // namespace limber
