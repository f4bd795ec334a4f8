// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <support/scene_run.h>

/**
 * @file Manufactured solutions of linear elasticity on the unit square between
 * slip walls, U(x, y) sin(w t) with w = pi sqrt(E / rho):
 *
 *   along the axes  U = A (sin(2 pi x), -sin(2 pi y))
 *   coupled         U = A (sin(pi x) cos(pi y), 1/2 cos(pi x) sin(pi y))
 *
 * with the body force that they need. In the first a cell has one divergence
 * only; the second has shear and a divergence that the treatment averages.
 * Neo-Hookean differs by O(A^2), and A is too small for any point to change
 * cell.
 */

using namespace limber;

namespace
{
  constexpr double pi        = dealii::numbers::PI;
  constexpr double amplitude = 1e-6, end_time = 0.4;

  // rho = E = 1
  const std::string square = R"(
    set Bodies = square
    subsection Body square
      subsection Box
        set Upper corner = 1, 1
      end
      set Constants = A = 1e-6
      subsection Linear elastic
        set Density = 1
        set Young's modulus = 1
      end
      subsection Neo hookean
        set Density = 1
        set Young's modulus = 1
      end
    end)";



  struct Solution
  {
    std::string                                                   ux, uy;
    std::string                                                   bx, by;
    std::function<dealii::Tensor<1, 2>(const dealii::Point<2> &)> shape;
  };



  // b = U_tt - div sigma(U), with mu and M = lambda + 2 mu
  const Solution along_axes = {"sin(2*pi*x)",
                               "-sin(2*pi*y)",
                               "(4*M - 1)*sin(2*pi*x)",
                               "-(4*M - 1)*sin(2*pi*y)",
                               [](const dealii::Point<2> &p) {
                                 return dealii::Tensor<1, 2>(
                                   {std::sin(2 * pi * p[0]),
                                    -std::sin(2 * pi * p[1])});
                               }};

  const Solution coupled = {"sin(pi*x)*cos(pi*y)",
                            "0.5*cos(pi*x)*sin(pi*y)",
                            "(2*mu - 1 + 1.5*(M - mu))*sin(pi*x)*cos(pi*y)",
                            "(mu - 0.5 + 1.5*(M - mu))*cos(pi*x)*sin(pi*y)",
                            [](const dealii::Point<2> &p) {
                              return dealii::Tensor<1, 2>(
                                {std::sin(pi * p[0]) * std::cos(pi * p[1]),
                                 0.5 * std::cos(pi * p[0]) *
                                   std::sin(pi * p[1])});
                            }};



  /** Root mean square error of the displacement over the amplitude. */
  double
  error(const Solution    &solution,
        const std::string &law,
        const std::string &treatment,
        const std::string &order,
        const double       nu,
        const unsigned int n)
  {
    const double mu = 0.5 / (1 + nu);
    const double M  = (1 - nu) / ((1 + nu) * (1 - 2 * nu));
    SceneRun<2>  run(
      square,
      {"Grid/Cells=" + std::to_string(n) + ", " + std::to_string(n),
        "Body square/Material=" + law,
        "Body square/Locking treatment=" + treatment,
        "Method/Stress update=" + order,
        "Body square/Linear elastic/Poisson's ratio=" + digits(nu),
        "Body square/Neo hookean/Poisson's ratio=" + digits(nu),
        "Body square/Initial velocity=A*pi*" + solution.ux + "; A*pi*(" +
          solution.uy + ")",
        "Loads/Constants=A = 1e-6, mu = " + digits(mu) + ", M = " + digits(M),
        "Loads/Body force=A*pi^2*sin(pi*t)*" + solution.bx +
          "; A*pi^2*sin(pi*t)*(" + solution.by + ")"});

    const auto start = run.positions();
    // dt ~ h^2, for the first order in time not to show, or dt ~ h
    const unsigned int n_steps =
      std::lround((order == "usavg" ? 5 : 0.45 * n) * n * std::sqrt(M));
    run.advance(end_time / n_steps, n_steps);
    const auto end = run.positions();
    double     sum = 0;
    for (std::size_t p = 0; p < start.size(); ++p)
      sum += ((end[p] - start[p]) / amplitude -
              std::sin(pi * end_time) * solution.shape(start[p]))
               .norm_square();
    return std::sqrt(sum / start.size());
  }



  void
  expect_second_order(const Solution    &solution,
                      const std::string &law,
                      const std::string &treatment,
                      const double       nu)
  {
    for (const std::string order : {"musl", "usavg"})
      {
        SCOPED_TRACE(law + ", " + treatment + ", " + order +
                     ", nu = " + digits(nu));
        std::vector<double> e;
        for (const unsigned int n : {8u, 16u, 32u})
          e.push_back(error(solution, law, treatment, order, nu, n));
        EXPECT_GE(e[0] / e[1], 3.2);
        EXPECT_GE(e[1] / e[2], 3.2);
      }
  }
} // namespace



TEST(ManufacturedSolution, SecondOrderAlongTheAxes)
{
  for (const std::string law : {"linear elastic", "neo hookean"})
    for (const std::string treatment : {"none", "cell"})
      expect_second_order(along_axes, law, treatment, 0.3);
}



TEST(ManufacturedSolution, SecondOrderWithShearAndCoupling)
{
  for (const std::string law : {"linear elastic", "neo hookean"})
    for (const std::string treatment : {"none", "cell"})
      expect_second_order(coupled, law, treatment, 0.3);
}
