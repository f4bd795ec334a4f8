// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/function_parser.h>
#include <deal.II/base/numbers.h>

#include <limber/base/exceptions.h>
#include <limber/base/floating_point_traps.h>
#include <limber/base/functions.h>
#include <limber/base/text.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iostream>
#include <new>
#include <regex>
#include <sstream>

namespace limber
{
  namespace
  {
    /**
     * deal.II 9.4 prints the parser's complaint to the error stream before it
     * throws. The user is to read it once, in our message.
     */
    class SilencedErrorStream
    {
    public:
      SilencedErrorStream()
        : original(std::cerr.rdbuf(swallowed.rdbuf()))
      {}

      ~SilencedErrorStream()
      {
        std::cerr.rdbuf(original);
      }

    private:
      std::ostringstream swallowed;
      std::streambuf    *original;
    };



    template <int dim>
    std::string
    variables()
    {
      return dim == 2 ? "x, y, t" : "x, y, z, t";
    }



    void
    check_components(const std::vector<std::string> &components,
                     const unsigned int              expected,
                     const std::string              &expression,
                     const std::string              &where)
    {
      const bool has_gap =
        std::find(components.begin(), components.end(), "") != components.end();
      if (components.size() == expected && !has_gap)
        return;

      std::vector<std::string> example(expected, "0");
      throw InputError(
        "The formula " + in_quotes(expression) + " has " +
        (has_gap ? "an empty component" :
                   counted(components.size(), "component")) +
        " in " + where + ", which takes " + std::to_string(expected) +
        ". Usually the separator ';' is missing or one too many. Write " +
        in_quotes(join(example, "; ")) + ", for instance.");
    }



    bool
    is_letter_of_name(const char letter)
    {
      return std::isalnum(static_cast<unsigned char>(letter)) || letter == '_';
    }



    /** Where @p name next stands in the formula, not as a part of another. */
    std::size_t
    find_name(const std::string &expression,
              const std::string &name,
              const std::size_t  from = 0)
    {
      std::size_t at = expression.find(name, from);
      while (at != std::string::npos &&
             ((at > 0 && is_letter_of_name(expression[at - 1])) ||
              (at + name.size() < expression.size() &&
               is_letter_of_name(expression[at + name.size()]))))
        at = expression.find(name, at + 1);
      return at;
    }



    /** The function @p name is called somewhere in the formula. */
    bool
    calls(const std::string &expression, const std::string &name)
    {
      for (auto at = find_name(expression, name); at != std::string::npos;
           at      = find_name(expression, name, at + 1))
        {
               const std::size_t next =
                 expression.find_first_not_of(" \t", at + name.size());
               if (next != std::string::npos && expression[next] == '(')
            return true;
        }
      return false;
    }



    /**
     * The next number of a sequence depends on how often and in which order
     * ranks have asked before, with a seed too.
     */
    void
    check_reproducible(const std::string &expression, const std::string &where)
    {
      for (const std::string name : {"rand", "rand_seed"})
        if (calls(expression, name))
          throw InputError(
            "The formula " + in_quotes(expression) + " calls " +
            in_quotes(name) + " in " + where +
            ". Random numbers depend on the order of evaluation, so no run "
            "could be repeated. Write a fixed pattern, for instance "
            "'sin(12.9898*x + 78.233*y)', or 'Placement = jittered'.");
    }



    // The parser recurses for every bracket that is opened.
    constexpr std::size_t longest_formula = 10000; // letters



    void
    check_length(const std::string &expression, const std::string &where)
    {
      if (expression.size() > longest_formula)
        throw InputError("The formula " + in_quotes(expression) + " has " +
                         std::to_string(expression.size()) + " letters in " +
                         where +
                         ". Usually a file was pasted in by mistake. "
                         "Write at most " +
                         std::to_string(longest_formula) +
                         " letters, for instance 'sin(pi*x)'.");
    }



    /** What muparser says, without deal.II's frame around it. */
    std::string
    complaint_of(const dealii::ExceptionBase &exception)
    {
      std::ostringstream text;
      exception.print_info(text);
      const std::string all = text.str();
      const std::string key = "The parser said: ";
      const auto        at  = all.find(key);
      std::string       result =
        trimmed(at == std::string::npos ? all : all.substr(at + key.size()));
      if (!result.empty() && result.back() == '.')
        result.pop_back();
      return result;
    }
  } // namespace



