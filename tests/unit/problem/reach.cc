// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/problem/farthest_place.h>
#include <limber/problem/shapes.h>

#include <gtest/gtest.h>
#include <support/scene_run.h>

/**
 * @file How far shapes reach in a direction: gravity hangs a hydrostatic
 * pressure there.
 */

using namespace limber;
using dealii::Point;
using dealii::Tensor;

namespace
{
  Tensor<1, 2>
  direction(const double angle)
  {
    return Point<2>(std::cos(angle), std::sin(angle));
  }



  /** The largest n . x of a shape. */
  template <int dim>
  std::optional<double>
  reach(const Shape<dim> &shape, const Tensor<1, dim> &n)
  {
    const auto place = farthest_place<dim>(shape, n);
    return place ? std::optional<double>(n * *place) : std::nullopt;
  }



  FormulaShape<2>
  formula_in_unit_box(const std::string &inside)
  {
    return {Formula<2>(inside, {}, 1, ""), {Point<2>(), Point<2>(1, 1)}};
  }



  FormulaShape<3>
  formula_in_unit_cube(const std::string &inside)
  {
    return {Formula<3>(inside, {}, 1, ""), {Point<3>(), Point<3>(1, 1, 1)}};
  }
} // namespace



TEST(Reach, IsThatOfTheFarthestPlace)
{
  const BoxShape<2>             box(Point<2>(-1, 2), Point<2>(3, 4));
  const Point<2>                centre(1, 2);
  const BallShape<2>            ball(centre, 0.5);
  const BlockShape<2>::Vertices corners = {
    {Point<2>(0, 0.2), Point<2>(0.7, 0), Point<2>(0.3, 1), Point<2>(1, 0.6)}};
  const BlockShape<2> block(corners);
  for (double angle = 0.1; angle < 6; angle += 0.37)
    {
      const Tensor<1, 2> n = direction(angle);
      EXPECT_NEAR(*reach<2>(box, n),
                  n[0] * (n[0] > 0 ? 3 : -1) + n[1] * (n[1] > 0 ? 4 : 2),
                  1e-14);
      EXPECT_NEAR(*reach<2>(ball, n), n * centre + 0.5, 1e-9);
      double of_corners = -1e300;
      for (const Point<2> &corner : corners)
        of_corners = std::max<double>(of_corners, n * corner);
      EXPECT_NEAR(*reach<2>(block, n), of_corners, 1e-9) << angle;
    }
}



// The box around a formula is that of the grid, and empty at its top.
TEST(Reach, OfAFormulaIsThatOfItsSurface)
{
  EXPECT_NEAR(*reach<2>(formula_in_unit_box("0.37 - y"), direction(M_PI / 2)),
              0.37,
              1e-12);
  const Tensor<1, 2> up = direction(1.2);
  EXPECT_NEAR(*reach<2>(formula_in_unit_box("0.4 - (cos(1.2)*x + sin(1.2)*y)"),
                        up),
              0.4,
              1e-12);
  EXPECT_NEAR(*reach<2>(formula_in_unit_box("0.3 + 0.1*exp(-((x - 0.613) / "
                                            "0.05)^2) - y"),
                        direction(M_PI / 2)),
              0.4,
              1e-9);
  const Tensor<1, 3> oblique = Point<3>(2. / 7, 3. / 7, 6. / 7);
  EXPECT_NEAR(*reach<3>(formula_in_unit_cube("0.5 - (2*x + 3*y + 6*z) / 7"),
                        oblique),
              0.5,
              1e-12);
  EXPECT_FALSE(
    reach<3>(formula_in_unit_cube("1e-4 - abs(z - 0.4)"), oblique).has_value());
}



// The bounding box of the formula would give 2.2 times the pressure.
TEST(Reach, HydrostaticPressureBeginsAtTheSurface)
{
  constexpr double g = 10, angle = 0.25, rho = 1000;
  SceneRun<2>      run(R"(
    set Bodies = water
    subsection Body water
      set Shape = formula
      subsection Formula
        set Inside = sin(0.25)*(x - 0.5) - cos(0.25)*(y - 0.5)
      end
      set Initial pressure = hydrostatic
      set Material = newtonian fluid
    end
    subsection Grid
      set Cells = 16, 16
    end
    subsection Loads
      set Gravity = )" +
                  digits(g * std::sin(angle)) + ", " +
                  digits(-g * std::cos(angle)) + "\nend\n");
  const auto       points = run.points();
  ASSERT_GT(points.size, 400u);
  for (std::size_t p = 0; p < points.size; ++p)
    {
      const auto   x = run.position(p);
      const double depth =
        std::sin(angle) * (x[0] - 0.5) - std::cos(angle) * (x[1] - 0.5);
      EXPECT_NEAR(points.pressure[p], rho * g * depth, 0.02);
    }
}
