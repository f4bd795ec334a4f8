// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/problem/acceleration.h>
#include <limber/problem/time_scale.h>

#include <algorithm>
#include <limits>

namespace limber
{
  namespace
  {
    constexpr unsigned int n_places = 3, n_times = 1001;

    // Interval of difference quotients as a share of that between samples: they
    // see what is faster than the samples, differences between samples see
    // jumps.
    constexpr double at_once = 1e-4;



    /**
     * Of a vector as a function of time, from zero to @p end: its rms about the
     * mean over the rms of its rate.
     */
    template <int dim, class Function>
    double
    time_scale(const Function &function, const double end)
    {
      const double           interval = end / n_times;
      dealii::Tensor<1, dim> sum, former;
      double squares = 0, squares_of_rate = 0, squares_of_steps = 0, before = 0;
      for (unsigned int k = 0; k < n_times; ++k)
        {
          // quasi-random times (golden ratio): at equal times a periodic
          // function might always have the same value
          const double golden = 0.5 * (std::sqrt(5.) - 1) * k,
                       time   = interval * (k + golden - std::floor(golden));
          const dealii::Tensor<1, dim> value = function(time),
                                       rate =
                                         (function(time + at_once * interval) -
                                          value) /
                                         (at_once * interval);
          sum += value;
          squares += value.norm_square();
          squares_of_rate += rate.norm_square();
          if (k > 0)
            squares_of_steps +=
              ((value - former) / (time - before)).norm_square();
          former = value;
          before = time;
        }
      const double variance = squares - sum.norm_square() / n_times;
      // what is left of a constant is round-off
      return std::isfinite(variance) && variance > 1e-12 * squares ?
               std::sqrt(variance /
                         std::max(squares_of_rate, squares_of_steps)) :
               std::numeric_limits<double>::infinity();
    }
  } // namespace



  template <int dim>
  double
  time_scale_of_formulas(const Problem<dim> &problem)
  {
    double     result   = std::numeric_limits<double>::infinity();
    const auto consider = [&](const auto &function) {
      result = std::min(result, time_scale<dim>(function, problem.end_time));
    };
    const auto anywhere = [&](const auto &consider_at) {
      for_each_place(Corners<dim>(problem.grid.lower, problem.grid.upper),
                     n_places,
                     consider_at);
    };
    for (const auto &side : problem.sides)
      if (!side.velocity.empty())
        anywhere([&](const dealii::Point<dim> &place) {
          consider([&](const double time) {
            dealii::Tensor<1, dim> velocity;
            for (unsigned int d = 0; d < dim; ++d)
              velocity[d] = side.prescribed_velocity(place, time, d);
            return velocity;
          });
        });
    if (const auto &force = problem.loads.body_force)
      anywhere([&](const dealii::Point<dim> &place) {
        consider([&](const double time) { return force->vector(place, time); });
      });
    for (const Obstacle<dim> &obstacle : problem.obstacles)
      anywhere([&](const dealii::Point<dim> &place) {
        consider([&](const double time) {
          return ObstaclePlace<dim>(obstacle, time).place_of(place) - place;
        });
      });
    return result;
  }



  template double
  time_scale_of_formulas(const Problem<2> &);
  template double
  time_scale_of_formulas(const Problem<3> &);
} // namespace limber
