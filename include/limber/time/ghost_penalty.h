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
   * A stiffness against jumps of the normal derivative across faces of cells
   * next to the surface (ghost penalty; Sticko, Ludvigsson and Kreiss 2020,
   * Coombs 2023),
   *
   *   energy  g E h/6  int [du/dn] . [du/dn] dA,
   *
   * without which nodes of cells that are hardly filled would resist some
   * motions with nothing.
   */
  template <int dim>
  class GhostPenalty
  {
  public:
    static constexpr unsigned int n_lines = 1 << (dim - 1);

    // A face between two cells with points, near the surface
    struct Face
    {
      // numbers of nodes: along the normal, for each place across it
      std::array<std::array<std::uint32_t, 3>, n_lines> lines;
      double                                            stiffness; // N/m
    };

    /** There is none. */
    void
    clear()
    {
      of_surface.clear();
    }

    /**
     * Find the faces: those of a cell that has a neighbour without points, and
     * of its neighbours with points. What lies beyond a side of the box does
     * not count. @p modulus: g E, Pa.
     */
    void
    find(const NumberedNodes<dim> &nodes, double modulus);

    const std::vector<Face> &
    faces() const
    {
      return of_surface;
    }

    /** Add the forces against displacements (dim a node, m) to @p forces, N;
     * returns the energy, J. */
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
    std::vector<Face> of_surface;
  };
} // namespace limber

#endif
