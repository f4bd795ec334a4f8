// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_surface_h
#define limber_problem_surface_h

#include <limber/problem/shapes.h>

#include <functional>

/** @file Triangulated surface of any shape (marching squares and cubes). */
namespace limber
{
  /**
   * A line segment in two dimensions, a triangle in three. Seen from outside
   * the shape, triangles run counterclockwise; segments have it on their left.
   */
  template <int dim>
  using Facet = std::array<dealii::Point<dim>, dim>;



  /** Indicator function of a shape or of a part: whether a place is inside. */
  template <int dim>
  using Region = std::function<bool(const dealii::Point<dim> &)>;



  /**
   * The surface of the part of a shape inside @p box, closed: marching squares
   * and cubes on a lattice that divides the common box of the two into parts
   * not larger than @p spacing (m, by direction). Vertices lie on the surface
   * to round-off, so smooth surfaces have errors of second order. Sharp corners
   * in the plane are where the tangents on both sides intersect; sharp edges in
   * space are cut off within a part of the lattice, unless they lie in the
   * sides of the common box, where lattice and shape fit. Features thinner than
   * a part may be missed.
   *
   * Uses Shape::contains() alone, so it works for every shape.
   */
  template <int dim>
  std::vector<Facet<dim>>
  surface(const Shape<dim>              &shape,
          const Corners<dim>            &box,
          const std::array<double, dim> &spacing);



  /** Facets clipped by a region. */
  template <int dim>
  std::vector<Facet<dim>>
  part_in(const Region<dim> &region, const std::vector<Facet<dim>> &facets);
} // namespace limber

#endif
