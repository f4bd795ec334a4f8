// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/adaptation/adaptation.h>
#include <limber/base/exceptions.h>
#include <limber/output/diagnosis.h>

#include <gtest/gtest.h>
#include <support/scene_parts.h>
#include <support/scene_run.h>

#include <map>
#include <random>

/**
 * @file Points that are split and meshes that change under them: what must stay
 * to the last digits, and what keeps a run going.
 */

using namespace limber;

namespace
{
  /** A random state on a block, fine in a region that can be moved. */
  template <int dim>
  std::string
  block(const std::string &criterion)
  {
    const std::string z = dim == 3 ? ", 0.5" : "", zz = dim == 3 ? ", 2.5" : "";
    return "set Dimension = " + std::to_string(dim) + R"(
    set Bodies = block
    subsection Body block
      subsection Box
        set Lower corner = 0.5, 0.5)" +
           z + R"(
        set Upper corner = 2.5, 2.5)" +
           zz + R"(
      end
      subsection Linear elastic
        set Density = 2
        set Young's modulus = 1
      end
    end
    subsection Grid
      set Upper corner = 4, 4)" +
           (dim == 3 ? ", 4" : "") + R"(
      set Cells = 8, 8)" +
           (dim == 3 ? ", 8" : "") + R"(
      set Levels = 1
      set Refine = part
      subsection Refine part
        )" +
           criterion +
           R"(
      end
    end
    subsection Boundaries
      set left = free
      set right = free
      set bottom = free
      set top = free
)" + (dim == 3 ? "set back = free\nset front = free\nend\n" : "end\n");
  }



  /** Sums over points, and all that nodes and cells get of them. */
  struct Picture
  {
    double              kinetic_energy, strain_energy;
    std::vector<double> sums; // mass, momentum, moments
    std::vector<double> nodes, cells;
  };



  template <int dim>
  Picture
  picture_of(SceneRun<dim> &run)
  {
    Picture                  result;
    const PointView<dim>     points  = run.points();
    double                   kinetic = 0;
    std::vector<long double> sums(1 + dim * (2 + dim)); // of many points
    for (std::size_t p = 0; p < points.size; ++p)
      {
        const double m = points.mass[p];
        kinetic += 0.5 * m * run.velocity(p).norm_square();
        std::size_t k = 0;
        sums[k++] += m;
        for (int d = 0; d < dim; ++d)
          {
            sums[k++] += m * run.velocity(p)[d];
            sums[k++] += m * run.position(p)[d];
            for (int e = 0; e < dim; ++e)
              sums[k++] += m * run.position(p)[d] * run.velocity(p)[e];
          }
      }
    result.kinetic_energy = kinetic;
    result.strain_energy =
      run.bodies[0]->stress->summarize(points).strain_energy;
    result.sums.assign(sums.begin(), sums.end());
    if (run.bodies[0]->cell_sums)
      for (std::uint32_t c = 0; c < run.grid.n_owned_cells(); ++c)
        {
          const double *const record = run.bodies[0]->cell_sums->record(c);
          result.cells.insert(result.cells.end(), record, record + (1 << dim));
        }
    run.advance(1e-9);
    for (std::uint32_t node = 0; node < run.nodes.table.n(); ++node)
      {
        // A third of a box may go beyond the whole by round-off.
        const double *const record = run.nodes.record(node);
        if (record[NodeLayout<dim>::mass] > 1e-15)
          result.nodes.insert(result.nodes.end(), record, record + 1 + 2 * dim);
      }
    return result;
  }



  template <int dim>
  void
  shake_points(SceneRun<dim> &run)
  {
    std::mt19937         random(3);
    const auto           draw   = [&]() { return random() / 2147483648. - 1; };
    const PointView<dim> points = run.points();
    for (std::size_t p = 0; p < points.size; ++p)
      {
        points.pressure[p] = draw();
        for (double *const component : points.deviator)
          component[p] = draw();
        for (double *const component : points.velocity)
          component[p] = draw();
      }
    run.integrator.reinit();
  }



  double
  largest(const std::vector<double> &values)
  {
    double result = 0;
    for (const double value : values)
      result = std::max(result, std::abs(value));
    return result;
  }



  void
  expect_equal(const std::vector<double> &a,
               const std::vector<double> &b,
               const double               tolerance)
  {
    ASSERT_EQ(a.size(), b.size());
    const double scale = largest(a);
    for (std::size_t i = 0; i < a.size(); ++i)
      EXPECT_NEAR(a[i], b[i], tolerance * scale) << i;
  }



  // All points become so many along each edge, on the grid that they are on.
  template <int dim>
  void
  expect_no_change(const std::string &treatment,
                   const std::string &placement,
                   const std::string &kernel = "linear",
                   const unsigned int n      = 2)
  {
    SCOPED_TRACE(treatment + ", " + placement + ", " + kernel + ", " +
                 std::to_string(dim) + "D, " + std::to_string(n) + " parts");
    const std::vector<std::string> set = {
      "Method/Kernel=" + kernel,
      "Body block/Locking treatment=" + treatment,
      "Body block/Placement=" + placement,
      "Method/Stress update=" +
        std::string(kernel == "linear" ? "musl" : "usl")};
    const std::string corner =
      dim == 2 ? "set Upper corner = 1, 1" : "set Upper corner = 1, 1, 1";
    SceneRun<dim> whole(block<dim>(corner), set),
      parts(block<dim>(corner), set);
    shake_points(whole);
    shake_points(parts);
    MaterialPoints<dim>     &points = parts.bodies[0]->points;
    std::vector<std::size_t> all(points.size());
    for (std::size_t p = 0; p < all.size(); ++p)
      all[p] = p;
    std::array<double, dim> spacing;
    spacing.fill(0.25);
    points.split(all, n, spacing, all.size());
    EXPECT_EQ(points.size(), all.size() * std::pow(n, dim));
    std::vector<std::uint64_t> ids = points.all_ids();
    std::sort(ids.begin(), ids.end());
    for (std::size_t i = 0; i < ids.size(); ++i)
      EXPECT_EQ(ids[i], i);
    // each in the cell that it says
    for (std::size_t p = 0; p < points.size(); ++p)
      for (const double xi : natural_place(
             points.view(), parts.grid.geometry[points.view().cell[p]], p))
        {
          EXPECT_GE(xi, -1e-12);
          EXPECT_LE(xi, 1 + 1e-12);
        }
    parts.integrator.reinit();

    const Picture before = picture_of(whole), after = picture_of(parts);
    EXPECT_NEAR(after.kinetic_energy,
                before.kinetic_energy,
                1e-14 * before.kinetic_energy);
    EXPECT_NEAR(after.strain_energy,
                before.strain_energy,
                1e-14 * before.strain_energy);
    expect_equal(after.sums, before.sums, 1e-14);
    // The monomials of the sums are multilinear, so second moments stay too.
    expect_equal(after.cells, before.cells, 1e-13);
    expect_equal(after.nodes, before.nodes, 1e-13);
  }
} // namespace



