// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/node_places.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

/** @file Names of nodes that do not depend on their numbers. */
namespace limber
{
  namespace
  {
    std::set<std::uint64_t>
    places_with(const KernelKind kernel)
    {
      GridDescription<2> box;
      box.upper  = dealii::Point<2>(4, 3);
      box.cells  = {{4, 3}};
      box.kernel = kernel;
      const BackgroundGrid<2> grid(box, MPI_COMM_SELF);
      const auto              places = places_of_nodes(grid);
      std::set<std::uint64_t> result(places.begin(), places.end());
      EXPECT_EQ(result.size(), grid.nodes().n()) << "two nodes in one place";
      return result;
    }

    /** At x and y, in halves of cells of a box that is four of them wide. */
    std::uint64_t
    place(const unsigned int x, const unsigned int y)
    {
      return x + 9 * y;
    }
  } // namespace



  TEST(NodePlaces, VerticesOfLinearFunctionsAndCubicSplines)
  {
    std::set<std::uint64_t> vertices;
    for (unsigned int y = 0; y <= 3; ++y)
      for (unsigned int x = 0; x <= 4; ++x)
        vertices.insert(place(2 * x, 2 * y));
    EXPECT_EQ(places_with(KernelKind::linear), vertices);
    EXPECT_EQ(places_with(KernelKind::cubic), vertices);
  }



  TEST(NodePlaces, MiddlesOfCellsAndSidesOfQuadraticSplines)
  {
    std::set<std::uint64_t> nodes;
    for (const unsigned int y : {0, 1, 3, 5, 6})
      for (const unsigned int x : {0, 1, 3, 5, 7, 8})
        nodes.insert(place(x, y));
    EXPECT_EQ(places_with(KernelKind::quadratic), nodes);
  }



  // A node keeps its place where the mesh around it changes.
  TEST(NodePlaces, CellsOfSeveralSizes)
  {
    GridDescription<2> box;
    box.upper  = dealii::Point<2>(2, 2);
    box.cells  = {{2, 2}};
    box.levels = 1;
    BackgroundGrid<2> grid(box, MPI_COMM_SELF);
    const auto        coarse = places_of_nodes(grid);
    grid.triangulation.begin_active()->set_refine_flag();
    grid.triangulation.prepare_coarsening_and_refinement();
    grid.triangulation.execute_coarsening_and_refinement();
    grid.rebuild();
    const auto                    fine = places_of_nodes(grid);
    const std::set<std::uint64_t> all(fine.begin(), fine.end());
    EXPECT_EQ(coarse.size(), 9u);
    EXPECT_EQ(fine.size(), 14u);
    EXPECT_EQ(all.size(), 14u) << "two nodes in one place";
    EXPECT_TRUE(std::all_of(coarse.begin(), coarse.end(), [&](const auto each) {
      return all.count(each);
    }));
    // Of the divided cell: in halves of the finest cells
    for (const unsigned int each :
         {2u, 2u * 9, 2u * 9 + 2, 2u * 9 + 4, 4u * 9 + 2})
      EXPECT_EQ(all.count(each), 1u) << each;
  }
} // namespace limber
