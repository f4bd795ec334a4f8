// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <support/scene_run.h>

/**
 * @file A manufactured solution on the unit square between slip walls:
 *
 *   u = A sin(2 pi x) sin(c pi t),  v = -A sin(2 pi y) sin(c pi t)
 *
 * with c^2 = E / rho. Linear elasticity needs the body force b_x = pi^2 u
 * (4 (lambda + 2 mu) / rho - c^2), b_y likewise; neo-Hookean differs by
 * O(A^2), and A is too small for any point to change cell.
 */

using namespace limber;

namespace
{
  constexpr double pi = dealii::numbers::PI;
  constexpr double amplitude = 1e-6, end_time = 0.4;

  // E = rho = 1, nu = 0.3: lambda + 2 mu = 0.7 / (1.3 * 0.4)
  const std::string square = R"(
    set Bodies = square
    subsection Body square
      subsection Box
        set Upper corner = 1, 1
      end
      set Initial velocity = 1e-6*pi*sin(2*pi*x); -1e-6*pi*sin(2*pi*y)
      subsection Linear elastic
        set Density = 1
        set Young's modulus = 1
        set Poisson's ratio = 0.3
      end
      subsection Neo hookean
        set Density = 1
        set Young's modulus = 1
        set Poisson's ratio = 0.3
      end
    end
    subsection Loads
      set Constants = A = 1e-6, M = 1.3461538461538463
      set Body force = A*pi^2*(4*M-1)*sin(2*pi*x)*sin(pi*t); -A*pi^2*(4*M-1)*sin(2*pi*y)*sin(pi*t)
    end)";



  /** Root mean square error of the displacement over the amplitude. */
  double
  error(const std::string &law, const std::string &treatment, unsigned int n)
  {
    const std::string cells = std::to_string(n) + ", " + std::to_string(n);
    SceneRun<2>       run(square,
                    {"Grid/Cells=" + cells,
                           "Body square/Material=" + law,
                           "Body square/Locking treatment=" + treatment});
    const auto        start   = run.positions();
    const unsigned int n_steps = n * n / 2; // dt ~ h^2, for order one in time
    run.advance(end_time / n_steps, n_steps);
    const auto   end   = run.positions();
    const double scale = std::sin(pi * end_time);
    double       sum   = 0;
    for (std::size_t p = 0; p < start.size(); ++p)
      {
        const dealii::Tensor<1, 2> exact({scale * std::sin(2 * pi * start[p][0]),
                                          -scale *
                                            std::sin(2 * pi * start[p][1])});
        sum += ((end[p] - start[p]) / amplitude - exact).norm_square();
      }
    return std::sqrt(sum / start.size());
  }
} // namespace



TEST(ManufacturedSolution, SecondOrderInSpace)
{
  for (const std::string law : {"linear elastic", "neo hookean"})
    for (const std::string treatment : {"none", "cell"})
      {
        SCOPED_TRACE(law + ", " + treatment);
        std::vector<double> e;
        for (const unsigned int n : {8u, 16u, 32u})
          e.push_back(error(law, treatment, n));
        printf("%s %s: %.3e %.3e %.3e ratios %.2f %.2f\n",law.c_str(),treatment.c_str(), e[0],e[1],e[2],e[0]/e[1],e[1]/e[2]);
        EXPECT_GE(e[0] / e[1], 3.2);
        EXPECT_GE(e[1] / e[2], 3.2);
      }
}
