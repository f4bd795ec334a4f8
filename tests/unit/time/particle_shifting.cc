// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/particle_shifting.h>

#include <gtest/gtest.h>
#include <support/scene_run.h>

#include <algorithm>
#include <cmath>

/** @file Points of liquids that spread evenly (ParticleShifting). */

using namespace limber;

namespace
{
  /** Water that fills the lower half of a box of cells of 1/8 m. */
  std::string
  half_full_box(const int dim, const std::string &more = "")
  {
    const bool in_3d = dim == 3;
    return "set Dimension = " + std::to_string(dim) +
           "\nset End time = 10\nset Bodies = water\nsubsection Body water\n"
           " set Shape = box\n subsection Box\n set Lower corner = 0, 0" +
           (in_3d ? ", 0" : "") + "\n set Upper corner = 1, 0.5" +
           (in_3d ? ", 0.5" : "") +
           "\n end\n set Points per cell edge = 3\n"
           " set Material = newtonian fluid\n"
           " subsection Newtonian fluid\n set Density = 1000\n"
           " set Bulk modulus = 1e6\n end\n" +
           more + "end\nsubsection Grid\n set Upper corner = 1, 1" +
           (in_3d ? ", 0.5" : "") + "\n set Cells = 8, 8" +
           (in_3d ? ", 4" : "") + "\nend\nsubsection Loads\n" +
           " set Gravity = 0, -9.81" + (in_3d ? ", 0" : "") + "\nend\n";
  }



  /** Draw points together around x = 1/2, by a 33rd of what they hold there. */
  template <int dim>
  void
  gather(SceneRun<dim> &run)
  {
    const PointView<dim> points = run.points();
    for (std::size_t p = 0; p < points.size; ++p)
      {
        double &x = points.position[0][p];
        x += 0.03 / (2 * M_PI) * std::sin(2 * M_PI * x);
        std::array<double, dim> place;
        for (int d = 0; d < dim; ++d)
          place[d] = points.position[d][p];
        points.cell[p] = run.nodes.view().bins.cell_at(place);
      }
    run.integrator.reinit();
  }



  /**
   * Root mean square of what is in columns along x, over the mean, less one;
   * with hat functions as wide as two cells.
   */
  template <int dim>
  double
  unevenness(SceneRun<dim> &run)
  {
    constexpr unsigned int    n = 8;
    std::array<double, n + 1> sums{};
    const PointView<dim>      points = run.points();
    for (std::size_t p = 0; p < points.size; ++p)
      {
        const double x = points.position[0][p] * n;
        const auto   k = static_cast<unsigned int>(x);
        sums[k] += k + 1 - x;
        sums[k + 1] += x - k;
      }
    double result = 0;
    for (unsigned int k = 0; k <= n; ++k)
      {
        const double nodal_volume =
          points.size / double(n) * (k % n == 0 ? 0.5 : 1);
        result += std::pow(sums[k] / nodal_volume - 1, 2) / (n + 1);
      }
    return std::sqrt(result);
  }



  template <int dim>
  double
  potential_energy(SceneRun<dim> &run)
  {
    const PointView<dim> points = run.points();
    double               result = 0;
    for (std::size_t p = 0; p < points.size; ++p)
      result += 9.81 * points.mass[p] * points.position[1][p];
    return result;
  }



  template <int dim>
  void
  expect_to_spread()
  {
    SceneRun<dim> run(half_full_box(dim));
    gather(run);
    const RunParts<dim> parts{
      run.problem, run.grid, run.nodes, run.bodies, run.ledger};
    const double before = unevenness(run), energy = potential_energy(run);
    const double removed = run.ledger.history;
    ASSERT_GT(before, 0.015);

    ParticleShifting<dim> shifting(parts, nullptr);
    EXPECT_FALSE(shifting.is_due());
    for (unsigned int time = 0; time < 20; ++time)
      {
        shifting.follow(0.205);
        ASSERT_TRUE(shifting.is_due());
        shifting.shift();
        EXPECT_FALSE(shifting.is_due());
        run.integrator.reinit();
      }
    // inside alone: at the surface half of the rows have no say
    EXPECT_LT(unevenness(run), 0.6 * before);
    EXPECT_NEAR(run.ledger.history - removed,
                energy - potential_energy(run),
                1e-12 * energy);
    const PointView<dim> points = run.points();
    for (std::size_t p = 0; p < points.size; ++p)
      for (int d = 0; d < dim; ++d)
        {
          EXPECT_GT(points.position[d][p], 0);
          EXPECT_LT(points.position[d][p], 1);
        }
  }
} // namespace



TEST(ParticleShifting, SpreadsWhatHasGathered)
{
  expect_to_spread<2>();
  expect_to_spread<3>();
}



