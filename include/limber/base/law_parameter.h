// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_base_law_parameter_h
#define limber_base_law_parameter_h

#include <cctype>
#include <string>
#include <vector>

namespace limber
{
  /**
   * One entry in the section of a law: what the scene may say and how it is
   * documented. Words are numbered: the value of a word is its place in the
   * list.
   */
  struct LawParameter
  {
    const char *name;
    double      standard;         // default
    double      lowest, highest;  // open interval, or closed where admitted
    bool        closed;           // the bounds themselves are admissible
    const char *text;             // symbol, meaning, unit, formula
    const char *words    = "";    // "false|true": a choice instead of a number
    bool        required = false; // no default: the scene has to say it
  };



  /** The largest number of variables that a law may have names for. */
  inline constexpr unsigned int max_variables = 4;



  /** A state variable of a law at a point that a scene may name: it is drawn,
   * observed and given at the start. */
  struct StateVariable
  {
    const char *name;
    const char *unit;
    double      lowest; // admissible at the start, this value included
  };



  /** What the scene needs to know of a law: its name and its entries. */
  struct LawDescription
  {
    std::string name;
    std::string text; // one line
    // Whether a body may start under pressure: its volume ratio then says
    // all there is to say about its initial state.
    bool takes_pressure;
    // Whether the stress is a function of the deformation alone (hyperelastic).
    bool is_elastic;
    // Whether it is plastic, so that no elastic coefficients hold for its
    // strain.
    bool                       is_plastic;
    std::vector<LawParameter>  parameters; // the first is the density
    std::vector<StateVariable> variables;

    /** The section of the scene that holds the entries. */
    std::string
    section() const
    {
      std::string result = name;
      result[0]          = static_cast<char>(std::toupper(result[0]));
      return result;
    }
  };



  /** Entries that several laws share. */
  namespace law_parameters
  {
    inline constexpr LawParameter density{
      "Density",
      1000,
      0,
      1e300,
      false,
      "rho_0, mass per volume in the reference state, kg/m^3"};
    inline constexpr LawParameter young_modulus{"Young's modulus",
                                                1e6,
                                                0,
                                                1e300,
                                                false,
                                                "E, Pa"};
    inline constexpr LawParameter poisson_ratio{
      "Poisson's ratio",
      0.3,
      -1,
      0.5,
      false,
      "nu, dimensionless; K = E / (3 (1 - 2 nu)), G = E / (2 (1 + nu))"};
  } // namespace law_parameters
} // namespace limber

#endif
