// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_farthest_place_h
#define limber_problem_farthest_place_h

#include <limber/problem/shape.h>

namespace limber
{
  /**
   * The place x of a shape at which n . x is largest (support function), to
   * 1e-9 of its size, for a direction @p n of unit length. The bounding box
   * alone does not tell, if it is not tight or n is not along an axis. Empty if
   * no place of the shape is found, as it is thinner than 1/256 (in three
   * dimensions 1/64) of its bounding box.
   */
  template <int dim>
  std::optional<dealii::Point<dim>>
  farthest_place(const Shape<dim> &shape, const dealii::Tensor<1, dim> &n);



  /**
   * Length of the ray along @p n, of unit length, from a place in a shape to
   * where it leaves the shape, m. Gaps shorter than @p stride may be missed;
   * the end is right to 1e-13 of it.
   */
  template <int dim>
  double
  way_out(const Shape<dim>             &shape,
          const dealii::Point<dim>     &place,
          const dealii::Tensor<1, dim> &n,
          double                        stride);
} // namespace limber

#endif
