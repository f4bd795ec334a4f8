// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/boundary_conditions.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

/**
 * @file What sides hold of the nodes of a box of 4 x 3 cells: which
 * components, at which values, the same on any number of ranks.
 */
namespace limber
{
  namespace
  {
    using Layout = NodeLayout<2>;

    constexpr unsigned int left = 0, right = 1, bottom = 2, top = 3;



    GridDescription<2>
    four_by_three()
    {
      GridDescription<2> result;
      result.upper = dealii::Point<2>(4, 3);
      result.cells = {{4, 3}};
      return result;
    }



    /** Left slips, right and bottom hold all, the bottom moves, top rubs. */
    Sides<2>
    different_sides()
    {
      Sides<2> sides;
      sides[right].held      = HeldComponents::all;
      sides[bottom].held     = HeldComponents::all;
      sides[bottom].velocity = Formula<2>("x + t; 2*t", {}, 2, "test");
      sides[top].one_sided   = true;
      sides[top].friction    = 0.5;
      return sides;
    }



    void
    occupy_all(const BackgroundGrid<2> &grid, NodalFields<2> &nodes)
    {
      std::vector<std::uint32_t> cells(grid.n_owned_cells());
      for (std::uint32_t c = 0; c < cells.size(); ++c)
        cells[c] = c;
      nodes.set_occupied(std::move(cells), /*agree=*/true);
    }



    unsigned int
    sum_over_ranks(const unsigned int value)
    {
      return dealii::Utilities::MPI::sum(value, MPI_COMM_WORLD);
    }



    struct SideConstraintsTest : testing::Test
    {
      SideConstraintsTest()
      {
        occupy_all(grid, nodes);
      }

      Sides<2>          sides = different_sides();
      BackgroundGrid<2> grid{four_by_three(), MPI_COMM_WORLD};
      NodalFields<2>    nodes{grid};
    };



    TEST_F(SideConstraintsTest, HoldWhatTheirSidesSayOfEveryNode)
    {
      SideConstraints<2> constraints(sides);
      unsigned int       n_owned = 0, n_of_side[4] = {};
      for (const Constraint &c : constraints.at(nodes, 0))
        if (nodes.owns(c.node))
          {
            ++n_owned;
            ++n_of_side[c.side];
            EXPECT_TRUE(nodes.table.sides[c.node] >> c.side & 1);
            EXPECT_EQ(c.one_sided, c.side == top);
            if (c.side == left)
              {
                EXPECT_EQ(c.component, 0);
              }
            if (c.side == top)
              {
                EXPECT_EQ(c.component, 1);
              }
          }
      EXPECT_EQ(sum_over_ranks(n_of_side[left]), 4u);
      // of the bottom, which moves, and its neighbours each alone holds the
      // velocity through itself
      EXPECT_EQ(sum_over_ranks(n_of_side[right]), 2u * 4 - 1);
      EXPECT_EQ(sum_over_ranks(n_of_side[bottom]), 2u * 5 - 2);
      EXPECT_EQ(sum_over_ranks(n_of_side[top]), 5u);
      EXPECT_EQ(sum_over_ranks(n_owned), 24u);
    }



    // Nothing goes through the right side where the bottom moves to it.
    TEST_F(SideConstraintsTest, LetNothingThroughWhereOneOfThemMoves)
    {
      SideConstraints<2> constraints(sides);
      for (const Constraint &c : constraints.at(nodes, 0.5))
        {
          const unsigned int of_node = nodes.table.sides[c.node];
          if (of_node == (1u << right | 1u << bottom))
            EXPECT_EQ(c.side, c.component == 0 ? right : bottom);
          if (of_node == (1u << left | 1u << bottom))
            EXPECT_EQ(c.side, c.component == 0 ? left : bottom);
        }
    }



    TEST_F(SideConstraintsTest, HaveTheValuesOfTheirPlaceAndTime)
    {
      SideConstraints<2> constraints(sides);
      for (const double time : {0., 0.25, 0.25, 2.})
        for (const Constraint &c : constraints.at(nodes, time))
          {
            const double x        = nodes.table.places.at(c.node)[0];
            const double moving[] = {x + time, 2 * time};
            EXPECT_NEAR(c.value,
                        c.side == bottom ? moving[c.component] : 0.,
                        1e-14);
          }
    }



    /** The last of several for a component counts: sides act in their order. */
    TEST_F(SideConstraintsTest, OfANodeStandTogetherInTheOrderOfTheSides)
    {
      SideConstraints<2>      constraints(sides);
      const auto             &all = constraints.at(nodes, 0);
      std::set<std::uint32_t> seen;
      for (std::size_t k = 0; k < all.size(); ++k)
        if (k > 0 && all[k].node == all[k - 1].node)
          EXPECT_GE(all[k].side, all[k - 1].side);
        else
          EXPECT_TRUE(seen.insert(all[k].node).second);
    }



    TEST_F(SideConstraintsTest, FollowTheActiveNodes)
    {
      SideConstraints<2> constraints(sides);
      const std::size_t  n = constraints.at(nodes, 1).size();
      nodes.set_occupied({}, /*agree=*/true);
      EXPECT_TRUE(constraints.at(nodes, 1).empty());
      occupy_all(grid, nodes);
      EXPECT_EQ(constraints.at(nodes, 1).size(), n);
      for (const Constraint &c : constraints.at(nodes, 1))
        if (c.side == bottom && c.component == 1)
          {
            EXPECT_NEAR(c.value, 2, 1e-14);
          }
    }



