// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/adaptation/adaptation.h>
#include <limber/adaptation/cell_values.h>

#include <gtest/gtest.h>
#include <support/scene_run.h>

/**
 * @file The numbers per cell of criteria with a scale, against fields that are
 * known, and what is done with them.
 */

using namespace limber;

namespace
{
  /** A block in cells of two sizes, fine at a corner. */
  template <int dim>
  std::string
  block_of(const std::string &material)
  {
    const auto all = [](const std::string &value) {
      return dim == 2 ? value + ", " + value :
                        value + ", " + value + ", " + value;
    };
    return "set Dimension = " + std::to_string(dim) +
           "\nset Bodies = block\nsubsection Body block\nset Material = " +
           material + "\nsubsection Box\nset Lower corner = " + all("0.5") +
           "\nset Upper corner = " + all("2.5") +
           "\nend\nsubsection Linear elastic\nset Density = 2\n"
           "set Young's modulus = 1\nend\nsubsection J2\nset Density = 2\n"
           "set Young's modulus = 1\nset Yield stress = 1\nend\nend\n"
           "subsection Grid\nset Upper corner = " +
           all("4") + "\nset Cells = " + all("8") +
           "\nset Levels = 1\nset Refine = part, field\n"
           "subsection Refine part\nset Upper corner = " +
           all("1.5") +
           "\nend\nsubsection Refine field\nset Criterion = rate\n"
           "set Scale = 1e9\nend\nend\n";
  }



  /** The refinement 'field' of the scene, by another criterion. */
  template <int dim>
  Refinement<dim>
  field_of(const SceneRun<dim> &run, const RefinementCriterion criterion)
  {
    Refinement<dim> result = run.problem.grid.refinements[1];
    result.criterion       = criterion;
    return result;
  }



  // h |dev D| / c of a linear field, in cells of both sizes.
  template <int dim>
  void
  expect_rates(const std::string &placement)
  {
    SCOPED_TRACE(placement + ", " + std::to_string(dim));
    SceneRun<dim>          run(block_of<dim>("linear elastic"),
                      {"Body block/Placement=" + placement});
    dealii::Tensor<2, dim> gradient;
    for (int d = 0; d < dim; ++d)
      for (int e = 0; e < dim; ++e)
        gradient[d][e] = 0.3 * d - 0.7 * e + 0.2 * d * e + 0.1;
    const PointView<dim> points = run.points();
    for (std::size_t p = 0; p < points.size; ++p)
      {
        const dealii::Tensor<1, dim> v = gradient * run.position(p);
        for (int d = 0; d < dim; ++d)
          points.velocity[d][p] = 3 + v[d];
      }
    const auto   rate = symmetrize(gradient);
    const double norm = std::sqrt(rate * rate - trace(rate) * trace(rate) / 3);
    // E = 1, nu of the scene's default; rho = 2
    const double c =
      std::sqrt(run.bodies[0]->stress->wave_speed_squared(points));
    ASSERT_GT(c, 0.5);
    const auto values = cell_values(field_of(run, RefinementCriterion::rate),
                                    run.grid,
                                    run.bodies);
    std::vector<unsigned int> n_points(run.grid.n_cells()), seen(2);
    for (std::size_t p = 0; p < points.size; ++p)
      ++n_points[points.cell[p]];
    for (std::uint32_t cell = 0; cell < values.size(); ++cell)
      {
        const unsigned int level = run.grid.level_of(cell);
        const double       h     = 0.5 / (1u << level);
        if (n_points[cell] == 0)
          {
            EXPECT_EQ(values[cell], 0);
          }
        else
          {
            EXPECT_NEAR(values[cell], h * norm / c, 1e-12 * norm);
            ++seen[level];
          }
      }
    EXPECT_GT(seen[0], 0u);
    EXPECT_GT(seen[1], 0u);
  }
} // namespace



TEST(CellValues, RateOfALinearFieldIsExact)
{
  for (const std::string placement : {"regular", "jittered"})
    {
      expect_rates<2>(placement);
      expect_rates<3>(placement);
    }
}



