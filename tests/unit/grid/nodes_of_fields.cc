// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/nodal_fields.h>

#include <gtest/gtest.h>

#include <set>

/** @file Which nodes the points of two fields may have given anything to. */
namespace limber
{
  namespace
  {
    // A row of six cells, apart from what is above it.
    struct NodesOfFieldsTest : testing::Test
    {
      NodesOfFieldsTest()
        : grid(description(), MPI_COMM_SELF)
        , nodes(grid)
      {
        nodes.set_n_fields(2);
        occupy();
      }

      static GridDescription<2>
      description()
      {
        GridDescription<2> result;
        result.upper = dealii::Point<2>(6, 2);
        result.cells = {{6, 2}};
        return result;
      }

      void
      occupy()
      {
        std::vector<std::uint32_t> all;
        for (std::uint32_t cell = 0; cell < grid.n_owned_cells(); ++cell)
          all.push_back(cell);
        nodes.set_occupied(std::move(all), /*agree=*/true);
      }

      /** The cell of the lower row with its left side at x. */
      std::uint32_t
      cell_at(const double x) const
      {
        for (std::uint32_t cell = 0; cell < grid.n_owned_cells(); ++cell)
          if (grid.geometry[cell].origin[0] == x &&
              grid.geometry[cell].origin[1] == 0)
            return cell;
        return invalid_cell;
      }

      std::set<std::uint32_t>
      nodes_of(const std::uint32_t cell) const
      {
        std::set<std::uint32_t> result;
        for (const std::uint32_t offset : grid.geometry[cell].node)
          result.insert(offset / NodeLayout<2>::stride);
        return result;
      }

      static std::set<std::uint32_t>
      as_set(const std::vector<std::uint32_t> &list)
      {
        const std::set<std::uint32_t> result(list.begin(), list.end());
        EXPECT_EQ(result.size(), list.size()); // none is there twice
        return result;
      }

      BackgroundGrid<2> grid;
      NodalFields<2>    nodes;
    };



    TEST_F(NodesOfFieldsTest, AreAllWhereNothingIsNoted)
    {
      EXPECT_EQ(nodes.active_nodes_of_field(), nodes.active_nodes());
      EXPECT_EQ(nodes.nodes_of_two_fields(), nodes.active_nodes());
    }



    TEST_F(NodesOfFieldsTest, AreThoseOfTheCellsNoted)
    {
      EXPECT_TRUE(nodes.begin_noting());
      nodes.note_cell(0, cell_at(0));
      nodes.note_cell(1, cell_at(3));
      EXPECT_TRUE(nodes.nodes_of_two_fields().empty());
      EXPECT_EQ(as_set(nodes.active_nodes_of_field()), nodes_of(cell_at(0)));
      nodes.select(1);
      EXPECT_EQ(as_set(nodes.active_nodes_of_field()), nodes_of(cell_at(3)));
      nodes.select(0);

      EXPECT_FALSE(nodes.begin_noting()); // they are known still
      nodes.note_cell(0, cell_at(2));
      nodes.note_cell(0, cell_at(2));
      std::set<std::uint32_t> both;
      for (const std::uint32_t node : nodes_of(cell_at(2)))
        if (nodes_of(cell_at(3)).count(node) > 0)
          both.insert(node);
      EXPECT_EQ(both.size(), 2u);
      EXPECT_EQ(as_set(nodes.nodes_of_two_fields()), both);
    }



    TEST_F(NodesOfFieldsTest, AreClearedAndForgotten)
    {
      nodes.begin_noting();
      nodes.note_cell(1, cell_at(4));
      const auto written = nodes_of(cell_at(4));
      for (const std::uint32_t node : written)
        nodes.record(1, node)[NodeLayout<2>::mass] = 7;
      nodes.clear();
      for (const std::uint32_t node : written)
        EXPECT_EQ(nodes.record(1, node)[NodeLayout<2>::mass], 0);

      occupy();
      EXPECT_EQ(nodes.active_nodes_of_field(), nodes.active_nodes());
      EXPECT_TRUE(nodes.begin_noting());
      EXPECT_TRUE(nodes.active_nodes_of_field().empty());
    }
  } // namespace
} // namespace limber
