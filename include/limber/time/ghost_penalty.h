// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_ghost_penalty_h
#define limber_time_ghost_penalty_h

#include <limber/time/numbered_nodes.h>

#include <array>
#include <functional>
#include <vector>

namespace limber
{
  /**
   * A stiffness against jumps of the normal derivative of order p, the degree
   * of the functions, across faces of cells next to the surface (ghost penalty;
   * Sticko, Ludvigsson and Kreiss 2020, Coombs 2023),
   *
   *   energy  g E / 2  h^(2p-1) / ((2p+1) p!^2)  int [d^p u/dn^p]^2 dA,
   *
   * without which nodes of hardly filled (small-cut) cells would have no
   * stiffness against some motions. Lower derivatives are continuous. p = 1 for
   * linear functions, 2 for quadratic splines; g is the factor of the penalty.
   */
  template <int dim>
  class GhostPenalty
  {
  public:
    // A face between two cells with points, of which one is at the surface; or
    // the part of a cell's face that a smaller one has
    struct Face
    {
      std::vector<std::uint32_t> nodes; // of both cells
      // Jump of the derivative times h^p at each node in the face, as
      // coefficients of the values at all nodes, row by row
      std::vector<double> jumps;
      // Integrals of products of the functions over the unit interval, for each
      // direction in the face
      std::array<std::array<std::array<double, 3>, 3>, dim - 1> mass;
      double stiffness; // N/m
    };

    /** Remove all faces. */
    void
    clear()
    {
      of_surface.clear();
    }

    /**
     * Find the faces between cells with points of which at least one has a
     * neighbour without points; the outside of the box is no such neighbour.
     * @p moduli: g E by cell, Pa; a face has the smaller one, as at material
     * interfaces the derivative does jump.
     */
    void
    find(const NumberedNodes<dim> &nodes, const std::vector<double> &moduli);

    const std::vector<Face> &
    faces() const
    {
      return of_surface;
    }

    /** Add the gradient of the energy at displacements (dim per node, m) to
     * @p forces, N; returns the energy, J. */
    double
    add_forces(const std::vector<double> &displacement,
               std::vector<double>       &forces) const;

    /** Call @p add for the numbers of the nodes and the block of the tangent of
     * each face. */
    using Add = std::function<void(const std::uint32_t *numbers,
                                   unsigned int         n_nodes,
                                   const double        *block)>;
    void
    add_tangent(const Add &add) const;

  private:
    Face
    face_of_splines(const NumberedNodes<dim> &nodes,
                    std::size_t               cell,
                    std::size_t               other,
                    int                       d) const;
    static Face
    face_of_vertices(const NumberedNodes<dim> &nodes,
                     std::size_t               cell,
                     std::size_t               other,
                     int                       d,
                     int                       step);
    static double
    mass(const Face        &face,
         unsigned int       i,
         unsigned int       j,
         const unsigned int along);

    unsigned int      along = 2; // nodes of a cell along a direction, p + 1
    std::vector<Face> of_surface;
  };
} // namespace limber

#endif
