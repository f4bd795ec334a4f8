// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/envelope_cholesky.h>
#include <limber/time/pressure_solver.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace limber;

namespace
{
  /**
   * Equations of the cells of a lattice with random couplings to the 8 cells
   * around; the sum of a row is @p excess. Cells of the column in the middle
   * stand alone, so that two parts are not connected.
   */
  PressureEquations
  lattice_equations(const std::uint32_t n_x,
                    const std::uint32_t n_y,
                    const double        excess)
  {
    constexpr unsigned int width = 9;
    PressureEquations      result;
    result.n_all = result.n = n_x * n_y;
    result.width            = width;
    result.columns.assign(result.n * width, PressureEquations::no_column);
    result.values.assign(result.n * width, 0.);
    std::mt19937                           engine(1);
    std::uniform_real_distribution<double> random(0.1, 1);
    for (std::uint32_t row = 0; row < result.n; ++row)
      {
        result.columns[row * width + 4] = row;
        result.values[row * width + 4]  = excess;
      }
    for (std::uint32_t row = 0; row < result.n; ++row)
      for (unsigned int place = 5; place < width; ++place)
        {
          const int x = int(row % n_x) + int(place % 3) - 1,
                    y = int(row / n_x) + int(place / 3) - 1;
          if (x < 0 || x >= int(n_x) || y >= int(n_y) || row % n_x == n_x / 2 ||
              x == int(n_x / 2))
            continue;
          const std::uint32_t other                 = y * n_x + x;
          const double        value                 = random(engine);
          result.columns[row * width + place]       = other;
          result.values[row * width + place]        = -value;
          result.columns[other * width + 8 - place] = row;
          result.values[other * width + 8 - place]  = -value;
          result.values[row * width + 4] += value;
          result.values[other * width + 4] += value;
        }
    return result;
  }



  std::vector<double>
  product(const PressureEquations &equations, const std::vector<double> &x)
  {
    std::vector<double> result(equations.n, 0.);
    for (std::size_t at = 0; at < equations.columns.size(); ++at)
      if (equations.columns[at] != PressureEquations::no_column)
        result[at / equations.width] +=
          equations.values[at] * x[equations.columns[at]];
    return result;
  }
} // namespace



TEST(EnvelopeCholesky, SolvesEquationsOfALattice)
{
  const auto       equations = lattice_equations(31, 12, 1e-3);
  EnvelopeCholesky factor;
  // A search from one end meets columns of 12 cells, one after the other: no
  // row begins more than three of them before its end.
  EXPECT_LE(factor.set_pattern(equations), 0.5 * 36 * 36 * equations.n);
  ASSERT_TRUE(factor.factorise(equations));
  std::vector<double> exact(equations.n);
  for (std::uint32_t row = 0; row < equations.n; ++row)
    exact[row] = std::sin(row);
  std::vector<double> solution = product(equations, exact);
  factor.solve(solution);
  for (std::uint32_t row = 0; row < equations.n; ++row)
    EXPECT_NEAR(solution[row], exact[row], 1e-9);
}



// The pressure of a closed vessel is known but for a constant.
TEST(EnvelopeCholesky, TellsWhatHasNoFactor)
{
  const auto       equations = lattice_equations(31, 12, -1e-3);
  EnvelopeCholesky factor;
  factor.set_pattern(equations);
  EXPECT_FALSE(factor.factorise(equations));
}



TEST(PressureSolver, UsesAFactorOnce)
{
  auto                equations = lattice_equations(31, 12, 1e-3);
  std::vector<double> exact(equations.n, 1.), solution(equations.n, 0.);
  equations.right_side = product(equations, exact);
  PressureSolver solver(MPI_COMM_SELF);
  solver.set_pattern(equations);
  EXPECT_EQ(solver.solve(equations, 1e-10, solution), 1u);
  for (std::uint32_t row = 0; row < equations.n; ++row)
    EXPECT_NEAR(solution[row], 1, 1e-7);
}
