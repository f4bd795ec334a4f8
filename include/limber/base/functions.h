// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_base_functions_h
#define limber_base_functions_h

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <map>
#include <memory>
#include <string>

// The parser's header costs seconds; only functions.cc needs it.
namespace dealii
{
  template <int dim>
  class FunctionParser;
}

namespace limber
{
  /** Named numbers that formulas may use. */
  using Constants = std::map<std::string, double>;

  /**
   * Throws InputError where a constant bears the name of a variable; @p where
   * names section and entry.
   */
  void
  check_constants(const Constants &constants, const std::string &where);



  /** Whether a formula asks for the time t. */
  bool
  asks_for_time(const std::string &formula);



  /**
   * A formula of place and time from the scene: components separated by ';',
   * written in x, y (, z), t, pi and named constants, in the language of
   * deal.II's FunctionParser (muparser): ^ is the power, if(condition, a, b)
   * the choice. Copies share the parser. One evaluation takes some 30 ns, so
   * this is for nodes, faces and set-up, not for every point in every step.
   */
  template <int dim>
  class Formula
  {
  public:
    /** No components: a quantity that the scene does not mention. */
    Formula() = default;

    /**
     * Parse @p expression. @p where names section and entry in error messages.
     * Throws InputError where a component is missing, the text cannot be
     * parsed, or a constant bears the name of a variable.
     */
    Formula(const std::string &expression,
            const Constants   &constants,
            const unsigned int n_components,
            const std::string &where);

    /** One component at @p point and @p time (s). */
    double
    value(const dealii::Point<dim> &point,
          const double              time,
          const unsigned int        component = 0) const;

    /** All components; the formula must have dim of them. */
    dealii::Tensor<1, dim>
    vector(const dealii::Point<dim> &point, const double time) const;

    /** No component is infinite or undefined here; never traps. */
    bool
    is_finite(const dealii::Point<dim> &point, const double time) const;

    unsigned int
    n_components() const;

    /** All components are literally the number 0: nothing to evaluate. */
    bool
    is_zero() const;

    /** No component mentions the place: one value serves all points. */
    bool
    is_uniform() const;

    /** Made without an expression. */
    bool
    empty() const;

    /** The text as it stands in the scene. */
    const std::string &
    expression() const;

  private:
    std::shared_ptr<dealii::FunctionParser<dim>> parser;
    std::string                                  text;
    unsigned int                                 components = 0;
    bool                                         zero       = true;
  };
} // namespace limber

#endif
