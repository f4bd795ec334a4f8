// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/nodal_fields.h>
#include <limber/grid/nodal_projection.h>
#include <limber/interpolation/nodal_means.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace limber
{
  namespace
  {
    using dealii::Utilities::MPI::n_mpi_processes;
    using dealii::Utilities::MPI::this_mpi_process;

    constexpr unsigned int n_owned = 7, stride = 4;



    /**
     * Seven records on each rank. Of its predecessor every rank holds the
     * last three as ghosts, of its successor the first one, and of rank 0 the
     * record 3: some records live on three ranks or on all.
     */
    struct Ring
    {
      Ring()
        : rank(this_mpi_process(MPI_COMM_WORLD))
        , n_ranks(n_mpi_processes(MPI_COMM_WORLD))
      {
        dealii::IndexSet owned(n_ranks * n_owned), ghosts(n_ranks * n_owned);
        owned.add_range(rank * n_owned, (rank + 1) * n_owned);
        for (unsigned int index = 0; index < n_ranks * n_owned; ++index)
          if (index / n_owned != rank && holds(rank, index))
            ghosts.add_index(index);
        records.reinit(owned, ghosts, MPI_COMM_WORLD);
      }

      bool
      holds(const unsigned int holder, const unsigned int index) const
      {
        const unsigned int owner = index / n_owned, place = index % n_owned;
        return owner == holder || index == 3 ||
               ((owner + 1) % n_ranks == holder && place >= 4) ||
               ((holder + 1) % n_ranks == owner && place <= 0);
      }

      unsigned int
      n_local() const
      {
        return records.locally_owned_size() + records.n_ghost_indices();
      }

      /** What a rank adds to a slot: sums depend on the order of addition. */
      static double
      share(const unsigned int rank, const unsigned int index, unsigned int k)
      {
        return std::sin(1. + index + 10. * k) * std::pow(7., 5. * rank);
      }

      /** All that ranks which may add have to give, in the order of ranks. */
      template <class MayAdd>
      double
      sum(const unsigned int index, const unsigned int k, const MayAdd &adds)
      {
        double result = 0;
        for (unsigned int r = 0; r < n_ranks; ++r)
          if (holds(r, index) && adds(r, index))
            result += share(r, index, k);
        return result;
      }

      template <class MayAdd, class Wants>
      void
      expect_sums(const ExchangePlan &plan,
                  const MayAdd       &adds,
                  const Wants        &wants)
      {
        std::vector<double> values(n_local() * stride, 0.), expected(values);
        for (unsigned int i = 0; i < n_local(); ++i)
          for (unsigned int k = 0; k < stride; ++k)
            {
              const auto index  = records.local_to_global(i);
              const bool summed = (k == 1 || k == 2) && wants(rank, index);
              double    &value  = values[i * stride + k];
              if (adds(rank, index))
                value = share(rank, index, k);
              expected[i * stride + k] = summed ? sum(index, k, adds) : value;
            }
        RecordExchange exchange(stride);
        exchange.start(plan, values.data(), 1, 3);
        exchange.finish(values.data());
        EXPECT_EQ(values, expected);
      }

      const unsigned int                  rank, n_ranks;
      dealii::Utilities::MPI::Partitioner records;
    };



    TEST(SharedRecords, AllHoldersGetTheSameSumToTheLastBit)
    {
      Ring                ring;
      const SharedRecords shared(ring.records);
      const auto          all = [](auto, auto) { return true; };
      ring.expect_sums(ExchangePlan(shared), all, all);
    }



    // The rest of the slots stays what it was.
    TEST(SharedRecords, AllHoldersGetTheSameLargestValue)
    {
      Ring                ring;
      const SharedRecords shared(ring.records);
      const ExchangePlan  plan(shared);
      std::vector<double> values(ring.n_local() * stride), expected(values);
      for (unsigned int i = 0; i < ring.n_local(); ++i)
        for (unsigned int k = 0; k < stride; ++k)
          {
            const auto index = ring.records.local_to_global(i);
            const auto of    = [&](const unsigned int rank) {
              return std::cos(1. + 3. * rank + index + 10. * k) - 2;
            };
            values[i * stride + k] = of(ring.rank);
            double &largest        = expected[i * stride + k];
            largest                = of(ring.rank);
            for (unsigned int r = 0; r < ring.n_ranks; ++r)
              if (k == 1 && ring.holds(r, index))
                largest = std::max(largest, of(r));
          }
      RecordExchange exchange(stride);
      exchange.start(plan, values.data(), 1, 2);
      exchange.finish_largest(values.data());
      EXPECT_EQ(values, expected);
    }



    TEST(SharedRecords, ThoseWhoAddSendToThoseWhoWant)
    {
      Ring                ring;
      const SharedRecords shared(ring.records);
      const auto          adds = [](const unsigned int rank, const auto index) {
        return (rank + index) % 3 != 0;
      };
      const auto wants = [&](const unsigned int rank, const auto index) {
        return adds(rank, index) || (rank + index) % 2 == 0;
      };
      const auto here = [&](const auto &of) {
        return [&](const std::uint32_t i) {
          return of(ring.rank, ring.records.local_to_global(i));
        };
      };
      const ExchangePlan plan(shared, here(adds), here(wants));
      for (const auto &neighbour : plan.neighbours)
        for (const std::uint32_t i : neighbour.send)
          EXPECT_TRUE(here(adds)(i));
      ring.expect_sums(plan, adds, wants);
    }



    template <int dim>
    GridDescription<dim>
    unit_box()
    {
      GridDescription<dim> description;
      for (int d = 0; d < dim; ++d)
        {
          description.lower[d] = 0;
          description.upper[d] = 1;
          description.cells[d] = 4;
        }
      return description;
    }



    /** Twice, around the origin. */
    template <int dim>
    void
    refine_corner(BackgroundGrid<dim> &grid)
    {
      for (unsigned int k = 0; k < 2; ++k)
        {
          for (const auto &cell : grid.triangulation.active_cell_iterators())
            if (cell->is_locally_owned() && cell->center().norm() < 0.6)
              cell->set_refine_flag();
          grid.triangulation.execute_coarsening_and_refinement();
        }
      grid.rebuild();
    }



    template <int dim>
    using Place = std::array<double, dim>;

    template <int dim>
    std::map<std::uint32_t, Place<dim>>
    places_of_nodes(const BackgroundGrid<dim> &grid)
    {
      std::map<std::uint32_t, Place<dim>> result;
      for (const CellGeometry<dim> &cell : grid.geometry)
        for (unsigned int i = 0; i < cell.node.size(); ++i)
          for (int d = 0; d < dim; ++d)
            result[cell.node[i] / NodeLayout<dim>::stride][d] =
              cell.origin[d] + (i >> d & 1) / cell.inverse_edge[d];
      return result;
    }



    /**
     * A point in the middle of each cell gives its mass to the nodes: mass
     * and its moment are those of the points, also where nodes hang; all
     * corners of cells with points agree on it wherever they are held; a
     * linear velocity passes through the nodes.
     */
    template <int dim>
    void
    check_hanging_nodes()
    {
      using Layout = NodeLayout<dim>;
      BackgroundGrid<dim> grid(unit_box<dim>(), MPI_COMM_WORLD);
      refine_corner(grid);
      ASSERT_GT(dealii::Utilities::MPI::sum(grid.vertices.hanging.size(),
                                            MPI_COMM_WORLD),
                0u);
      const auto       places = places_of_nodes(grid);
      NodalFields<dim> nodes(grid);

      std::vector<std::uint32_t> cells(grid.n_owned_cells());
      for (std::uint32_t c = 0; c < cells.size(); ++c)
        cells[c] = c;
      nodes.set_occupied(std::vector<std::uint32_t>(cells), /*agree=*/true);

      // mass and first moment of mass, of the points and of the nodes
      std::array<double, 1 + dim> given{}, found{};
      for (const std::uint32_t c : cells)
        {
          const CellGeometry<dim> &cell = grid.geometry[c];
          double                   mass = 1;
          for (int d = 0; d < dim; ++d)
            mass /= cell.inverse_edge[d];
          given[0] += mass;
          for (int d = 0; d < dim; ++d)
            given[1 + d] +=
              mass * (cell.origin[d] + 0.5 / cell.inverse_edge[d]);
          for (const std::uint32_t offset : cell.node)
            nodes.record(offset / Layout::stride)[Layout::mass] +=
              mass / (1 << dim);
        }
      nodes.start_sum();
      nodes.finish_sum();

      std::vector<std::pair<Place<dim>, double>> held;
      for (const auto &[node, place] : places)
        {
          const double mass = nodes.record(node)[Layout::mass];
          if (mass == 0)
            continue;
          held.emplace_back(place, mass);
          if (!nodes.owns(node))
            continue;
          found[0] += mass;
          for (int d = 0; d < dim; ++d)
            found[1 + d] += mass * place[d];
        }
      for (unsigned int k = 0; k < given.size(); ++k)
        EXPECT_NEAR(dealii::Utilities::MPI::sum(given[k], MPI_COMM_WORLD),
                    dealii::Utilities::MPI::sum(found[k], MPI_COMM_WORLD),
                    1e-13);

      std::map<Place<dim>, double> masses;
      for (const auto &of_rank :
           dealii::Utilities::MPI::all_gather(MPI_COMM_WORLD, held))
        for (const auto &[place, mass] : of_rank)
          EXPECT_EQ(masses.emplace(place, mass).first->second, mass);

      const auto linear = [](const Place<dim> &x) {
        return 1 + x[0] - 3 * x[1];
      };
      for (const auto &[node, place] : places)
        nodes.record(node)[Layout::velocity] = linear(place);
      nodes.interpolate_hanging();
      for (const HangingNode &hanging : grid.vertices.hanging)
        {
          bool all_known = true;
          for (const auto &[master, weight] : hanging.masters)
            all_known &= places.count(master) == 1;
          if (!all_known)
            continue;
          EXPECT_NEAR(nodes.record(hanging.node)[Layout::velocity],
                      linear(places.at(hanging.node)),
                      1e-14);
        }
    }



    /**
     * With hanging nodes, points of several weights in half of the cells:
     * a constant stays what it is, sum m a (S b) = sum m (S a) b, and a sum
     * taken afresh knows nothing of the one before.
     */
    template <int dim>
    void
    check_projection_on_nodes()
    {
      BackgroundGrid<dim> grid(unit_box<dim>(), MPI_COMM_WORLD);
      refine_corner(grid);
      NodalFields<dim>           nodes(grid);
      std::vector<std::uint32_t> cells;
      for (std::uint32_t c = 0; c < grid.n_owned_cells(); ++c)
        if (grid.geometry[c].origin[1] < 0.55)
          cells.push_back(c);
      nodes.set_occupied(std::vector<std::uint32_t>(cells), /*agree=*/true);

      // the same on all ranks: it follows from the place
      struct Point
      {
        std::uint32_t cell;
        Place<dim>    xi;
        double        mass, a, b;
      };
      std::vector<Point> points;
      for (const std::uint32_t c : cells)
        for (int k = 0; k < 3; ++k)
          {
            double seed = 3 * k;
            for (int d = 0; d < dim; ++d)
              seed += (7 + d) * grid.geometry[c].origin[d];
            Point point{c,
                        {},
                        2 + std::sin(3 * seed),
                        std::sin(5 * seed),
                        std::cos(11 * seed)};
            for (int d = 0; d < dim; ++d)
              point.xi[d] = 0.5 + 0.5 * std::sin((d + 2) * seed);
            points.push_back(point);
          }

      NodalProjection<dim> projection(grid.vertices);
      const auto           project = [&](const auto &quantity) {
        projection.clear(nodes.active_nodes());
        for (const Point &point : points)
          {
            NodalSums<dim> sums;
            sums.add(point.xi, point.mass, quantity(point));
            sums.add_to_nodes(grid.geometry[point.cell], projection.data());
          }
        projection.start_completion(nodes.node_plan());
        projection.finish_completion(nodes.active_nodes());
        std::vector<double> result;
        for (const Point &point : points)
          result.push_back(
            NodalMean<dim, Treatment::node>(projection.data(),
                                            grid.geometry[point.cell])
              .template value<double>(point.xi));
        return result;
      };
      const auto Sa   = project([](const Point &point) { return point.a; });
      const auto Sb   = project([](const Point &point) { return point.b; });
      const auto one  = project([](const Point &) { return 1.; });
      double     a_Sb = 0, Sa_b = 0, change = 0;
      for (std::size_t p = 0; p < points.size(); ++p)
        {
          EXPECT_NEAR(one[p], 1, 1e-14);
          a_Sb += points[p].mass * points[p].a * Sb[p];
          Sa_b += points[p].mass * Sa[p] * points[p].b;
          change = std::max(change, std::abs(Sa[p] - points[p].a));
        }
      a_Sb = dealii::Utilities::MPI::sum(a_Sb, MPI_COMM_WORLD);
      Sa_b = dealii::Utilities::MPI::sum(Sa_b, MPI_COMM_WORLD);
      EXPECT_NEAR(a_Sb, Sa_b, 1e-13 * points.size());
      EXPECT_GT(dealii::Utilities::MPI::max(change, MPI_COMM_WORLD), 0.1);

      // A cleared record is clear, hanging nodes of empty cells included.
      nodes.interpolate_hanging();
      for (std::uint32_t n = 0; n < grid.vertices.n(); ++n)
        nodes.record(n)[NodeLayout<dim>::velocity] = 1;
      nodes.interpolate_hanging();
      nodes.clear();
      nodes.start_sum();
      nodes.finish_sum();
      for (const std::uint32_t n : nodes.active_nodes())
        EXPECT_EQ(nodes.record(n)[NodeLayout<dim>::velocity], 0);
    }



    TEST(NodalProjection, IsSymmetricWithHangingNodesOnAnyNumberOfRanks)
    {
      check_projection_on_nodes<2>();
      check_projection_on_nodes<3>();
    }



    /** Or a rank would send what a cell held before its points left. */
    TEST(NodalFields, CellsAgreedOnStayOccupiedWhenPointsLeave)
    {
      BackgroundGrid<2>          grid(unit_box<2>(), MPI_COMM_WORLD);
      NodalFields<2>             nodes(grid);
      std::vector<std::uint32_t> cells(grid.n_cells());
      for (std::uint32_t c = 0; c < cells.size(); ++c)
        cells[c] = c;
      nodes.set_occupied(std::move(cells), /*agree=*/true);
      nodes.set_occupied({});

      auto kept = nodes.owned_occupied_cells();
      kept.insert(kept.end(),
                  nodes.ghost_occupied_cells().begin(),
                  nodes.ghost_occupied_cells().end());
      for (const auto &neighbour : nodes.cell_plan().neighbours)
        for (const std::uint32_t cell : neighbour.send)
          EXPECT_EQ(std::count(kept.begin(), kept.end(), cell), 1);
    }



    TEST(NodalFields, HangingNodesKeepMassMomentsAndLinearFields)
    {
      check_hanging_nodes<2>();
      check_hanging_nodes<3>();
    }
  } // namespace
} // namespace limber
