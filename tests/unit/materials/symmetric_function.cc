// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/materials/symmetric_function.h>

#include <gtest/gtest.h>
#include <support/small_grid.h>

using namespace limber;
using namespace limber::testing_support;

namespace
{
  Matrix<3>
  random_symmetric(Random &random)
  {
    Matrix<3> a = random.matrix<3>();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < i; ++j)
        a[i][j] = a[j][i];
    return a;
  }



  Matrix<3>
  product(const Matrix<3> &a, const Matrix<3> &b)
  {
    Matrix<3> result{};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k)
          result[i][j] += a[i][k] * b[k][j];
    return result;
  }



  void
  expect_near(const Matrix<3> &a, const Matrix<3> &b, const double tolerance)
  {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        EXPECT_NEAR(a[i][j], b[i][j], tolerance);
  }



  double
  square(const double x)
  {
    return x * x;
  }
} // namespace



TEST(SymmetricFunction, OfAPolynomialIsThePolynomial)
{
  Random random;
  for (int k = 0; k < 100; ++k)
    {
      const auto a = random_symmetric(random);
      expect_near(symmetric_function(a, [](const double x) { return x; }),
                  a,
                  1e-14);
      expect_near(symmetric_function(a, square), product(a, a), 1e-14);
    }
}



TEST(SymmetricFunction, LogarithmUndoesTheExponential)
{
  Random     random;
  const auto exponential = [](const double x) { return std::exp(x); };
  const auto logarithm   = [](const double x) { return std::log(x); };
  for (int k = 0; k < 100; ++k)
    {
      auto a = random_symmetric(random);
      if (k % 3 == 0) // plane
        a[0][2] = a[2][0] = a[1][2] = a[2][1] = 0;
      expect_near(symmetric_function(symmetric_function(a, exponential),
                                     logarithm),
                  a,
                  2e-14);
    }
}



// Where directions are not unique, and where they nearly are not.
TEST(SymmetricFunction, EqualEigenvaluesDoNoHarm)
{
  for (const double difference : {0., 1e-17, 1e-12, 1e-8})
    {
      Matrix<3> a{};
      for (int d = 0; d < 3; ++d)
        a[d][d] = 3;
      a[0][1] = a[1][0] = difference;
      a[1][2] = a[2][1] = -difference;
      expect_near(symmetric_function(a, square), product(a, a), 1e-14);
    }
}
