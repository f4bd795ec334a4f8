// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/covered_sides.h>

#include <algorithm>

namespace limber
{
  template <int dim>
  CoveredSides<dim>::CoveredSides(const std::vector<Obstacle<dim>> &obstacles,
                                  const GridDescription<dim>       &grid)
    : grid(grid)
  {
    for (const Obstacle<dim> &obstacle : obstacles)
      if (obstacle.changes_place())
        moving.push_back(&obstacle);
    find(0);
  }



  template <int dim>
  void
  CoveredSides<dim>::find(const double time)
  {
    if (moving.empty())
      return;
    places.clear();
    for (const Obstacle<dim> *const obstacle : moving)
      places.emplace_back(*obstacle, time);
    ++n_found;
  }



  template <int dim>
  std::uint8_t
  CoveredSides<dim>::uncovered(std::uint8_t              set,
                               const dealii::Point<dim> &place) const
  {
    constexpr double alike = 0.7; // normals less than 45 degrees apart
    for (const ObstaclePlace<dim> &obstacle : places)
      if (const auto distance = obstacle.distance(place); is_in(distance))
        for (unsigned int side = 0; side < 2 * dim; ++side)
          if ((set >> side & 1) &&
              (side % 2 == 0 ? 1 : -1) * distance.normal[side / 2] > alike &&
              covers_faces_at(obstacle, side, place))
            set &= ~(1u << side);
    return set;
  }



  template <int dim>
  bool
  CoveredSides<dim>::is_in(const SignedDistance<dim> &distance) const
  {
    constexpr double round_off = 1e-6; // relative to an edge
    return distance.value <= round_off * grid.edge(0);
  }



  // Checked at the neighbours of this node in the side.
  template <int dim>
  bool
  CoveredSides<dim>::covers_faces_at(const ObstaclePlace<dim> &obstacle,
                                     const unsigned int        side,
                                     const dealii::Point<dim> &place) const
  {
    for (unsigned int d = 0; d < dim; ++d)
      for (const int direction : {-1, 1})
        if (d != side / 2)
          {
            dealii::Point<dim> next = place;
            next[d] = std::clamp(next[d] + direction * grid.edge(d),
                                 grid.lower[d],
                                 grid.upper[d]);
            if (!is_in(obstacle.distance(next)))
              return false;
          }
    return true;
  }



  template class CoveredSides<2>;
  template class CoveredSides<3>;
} // namespace limber