namespace
{
  // Each cell has been turned about its middle and stretched, too far for a
  // part to have been displaced as its whole point.
  template <int dim>
  void
  expect_initial_places_of_parts(const bool mixed, const unsigned int parts)
  {
    SceneRun<dim>        run(block<dim>(dim == 2 ? "set Upper corner = 1, 1" :
                                                   "set Upper corner = 1, 1, 1"),
                      {"Output/Time interval=1", "Output/Fields=displacement"});
    MaterialPoints<dim> &points = run.bodies[0]->points;
    ASSERT_GT(points.reference_position(0).norm(), 0);
    dealii::Tensor<2, dim> F = dealii::unit_symmetric_tensor<dim>();
    F[0][0] = F[1][1] = 1.1 * std::cos(1.);
    F[0][1]           = -1.1 * std::sin(1.);
    F[1][0]           = 1.1 * std::sin(1.);
    const auto middle = [&](const std::size_t p) {
      const auto            &cell = run.grid.geometry[points.view().cell[p]];
      dealii::Tensor<1, dim> result;
      for (int d = 0; d < dim; ++d)
        result[d] = cell.origin[d] + 0.5 / cell.inverse_edge[d];
      return result;
    };
    const auto place = [&](const std::size_t p) {
      dealii::Tensor<1, dim> result;
      for (int d = 0; d < dim; ++d)
        result[d] = points.view().position[d][p];
      return result;
    };
    std::mt19937                                    engine(1);
    std::uniform_real_distribution<double>          anywhere(-0.2, 0.2);
    std::vector<std::size_t>                        all(points.size());
    std::map<std::uint64_t, dealii::Tensor<1, dim>> displacement;
    for (std::size_t p = 0; p < all.size(); ++p)
      {
        all[p]              = p;
        const auto position = middle(p) + F * (place(p) - middle(p));
        for (int d = 0; d < dim; ++d)
          points.view().position[d][p] =
            mixed ? middle(p)[d] + anywhere(engine) : position[d];
        displacement[points.id(p)] = place(p) - points.reference_position(p);
      }
    std::array<double, dim> spacing;
    spacing.fill(0.25);
    points.split(all, parts, spacing, all.size());
    double largest = 0, shift = 0;
    for (std::size_t p = 0; p < points.size(); ++p)
      {
        const dealii::Tensor<1, dim> initial(points.reference_position(p)),
          expected = middle(p) + invert(F) * (place(p) - middle(p)),
          copied   = place(p) - initial;
        largest    = std::max(largest, (initial - expected).norm());
        if (displacement.count(points.id(p)) > 0)
          shift = std::max(shift, (copied - displacement[points.id(p)]).norm());
      }
    if (mixed) // somewhere within reach, whatever the fit says
      EXPECT_LT(shift, 0.25);
    else
      {
        EXPECT_LT(largest, 1e-13);
        if (parts == 2)
          EXPECT_GT(shift, 0.04); // of 0.09 that the parts are from the middle
        else
          EXPECT_EQ(shift, 0); // the middle one is where the whole was
      }
  }
} // namespace