  bool
  asks_for_time(const std::string &formula)
  {
    static const std::regex time("(^|[^A-Za-z_0-9.])t($|[^A-Za-z_0-9])");
    return std::regex_search(formula, time);
  }



  namespace
  {
    /** A letter, then letters, digits and '_'. */
    bool
    is_name(const std::string &name)
    {
      constexpr std::size_t longest = 60;
      return !name.empty() && name.size() <= longest &&
             !std::isdigit(static_cast<unsigned char>(name.front())) &&
             std::all_of(name.begin(), name.end(), is_letter_of_name);
    }
  } // namespace



  void
  check_constants(const Constants &constants, const std::string &where)
  {
    for (const auto &[name, value] : constants)
      if (!is_name(name))
        throw InputError("The constant " + in_quotes(name) + " = " +
                         brief(value) + " in " + where +
                         " has no name that formulas can use. Write up to 60 "
                         "letters, digits and '_', a letter first, for "
                         "instance 'v0 = 1'.");
    for (const std::string reserved : {"x", "y", "z", "t", "pi"})
      if (constants.count(reserved) > 0)
        throw InputError("The constant " + in_quotes(reserved) +
                         " is used in " + where +
                         ". This name is taken by a variable or by the " +
                         "number pi. Choose another name, for instance " +
                         in_quotes(reserved + "0") + ".");
  }



  template <int dim>
  Formula<dim>::Formula(const std::string &expression,
                        const Constants   &constants,
                        const unsigned int n_components,
                        const std::string &where)
    : parser(std::make_shared<dealii::FunctionParser<dim>>(n_components))
    , text(trimmed(expression))
    , components(n_components)
  {
    check_constants(constants, where);
    check_length(text, where);
    check_reproducible(text, where);
    const std::vector<std::string> parts = split(text, ';');
    check_components(parts, n_components, text, where);

    zero = std::all_of(parts.begin(), parts.end(), [](const std::string &part) {
      return to_number(part) == 0.;
    });

    Constants with_pi = constants;
    with_pi["pi"]     = dealii::numbers::PI;
    try
      {
        const SilencedErrorStream silence;
        parser->initialize(dim == 2 ? "x,y,t" : "x,y,z,t",
                           parts,
                           with_pi,
                           /*time_dependent=*/true);
        // The parser looks at the text of a component only when its value is
        // asked for.
        const HeldFloatingPointTraps held;
        for (unsigned int c = 0; c < components; ++c)
          value(dealii::Point<dim>(), 0., c);
      }
    catch (const dealii::ExceptionBase &exception)
      {
        throw InputError(
          "The formula " + in_quotes(text) +
          " cannot be read: " + printable(complaint_of(exception)) + ", in " +
          where + ". Usually a name or a bracket is wrong. Use " +
          variables<dim>() + ", pi and 'Constants', as in 'sin(pi*x)'.");
      }
  }



  template <int dim>
  double
  Formula<dim>::value(const dealii::Point<dim> &point,
                      const double              time,
                      const unsigned int        component) const
  {
    AssertIndexRange(component, components);
    parser->set_time(time);
    return parser->value(point, component);
  }



  template <int dim>
  dealii::Tensor<1, dim>
  Formula<dim>::vector(const dealii::Point<dim> &point, const double time) const
  {
    AssertDimension(components, dim);
    dealii::Tensor<1, dim> result;
    for (unsigned int d = 0; d < dim; ++d)
      result[d] = value(point, time, d);
    return result;
  }



  template <int dim>
  bool
  Formula<dim>::is_finite(const dealii::Point<dim> &point,
                          const double              time) const
  {
    const HeldFloatingPointTraps held;
    for (unsigned int c = 0; c < components; ++c)
      if (!std::isfinite(value(point, time, c)))
        return false;
    return true;
  }



  template <int dim>
  unsigned int
  Formula<dim>::n_components() const
  {
    return components;
  }



  template <int dim>
  bool
  Formula<dim>::is_zero() const
  {
    return zero;
  }



  template <int dim>
  bool
  Formula<dim>::is_uniform() const
  {
    for (const char *const name : {"x", "y", "z"})
      if (find_name(text, name) != std::string::npos)
        return false;
    return true;
  }



  template <int dim>
  bool
  Formula<dim>::empty() const
  {
    return components == 0;
  }



  template <int dim>
  const std::string &
  Formula<dim>::expression() const
  {
    return text;
  }



  template class Formula<2>;
  template class Formula<3>;
} // namespace limber