// A shift serves a way of 0.42 / C = 0.21 cells; what is left of a longer one
// counts for the next.
TEST(ParticleShifting, LongWaysLeaveSomethingToShift)
{
  SceneRun<2>       run(half_full_box(2));
  const RunParts<2> parts{
    run.problem, run.grid, run.nodes, run.bodies, run.ledger};
  ParticleShifting<2> shifting(parts, nullptr);
  shifting.follow(0.3);
  shifting.shift();
  EXPECT_NEAR(shifting.way_since(), 0.09, 1e-12);
  EXPECT_FALSE(shifting.is_due());
  shifting.follow(0.12);
  EXPECT_TRUE(shifting.is_due());
  shifting.shift();
  EXPECT_NEAR(shifting.way_since(), 0, 1e-12);
}



// Water that takes 3 percent less height than it should has no gradient to
// follow, but rises; not quite, as nodes right below the surface have no say.
template <int dim>
void
expect_to_rise()
{
  SceneRun<dim> run(half_full_box(dim));
  const double  right = potential_energy(run);
  {
    const PointView<dim> points = run.points();
    for (std::size_t p = 0; p < points.size; ++p)
      points.position[1][p] *= 0.97;
  }
  run.integrator.reinit();
  const RunParts<dim> parts{
    run.problem, run.grid, run.nodes, run.bodies, run.ledger};
  const double          lost = right - potential_energy(run);
  ParticleShifting<dim> shifting(parts, nullptr);
  for (unsigned int time = 0; time < 10; ++time)
    {
      shifting.follow(0.2);
      shifting.shift();
      run.integrator.reinit();
    }
  EXPECT_LT(right - potential_energy(run), 0.15 * lost); // else 0.55
  EXPECT_GT(right - potential_energy(run), -0.1 * lost);
}



TEST(ParticleShifting, MakesRoomForAnEvenExcess)
{
  expect_to_rise<2>();
  expect_to_rise<3>();
}



// A lid that has sunk half a cell into the water presses it aside, to where the
// surface is free, and stays where it is.
template <int dim>
void
expect_to_go_aside()
{
  const std::string z = dim == 3 ? ", 0" : "", end = dim == 3 ? ", 0.5" : "";
  SceneRun<dim>     run(
    half_full_box(dim,
                  "set Frame = current\nend\nset Bodies = water, lid\n"
                      "subsection Body lid\n set Shape = box\n subsection Box\n"
                      " set Lower corner = 0, 0.4375" +
                    z + "\n set Upper corner = 0.5, 0.75" + end +
                    "\n end\n set Frame = current\n set Placement = cut\n"
                        " set Material = neo hookean\n"));
  const auto under_lid = [&]() {
    const auto points = run.points();
    double     mass   = 0;
    for (std::size_t p = 0; p < points.size; ++p)
      if (points.position[0][p] < 0.5 && points.position[1][p] > 0.4375)
        mass += points.mass[p];
    return mass;
  };
  const auto lid = run.positions(1);
  run.integrator.reinit();
  const RunParts<dim> parts{
    run.problem, run.grid, run.nodes, run.bodies, run.ledger};
  const double          before = under_lid();
  ParticleShifting<dim> shifting(parts, nullptr);
  for (unsigned int time = 0; time < 10; ++time)
    {
      shifting.follow(0.2);
      shifting.shift();
      run.integrator.reinit();
    }
  EXPECT_LT(under_lid(), 0.6 * before);
  const auto after = run.positions(1);
  for (std::size_t p = 0; p < lid.size(); ++p)
    EXPECT_EQ(lid[p], after[p]);
}



TEST(ParticleShifting, GoesAsideForSolids)
{
  expect_to_go_aside<2>();
  expect_to_go_aside<3>();
}



// Between a wall below and a surface four cells above it a source of 1 has the
// potential (16 - y^2) / 2, exactly so at the nodes, along the other axes none.
template <int dim>
void
expect_parabola()
{
  SceneRun<dim>           run(half_full_box(dim));
  const NodalFields<dim> &vertices = run.nodes.vertices();
  ShiftingPotential<dim>  potential(run.grid);
  potential.reinit();
  potential.clear(vertices);
  const double                    volume = std::pow(0.125, dim);
  std::vector<double>             nodal_volumes(run.grid.vertices.n());
  std::vector<dealii::Point<dim>> places(run.grid.vertices.n());
  for (const std::uint32_t cell : vertices.owned_occupied_cells())
    {
      const CellGeometry<dim> &geometry = run.grid.geometry[cell];
      potential.add_cell(cell, volume);
      for (unsigned int a = 0; a < 1 << dim; ++a)
        {
          const std::uint32_t node = geometry.node[a] / NodeLayout<dim>::stride;
          nodal_volumes[node] += volume / (1 << dim);
          for (int d = 0; d < dim; ++d)
            places[node][d] = geometry.origin[d] + 0.125 * (a >> d & 1);
        }
    }
  for (const std::uint32_t node : vertices.active_nodes())
    potential.set_source(node, nodal_volumes[node], places[node][1] > 0.49);
  potential.solve(vertices);
  for (const std::uint32_t node : vertices.active_nodes())
    {
      const double y = 8 * places[node][1];
      EXPECT_NEAR(potential.at(node), (16 - y * y) / 2, 0.04 * 8) << y;
    }
}



