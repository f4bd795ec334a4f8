// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_farthest_place_h
#define limber_problem_farthest_place_h

#include <limber/problem/shape.h>

namespace limber
{
  /**
   * Support function of a shape: the largest n . x of all its places x, m, to
   * 1e-9 of its size, in the direction @p n of unit length. The bounding box
   * alone does not tell, if it is not tight or n is not along an axis. Empty if
   * no place of the shape is found, as it is thinner than 1/256 (in three
   * dimensions 1/64) of its bounding box.
   */
  template <int dim>
  std::optional<double>
  reach(const Shape<dim> &shape, const dealii::Tensor<1, dim> &n);
} // namespace limber

#endif
