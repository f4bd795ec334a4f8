// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_basis_h
#define limber_interpolation_basis_h

#include <limber/interpolation/linear.h>
#include <limber/interpolation/spline.h>

#include <type_traits>

/**
 * @file The bases that a grid can have. A basis is a type without state:
 *
 *   dim, n_nodes          nodes whose functions do not vanish in a cell
 *   stride(d)             from a node of a cell, or a monomial, to the next
 *   power(k, d)           the power of monomial k in direction d
 *   nodes_of(grid, cell)  whose member `node` are the offsets of their records
 *   to_monomials(a, nodes_of)   nodal values to coefficients of monomials
 *   value(c, xi), gradient(c, xi)   of these, at natural coordinates
 *
 * All its points of a cell see the same nodes. What points give to nodes is
 * written for each basis, for its speed (transfer/).
 */
namespace limber
{
  /** Whether a cell has the modes that assumed strain treats apart. */
  template <class Basis>
  inline constexpr bool has_bending_modes = Basis::n_nodes == 1 << Basis::dim;



  /** Call @p work with a (stateless) object of the type of the grid's basis. */
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