// A point at a slanted surface: no part sticks out, and all end where the whole
// does; the centre of mass stays. Joined again, it is as before.
TEST(Splitting, PartsAtASurfaceEndWhereTheWholeDoes)
{
  SceneRun<2>          run(block<2>("set Upper corner = 1, 1"),
                  {"Obstacles=floor",
                            "Obstacle floor/Shape=half-space",
                            "Obstacle floor/Half-space/Point=0, -1",
                            "Obstacle floor/Half-space/Normal=0, 1"});
  MaterialPoints<2>   &points = run.bodies[0]->points;
  dealii::Tensor<1, 2> normal;
  normal[0] = -0.5;
  normal[1] = -std::sqrt(0.75);
  for (const double reach : {0.05, 0.125, 0.3})
    for (const unsigned int parts : {2, 3})
      {
        SCOPED_TRACE(std::to_string(reach) + ", " + std::to_string(parts));
        const std::size_t      p     = 0;
        const std::size_t      n     = points.size();
        const dealii::Point<2> whole = run.position(p);
        ASSERT_NE(points.view().reach, nullptr);
        points.view().reach[p] = reach;
        points.split({p}, parts, {{0.25, 0.25}}, 1000, {normal});
        std::vector<std::size_t> all = {p};
        for (std::size_t q = n; q < points.size(); ++q)
          all.push_back(q);
        ASSERT_EQ(all.size(), parts * parts);
        dealii::Tensor<1, 2> centre;
        for (const std::size_t q : all)
          {
            const dealii::Tensor<1, 2> way = run.position(q) - whole;
            centre += way;
            EXPECT_NEAR(normal * way + points.view().reach[q], reach, 1e-15);
            EXPECT_GE(points.view().reach[q], 0.249 * reach);
          }
        EXPECT_LT(centre.norm(), 1e-15);
        points.join({all});
        EXPECT_EQ(points.size(), n);
      }

  // The last of a row along an axis, whose parts are of two kinds
  dealii::Tensor<1, 2> down;
  down[1]                = -1;
  const std::size_t n    = points.size();
  points.view().reach[0] = 0.125;
  points.split({0}, 2, {{0.25, 0.25}}, 2000, {down});
  points.join({{0, n, n + 1, n + 2}});
  EXPECT_NEAR(points.view().reach[0], 0.125, 1e-15);
}



