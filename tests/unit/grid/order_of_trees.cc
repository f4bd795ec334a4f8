// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/grid/grid_tools.h>

#include <limber/grid/background_grid.h>
#include <limber/grid/order_of_trees.h>

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

using namespace limber;

namespace
{
  /** Cells of a plane lattice, each with all that touch it. */
  dealii::DynamicSparsityPattern
  cells_of_lattice(const int nx, const int ny)
  {
    dealii::DynamicSparsityPattern graph(nx * ny, nx * ny);
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        for (int l = std::max(0, j - 1); l <= std::min(ny - 1, j + 1); ++l)
          for (int k = std::max(0, i - 1); k <= std::min(nx - 1, i + 1); ++k)
            graph.add(j * nx + i, l * nx + k);
    return graph;
  }



  std::string
  library_of(void *const function)
  {
    Dl_info info;
    return dladdr(function, &info) != 0 ? info.dli_fname : "";
  }
} // namespace



// What deal.II 9.4.1's own function gives for this lattice.
TEST(OrderOfTrees, IsThatOfDealII)
{
  const Order places = {0,  1,  4,  5,  20, 21, 24, 2,  3,  6,  7,  22,
                        23, 25, 8,  9,  12, 13, 26, 27, 30, 10, 11, 14,
                        15, 28, 29, 31, 16, 17, 18, 19, 32, 33, 34};
  const Order order  = hierarchical_order(cells_of_lattice(7, 5));
  ASSERT_EQ(order.size(), places.size());
  for (unsigned int i = 0; i < order.size(); ++i)
    EXPECT_EQ(places[order[i]], i);
}



TEST(OrderOfTrees, NamesEachOfUnconnectedPartsOnce)
{
  dealii::DynamicSparsityPattern graph(6, 6);
  for (const int row : {0, 2, 4})
    for (const int a : {row, row + 1})
      for (const int b : {row, row + 1})
        graph.add(a, b);
  Order order = hierarchical_order(graph);
  std::sort(order.begin(), order.end());
  Order all(6);
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(order, all);
}



// deal.II asks the dynamic linker for its function and must get ours.
TEST(OrderOfTrees, IsTakenByDealII)
{
  const bool  wide = sizeof(Order::value_type) == 8;
  const char *name = wide ? "_ZN6dealii13SparsityTools20reorder_hierarchicalERK"
                            "NS_22DynamicSparsityPatternERSt6vectorIySaIyEE" :
                            "_ZN6dealii13SparsityTools20reorder_hierarchicalERK"
                            "NS_22DynamicSparsityPatternERSt6vectorIjSaIjEE";
  void *const found = dlsym(RTLD_DEFAULT, name);
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(library_of(found),
            library_of(reinterpret_cast<void *>(&hierarchical_order)));

  GridDescription<2> description;
  description.upper = {7, 5};
  description.cells = {{7, 5}};
  const BackgroundGrid<2>        grid(description, MPI_COMM_SELF);
  dealii::DynamicSparsityPattern graph;
  dealii::GridTools::get_vertex_connectivity_of_cells(grid.triangulation,
                                                      graph);
  EXPECT_EQ(grid.triangulation.get_p4est_tree_to_coarse_cell_permutation(),
            hierarchical_order(graph));
}
