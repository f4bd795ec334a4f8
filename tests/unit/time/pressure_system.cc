// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/pressure_system.h>

#include <gtest/gtest.h>
#include <support/scene_run.h>

/**
 * @file The equations of the implicit pressure, as PressureSystem makes them of
 * the cells and nodes of a step: what doc/theory/implicit_pressure.md says of
 * their operators.
 */

using namespace limber;

namespace
{
  /** A block of water of these edges (cells of 1 m), in space on all sides. */
  template <int dim>
  std::string
  water_block(const std::string &upper)
  {
    const std::string cells = dim == 2 ? "8, 8" : "6, 6, 6";
    std::string       sides;
    for (const char *const side :
         {"left", "right", "bottom", "top", "front", "back"})
      if (dim == 3 ||
          (std::string(side) != "front" && std::string(side) != "back"))
        sides += " set " + std::string(side) + " = free\n";
    return std::string(dim == 2 ? "" : "set Dimension = 3\n") + R"(
    set Bodies = water
    subsection Body water
      subsection Box
        set Lower corner = )" +
           (dim == 2 ? "1, 1" : "1, 1, 1") + R"(
        set Upper corner = )" +
           upper + R"(
      end
      set Points per cell edge = 2
      set Placement = cut
      set Material = newtonian fluid
      subsection Newtonian fluid
        set Density = 1000
        set Bulk modulus = 1e8
      end
      set Locking treatment = cell
      set Hourglass control = 0
      set Density control = 0
    end
    subsection Grid
      set Upper corner = )" +
           cells + R"(
      set Cells = )" +
           cells + R"(
    end
    subsection Boundaries
)" + sides +
           R"(
    end
    subsection Method
      set Time integration = semi-implicit
    end)";
  }



  constexpr double dt = 0.05; // s



  /** The equations of a step of such a scene, from its beginning. */
  template <int dim>
  class EquationsOfStep
  {
  public:
    explicit EquationsOfStep(const std::string              &scene,
                             const std::vector<std::string> &changes = {})
      : run(scene, changes)
      , boundaries(run.problem.sides)
      , cells({run.problem, run.grid, run.nodes, run.bodies, run.ledger},
              nullptr)
      , system({run.problem, run.grid, run.nodes, run.bodies, run.ledger},
               boundaries,
               cells)
    {
      run.advance(dt); // leaves masses of nodes and sums of cells behind
      cells.update();
      system.find_columns();
      system.assemble(dt, dt, 1);
    }

    const typename PressureCells<dim>::Medium &
    water() const
    {
      return cells.media[0];
    }

    bool
    is_full(const std::uint32_t cell) const
    {
      return water().record(cell)[PressureCells<dim>::Record::volume] > 0;
    }

    /** The matrix by rows and columns. */
    std::vector<std::vector<double>>
    matrix() const
    {
      const auto                      &e = system.equations;
      std::vector<std::vector<double>> result(e.n, std::vector<double>(e.n));
      for (std::uint32_t row = 0; row < e.n; ++row)
        for (unsigned int k = 0; k < e.width; ++k)
          if (const auto column = e.columns[row * e.width + k];
              column != PressureEquations::no_column)
            result[row][column] += e.values[row * e.width + k];
      return result;
    }

    /** gamma T of a pressure that depends on the middle of the cell, by rows,
     * over the largest entry of gamma T P of one cell of pressure one. */
    template <class Pressure>
    double
    largest_flux(const Pressure &pressure)
    {
      auto &medium = cells.media[0];
      for (const std::uint32_t cell : medium.cells)
        medium.result(cell)[PressureCells<dim>::Result::pressure] =
          pressure(middle(cell));
      double result = 0;
      for (const std::uint32_t cell : medium.cells)
        if (is_full(cell))
          result = std::max(result, std::abs(system.flux(0, cell)));
      return result;
    }

    dealii::Point<dim>
    middle(const std::uint32_t cell) const
    {
      const CellGeometry<dim> &geometry = run.grid.geometry[cell];
      dealii::Point<dim>       result;
      for (int d = 0; d < dim; ++d)
        result[d] = geometry.origin[d] + 0.5 / geometry.inverse_edge[d];
      return result;
    }

    SceneRun<dim>           run;
    BoundaryConditions<dim> boundaries;
    PressureCells<dim>      cells;
    PressureSystem<dim>     system;
  };



  template <int dim>
  void
  expect_symmetric(const std::string &upper)
  {
    const EquationsOfStep<dim> step(water_block<dim>(upper));
    const auto                 S = step.matrix();
    for (std::size_t i = 0; i < S.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        ASSERT_NEAR(S[i][j], S[j][i], 1e-15 * std::sqrt(S[i][i] * S[j][j]));
  }



  /** T of pressures that do not alternate in two directions at once. */
  template <int dim>
  void
  expect_silence(const std::string &upper)
  {
    EquationsOfStep<dim> step(water_block<dim>(upper));
    using Place       = dealii::Point<dim>;
    const double seen = step.largest_flux(
      [](const Place &x) { return int(x[0]) % 2 == int(x[1]) % 2 ? 1. : -1.; });
    const auto share = [&](const auto &pressure) {
      return step.largest_flux(pressure) / seen;
    };
    ASSERT_GT(seen, 0);
    EXPECT_LT(share([](const Place &) { return 1; }), 1e-15);
    EXPECT_LT(share([](const Place &x) { return x[0] - 0.3 * x[1]; }), 1e-14);
    EXPECT_LT(share([](const Place &x) {
                return x[0] * x[0] - 2 * std::pow(x[dim - 1], 3);
              }),
              1e-12);
    EXPECT_GT(share([](const Place &x) { return x[0] * x[1]; }), 1e-2);
  }



  /** With gamma = 1 the row of a cell with full cells around is the Laplacian
   * of its 2 dim neighbours. */
  template <int dim>
  void
  expect_compact(const std::string &upper, const dealii::Point<dim> &centre)
  {
    const EquationsOfStep<dim> step(water_block<dim>(upper),
                                    {"Body water/Checkerboard control=1"});
    const auto                 S     = step.matrix();
    const auto                &cells = step.water().cells;
    // dt^2 m / (rho h)^2, and C = V / K
    const double unit = dt * dt / 1000, compliance = 1. / 1e8;
    std::size_t  row = 0;
    while (step.middle(cells.at(row)).distance(centre) > 1e-9)
      ++row;
    for (std::size_t k = 0; k < cells.size(); ++k)
      {
        const double distance = step.middle(cells[k]).distance(centre);
        const double expected = distance < 1e-9 ? 2 * dim * unit + compliance :
                                std::abs(distance - 1) < 1e-9 ? -unit :
                                                                0;
        // points have moved by nothing; the density is that of the start
        ASSERT_NEAR(S[row][k], expected, 1e-13 * unit) << step.middle(cells[k]);
      }
  }
  /** Fine cells in one half, so that nodes hang between. */
  const std::vector<std::string> two_sizes = {
    "Body water/Checkerboard control=0",
    "Grid/Levels=1",
    "Grid/Refine=part",
    "Grid/Refine part/Upper corner=3, 8"};



  /**
   * The matrix, column by column, is what the tables of hanging nodes make of
   * the rows B of cells, those by which explicit steps go too: forces of one
   * pressure on corners go to masters, what these get of velocity to corners.
   */
  void
  expect_masters_in_equations()
  {
    using Record = PressureCells<2>::Record;
    const EquationsOfStep<2> step(water_block<2>("5.3, 4.6"), two_sizes);
    const auto               S     = step.matrix();
    const auto              &water = step.water();
    const NodeTable<2>      &table = step.run.nodes.table;
    ASSERT_GT(table.hanging.size(), 0u);
    unsigned int hanging = 0; // entries that go through them
    for (std::size_t column = 0; column < S.size(); ++column)
      {
        std::vector<double> at_nodes(2 * table.n());
        const auto          for_each_entry = [&](const std::size_t row,
                                        const auto       &work) {
          const std::uint32_t cell = water.cells[row];
          if (step.is_full(cell))
            for (unsigned int a = 0; a < 4; ++a)
              for (unsigned int d = 0; d < 2; ++d)
                work(at_nodes[2 * step.cells.node_of(cell, a) + d],
                     water.record(cell)[Record::rows + 2 * a + d]);
        };
        for_each_entry(column, [](double &force, const double entry) {
          force += entry;
        });
        for (const HangingNode &node : table.hanging)
          hanging += at_nodes[2 * node.node] != 0;
        table.give_to_masters(at_nodes.data(), 2, 0, 2);
        for (std::uint32_t node = 0; node < table.n(); ++node)
          for (unsigned int d = 0; d < 2; ++d)
            {
              const double mass =
                step.run.nodes.record(node)[NodeLayout<2>::mass];
              at_nodes[2 * node + d] *= mass > 0 ? dt / mass : 0;
            }
        table.take_from_masters(at_nodes.data(), 2, 0, 2);
        for (std::size_t row = 0; row < S.size(); ++row)
          {
            double expected =
              row == column ? step.system.former[row].compliance : 0;
            for_each_entry(row,
                           [&](const double &velocity, const double entry) {
                             expected += dt * entry * velocity;
                           });
            ASSERT_NEAR(S[row][column],
                        expected,
                        1e-13 * std::sqrt(S[row][row] * S[column][column]));
          }
      }
    EXPECT_GT(hanging, 5u);
  }
} // namespace