TEST(Splitting, PartsWereWhereTheDeformationSays)
{
  for (const bool mixed : {false, true})
    for (const unsigned int parts : {2, 3})
      {
        SCOPED_TRACE((mixed ? "mixed" : "turned") + std::to_string(parts));
        expect_initial_places_of_parts<2>(mixed, parts);
        expect_initial_places_of_parts<3>(mixed, parts);
      }
}



// Means around nodes are the exception: their pressure varies within a cell,
// and its product with gradients is of second order in the shift.
TEST(Splitting, ChangesNothingThatTheGridSees)
{
  for (const std::string placement : {"regular", "jittered"})
    {
      for (const std::string treatment :
           {"none", "cell", "cell full", "assumed strain"})
        for (const unsigned int parts : {2, 3})
          expect_no_change<2>(treatment, placement, "linear", parts);
      for (const std::string treatment : {"cell", "assumed strain"})
        for (const unsigned int parts : {2, 3})
          expect_no_change<3>(treatment, placement, "linear", parts);
    }
}



// Parts of boxes see what the whole box saw.
TEST(Splitting, OfBoxesChangesNothingThatTheGridSees)
{
  for (const std::string kernel : {"gimp", "cpgimp"})
    {
      for (const unsigned int parts : {2, 3})
        {
          expect_no_change<2>("none", "regular", kernel, parts);
          expect_no_change<3>("none", "regular", kernel, parts);
        }
    }
}



namespace
{
  std::uint64_t
  points_of_size(const MaterialPoints<2> &points, const unsigned int size)
  {
    std::uint64_t n = 0;
    for (std::size_t p = 0; p < points.size(); ++p)
      n += points.size_class(p) == size;
    return n;
  }
} // namespace



// A fine region that comes, moves on and goes, under points at rest.
TEST(Adapting, FollowsARegionThatMoves)
{
  SceneRun<2>   run(block<2>("set Where = 0.5 - abs(x - 1 - t)"),
                  {"Grid/Levels=2", "Body block/Locking treatment=cell"});
  Adaptation<2> adaptation(run.problem, run.grid, run.bodies);
  const Adaptation<2>::KeptPoints kept(1);
  const auto                      before  = run.totals();
  const auto                      n_start = run.bodies[0]->points.size();
  for (unsigned int k = 1; k <= 12; ++k)
    {
      run.time = 0.25 * k;
      if (adaptation.adapt(run.time, kept))
        run.integrator.reinit();
      const auto now = run.totals();
      EXPECT_NEAR(now.all.kinetic_energy, before.all.kinetic_energy, 1e-12);
      EXPECT_EQ(run.ledger.lost_points, 0u);
      // In the region cells are fine, and the points in them as well.
      const PointView<2> points = run.points();
      for (std::size_t p = 0; p < points.size; ++p)
        {
          const unsigned int level = run.grid.level_of(points.cell[p]);
          if (std::abs(points.position[0][p] - 1 - run.time) < 0.5)
            {
              EXPECT_EQ(level, 2u);
            }
          EXPECT_GE(run.bodies[0]->points.size_class(p), level);
        }
    }
  EXPECT_GT(adaptation.state().mesh_changes, 3u);
  EXPECT_EQ(run.bodies[0]->points.size(),
            n_start + adaptation.state().points_added);
  EXPECT_EQ(adaptation.state().points_added,
            3 * adaptation.state().points_split);

  // Long gone: the body may be as coarse as its points allow, sixteen a cell.
  for (unsigned int k = 0; k < 6; ++k)
    adaptation.adapt(100, kept);
  run.integrator.reinit();
  std::map<std::uint32_t, unsigned int> count;
  const PointView<2>                    points = run.points();
  unsigned int                          finest = 0;
  for (std::size_t p = 0; p < points.size; ++p)
    {
      ++count[points.cell[p]];
      finest = std::max(finest, run.grid.level_of(points.cell[p]));
    }
  for (const auto &[cell, n] : count)
    EXPECT_LE(n, 16u);
  EXPECT_EQ(finest, 1u);
  EXPECT_GT(points_of_size(run.bodies[0]->points, 2), 0u);
}