// A step of the stress on a plane between cells, from fine to fine, from coarse
// to coarse and across the change of size.
TEST(CellValues, StressJumpsByTheNormOfTheStep)
{
  SceneRun<2>        run(block_of<2>("linear elastic"));
  const PointView<2> points = run.points();
  const double       step = 1.5, pressure = 2, xx = 0.3, yy = -0.5, xy = 0.7;
  for (std::size_t p = 0; p < points.size; ++p)
    {
      const double high     = run.position(p)[0] > step;
      points.pressure[p]    = 5 + pressure * high;
      points.deviator[0][p] = xx * high;
      points.deviator[1][p] = yy * high - 1;
      points.deviator[2][p] = xy * high;
    }
  const double zz      = -(xx + yy);
  const double norm    = std::sqrt(3 * pressure * pressure + xx * xx + yy * yy +
                                zz * zz + 2 * xy * xy);
  const auto   values  = cell_values(field_of(run, RefinementCriterion::stress),
                                  run.grid,
                                  run.bodies);
  unsigned int n_jumps = 0, n_of_level[2] = {0, 0};
  for (std::size_t p = 0; p < points.size; ++p)
    {
      const std::uint32_t cell  = points.cell[p];
      const auto         &edges = run.grid.geometry[cell];
      const double        left  = edges.origin[0];
      const double        right = left + 1 / edges.inverse_edge[0];
      const bool          touches =
        std::abs(left - step) < 1e-9 || std::abs(right - step) < 1e-9;
      EXPECT_NEAR(values[cell], touches ? norm : 0, 1e-12 * norm);
      n_jumps += touches;
      n_of_level[run.grid.level_of(cell)] += touches;
    }
  EXPECT_GT(n_jumps, 0u);
  EXPECT_GT(n_of_level[0], 0u);
  EXPECT_GT(n_of_level[1], 0u);
}



TEST(CellValues, PlasticStrainIsTheMeanByMass)
{
  SceneRun<2> run(
    block_of<2>("j2"),
    {"Body block/Initial state=equivalent plastic strain: 0.1*x"});
  const auto values =
    cell_values(field_of(run, RefinementCriterion::plastic_strain),
                run.grid,
                run.bodies);
  const PointView<2> points = run.points();
  for (std::size_t p = 0; p < points.size; ++p)
    {
      const auto  &edges  = run.grid.geometry[points.cell[p]];
      const double middle = edges.origin[0] + 0.5 / edges.inverse_edge[0];
      EXPECT_NEAR(values[points.cell[p]], 0.1 * middle, 1e-14);
    }
  // A body that has none counts as nothing.
  SceneRun<2> elastic(block_of<2>("linear elastic"));
  for (const double value :
       cell_values(field_of(elastic, RefinementCriterion::plastic_strain),
                   elastic.grid,
                   elastic.bodies))
    EXPECT_EQ(value, 0);
}



// Divided beyond the scale, level by level; kept down to a quarter of it;
// joined below, when two questions in a row have not wanted it.
TEST(CellValues, DivideAndJoinWithHysteresis)
{
  SceneRun<2>                     run(block_of<2>("j2"),
                  {"Grid/Levels=2",
                                       "Grid/Refine part/Lower corner=3.9, 3.9",
                                       "Grid/Refine part/Upper corner=4, 4",
                                       "Grid/Refine field/Criterion=plastic strain",
                                       "Grid/Refine field/Scale=0.01"});
  Adaptation<2>                   adaptation(run.problem, run.grid, run.bodies);
  const Adaptation<2>::KeptPoints kept(1);
  const auto                      finest_with = [&](const double strain) {
    double *const field =
      run.points().history[run.bodies[0]->stress->first_variable()];
    for (std::size_t p = 0; p < run.points().size; ++p)
      field[p] = strain;
    if (adaptation.adapt(0, kept))
      run.integrator.reinit();
    unsigned int finest = 0;
    for (std::size_t p = 0; p < run.points().size; ++p)
      finest =
        std::max<unsigned int>(finest, run.grid.level_of(run.points().cell[p]));
    return finest;
  };
  EXPECT_EQ(finest_with(0.0099), 0u);
  EXPECT_EQ(finest_with(0.0101), 1u);
  EXPECT_EQ(finest_with(0.0099), 1u);
  EXPECT_EQ(finest_with(0.0101), 2u);
  for (unsigned int k = 0; k < 3; ++k)
    EXPECT_EQ(finest_with(0.0026), 2u);
  EXPECT_EQ(finest_with(0.0024), 2u); // first question
  EXPECT_EQ(finest_with(0.0024), 1u);
  // sixteen points a cell now: coarser cells would hold 64
  for (unsigned int k = 0; k < 4; ++k)
    EXPECT_EQ(finest_with(0), 1u);
}
