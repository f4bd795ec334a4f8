// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/mpi.h>

#include <limber/adaptation/mesh_change.h>

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

/** @file Meshes as lists of divided cells, and the meshes made of them. */

using namespace limber;

namespace
{
  template <int dim>
  GridDescription<dim>
  box_with_levels(const unsigned int n, const unsigned int levels)
  {
    GridDescription<dim> result;
    for (int d = 0; d < dim; ++d)
      {
        result.lower[d] = -0.3;
        result.upper[d] = result.lower[d] + 0.7 * n;
        result.cells[d] = n;
      }
    result.levels = levels;
    return result;
  }



  /** Some cells of the finest but one level, and what grading adds. */
  template <int dim>
  RefinedCells<dim>
  random_mesh(const GridDescription<dim> &box, const unsigned int seed)
  {
    RefinedCells<dim> mesh(box.cells, box.levels);
    std::mt19937      random(seed);
    for (unsigned int k = 0; k < 3; ++k)
      {
        typename RefinedCells<dim>::Place place;
        for (int d = 0; d < dim; ++d)
          place[d] = random() % (box.cells[d] << (box.levels - 1));
        mesh.divide(box.levels - 1, place);
      }
    mesh.sum_over_ranks(MPI_COMM_SELF);
    mesh.grade(0);
    return mesh;
  }



  template <int dim>
  void
  expect_graded(const unsigned int n, const unsigned int levels)
  {
    const GridDescription<dim> box = box_with_levels<dim>(n, levels);
    BackgroundGrid<dim>        grid(box, MPI_COMM_WORLD);
    std::vector<std::unique_ptr<MaterialBody<dim>>> none;
    for (unsigned int seed = 1; seed < 6; ++seed)
      {
        const auto mesh = random_mesh(box, seed);
        change_mesh(grid, none, mesh);
        EXPECT_TRUE(grid.divided_cells() == mesh);

        // Round a cell that has been divided, everything is as fine as it was.
        double volume = 0;
        for (std::uint32_t c = 0; c < grid.n_owned_cells(); ++c)
          {
            double of_cell = 1;
            for (int d = 0; d < dim; ++d)
              of_cell /= grid.geometry[c].inverse_edge[d];
            volume += of_cell;
          }
        volume = dealii::Utilities::MPI::sum(volume, MPI_COMM_WORLD);
        EXPECT_NEAR(volume, std::pow(0.7 * n, dim), 1e-10);

        // Every place leads to the cell that holds it, or to none of this rank.
        std::mt19937 random(7);
        const auto   view = grid.view();
        for (unsigned int k = 0; k < 2000; ++k)
          {
            std::array<double, dim> x;
            for (int d = 0; d < dim; ++d)
              x[d] = box.lower[d] + 0.7 * n * random() / 4294967296.;
            const std::uint32_t cell = view.bins.cell_at(x);
            if (cell == invalid_cell)
              {
                EXPECT_GT(
                  dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD), 1u);
                continue;
              }
            for (int d = 0; d < dim; ++d)
              {
                const double xi = (x[d] - grid.geometry[cell].origin[d]) *
                                  grid.geometry[cell].inverse_edge[d];
                EXPECT_GE(xi, -1e-9);
                EXPECT_LE(xi, 1 + 1e-9);
              }
            EXPECT_EQ(view.bins.nearest_cell(x), cell);
          }

        // Hanging nodes lie where their masters say, and masters do not hang.
        std::map<std::uint32_t, dealii::Point<dim>> places;
        for (const auto &cell : grid.geometry)
          for (int i = 0; i < 1 << dim; ++i)
            for (int d = 0; d < dim; ++d)
              places[cell.node[i] / NodeLayout<dim>::stride][d] =
                cell.origin[d] + (i >> d & 1) / cell.inverse_edge[d];
        std::vector<bool> hangs(grid.vertices.n());
        for (const HangingNode &hanging : grid.vertices.hanging)
          hangs[hanging.node] = true;
        for (const HangingNode &hanging : grid.vertices.hanging)
          {
            dealii::Tensor<1, dim> sum;
            bool                   all_known = true;
            for (const auto &[master, weight] : hanging.masters)
              {
                EXPECT_FALSE(hangs[master]);
                all_known = all_known && places.count(master) > 0;
                if (all_known)
                  sum += weight * places[master];
              }
            if (all_known)
              {
                EXPECT_LT((sum - places.at(hanging.node)).norm(), 1e-12);
              }
          }
      }
  }
} // namespace



TEST(RefinedCells, MakeTheMeshThatTheyDescribe)
{
  expect_graded<2>(6, 1);
  expect_graded<2>(6, 3);
  expect_graded<2>(5, 4);
  expect_graded<3>(4, 2);
}



TEST(RefinedCells, GradingLeavesTwoCellsBetweenJumps)
{
  const GridDescription<2> box  = box_with_levels<2>(8, 3);
  const auto               mesh = random_mesh(box, 3);
  // A cell beside or across a corner of a divided one exists: its parent is
  // divided.
  unsigned int n_divided = 0;
  for (unsigned int level = 1; level < 3; ++level)
    for (unsigned int x = 0; x < 8u << level; ++x)
      for (unsigned int y = 0; y < 8u << level; ++y)
        if (mesh.is_divided(level, {{x, y}}))
          for (int i = -1; i <= 1; ++i)
            for (int j = -1; j <= 1; ++j, ++n_divided)
              {
                const unsigned int u = x + i, v = y + j;
                if (u < 8u << level && v < 8u << level)
                  {
                    EXPECT_TRUE(mesh.is_divided(level - 1, {{u / 2, v / 2}}));
                  }
              }
  EXPECT_GT(n_divided, 9u);
}



TEST(RefinedCells, AsNumbersAndBack)
{
  const GridDescription<3> box  = box_with_levels<3>(4, 3);
  const auto               mesh = random_mesh(box, 5);
  RefinedCells<3>          copy(box.cells, box.levels);
  copy.set(mesh.numbers());
  EXPECT_TRUE(copy == mesh);
  EXPECT_FALSE(copy == RefinedCells<3>(box.cells, box.levels));

  const std::vector<std::vector<std::uint64_t>> wrong = {
    {},                 // no counts
    {1, 3, 0},          // a level is missing
    {1, 64, 0, 0},      // beyond the lattice
    {2, 7, 3, 0, 0},    // not in order
    {0, 1, 0, 0},       // the child of a cell that is not divided
    {0, 0, 0, 0},       // one number too many
    {1ull << 63, 1, 0}, // more than there are
  };
  for (const auto &numbers : wrong)
    EXPECT_THROW(copy.set(numbers), std::invalid_argument);
}
