// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/averaged_volumes.h>
#include <limber/time/newton_equations.h>
#include <limber/time/newton_tangent.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

/** @file Whether an equilibrium is stable (buckling). */
namespace limber
{
  // Inverse iteration K w = D v from noise, which no symmetry keeps from any
  // motion; with D = diag(K), so that nodes that points hardly see are not the
  // softest. The sign of w . K w = w . D v tells.
  template <int dim>
  bool
  NewtonEquations<dim>::is_stable()
  {
    if (displacement_of_tangent.empty() ||
        std::find(held.begin(), held.end(), 0) == held.end())
      return true; // nothing was to move, or nothing can
    constexpr unsigned int    n_solutions = 2;
    std::minstd_rand          noise;
    const std::vector<double> at_rest(size());
    std::vector<double>       v(size()), w;
    for (std::size_t k = 0; k < size(); ++k)
      v[k] = is_held(k) ? 0. : double(noise()) / noise.max() - 0.5;
    // If the equations cannot be solved here, nothing follows for the steps.
    const bool          all = factorises_all, large = too_large;
    const std::string   failed  = failed_iterations;
    const unsigned long counted = n_linear_iterations;
    double              sign    = 1;
    for (unsigned int i = 0; i < n_solutions; ++i)
      {
        std::vector<double> right_side(size());
        for (std::size_t k = 0; k < size(); ++k)
          right_side[k] = tangent->values().diag_element(k) * v[k];
        if (!solve(right_side, at_rest, w))
          break;
        sign = std::inner_product(w.begin(), w.end(), right_side.begin(), 0.);
        const double length =
          std::sqrt(std::inner_product(w.begin(), w.end(), w.begin(), 0.));
        for (std::size_t k = 0; k < size(); ++k)
          v[k] = w[k] / length;
      }
    factorises_all      = all;
    too_large           = large;
    failed_iterations   = failed;
    n_linear_iterations = counted;
    return sign > 0;
  }



  template bool
  NewtonEquations<2>::is_stable();
  template bool
  NewtonEquations<3>::is_stable();
} // namespace limber
