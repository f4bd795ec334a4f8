// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/points/part_inside.h>
#include <limber/problem/ball.h>
#include <limber/problem/half_space.h>

#include <gtest/gtest.h>

/** @file Volume, centroid and spread of what shapes have inside of boxes. */

using namespace limber;

namespace
{
  template <int dim>
  dealii::Point<dim>
  all(const double x)
  {
    dealii::Point<dim> result;
    for (unsigned int d = 0; d < dim; ++d)
      result[d] = x;
    return result;
  }



  /** Of a half space x_d < c in the unit box. */
  template <int dim>
  void
  expect_slab(const unsigned int direction, const double share)
  {
    SCOPED_TRACE(std::to_string(dim) + "d, " + std::to_string(share));
    dealii::Point<dim>     place;
    dealii::Tensor<1, dim> normal;
    place[direction]  = share;
    normal[direction] = 1;
    const auto part   = inside_of<dim>(HalfSpaceShape<dim>(place, normal),
                                     Corners<dim>(all<dim>(0), all<dim>(1)));
    EXPECT_NEAR(part.volume, share, 1e-13);
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double edge = d == direction ? share : 1;
        EXPECT_NEAR(part.centroid[d], edge / 2, 1e-13);
        EXPECT_NEAR(part.spread[d][d], edge * edge / 12, 1e-13);
      }
  }



  /** The errors of the volume and of the second moment of a ball, of 10 boxes
   * along its diameter or less. */
  template <int dim>
  std::array<double, 2>
  errors_of_ball()
  {
    const double             radius = 0.347;
    const dealii::Point<dim> centre = all<dim>(0.513);
    const BallShape<dim>     ball(centre, radius);
    constexpr unsigned int   n      = 14;
    double                   volume = 0, moment = 0;
    for (unsigned int i = 0; i < (dim == 2 ? n * n : n * n * n); ++i)
      {
        dealii::Point<dim> lower;
        for (unsigned int d = 0, rest = i; d < dim; ++d, rest /= n)
          lower[d] = double(rest % n) / n;
        const auto part =
          inside_of<dim>(ball, Corners<dim>(lower, lower + all<dim>(1. / n)));
        volume += part.volume;
        if (part.volume > 0)
          moment += part.volume * (trace(part.spread) +
                                   (part.centroid - centre).norm_square());
      }
    const double exact = dim == 2 ? M_PI * radius * radius :
                                    4 * M_PI / 3 * radius * radius * radius;
    return {{volume / exact - 1,
             moment / (exact * radius * radius * dim / (dim + 2.)) - 1}};
  }
} // namespace



// Counted by pieces, .3 of a part would be .3125: water of that volume beside
// a wall is 4 % too heavy there and does not rest.
TEST(PartInside, PlanesAlongTheAxesAreExact)
{
  for (const double share : {0.01, 0.3, 0.5, 0.77, 0.99})
    for (unsigned int d = 0; d < 2; ++d)
      {
        expect_slab<2>(d, share);
        expect_slab<3>(d + 1, share);
      }
}



// Rods are cut at their axes: of second order in the pieces.
TEST(PartInside, ObliquePlanesHaveTheirVolume)
{
  for (const double degrees : {10., 30., 45., 77.})
    {
      SCOPED_TRACE(std::to_string(degrees) + " degrees");
      const double               angle = degrees * M_PI / 180;
      const dealii::Tensor<1, 2> normal({std::sin(angle), std::cos(angle)});
      const auto part = inside_of<2>(HalfSpaceShape<2>(all<2>(0.5), normal),
                                     Corners<2>(all<2>(0), all<2>(1)));
      EXPECT_NEAR(part.volume, 0.5, 1e-12); // by symmetry
      // a plane that takes a corner: a triangle
      const double tangent = std::tan(angle);
      const double base    = std::min(0.4, 0.4 / tangent); // along x
      const auto   tip =
        inside_of<2>(HalfSpaceShape<2>(dealii::Point<2>(base, 0), normal),
                     Corners<2>(all<2>(0), all<2>(1)));
      EXPECT_NEAR(tip.volume, base * base * tangent / 2, 2e-4);
      EXPECT_NEAR(tip.centroid[0], base / 3, 2e-3);
      EXPECT_NEAR(tip.centroid[1], base * tangent / 3, 2e-3);
    }
}



TEST(PartInside, BallsHaveTheirVolume)
{
  for (const auto &errors : {errors_of_ball<2>(), errors_of_ball<3>()})
    for (const double error : errors)
      EXPECT_NEAR(error, 0, 3e-4);
}
