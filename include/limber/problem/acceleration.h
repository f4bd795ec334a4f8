// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_acceleration_h
#define limber_problem_acceleration_h

#include <limber/problem/problem.h>

#include <cmath>

namespace limber
{
  /** Calls work(place) for a lattice in a box, @p n places along each edge,
   * from end to end. */
  template <int dim, class Work>
  void
  for_each_place(const Corners<dim> &box,
                 const unsigned int  n,
                 const Work         &work)
  {
    for (unsigned int k = 0; k < std::pow(n, dim); ++k)
      {
        dealii::Point<dim> place;
        for (unsigned int d = 0, rest = k; d < dim; ++d, rest /= n)
          place[d] = box.first[d] +
                     (box.second[d] - box.first[d]) * (rest % n) / (n - 1.);
        work(place);
      }
  }



  /**
   * Bound of each component of gravity plus body force, m/s^2, in the box
   * around the body at the start and at any time of the run: sampled, where the
   * formula is finite.
   */
  template <int dim>
  dealii::Tensor<1, dim>
  largest_acceleration(const Problem<dim> &problem, const Body<dim> &body);
} // namespace limber

#endif
