// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <support/scene_run.h>

/**
 * @file Points that are hardly beyond a closed side are put back, as a node
 * without mass next to it may push them there; others are lost.
 */

using namespace limber;

namespace
{
  constexpr double edge = 0.1;

  /** Water fills the lower half of a box; one point, a fraction of a cell
   * beyond the left or the upper side, takes a step. What is left of it. */
  struct AfterAStep
  {
    std::size_t lost;
    double      x, y;
    double      mass_of_cells; // in the sums for the next step, kg
    double      put_back, way; // points; cells
  };



  AfterAStep
  step_from_beyond(const std::string &side,
                   const double       fraction,
                   const std::string &condition = "slip")
  {
    SceneRun<2> run(R"(
      set Bodies = water
      subsection Body water
        subsection Box
          set Upper corner = 1, 0.5
        end
        set Material = newtonian fluid
      end
      subsection Grid
        set Upper corner = 1, 0.5
        set Cells = 10, 5
      end)",
                    {"Boundaries/" + side + "=" + condition});
    const bool  left   = side == "left";
    std::size_t corner = 0;
    const auto  before = run.points();
    for (std::size_t p = 0; p < before.size; ++p)
      if (left ? before.position[0][p] < before.position[0][corner] :
                 before.position[1][p] > before.position[1][corner])
        corner = p;
    before.position[left ? 0 : 1][corner] =
      left ? -fraction * edge : 0.5 + fraction * edge;
    const std::size_t n = before.size;
    run.advance(1e-8);

    const auto after = run.points();
    AfterAStep result{n - after.size,
                      1,
                      0,
                      0,
                      run.totals().put_back,
                      run.totals().put_back_way};
    for (std::size_t p = 0; p < after.size; ++p)
      {
        result.x = std::min(result.x, after.position[0][p]);
        result.y = std::max(result.y, after.position[1][p]);
      }
    const auto sums = run.bodies.front()->cell_sums->view();
    for (std::uint32_t cell = 0; cell < run.grid.n_cells(); ++cell)
      result.mass_of_cells += sums.present_mass(cell);
    return result;
  }
} // namespace



TEST(ClosedSides, PutPointsBack)
{
  const double all = 1000 * 1 * 0.5; // kg
  for (const std::string condition : {"slip", "no slip", "separating"})
    {
      const auto left = step_from_beyond("left", 0.005, condition);
      EXPECT_EQ(left.lost, 0u) << condition;
      EXPECT_GE(left.x, 0);
      EXPECT_LT(left.x, 1e-5 * edge);
      EXPECT_NEAR(left.mass_of_cells, all, 1e-9);
      EXPECT_EQ(left.put_back, 1);
      EXPECT_NEAR(left.way, 0.005, 1e-5);
      const auto top = step_from_beyond("top", 0.005, condition);
      EXPECT_EQ(top.lost, 0u) << condition;
      EXPECT_LT(top.y, 0.5);
      EXPECT_GT(top.y, 0.5 - 1e-5 * edge);
      EXPECT_NEAR(top.mass_of_cells, all, 1e-9);
    }
}



// What is as far beyond as round-off makes it is put back and not counted.
TEST(ClosedSides, DoNotCountRoundOff)
{
  const auto rounded = step_from_beyond("left", 1e-12);
  EXPECT_EQ(rounded.lost, 0u);
  EXPECT_GE(rounded.x, 0);
  EXPECT_EQ(rounded.put_back, 0);
  EXPECT_EQ(step_from_beyond("top", 1e-6).put_back, 1);
}



TEST(ClosedSides, LosePointsThatAreFarBeyond)
{
  EXPECT_EQ(step_from_beyond("left", 0.02).lost, 1u);
  EXPECT_EQ(step_from_beyond("top", 0.02).lost, 1u);
  EXPECT_EQ(step_from_beyond("left", 0.005, "free").lost, 1u);
}
