// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/free_motions.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  template <int dim>
  double
  rigid_motion(const unsigned int        motion,
               const unsigned int        component,
               const dealii::Point<dim> &place,
               const dealii::Point<dim> &centre)
  {
    if (motion < dim)
      return component == motion ? 1 : 0;
    // about the axis r in space, about z in the plane
    const unsigned int r = motion - dim;
    const unsigned int a = dim == 2 ? 0 : (r + 1) % 3;
    const unsigned int b = dim == 2 ? 1 : (r + 2) % 3;
    if (component == a)
      return -(place[b] - centre[b]);
    return component == b ? place[a] - centre[a] : 0;
  }



  // A motion is free where what it does to held components is a combination of
  // what motions before it do: with as much of these it does not move them.
  template <int dim>
  std::string
  free_rigid_motion(const std::vector<dealii::Point<dim>>    &places,
                    const std::vector<std::array<bool, dim>> &held)
  {
    constexpr double   negligible = 1e-6;
    dealii::Point<dim> centre;
    for (const auto &place : places)
      centre += place / double(places.size());
    double size = 1e-300; // of the body, so that rotations compare with shifts
    for (const auto &place : places)
      size = std::max(size, place.distance(centre));

    std::vector<std::vector<double>> kept;
    for (unsigned int m = 0; m < n_rigid_motions<dim>; ++m)
      {
        std::vector<double> motion;
        for (std::size_t i = 0; i < places.size(); ++i)
          for (unsigned int d = 0; d < dim; ++d)
            if (held[i][d])
              motion.push_back(rigid_motion<dim>(m, d, places[i], centre) /
                               (m < dim ? 1 : size));
        for (const auto &other : kept)
          {
            double product = 0;
            for (std::size_t k = 0; k < motion.size(); ++k)
              product += motion[k] * other[k];
            for (std::size_t k = 0; k < motion.size(); ++k)
              motion[k] -= product * other[k];
          }
        double square = 0;
        for (const double value : motion)
          square += value * value;
        if (!(std::sqrt(square) > negligible))
          return (m < dim ? "the translation along " : "the rotation about ") +
                 std::string(1,
                             "xyz"[m < dim  ? m :
                                   dim == 2 ? 2 :
                                              m - dim]);
        for (double &value : motion)
          value /= std::sqrt(square);
        kept.push_back(motion);
      }
    return "";
  }



  template double
  rigid_motion<2>(unsigned int,
                  unsigned int,
                  const dealii::Point<2> &,
                  const dealii::Point<2> &);
  template std::string
  free_rigid_motion<2>(const std::vector<dealii::Point<2>> &,
                       const std::vector<std::array<bool, 2>> &);
  template double
  rigid_motion<3>(unsigned int,
                  unsigned int,
                  const dealii::Point<3> &,
                  const dealii::Point<3> &);
  template std::string
  free_rigid_motion<3>(const std::vector<dealii::Point<3>> &,
                       const std::vector<std::array<bool, 3>> &);
} // namespace limber
