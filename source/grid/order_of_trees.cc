// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/utilities.h>

#include <deal.II/lac/sparsity_tools.h>

#include <limber/grid/order_of_trees.h>

#include <functional>
#include <limits>
#include <queue>
#include <tuple>

namespace limber
{
  namespace
  {
    using Row = dealii::DynamicSparsityPattern::size_type;

    constexpr Row no_group = std::numeric_limits<Row>::max();



    /** A graph in compressed row storage. */
    class Graph
    {
    public:
      explicit Graph(const dealii::DynamicSparsityPattern &pattern)
      {
        for (Row row = 0; row < pattern.n_rows(); ++row)
          {
            for (Row k = 0; k < pattern.row_length(row); ++k)
              columns.push_back(pattern.column_number(row, k));
            starts.push_back(columns.size());
          }
      }

      Row
      size() const
      {
        return starts.size() - 1;
      }

      Row
      n_neighbours(const Row row) const
      {
        return starts[row + 1] - starts[row];
      }

      template <class Work>
      void
      for_each_neighbour(const Row row, const Work &work) const
      {
        for (std::size_t k = starts[row]; k < starts[row + 1]; ++k)
          work(columns[k]);
      }

    private:
      std::vector<Row>         columns;
      std::vector<std::size_t> starts = {0};
    };



    /**
     * Partitions a graph into groups of neighbours, advancing along the rim.
     */
    class Grouping
    {
    public:
      explicit Grouping(const Graph &graph)
        : graph(graph)
        , group_of(graph.size(), no_group)
        , free_neighbours(graph.size())
      {
        for (Row row = 0; row < graph.size(); ++row)
          free_neighbours[row] = graph.n_neighbours(row);
        for (Row start = next_start(); start != no_group; start = next_start())
          {
            add_to_rim(start);
            while (!rim.empty())
              {
                const Row row = std::get<2>(rim.top());
                // Skip outdated entries of rows.
                const bool counts =
                  group_of[row] == no_group &&
                  std::get<0>(rim.top()) == free_neighbours[row];
                rim.pop();
                if (counts)
                  make_group(row);
              }
          }
      }

      /** The graph of adjacent groups. */
      dealii::DynamicSparsityPattern
      connections() const
      {
        dealii::DynamicSparsityPattern result(groups.size(), groups.size());
        for (Row row = 0; row < graph.size(); ++row)
          graph.for_each_neighbour(row, [&](const Row other) {
            result.add(group_of[row], group_of[other]);
          });
        return result;
      }

      std::vector<std::vector<Row>> groups;

    private:
      // Priority: fewest free neighbours, then most neighbours, then lowest
      // number.
      using RimEntry = std::tuple<Row, Row, Row>;

      void
      add_to_rim(const Row row)
      {
        rim.emplace(free_neighbours[row],
                    no_group - graph.n_neighbours(row),
                    row);
      }

      /** The first of the free rows with fewest neighbours. */
      Row
      next_start() const
      {
        if (n_grouped == graph.size())
          return no_group;
        Row best = no_group;
        for (Row row = 0; row < graph.size(); ++row)
          if (group_of[row] == no_group &&
              (best == no_group ||
               graph.n_neighbours(row) < graph.n_neighbours(best)))
            best = row;
        return best;
      }

      void
      make_group(const Row centre)
      {
        const Row        number = groups.size();
        std::vector<Row> group  = {centre};
        group_of[centre]        = number;
        graph.for_each_neighbour(centre, [&](const Row row) {
          if (group_of[row] == no_group)
            {
              group.push_back(row);
              group_of[row] = number;
            }
        });
        n_grouped += group.size();
        for (const Row member : group)
          graph.for_each_neighbour(member, [&](const Row row) {
            --free_neighbours[row];
            if (group_of[row] == no_group)
              add_to_rim(row);
          });
        groups.push_back(std::move(group));
      }

      const Graph     &graph;
      std::vector<Row> group_of, free_neighbours;
      Row              n_grouped = 0;
      std::priority_queue<RimEntry, std::vector<RimEntry>, std::greater<>> rim;
    };
  } // namespace



  Order
  hierarchical_order(const dealii::DynamicSparsityPattern &pattern)
  {
    const Graph    graph(pattern);
    const Grouping grouping(graph);
    const Row      n_groups = grouping.groups.size();
    Order          of_groups(n_groups);
    if (n_groups < graph.size())
      of_groups = hierarchical_order(grouping.connections());
    else
      for (Row group = 0; group < n_groups; ++group)
        of_groups[group] = group;

    Order result;
    for (const Row group : of_groups)
      result.insert(result.end(),
                    grouping.groups[group].begin(),
                    grouping.groups[group].end());
    return result;
  }



  void
  order_trees_quickly()
  {}
} // namespace limber



namespace dealii
{
  namespace SparsityTools
  {
    void
    reorder_hierarchical(
      const DynamicSparsityPattern                   &sparsity,
      std::vector<DynamicSparsityPattern::size_type> &new_indices)
    {
      new_indices =
        Utilities::invert_permutation(limber::hierarchical_order(sparsity));
    }
  } // namespace SparsityTools
} // namespace dealii