TEST(PressureSystem, PushesTheMastersOfHangingNodes)
{
  expect_masters_in_equations();
}



TEST(PressureSystem, IsSymmetricOverLevels)
{
  auto changes = two_sizes;
  changes[0]   = "Body water/Checkerboard control=1";
  const EquationsOfStep<2> step(water_block<2>("5.3, 4.6"), changes);
  const auto               S = step.matrix();
  for (std::size_t i = 0; i < S.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      ASSERT_NEAR(S[i][j], S[j][i], 1e-14 * std::sqrt(S[i][i] * S[j][j]));
}



TEST(PressureSystem, IsSymmetric)
{
  expect_symmetric<2>("5.3, 4.6");
  expect_symmetric<3>("3.3, 3.6, 4.1");
}



TEST(PressureSystem, ControlIsBlindToPressuresOfOneDirectionAtATime)
{
  expect_silence<2>("6, 5");
  expect_silence<3>("4, 5, 4");
}



TEST(PressureSystem, ControlMakesTheLaplacianCompact)
{
  expect_compact<2>("6, 6", {3.5, 3.5});
  expect_compact<3>("6, 6, 6", {3.5, 3.5, 3.5});
}



// The divergences of all cells, weighed with their volumes, are what crosses
// the surface: the mean of neighbouring nodes times their distance, as
// functions are linear between them.
TEST(PressureSystem, DivergencesSumUpToTheFluxThroughTheSurface)
{
  using Layout = NodeLayout<2>;
  EquationsOfStep<2> step(
    water_block<2>("6, 5"),
    {"Body water/Initial velocity=0.02*x*y; 0.02*sin(x)*y*y"});
  double volume = 0, change = 0;
  for (std::size_t p = 0; p < step.run.points().size; ++p)
    {
      const double of_point = step.run.points().mass[p] / 1000;
      volume += of_point;
      change += of_point * (step.run.points().history[0][p] - 1);
    }
  double      flux = 0;
  const auto &grid = step.run.grid;
  for (const std::uint32_t cell : step.water().cells)
    if (step.is_full(cell))
      for (unsigned int d = 0; d < 2; ++d)
        for (const int side : {0, 1})
          {
            auto beyond = step.middle(cell);
            beyond[d] += side ? 1 : -1;
            const auto other = grid.bins.cell_at({{beyond[0], beyond[1]}});
            if (step.is_full(other))
              continue;
            for (unsigned int k = 0; k < 4; ++k)
              if (int(k >> d & 1) == side)
                flux += (side ? 0.5 : -0.5) *
                        step.run.nodes.record(
                          step.cells.node_of(cell, k))[Layout::velocity + d];
          }
  EXPECT_NEAR(volume, 20, 1e-12);
  EXPECT_GT(std::abs(flux), 1e-6);
  EXPECT_NEAR(change, dt * flux, 1e-13 * volume);
}