// Points go into cells that are fine from the start, as parts.
TEST(Adapting, SplitsWhatIsGoingToEnterFineCells)
{
  SceneRun<2>                     run(block<2>("set Where = x - 2.6"),
                  {"Body block/Initial velocity=0.5; 0.1",
                                       "Body block/Locking treatment=none"});
  Adaptation<2>                   adaptation(run.problem, run.grid, run.bodies);
  const Adaptation<2>::KeptPoints kept(1);
  constexpr double                step = 0.01, edge = 0.25;
  for (unsigned int k = 0; k < 150; ++k)
    {
      run.advance(step);
      if (adaptation.is_due(0.5 * step / edge) &&
          adaptation.adapt(run.time, kept))
        run.integrator.reinit();
      const PointView<2> points = run.points();
      for (std::size_t p = 0; p < points.size; ++p)
        ASSERT_GE(run.bodies[0]->points.size_class(p),
                  run.grid.level_of(points.cell[p]));
    }
  EXPECT_GT(adaptation.state().points_split, 20u);
  EXPECT_EQ(run.ledger.lost_points, 0u);
}



// Steps of coarse cells are long, so a region that appears is looked for after
// fewer of them: 50 of the finest ones.
TEST(Adapting, LooksForRegionsThatAppear)
{
  SceneRun<2>   run(block<2>("set Where = if(t < 1, -1, 1 - x)"),
                  {"Grid/Levels=2", "Body block/Locking treatment=none"});
  Adaptation<2> adaptation(run.problem, run.grid, run.bodies);
  const Adaptation<2>::KeptPoints kept(1);
  const auto                      steps_until_due = [&]() {
    for (unsigned int n = 1;; ++n)
      if (adaptation.is_due(0))
        return n;
  };
  EXPECT_EQ(steps_until_due(), 13u);
  adaptation.adapt(0.5, kept);
  EXPECT_EQ(steps_until_due(), 13u);
  adaptation.adapt(1.5, kept);
  EXPECT_EQ(steps_until_due(), 25u);
  adaptation.adapt(1.5, kept);
  EXPECT_EQ(steps_until_due(), 50u);
}



// One that is observed becomes nine and stays the one in the middle.
TEST(Adapting, LeavesAnObservedPointWhereItIs)
{
  SceneRun<2>              run(block<2>("set Where = t - 0.5"),
                  {"Grid/Levels=2", "Body block/Locking treatment=cell"});
  Adaptation<2>            adaptation(run.problem, run.grid, run.bodies);
  const MaterialPoints<2> &points      = run.bodies[0]->points;
  const std::size_t        n_start     = points.size();
  const std::uint64_t      id          = points.id(n_start / 2);
  const auto               place_of_it = [&]() {
    std::size_t p = 0;
    while (points.id(p) != id)
      ++p;
    return std::array<double, 2>{
      {points.view().position[0][p], points.view().position[1][p]}};
  };
  const auto before = place_of_it();
  run.time          = 1;
  ASSERT_TRUE(adaptation.adapt(run.time, {{id}}));
  EXPECT_EQ(points.size(), 4 * (n_start - 1) + 9);
  ASSERT_TRUE(adaptation.adapt(run.time, {{id}}));
  EXPECT_EQ(place_of_it(), before);
  EXPECT_EQ(points.size(), 16 * (n_start - 1) + 8 * 4 + 9);
  EXPECT_EQ(points.size(), n_start + adaptation.state().points_added);
}



