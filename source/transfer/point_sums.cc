// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/batch_lanes.h>
#include <limber/transfer/point_sums.h>

#include <limits>

namespace limber
{
  template <int dim>
  MotionSums<dim>
  sum_motion(const PointView<dim> &points)
  {
    using Number = PointPack<dim>;
    MotionSums<dim> sums;
    Number          largest{};
    for_each_block(points.size, [&](const CellBatch &block) {
      Number                  mass{}, energy{}, absolute{};
      std::array<Number, dim> momentum{}, moment{};
      for_each_pack<dim>(block, [&](const auto &lanes) {
        const Number m = lanes.only_active(lanes.load(points.mass));
        Number       square{};
        for (int d = 0; d < dim; ++d)
          {
            const Number v = lanes.load(points.velocity[d]);
            square += v * v;
            momentum[d] += m * v;
            moment[d] += m * lanes.load(points.position[d]);
          }
        mass += m;
        energy += m * square;
        absolute += m * square_root(square);
        largest = larger(square, largest);
      });
      sums.mass += sum(mass);
      sums.kinetic_energy += 0.5 * sum(energy);
      sums.absolute_momentum += sum(absolute);
      for (int d = 0; d < dim; ++d)
        {
          sums.momentum[d] += sum(momentum[d]);
          sums.mass_moment[d] += sum(moment[d]);
        }
    });
    sums.squared_speed = maximum(largest);
    return sums;
  }



  template <int dim>
  PositionBounds<dim>
  bounds_of_positions(const PointView<dim> &points)
  {
    using Number                   = PointPack<dim>;
    constexpr double        beyond = std::numeric_limits<double>::max();
    std::array<Number, dim> lower, upper;
    lower.fill(broadcast<Number>(beyond));
    upper.fill(broadcast<Number>(-beyond));
    for_each_block(points.size, [&](const CellBatch &block) {
      for_each_pack<dim>(block, [&](const auto &lanes) {
        for (int d = 0; d < dim; ++d)
          {
            const Number x = lanes.load(points.position[d]);
            lower[d]       = smaller(x, lower[d]);
            upper[d]       = larger(x, upper[d]);
          }
      });
    });
    PositionBounds<dim> result;
    for (int d = 0; d < dim; ++d)
      {
        result.lower[d] = minimum(lower[d]);
        result.upper[d] = maximum(upper[d]);
      }
    return result;
  }



  template MotionSums<2>
  sum_motion(const PointView<2> &);
  template MotionSums<3>
  sum_motion(const PointView<3> &);
  template PositionBounds<2>
  bounds_of_positions(const PointView<2> &);
  template PositionBounds<3>
  bounds_of_positions(const PointView<3> &);
} // namespace limber
