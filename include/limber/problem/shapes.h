// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_shapes_h
#define limber_problem_shapes_h

#include <limber/problem/ball.h>
#include <limber/problem/block.h>
#include <limber/problem/box.h>
#include <limber/problem/cylinder.h>
#include <limber/problem/formula_shape.h>
#include <limber/problem/union_of_shapes.h>

#include <tuple>

namespace limber
{
  /**
   * The one list of shapes. Their words, sections and help in the scene follow
   * from it, for bodies and for the parts of unions.
   */
  template <int dim>
  using ShapeList = std::tuple<BoxShape<dim>,
                               BallShape<dim>,
                               CylinderShape<dim>,
                               FormulaShape<dim>,
                               BlockShape<dim>>;
} // namespace limber

#endif
