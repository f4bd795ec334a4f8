// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_covered_sides_h
#define limber_grid_covered_sides_h

#include <limber/problem/problem.h>

#include <vector>

namespace limber
{
  /**
   * Sides of the box in whose place an obstacle has moved: a piston, a press or
   * a paddle that starts in a side. A side that went on holding the nodes
   * behind its surface would hold the material in front of it as well, in the
   * cells that the obstacle cuts, both against being pushed and against coming
   * along. Such nodes are left to the obstacle.
   *
   * Where it has not taken all faces around a node yet, as an oblique wall in a
   * corner, and where it does not look into the box as the side does, as behind
   * a piston on the floor, the side remains what holds the material.
   */
  template <int dim>
  class CoveredSides
  {
  public:
    /** By those of the obstacles that move; these outlive this object. */
    CoveredSides(const std::vector<Obstacle<dim>> &obstacles,
                 const GridDescription<dim>       &grid);

    /** This, or null where no obstacle moves: then no side is asked. */
    const CoveredSides *
    if_any() const
    {
      return moving.empty() ? nullptr : this;
    }

    /** Where they are in the step that begins at @p time, s. */
    void
    find(double time);

    /** Of the sides in @p set (bits) at a place, those that still act. */
    std::uint8_t
    uncovered(std::uint8_t set, const dealii::Point<dim> &place) const;

    /** Raised by one whenever obstacles have moved. */
    std::uint64_t
    version() const
    {
      return n_found;
    }

  private:
    bool
    is_in(const SignedDistance<dim> &distance) const;

    /** Whether it has all faces of cells in a side that meet in a place. */
    bool
    covers_faces_at(const ObstaclePlace<dim> &obstacle,
                    unsigned int              side,
                    const dealii::Point<dim> &place) const;

    std::vector<const Obstacle<dim> *> moving;
    std::vector<ObstaclePlace<dim>>    places; // of these, now
    const GridDescription<dim>         grid;
    std::uint64_t                      n_found = 0;
  };
} // namespace limber

#endif
