// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_covered_sides_h
#define limber_grid_covered_sides_h

#include <limber/problem/problem.h>

#include <vector>

namespace limber
{
  /**
   * Sides of the box that are covered by a moving obstacle: a piston, a press
   * or a paddle that starts in a side. If the side still held the nodes behind
   * its surface, it would also hold the material in front of it in the cut
   * cells, against both compression and motion along. So only the obstacle acts
   * on such nodes.
   *
   * The side still acts where the obstacle does not cover all faces around a
   * node, as an oblique wall in a corner, and where its normal differs from
   * that of the side, as behind a piston on the floor.
   */
  template <int dim>
  class CoveredSides
  {
  public:
    /**
     * With the moving ones of these obstacles, which must outlive this object.
     */
    CoveredSides(const std::vector<Obstacle<dim>> &obstacles,
                 const GridDescription<dim>       &grid);

    /** This, or null if no obstacle moves. */
    const CoveredSides *
    if_any() const
    {
      return moving.empty() ? nullptr : this;
    }

    /** Positions of the obstacles in the step that begins at @p time, s. */
    void
    find(double time);

    /** Of the sides in @p set (bits) at a position, those that still act. */
    std::uint8_t
    uncovered(std::uint8_t set, const dealii::Point<dim> &place) const;

    /** Incremented when obstacles have moved. */
    std::uint64_t
    version() const
    {
      return n_found;
    }

  private:
    bool
    is_in(const SignedDistance<dim> &distance) const;

    /** Whether it covers all faces in a side that share this node. */
    bool
    covers_faces_at(const ObstaclePlace<dim> &obstacle,
                    unsigned int              side,
                    const dealii::Point<dim> &place) const;

    std::vector<const Obstacle<dim> *> moving;
    std::vector<ObstaclePlace<dim>>    places; // of these, at present
    const GridDescription<dim>         grid;
    std::uint64_t                      n_found = 0;
  };
} // namespace limber

#endif