// Back and forth: mesh changes alone leave points as they are.
TEST(Adapting, OfTheMeshAloneLeavesPointsAsTheyAre)
{
  SceneRun<2> run(block<2>("set Upper corner = 1.5, 1.5"),
                  {"Grid/Levels=2", "Body block/Locking treatment=cell"});
  shake_points(run);
  const auto fine = run.grid.divided_cells();
  struct Point
  {
    dealii::Point<2>     place;
    dealii::Tensor<1, 2> velocity;
    double               mass, pressure;
  };
  const auto all = [&]() {
    std::map<std::uint64_t, Point> result;
    for (std::size_t p = 0; p < run.points().size; ++p)
      result[run.bodies[0]->points.id(p)] = {run.position(p),
                                             run.velocity(p),
                                             run.points().mass[p],
                                             run.points().pressure[p]};
    return result;
  };
  const auto before = all();
  for (unsigned int k = 0; k < 4; ++k)
    {
      EXPECT_TRUE(change_mesh(run.grid,
                              run.bodies,
                              k % 2 == 0 ? run.grid.no_divided_cells() : fine));
      run.integrator.reinit();
      const auto after = all();
      ASSERT_EQ(after.size(), before.size());
      for (const auto &[id, point] : before)
        {
          const Point &now = after.at(id);
          EXPECT_EQ(now.place, point.place);
          EXPECT_EQ(now.velocity, point.velocity);
          EXPECT_EQ(now.mass, point.mass);
          EXPECT_EQ(now.pressure, point.pressure);
        }
    }
  EXPECT_TRUE(run.grid.divided_cells() == fine);
}



// All cells with points of a body, and none that is far from them.
TEST(Adapting, FollowsABodyAndItsSurface)
{
  for (const std::string criterion :
       {"set Criterion = body\nset Bodies = block", "set Criterion = surface"})
    {
      SCOPED_TRACE(criterion);
      SceneRun<2>   run(block<2>(criterion),
                      {"Grid/Levels=2",
                         "Grid/Cells=32, 32",
                         "Body block/Initial velocity=0.4; 0.2",
                         "Body block/Locking treatment=cell"});
      Adaptation<2> adaptation(run.problem, run.grid, run.bodies);
      const Adaptation<2>::KeptPoints kept(1);
      const double                    energy = run.totals().all.kinetic_energy;
      for (unsigned int n = 0; n < 400; ++n)
        {
          const bool asked =
            adaptation.is_due(run.integrator.largest_displacement());
          if (asked && adaptation.adapt(run.time, kept))
            run.integrator.reinit();
          // Until the next time a point may enter a cell of a finer level.
          if (asked)
            for (std::size_t p = 0; p < run.points().size; ++p)
              {
                ASSERT_GE(run.bodies[0]->points.size_class(p),
                          run.grid.level_of(run.points().cell[p]));
              }
          run.advance(0.008);

          const PointView<2> points = run.points();
          for (std::size_t p = 0; p < points.size; ++p)
            {
              const auto   x     = run.position(p);
              const double left  = 0.5 + 0.4 * run.time,
                           lower = 0.5 + 0.2 * run.time;
              const double depth = std::min(
                {x[0] - left, left + 2 - x[0], x[1] - lower, lower + 2 - x[1]});
              const unsigned int level = run.grid.level_of(points.cell[p]);
              if (criterion.find("body") != std::string::npos || depth < 0.03)
                {
                  ASSERT_EQ(level, 2u) << x << " at " << run.time;
                }
              else if (depth > 0.7)
                {
                  ASSERT_EQ(level, 0u) << x << " at " << run.time;
                }
            }
        }
      // A rim with nothing but room in it is wider, and lasts longer.
      const bool is_body = criterion.find("body") != std::string::npos;
      EXPECT_GT(adaptation.state().mesh_changes, is_body ? 2u : 10u);
      EXPECT_LT(adaptation.state().times_asked, is_body ? 6u : 40u);
      EXPECT_EQ(run.ledger.lost_points, 0u);
      // rigid motion goes on rigidly
      EXPECT_NEAR(run.totals().all.kinetic_energy, energy, 1e-11 * energy);
    }
}



