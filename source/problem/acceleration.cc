// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/problem/acceleration.h>

#include <algorithm>

namespace limber
{
  template <int dim>
  dealii::Tensor<1, dim>
  largest_acceleration(const Problem<dim> &problem, const Body<dim> &body)
  {
    constexpr unsigned int n_places = 5, n_times = 33;
    dealii::Tensor<1, dim> result;
    const auto             consider = [&](const dealii::Tensor<1, dim> &force) {
      for (unsigned int d = 0; d < dim; ++d)
        result[d] =
          std::max(result[d], std::abs(problem.loads.gravity[d] + force[d]));
    };
    const auto &force = problem.loads.body_force;
    if (!force)
      {
        consider({});
        return result;
      }
    for_each_place(body.shape->bounding_box(),
                   n_places,
                   [&](const dealii::Point<dim> &place) {
                     for (unsigned int k = 0; k < n_times; ++k)
                       if (const double time =
                             problem.end_time * k / (n_times - 1.);
                           force->is_finite(place, time))
                         consider(force->vector(place, time));
                   });
    return result;
  }



  template dealii::Tensor<1, 2>
  largest_acceleration(const Problem<2> &, const Body<2> &);
  template dealii::Tensor<1, 3>
  largest_acceleration(const Problem<3> &, const Body<3> &);
} // namespace limber