    /** All nodes of mass 2 kg move outward through the top and to the right. */
    TEST_F(SideConstraintsTest, AreKeptByNodesAndAccountedOnceOverRanks)
    {
      BoundaryConditions<2> boundaries(sides);
      for (const std::uint32_t node : nodes.active_nodes())
        {
          double *const record          = nodes.record(node);
          record[Layout::mass]          = 2;
          record[Layout::velocity]      = 3;
          record[Layout::velocity + 1]  = 1;
          record[Layout::increment]     = 0.5;
          record[Layout::increment + 1] = 0.25;
        }
      std::array<dealii::Tensor<1, 2>, 4> impulse;
      const double                        time = 2;
      boundaries.apply(nodes,
                       {time - 1, time},
                       [&](const unsigned int side, const auto &action) {
                         impulse[side] += action.impulse;
                       });
      for (auto &of_side : impulse)
        of_side = dealii::Utilities::MPI::sum(of_side, MPI_COMM_WORLD);

      for (const std::uint32_t node : nodes.active_boundary_nodes())
        {
          const unsigned int  in     = nodes.table.sides[node];
          const double *const record = nodes.record(node);
          const double        x      = nodes.table.places.at(node)[0];
          // beside the bottom, which moves, each holds what goes through it;
          // friction takes half of the normal impulse
          const double expected[] = {in >> right & 1 || in >> left & 1 ? 0 :
                                     in >> bottom & 1 ? x + time :
                                                        2.5,
                                     in >> bottom & 1 ? 2 * time :
                                     in >> right & 1 || in >> top & 1 ? 0 :
                                                                        1};
          for (int d = 0; d < 2; ++d)
            {
              EXPECT_NEAR(record[Layout::velocity + d], expected[d], 1e-14);
              const double before = d == 0 ? 2.5 : 0.75;
              EXPECT_NEAR(record[Layout::velocity + d] -
                            record[Layout::increment + d],
                          before,
                          1e-14);
            }
        }
      // Other corners belong to the side that comes first.
      EXPECT_NEAR(impulse[left][0], 4 * 2 * -3., 1e-12);
      EXPECT_NEAR(impulse[left][1], 0, 1e-12);
      EXPECT_NEAR(impulse[right][0], 4 * 2 * -3., 1e-12);
      EXPECT_NEAR(impulse[right][1], 3 * 2 * -1., 1e-12);
      // x + 2 from 3 between the corners, 4 from 1
      EXPECT_NEAR(impulse[bottom][0], 2 * (0. + 1 + 2), 1e-12);
      EXPECT_NEAR(impulse[bottom][1], 2 * 5 * 3., 1e-12);
      EXPECT_NEAR(impulse[top][0], 3 * 2 * -0.5, 1e-12);
      EXPECT_NEAR(impulse[top][1], 4 * 2 * -1., 1e-12);
    }



    /** Points there take the change of velocity of their side, and no other. */
    TEST_F(SideConstraintsTest, SidesThatKeepTheirPointsLeaveThemWhatTheyBring)
    {
      BoundaryConditions<2> boundaries(sides);
      const auto            set = [this]() {
        for (const std::uint32_t node : nodes.active_nodes())
          {
            double *const record          = nodes.record(node);
            record[Layout::mass]          = 2;
            record[Layout::velocity]      = 3;
            record[Layout::velocity + 1]  = 1;
            record[Layout::increment]     = 0.5;
            record[Layout::increment + 1] = 0.25;
          }
      };
      const auto apply = [&](const bool keeps, const double share) {
        set();
        dealii::Tensor<1, 2> impulse;
        boundaries.apply(nodes,
                         {1, 2, share, keeps},
                         [&](const unsigned int side, const auto &action) {
                           if (side == left)
                             impulse += action.impulse;
                         });
        return dealii::Utilities::MPI::sum(impulse, MPI_COMM_WORLD);
      };
      const auto increments = [&](const unsigned int side, const int d) {
        std::set<double> result;
        for (const std::uint32_t node : nodes.active_boundary_nodes())
          if (nodes.table.sides[node] == 1 << side)
            result.insert(nodes.record(node)[Layout::increment + d]);
        return result;
      };
      // left: slip; bottom: velocity x + t, 2 t; top: friction
      const auto of_flip = apply(true, 1);
      for (const double value : increments(left, 0))
        EXPECT_EQ(value, 0);
      for (const double value : increments(bottom, 0))
        EXPECT_NEAR(value, 1, 1e-14);
      for (const double value : increments(bottom, 1))
        EXPECT_NEAR(value, 2, 1e-14);
      for (const double value : increments(top, 1))
        EXPECT_NEAR(value, -0.75, 1e-14);
      EXPECT_NEAR(of_flip[0], 4 * 2 * -0.5, 1e-12);
      EXPECT_NEAR(apply(true, 0)[0], 4 * 2 * -3., 1e-12);
      EXPECT_NEAR(apply(false, 1)[0], 4 * 2 * -3., 1e-12);
      for (const double value : increments(left, 0))
        EXPECT_NEAR(value, -2.5, 1e-14);
    }
  } // namespace
} // namespace limber
