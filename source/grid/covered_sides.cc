// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/covered_sides.h>

namespace limber
{
  template <int dim>
  CoveredSides<dim>::CoveredSides(const std::vector<Obstacle<dim>> &obstacles,
                                  const double smallest_edge)
    : tolerance(1e-6 * smallest_edge)
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
    constexpr double alike = 0.7; // less than 45 degrees apart
    for (const ObstaclePlace<dim> &obstacle : places)
      if (const auto distance = obstacle.distance(place);
          distance.value <= tolerance)
        for (unsigned int side = 0; side < 2 * dim; ++side)
          if ((side % 2 == 0 ? 1 : -1) * distance.normal[side / 2] > alike)
            set &= ~(1u << side);
    return set;
  }



  template class CoveredSides<2>;
  template class CoveredSides<3>;
} // namespace limber
