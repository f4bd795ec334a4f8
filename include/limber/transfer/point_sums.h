// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_point_sums_h
#define limber_transfer_point_sums_h

#include <limber/points/point_view.h>

namespace limber
{
  /**
   * Sums over the points of a body for the statistics, which may be written in
   * every step.
   */
  template <int dim>
  struct MotionSums
  {
    double                  mass              = 0; // kg
    double                  kinetic_energy    = 0; // J
    double                  absolute_momentum = 0; // sum of m |v|, kg m/s
    double                  squared_speed     = 0; // the largest, m^2/s^2
    std::array<double, dim> momentum{};            // kg m/s
    std::array<double, dim> mass_moment{};         // sum of m x, kg m
  };

  template <int dim>
  MotionSums<dim>
  sum_motion(const PointView<dim> &points);

  /** The box of all positions, m; without points from large to small. */
  template <int dim>
  struct PositionBounds
  {
    std::array<double, dim> lower, upper;
  };

  template <int dim>
  PositionBounds<dim>
  bounds_of_positions(const PointView<dim> &points);
} // namespace limber

#endif
