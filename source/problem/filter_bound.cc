// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/text.h>
#include <limber/problem/filter_bound.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace limber
{
  namespace
  {
    /**
     * Fit of the stability limit of the Courant number for order k of the
     * filter: C = a k^-b is nine tenths of the least limit among blocks at any
     * place in the grid, with two points or more per edge, plane strain and
     * Poisson's ratios from 0 to 0.5, up to k = 16; for linear functions in
     * full cells only.
     */
    struct Bound
    {
      double a, b;
      double shrinks; // C falls as (2 / n)^shrinks, n points per edge
    };



    // Of semi-implicit steps, whose Courant number is that of shear waves,
    // times the order: blocks in free flight through small cuts are stable up
    // to 1 with order 4, .9 with 6 and 1.2 with 8.
    constexpr double of_semi_implicit = 0.8;



    Bound
    bound_of(const KernelKind kernel)
    {
      switch (kernel)
        {
          case KernelKind::quadratic:
            return {0.58, 0.41, 0};
          case KernelKind::cubic:
            return {0.86, 0.355, 0};
          case KernelKind::gimp:
          case KernelKind::cpgimp:
            return {0.46, 0.43, 0.4};
          case KernelKind::cpdi:
          case KernelKind::cpdi2:
            return {0.54, 0.35, 0.4};
          case KernelKind::automatic: // has been chosen long before
          case KernelKind::linear:
          case KernelKind::ddmp:
            break;
        }
      return {0.64, 0.21, 0};
    }
  } // namespace



  template <int dim>
  double
  courant_number_of_filter(const Problem<dim> &problem)
  {
    const Method &method = problem.method;
    if (!filters_velocity(method.transfer))
      return std::numeric_limits<double>::infinity();
    if (method.integration == TimeIntegration::semi_implicit)
      return method.transfer == Transfer::fmpm &&
                 std::any_of(problem.bodies.begin(),
                             problem.bodies.end(),
                             [](const auto &body) { return !body.is_liquid; }) ?
               of_semi_implicit / method.transfer_order :
               std::numeric_limits<double>::infinity();
    const auto [a, b, shrinks] = bound_of(problem.grid.kernel);
    double       result        = method.transfer == Transfer::fmpm ?
                                   a * std::pow(double(method.transfer_order), -b) :
                                   a;
    unsigned int most = 2, least = 2; // points per edge
    for (const auto &body : problem.bodies)
      for (const unsigned int n : body.points_per_cell_edge)
        {
          most  = std::max(most, n);
          least = std::min(least, n);
        }
    result *= std::pow(2. / most, shrinks);
    // One point per cell hardly resolves the shortest waves of the grid.
    return least == 1 ? 0.7 * result : result;
  }



  std::string
  entries_of_filter(const Method &method)
  {
    const Method usual;
    std::string  result;
    if (method.transfer_order != usual.transfer_order)
      result +=
        " and 'Transfer order = " + std::to_string(usual.transfer_order) + "'";
    if (method.transfer_period != usual.transfer_period)
      result +=
        " and 'Transfer period = " + std::to_string(usual.transfer_period) +
        "'";
    return result;
  }



  template <int dim>
  void
  obey_filter(Problem<dim> &problem)
  {
    Method      &method = problem.method;
    const double bound  = courant_number_of_filter(problem);
    if (is_solved_by_newton(method.integration) || method.time_step > 0 ||
        method.courant_number <= bound)
      return;
    problem.notes.push_back(
      "Courant number " + brief(method.courant_number) + " is lowered to " +
      brief(bound) + ", up to which the transfer '" +
      (method.transfer == Transfer::fmpm ?
         "fmpm' of order " + std::to_string(method.transfer_order) :
         "xpic'") +
      " is stable with these functions.");
    method.courant_number = bound;
  }



  template double
  courant_number_of_filter(const Problem<2> &);
  template double
  courant_number_of_filter(const Problem<3> &);
  template void
  obey_filter(Problem<2> &);
  template void
  obey_filter(Problem<3> &);
} // namespace limber
