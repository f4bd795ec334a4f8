// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/transfer/surface_fit.h>

#include <gtest/gtest.h>

/** @file Normals of surfaces from the points next to them (SurfaceFit). */

using namespace limber;

namespace
{
  constexpr double edge = 0.1;

  template <int dim>
  using Vector = typename SurfaceFit<dim>::Vector;



  template <int dim>
  double
  norm(const std::array<double, dim> &a)
  {
    double square = 0;
    for (const double component : a)
      square += component * component;
    return std::sqrt(square);
  }



  /** factor * a + b */
  template <std::size_t dim>
  std::array<double, dim>
  sum(const double                   factor,
      const std::array<double, dim> &a,
      std::array<double, dim>        b = {})
  {
    for (std::size_t d = 0; d < dim; ++d)
      b[d] += factor * a[d];
    return b;
  }



  template <int dim>
  double
  distance(const std::array<double, dim> &a, const std::array<double, dim> &b)
  {
    return norm<dim>(sum(-1, a, b));
  }



  /** Of angles to the last axis in the planes of the first ones and it. */
  template <int dim>
  Vector<dim>
  oblique(const double tangent)
  {
    Vector<dim> result{};
    result[0]       = tangent;
    result[dim - 1] = 1;
    if constexpr (dim == 3)
      result[1] = -0.5 * tangent;
    return sum(1 / norm<dim>(result), result);
  }



  /** Of the columns of a lattice under a plane the points next to it. */
  template <int dim>
  SurfaceFit<dim>
  fit_stairs(const Vector<dim> &normal,
             const Vector<dim> &guess,
             const int          n_columns)
  {
    SurfaceFit<dim> fit(guess, edge);
    for (int i = -n_columns; i <= n_columns; ++i)
      for (int j = dim == 3 ? -n_columns : 0; j <= (dim == 3 ? n_columns : 0);
           ++j)
        for (int k = -20; k < 20; ++k)
          {
            Vector<dim> place{};
            place[0] = (i + 0.5) * edge;
            if constexpr (dim == 3)
              place[1] = (j + 0.5) * edge;
            place[dim - 1] = (k + 0.5) * edge;
            double depth   = 0.03;
            for (int d = 0; d < dim; ++d)
              depth -= place[d] * normal[d];
            if (depth > 0 && depth < edge * normal[dim - 1])
              fit.add(place, depth, 1 + 0.1 * i);
          }
    return fit;
  }



  template <int dim>
  void
  expect_planes()
  {
    for (const double tangent : {0., 0.05, 0.2, 0.5, 0.9})
      {
        SCOPED_TRACE(tangent);
        const auto exact = oblique<dim>(tangent);
        // The heights are those along the guess, and the reaches are not: what
        // is left is of second order.
        const auto near =
          fit_stairs<dim>(exact, sum(3, oblique<dim>(tangent + 0.02)), 3)
            .normal();
        EXPECT_LT(distance<dim>(near, exact), 1e-3);
        EXPECT_NEAR(norm<dim>(near), 1, 1e-14);
        EXPECT_LT(distance<dim>(fit_stairs<dim>(exact, exact, 3).normal(),
                                exact),
                  1e-13);
      }
  }
} // namespace



TEST(SurfaceFit, FindsPlanesUnderStairs)
{
  expect_planes<2>();
  expect_planes<3>();
}



TEST(SurfaceFit, HasNoOpinionOfFewPoints)
{
  const auto    guess = oblique<2>(0.3);
  SurfaceFit<2> fit(sum(2, guess), edge);
  Vector<2>     place{};
  EXPECT_EQ(fit.normal(), fit.guess());
  EXPECT_LT(distance<2>(fit.guess(), guess), 1e-15);
  fit.add(place, 0.05, 1.);
  place[0] = 1e-3;
  fit.add(place, 0.04, 1.);
  EXPECT_EQ(fit.normal(), fit.guess());

  // a row in three dimensions
  SurfaceFit<3> row(oblique<3>(0.3), edge);
  Vector<3>     x{};
  for (int k = 0; k < 5; ++k)
    {
      x[0] = k * edge;
      row.add(x, 0.05 + 0.01 * k, 1.);
    }
  EXPECT_EQ(row.normal(), row.guess());

  EXPECT_EQ(SurfaceFit<3>({}, edge).normal(), Vector<3>());
}



// The face below an edge is lower, however many points are next to it.
TEST(SurfaceFit, LooksAtTheHighestFace)
{
  const Vector<2> up{{0, 1}};
  SurfaceFit<2>   fit(up, edge);
  Vector<2>       place{};
  for (int k = 0; k < 6; ++k)
    {
      place[0] = -(k + 0.5) * edge;
      place[1] = -0.5 * edge;
      fit.add(place, 0.5 * edge, 1.);
    }
  for (int k = 1; k < 12; ++k)
    {
      place[0] = -0.5 * edge;
      place[1] = -(k + 0.5) * edge;
      fit.add(place, 0.5 * edge, 1.);
    }
  // 12 of 17 points are next to the other face: 60 degrees if all were alike
  EXPECT_NEAR(fit.normal()[0], 0, 0.15);
}