TEST(ShiftingPotential, GrowsBetweenAWallAndASurface)
{
  expect_parabola<2>();
  expect_parabola<3>();
}



// Stripes two cells wide, six points of nine in each second column having gone
// to the next one, which nodes do not notice.
template <int dim>
void
expect_stripes_to_fade(const std::vector<std::string> &settings)
{
  std::vector<std::string> all = settings;
  all.push_back(dim == 2 ? "Body water/Box/Upper corner=1, 1" :
                           "Body water/Box/Upper corner=1, 1, 0.5");
  SceneRun<dim> run(half_full_box(dim), all);
  {
    const PointView<dim> points = run.points();
    for (std::size_t p = 0; p < points.size; ++p)
      {
        double &x = points.position[0][p];
        if (x > 1. / 8 && x < 7. / 8)
          x += 0.25 / 8 * std::cos(8 * M_PI * x);
        std::array<double, dim> place;
        for (int d = 0; d < dim; ++d)
          place[d] = points.position[d][p];
        points.cell[p] = run.nodes.view().bins.cell_at(place);
      }
  }
  run.integrator.reinit();
  // over what it should be, in the inner columns
  const auto largest_column = [&]() {
    const PointView<dim>        points = run.points();
    std::array<unsigned int, 8> columns{};
    for (std::size_t p = 0; p < points.size; ++p)
      ++columns[static_cast<unsigned int>(8 * points.position[0][p])];
    return 8. / points.size *
           *std::max_element(columns.begin() + 2, columns.end() - 2);
  };
  ASSERT_GT(largest_column(), 1.6);

  const RunParts<dim> parts{
    run.problem, run.grid, run.nodes, run.bodies, run.ledger};
  ParticleShifting<dim> shifting(parts, nullptr);
  for (unsigned int time = 0; time < 20; ++time)
    {
      shifting.follow(0.25);
      shifting.shift();
      run.integrator.reinit();
    }
  EXPECT_LT(largest_column(), 1.1);
}



TEST(ParticleShifting, EvensOutStripes)
{
  expect_stripes_to_fade<2>({});
  expect_stripes_to_fade<3>({});
  for (const std::string treatment : {"cell", "node"})
    expect_stripes_to_fade<2>(
      {"Method/Kernel=quadratic", "Body water/Locking treatment=" + treatment});
}



// Evenly spread points stay where they are, to the last bit.
TEST(ParticleShifting, LeavesWhatIsEven)
{
  SceneRun<2>       run(half_full_box(2));
  const RunParts<2> parts{
    run.problem, run.grid, run.nodes, run.bodies, run.ledger};
  ParticleShifting<2> shifting(parts, nullptr);
  const auto          before = run.positions();
  shifting.follow(1);
  shifting.shift();
  const auto after = run.positions();
  for (std::size_t p = 0; p < before.size(); ++p)
    EXPECT_LT(after[p].distance(before[p]), 1e-14);
}



TEST(ParticleShifting, IsSwitchedOff)
{
  SceneRun<2>       run(half_full_box(2, " set Particle shifting = 0\n"));
  const RunParts<2> parts{
    run.problem, run.grid, run.nodes, run.bodies, run.ledger};
  ParticleShifting<2> shifting(parts, nullptr);
  shifting.follow(1);
  EXPECT_FALSE(shifting.is_due());
}



// A tank that is stirred keeps its volume; without shifting it sinks by 3.4
// percent.
TEST(ParticleShifting, KeepsTheVolumeOfStirredWater)
{
  const auto sinks_by = [](const std::string &shifting) {
    SceneRun<2>  run(half_full_box(2),
                    {"Body water/Box/Upper corner=1, 1",
                      "Body water/Initial velocity=0.1*sin(29*x+13*y*y); "
                       "0.1*cos(31*x*y-9*y)",
                      "Body water/Initial pressure=hydrostatic",
                      "Body water/Density control=0",
                      "Body water/Particle shifting=" + shifting,
                      "Grid/Upper corner=1, 1.5",
                      "Grid/Cells=8, 12"});
    const double before = potential_energy(run);
    run.advance_to(12);
    return 1 - potential_energy(run) / before;
  };
  EXPECT_GT(sinks_by("0"), 0.02);
  EXPECT_LT(std::abs(sinks_by("auto")), 0.005);
}
