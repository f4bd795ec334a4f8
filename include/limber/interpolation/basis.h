// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_basis_h
#define limber_interpolation_basis_h

#include <limber/interpolation/linear.h>
#include <limber/interpolation/spline.h>

#include <type_traits>

/**
 * @file The bases (shape functions) that a grid can have. A basis is a type
 * without state:
 *
 *   dim, n_nodes          nodes whose functions do not vanish in a cell
 *   stride(d)             from a node of a cell, or a monomial, to the next
 *   power(k, d)           the power of monomial k in direction d
 *   nodes_of(grid, cell)  with a member `node`, the offsets of their records
 *   to_monomials(a, nodes_of)   nodal values to coefficients of monomials
 *   value(c, xi), gradient(c, xi)   of these, at natural coordinates
 *
 * All points of a cell share its nodes. P2G is written for each basis
 * separately, for speed (transfer/).
 */
namespace limber
{
  /** Whether a cell has the hourglass (bending) modes of the assumed strain. */
  template <class Basis>
  inline constexpr bool has_bending_modes = Basis::n_nodes == 1 << Basis::dim;



  /** Call @p work with an object of the basis of the grid (tag dispatch). */
  template <int dim, class Work>
  auto
  with_basis(const GridView<dim> &grid, const Work &work)
  {
    return grid.quadratics != nullptr ? work(Quadratic<dim>()) :
           grid.cubics != nullptr     ? work(Cubic<dim>()) :
                                        work(Linear<dim>());
  }
} // namespace limber

#endif