// What lies on a side that it meets with its surface still does so when its
// points are split, wherever these are in their cells.
TEST(Adapting, LeavesABlockOnASideAtRest)
{
  const std::string scene = R"(
    set Bodies = block
    subsection Body block
      subsection Box
        set Lower corner = 0.25, 0
        set Upper corner = 0.75, 0.5
      end
      set Material = neo hookean
      set Frame = current
    end
    subsection Grid
      set Cells  = 8, 8
      set Levels = 1
      set Refine = later
      subsection Refine later
        set Where = t - 0.005
      end
    end
    subsection Boundaries
      set bottom = separating
    end)";
  for (const std::string placement : {"regular", "gauss", "jittered"})
    {
      SCOPED_TRACE(placement);
      SceneRun<2>   run(scene,
                      {"Method/Kernel=cpgimp",
                         "Body block/Placement=" + placement});
      Adaptation<2> adaptation(run.problem, run.grid, run.bodies);
      const Adaptation<2>::KeptPoints kept(1);
      const unsigned int              n_points = run.points().size;
      while (run.time < 0.03)
        {
          if (adaptation.adapt(run.time, kept))
            run.integrator.reinit();
          run.advance(run.integrator.longest_step());
        }
      EXPECT_EQ(run.points().size, 4 * n_points);
      EXPECT_LT(run.totals().all.kinetic_energy, 1e-20);
    }
}



// Parts of a point near the edge of a cell lie in the next one: where their
// domains overlapped, others would leave gaps, and bodies under stress creep.
TEST(Splitting, DomainsOfPartsFillThatOfTheWhole)
{
  for (const std::string kernel : {"cpdi", "gimp"})
    {
      SCOPED_TRACE(kernel);
      SceneRun<2>          run(block<2>("set Lower corner = 3, 3"),
                      {"Method/Kernel=" + kernel,
                                "Method/Stress update=usl",
                                "Body block/Locking treatment=none",
                                "Body block/Placement=regular"});
      dealii::Tensor<1, 2> shift;
      shift[0] = 0.1;
      shift[1] = 0.07;
      run.translate(shift);
      constexpr double   half    = 0.125; // edge of a domain
      MaterialPoints<2> &points  = run.bodies[0]->points;
      const std::size_t  n       = points.size();
      std::size_t        n_apart = 0;
      for (std::size_t p = 0; p < n; ++p)
        {
          const dealii::Point<2>   whole = run.position(p);
          const std::uint32_t      cell  = points.view().cell[p];
          std::vector<std::size_t> all   = {p};
          for (std::size_t q = 0; q < 3; ++q)
            all.push_back(points.size() + q);
          points.split({p}, 2, {{0, 0}}, points.size());
          for (const std::size_t q : all)
            {
              const auto way = run.position(q) - whole;
              const auto xi =
                natural_place(points.view(),
                              run.grid.geometry[points.view().cell[q]],
                              q);
              for (int d = 0; d < 2; ++d)
                {
                  EXPECT_NEAR(std::abs(way[d]), 0.5 * half, 1e-14);
                  EXPECT_NEAR(points.view().domain[3 * d][q],
                              0.5 * half,
                              1e-14);
                  EXPECT_GE(xi[d], 0);
                  EXPECT_LE(xi[d], 1);
                }
              n_apart += points.view().cell[q] != cell;
            }
        }
      EXPECT_GT(n_apart, 0u);
    }
}



// The cells with points limit the steps, not finer ones further on.
TEST(Adapting, EmptyFineCellsDoNotCountInTheCourantNumber)
{
  SceneRun<2> apart(block<2>("set Lower corner = 3, 3")),
    inside(block<2>("set Upper corner = 1, 1"));
  EXPECT_EQ(apart.grid.smallest_edge, 0.25);
  EXPECT_EQ(smallest_edge_with_points(apart.state()), 0.5);
  EXPECT_EQ(smallest_edge_with_points(inside.state()), 0.25);
}



TEST(Adapting, RefusesABodyThinnerThanItsCells)
{
  const std::string far_away = "set Lower corner = 3, 3";
  const std::string thin     = "Body block/Box/Upper corner=2.5, 0.7";
  try
    {
      SceneRun<2> run(block<2>(far_away), {thin});
      FAIL() << "should have been refused";
    }
  catch (const InputError &error)
    {
      for (const char *const words :
           {"'block'", "thin along y", "0.5 m", "'Grid/Refine'"})
        EXPECT_NE(std::string(error.what()).find(words), std::string::npos)
          << error.what();
    }
  SceneRun<2> covered(block<2>("set Criterion = body\nset Bodies = block"),
                      {thin});
  EXPECT_GT(covered.points().size, 0u);
}
