// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/interpolation/convected_fields.h>
#include <limber/problem/read_parts.h>

#include <gtest/gtest.h>
#include <support/scene_parts.h>
#include <support/scene_run.h>

#include <map>
#include <random>

/**
 * @file What cells of several sizes must not change: sums over nodes, patches
 * of constant stress, rigid motion, the longest step; and what they do change,
 * reflection, against its closed form (doc/theory/adaptive_grid.md).
 */

using namespace limber;

namespace
{
  const std::string free_box_3d = R"(
    subsection Boundaries
      set left = free
      set right = free
      set bottom = free
      set top = free
      set back = free
      set front = free
    end
)";



  /** A block that is fine in two steps towards a corner, in the current frame.
   */
  template <int dim>
  std::string
  graded_block(const std::string &body)
  {
    const std::string z = dim == 3 ? ", 0.5" : "", zz = dim == 3 ? ", 3" : "";
    return "set Dimension = " + std::to_string(dim) + R"(
    set Bodies = block
    subsection Body block
      subsection Box
        set Lower corner = 0.5, 0.5)" +
           z + R"(
        set Upper corner = 3, 3)" +
           zz + R"(
      end
      subsection Linear elastic
        set Density = 2
        set Young's modulus = 1
      end
      )" + body +
           R"(
    end
    subsection Grid
      set Upper corner = 4, 4)" +
           (dim == 3 ? ", 4" : "") + R"(
      set Cells = 8, 8)" +
           (dim == 3 ? ", 8" : "") + R"(
      set Levels = 2
      set Refine = corner, edge
      subsection Refine corner
        set Upper corner = 0.8, 0.8)" +
           (dim == 3 ? ", 0.8" : "") + R"(
      end
      subsection Refine edge
        set Level = 1
        set Where = 1.8 - x
      end
    end
)" + (dim == 2 ? free_sides : free_box_3d);
  }



  /** Places of the nodes at corners of cells that this rank knows. */
  template <int dim>
  std::map<std::uint32_t, dealii::Point<dim>>
  places_of_nodes(const BackgroundGrid<dim> &grid)
  {
    std::map<std::uint32_t, dealii::Point<dim>> places;
    for (const auto &cell : grid.geometry)
      for (int i = 0; i < 1 << dim; ++i)
        for (int d = 0; d < dim; ++d)
          places[cell.node[i] / NodeLayout<dim>::stride][d] =
            cell.origin[d] + (i >> d & 1) / cell.inverse_edge[d];
    return places;
  }



  /** x_a y_b - x_b y_a, all of them. */
  template <int dim>
  dealii::Tensor<2, dim>
  moment(const dealii::Tensor<1, dim> &x, const dealii::Tensor<1, dim> &y)
  {
    dealii::Tensor<2, dim> result;
    for (int a = 0; a < dim; ++a)
      for (int b = 0; b < dim; ++b)
        result[a][b] = x[a] * y[b] - x[b] * y[a];
    return result;
  }



  /** Random velocities and stresses at the points. */
  template <int dim>
  void
  shake(SceneRun<dim> &run)
  {
    std::mt19937         random(11);
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



  template <int dim>
  void
  expect_sums(const std::string &treatment,
              const std::string &scheme,
              const std::string &kernel = "linear")
  {
    SCOPED_TRACE(treatment + ", " + scheme + ", " + kernel + ", dim " +
                 std::to_string(dim));
    using Layout = NodeLayout<dim>;
    SceneRun<dim> run(graded_block<dim>("set Placement = jittered"),
                      {"Body block/Locking treatment=" + treatment,
                       "Method/Stress update=" + scheme,
                       "Method/Kernel=" + kernel});
    shake(run);

    double                 mass = 0, scale = 0;
    dealii::Tensor<1, dim> first, momentum;
    dealii::Tensor<2, dim> spin;
    const PointView<dim>   points = run.points();
    for (std::size_t p = 0; p < points.size; ++p)
      {
        const dealii::Tensor<1, dim> x = run.position(p), v = run.velocity(p);
        mass += points.mass[p];
        first += points.mass[p] * x;
        momentum += points.mass[p] * v;
        spin += points.mass[p] * moment<dim>(x, v);
      }
    constexpr double step = 1e-9;
    run.advance(step);

    double                 nodal_mass = 0;
    dealii::Tensor<1, dim> nodal_first, nodal_momentum, force;
    dealii::Tensor<2, dim> nodal_spin, torque;
    const auto             places = places_of_nodes(run.grid);
    for (const std::uint32_t node : run.nodes.active_nodes())
      {
        const double *const record = run.nodes.record(node);
        const double        m      = record[Layout::mass];
        if (!(m > 0))
          continue;
        dealii::Tensor<1, dim> x = places.at(node), v, f;
        for (int d = 0; d < dim; ++d)
          {
            f[d] = m * record[Layout::increment + d] / step;
            v[d] = record[Layout::velocity + d] - record[Layout::increment + d];
          }
        nodal_mass += m;
        nodal_first += m * x;
        nodal_momentum += m * v;
        nodal_spin += m * moment<dim>(x, v);
        force += f;
        torque += moment<dim>(x, f);
        scale += f.norm();
      }
    EXPECT_FALSE(run.grid.vertices.hanging.empty());
    EXPECT_NEAR(nodal_mass, mass, 1e-13 * mass);
    EXPECT_LT((nodal_first - first).norm(), 1e-13 * first.norm());
    EXPECT_LT((nodal_momentum - momentum).norm(), 1e-13 * mass);
    EXPECT_LT((nodal_spin - spin).norm(), 1e-12 * mass);
    EXPECT_LT(force.norm(), 1e-13 * scale);
    EXPECT_LT(torque.norm(), 1e-12 * scale);
  }
} // namespace



TEST(Jumps, SumsOverNodesAreThoseOverPoints)
{
  for (const std::string treatment : {"none",
                                      "cell",
                                      "cell shear",
                                      "cell full",
                                      "assumed strain",
                                      "node",
                                      "hybrid"})
    expect_sums<2>(treatment, "musl");
  for (const std::string treatment : {"none", "cell", "assumed strain", "node"})
    expect_sums<3>(treatment, "musl");
}



// With USL, as solids with domains move with the velocity that strains them
// otherwise, which then is in the record of the new one.
TEST(Jumps, SumsOverNodesAreThoseOverPointsWithDomains)
{
  for (const std::string kernel : {"gimp", "cpgimp", "cpdi"})
    for (const std::string treatment : {"none", "cell", "node"})
      {
        expect_sums<2>(treatment, "usl", kernel);
        expect_sums<3>(treatment, "usl", kernel);
      }
}



namespace
{
  // Constant stress: no force in nodes that are surrounded by material, of
  // whichever size the cells around are.
  template <int dim>
  void
  expect_no_force(const std::string &treatment,
                  const std::string &kernel = "linear")
  {
    SCOPED_TRACE(treatment + ", " + kernel + ", dim " + std::to_string(dim));
    using Layout = NodeLayout<dim>;
    SceneRun<dim>        run(graded_block<dim>(""),
                      {"Body block/Locking treatment=" + treatment,
                              "Method/Stress update=musl",
                              "Method/Kernel=" + kernel});
    const PointView<dim> points = run.points();
    for (std::size_t p = 0; p < points.size; ++p)
      {
        points.pressure[p] = 0.7;
        double value       = 0.2;
        for (double *const component : points.deviator)
          component[p] = value += 0.1;
      }
    run.integrator.reinit();
    constexpr double step = 1e-9;
    run.advance(step);
    const auto   places  = places_of_nodes(run.grid);
    unsigned int n_inner = 0;
    for (const std::uint32_t node : run.nodes.active_nodes())
      {
        const double *const record = run.nodes.record(node);
        bool                inner  = record[Layout::mass] > 0;
        for (int d = 0; d < dim; ++d)
          inner = inner && places.at(node)[d] > 0.6 && places.at(node)[d] < 2.4;
        if (!inner)
          continue;
        ++n_inner;
        for (int d = 0; d < dim; ++d)
          EXPECT_NEAR(record[Layout::mass] * record[Layout::increment + d] /
                        step,
                      0,
                      1e-14);
      }
    EXPECT_GT(n_inner, dim == 2 ? 30u : 200u);
  }
} // namespace



TEST(Jumps, ConstantStressGivesNoForce)
{
  for (const std::string treatment : {"none",
                                      "cell",
                                      "cell shear",
                                      "cell full",
                                      "assumed strain",
                                      "node",
                                      "hybrid"})
    expect_no_force<2>(treatment);
  for (const std::string treatment : {"none", "cell", "assumed strain", "node"})
    expect_no_force<3>(treatment);
  // Domains fill the room at the start.
  for (const std::string kernel : {"gimp", "cpgimp"})
    {
      expect_no_force<2>("cell", kernel);
      expect_no_force<3>("cell", kernel);
    }
}



// Through both jumps and over many cells, in a fluid and a solid.
TEST(Jumps, RigidMotionStaysRigid)
{
  for (const std::string transfer :
       {"flip", "pic", "apic", "aflip", "fmpm", "xpic"})
    for (const std::string &scheme : stress_update_orders)
      {
        const bool filters = transfer == "fmpm" || transfer == "xpic";
        if (filters && scheme != "usl")
          continue;
        SCOPED_TRACE(transfer + ", " + scheme);
        SceneRun<2>  run(graded_block<2>("set Initial velocity = 0.5; 0.31"),
                        {"Method/Transfer=" + transfer,
                          "Method/Stress update=" + scheme});
        const double before = run.totals().all.kinetic_energy;
        run.advance(0.0217, 90);
        const Totals<2> after = run.totals();
        EXPECT_NEAR(after.all.kinetic_energy, before, 1e-12 * before);
        EXPECT_LT(after.all.strain_energy, 1e-24 * before);
        EXPECT_EQ(run.ledger.lost_points, 0u);
      }
}



namespace
{
  /** How a body that fills a box with three sizes of cells is sheared. */
  struct Sheared
  {
    double spread;   // of the deviatoric stress, of G gamma t
    double velocity; // largest difference from the exact one, of gamma
  };

  // Simple shear along x: v = gamma y, or gamma (y + z), which sides hold and
  // which needs no force. No point crosses the edge of a cell. Of a transfer
  // with the full mass the order k, else 0.
  template <int dim>
  Sheared
  shear(const std::string &treatment,
        const std::string &transfer,
        const std::string &finest,
        const std::string &fine,
        const unsigned int order = 0)
  {
    const std::string velocity = dim == 2 ? "0.01*y; 0" : "0.01*(y + z); 0; 0",
                      ones     = dim == 2 ? "1, 1" : "1, 1, 1";
    std::string text = "set Dimension = " + std::to_string(dim) + R"(
    set Bodies = block
    subsection Body block
      set Initial velocity = )" +
                       velocity + R"(
      subsection Box
        set Upper corner = )" +
                       ones + R"(
      end
      subsection Linear elastic
        set Density = 1
        set Young's modulus = 1
        set Poisson's ratio = 0.25
      end
    end
    subsection Grid
      set Upper corner = )" +
                       ones +
                       "\nset Cells = " + (dim == 2 ? "4, 4" : "4, 4, 4") +
                       R"(
      set Levels = 2
      set Refine = finest, fine
      subsection Refine finest
        set Where = )" +
                       finest + R"(
      end
      subsection Refine fine
        set Level = 1
        set Where = )" +
                       fine + R"(
      end
    end
    subsection Boundaries
)";
    for (int side = 0; side < 2 * dim; ++side)
      {
        const std::string name = side_names(dim)[side];
        text += "set " + name + " = velocity\nsubsection Side " + name +
                "\nset Velocity = " + velocity + "\nend\n";
      }
    SceneRun<dim> run(
      text + "end\n",
      {"Body block/Locking treatment=" + treatment,
       "Method/Transfer=" + transfer,
       "Method/Transfer order=" + std::to_string(order > 0 ? order : 4),
       order > 0 ? "Method/Stress update=usl" : "Method/Stress update=musl"});
    dealii::Tensor<2, dim> gradient;
    for (int d = 1; d < dim; ++d)
      gradient[0][d] = 0.01;
    run.set_linear_velocity(gradient, dealii::Point<dim>());
    run.integrator.reinit();
    EXPECT_FALSE(run.grid.vertices.hanging.empty());
    const double           time = 0.9 / 64 / (0.01 * (dim - 1));
    constexpr unsigned int n    = 60;
    run.advance(time / n, n);
    const PointView<dim> points = run.points();
    Sheared              result{0, 0};
    double               least = 1e300, most = -1e300;
    for (std::size_t p = 0; p < points.size; ++p)
      {
        const double xy = points.deviator[2][p];
        least           = std::min(least, xy);
        most            = std::max(most, xy);
        result.velocity =
          std::max(result.velocity,
                   (run.velocity(p) - gradient * run.position(p)).norm() /
                     0.01);
      }
    result.spread = (most - least) / (0.4 * 0.01 * time);
    return result;
  }
} // namespace



// With velocities that know their gradient the deformation is homogeneous
// through changes of size that lie along the shear. Others bring nodes in a
// jump the velocity of the centre of what they see, not their own, as at any
// surface; so stress has peaks there until they are in balance. So do nodes at
// the corner of a finer part with any transfer, as those that hang lie on one
// side of them.
TEST(Jumps, HomogeneousShearIsExactWithApic)
{
  for (const std::string treatment : {"none", "cell", "assumed strain"})
    {
      SCOPED_TRACE(treatment);
      const Sheared plane = shear<2>(treatment, "apic", "0.3 - y", "0.6 - y"),
                    space = shear<3>(treatment, "apic", "0.3 - y", "0.6 - y");
      EXPECT_LT(plane.spread, 1e-10);
      EXPECT_LT(plane.velocity, 1e-12);
      EXPECT_LT(space.spread, 1e-10);
      EXPECT_LT(space.velocity, 1e-12);
    }
  for (const std::string transfer : {"flip", "apic"})
    for (const std::string fine : {"y", "x", "max(x, y)"})
      std::printf(
        "%s, fine where %s < 0.5: spread of the shear stress %.3f, in 3d %.3f\n",
        transfer.c_str(),
        fine.c_str(),
        shear<2>("cell", transfer, "0*x - 1", "0.5 - " + fine).spread,
        shear<3>("cell", transfer, "0*x - 1", "0.5 - " + fine).spread);
}



// The velocity that has the momenta of the nodes is the linear one, whatever
// the size of cells: what is left after k passes falls geometrically.
TEST(Jumps, HomogeneousShearTendsToExactWithFullMass)
{
  for (const std::string fine : {"y", "x", "max(x, y)"})
    {
      const std::string where = "0.5 - " + fine;
      SCOPED_TRACE(where);
      for (const unsigned int order : {4, 16, 64})
        std::printf(
          "fmpm(%u), fine where %s < 0.5: spread of the shear stress %.1e, in 3d %.1e\n",
          order,
          fine.c_str(),
          shear<2>("cell", "fmpm", "0*x - 1", where, order).spread,
          shear<3>("cell", "fmpm", "0*x - 1", where, order).spread);
      EXPECT_LT(shear<2>("cell", "fmpm", "0*x - 1", where, 64).spread, 2e-6);
      EXPECT_LT(shear<3>("cell", "fmpm", "0*x - 1", where, 64).spread, 2e-4);
    }
}



namespace
{
  // A strip without Poisson's effect between slip walls, one coarse cell high:
  // fine cells up to x = 0, then coarse ones of twice the size, or all fine.
  std::string
  strip(const double       length_fine,
        const double       length_coarse,
        const std::string &refinement,
        const std::string &side = "")
  {
    const double lower = -length_fine;
    return R"(
    set Bodies = bar
    subsection Body bar
      subsection Box
        set Lower corner = )" +
           digits(lower) + ", 0\nset Upper corner = " + digits(length_coarse) +
           R"(, 1
      end
      set Locking treatment = none
      subsection Linear elastic
        set Density = 1
        set Young's modulus = 1
        set Poisson's ratio = 0
      end
    end
    subsection Grid
      set Lower corner = )" +
           digits(lower) + ", 0\nset Upper corner = " + digits(length_coarse) +
           ", 1\nset Cells = " +
           std::to_string(std::lround(length_fine + length_coarse)) + R"(, 1
      set Levels = 1
      set Refine = left
      subsection Refine left
        set Where = )" +
           refinement + R"(
      end
    end
    subsection Boundaries
      set left = slip
      set right = slip
      )" + side +
           "\nend\n";
  }



  /** Of the reflected burst over the incident one, by their mean squares. */
  double
  reflection(const double wave) // length, in coarse cells
  {
    const double burst = 8 * wave;
    // Of the burst in fine cells, by dispersion (tests/unit/time/dispersion.cc)
    const double theta = dealii::numbers::PI / wave;
    const double speed = 1 - 3 * 0.1354 * theta * theta;
    SceneRun<2>  run(strip(9 * wave,
                          5 * wave,
                          "-x",
                          R"(
      set left = velocity
      subsection Side left
        set Constants = period = )" +
                            digits(wave) + R"(, burst = )" + digits(burst) + R"(
        set Velocity = if(t < burst, 1e-6*sin(2*pi*t/period)*sin(pi*t/burst)^2, 0); 0
      end)"),
                    {"Method/Stress update=musl"});
    // 4.5 waves before the jump and behind the wall that moves: the burst has
    // passed before it comes back, and comes back before the wall sends it on.
    std::size_t nearest = 0;
    for (std::size_t p = 0; p < run.points().size; ++p)
      if (run.position(p).distance({-4.5 * wave, 0.25}) <
          run.position(nearest).distance({-4.5 * wave, 0.25}))
        nearest = p;
    const std::uint64_t id       = run.bodies[0]->points.id(nearest);
    const double        passed   = 4.5 * wave / speed + burst + 0.5 * wave;
    double              incident = 0, reflected = 0;
    run.advance_to(13.5 * wave / speed + burst, [&]() {
      for (std::size_t p = 0; p < run.points().size; ++p)
        if (run.bodies[0]->points.id(p) == id)
          {
            const double v = run.velocity(p)[0];
            (run.time < passed ? incident : reflected) += v * v;
          }
    });
    EXPECT_GT(incident, 0);
    return std::sqrt(reflected / incident);
  }
} // namespace



// R = (1 + s) k^2 (h_c^2 - h_f^2) / 16 for long waves, and its exact form.
TEST(Jumps, ReflectAsTheClosedFormSays)
{
  const std::map<double, double> closed = {{20, 0.0084},
                                           {10, 0.0390},
                                           {8, 0.0701}};
  for (const auto &[cells, expected] : closed)
    {
      const double R = reflection(cells);
      std::printf("%g coarse cells per wave: R = %.4f, closed form %.4f\n",
                  cells,
                  R,
                  expected);
      EXPECT_NEAR(R, expected, 0.15 * expected);
    }
  // Shorter than 5.18 coarse cells: none of it gets through.
  const double all = reflection(4.5);
  std::printf("4.5 coarse cells per wave: R = %.4f\n", all);
  EXPECT_GT(all, 0.95);
}



namespace
{
  /** The longest step with which noise does not grow, of fine cells' h / c. */
  double
  longest_step(const std::string &refinement, const std::string &scheme)
  {
    const auto grows = [&](const double courant_number) {
      SceneRun<2>        run(strip(6, 6, refinement),
                      {"Method/Stress update=" + scheme});
      std::mt19937       random(5);
      const PointView<2> points = run.points();
      for (std::size_t p = 0; p < points.size; ++p)
        points.velocity[0][p] = 1e-8 * (random() / 2147483648. - 1);
      const double before = run.totals().all.kinetic_energy;
      try
        {
          run.advance(0.5 * courant_number, 1500);
        }
      catch (const ComputationError &)
        {
          return true;
        }
      return !(run.totals().all.kinetic_energy < 100 * before);
    };
    double stable = 0.5, unstable = 2.5;
    while (unstable - stable > 0.002)
      {
        const double middle                 = 0.5 * (stable + unstable);
        (grows(middle) ? unstable : stable) = middle;
      }
    return stable;
  }
} // namespace



TEST(Jumps, TheLongestStepIsThatOfFineCells)
{
  for (const std::string scheme : {"musl", "usavg"})
    {
      const double fine = longest_step("1", scheme),
                   jump = longest_step("-x", scheme);
      std::printf("%s: longest step %.3f with a jump, %.3f without\n",
                  scheme.c_str(),
                  jump,
                  fine);
      EXPECT_NEAR(jump, fine, 0.02 * fine);
    }
}



// Functions of points with domains: those of hanging nodes are handed on to
// their masters.
namespace
{
  /** A block on cells of three sizes, with jittered points. */
  template <int dim>
  SceneRun<dim>
  block_on_three_sizes(const std::string &kernel)
  {
    const auto corner = [](const std::string &x) {
      return x + ", " + x + (dim == 3 ? ", " + x : "");
    };
    return SceneRun<dim>("set Dimension = " + std::to_string(dim) + R"(
    set Bodies = block
    subsection Body block
      set Placement = jittered
      set Locking treatment = none
      subsection Box
        set Lower corner = )" +
                           corner("0.5") +
                           "\nset Upper corner = " + corner("3") + R"(
      end
    end
    subsection Grid
      set Upper corner = )" +
                           corner("4") + "\nset Cells = " + corner("8") + R"(
      set Levels = 2
      set Refine = corner, edge
      subsection Refine corner
        set Upper corner = )" +
                           corner("0.8") + R"(
      end
      subsection Refine edge
        set Level = 1
        set Where = 1.8 - x
      end
    end)",
                         {"Method/Kernel=" + kernel});
  }



  /** Longer along one axis and turned, as if points had been strained. */
  template <int dim>
  void
  strain_domains(const PointView<dim> &points)
  {
    std::mt19937 random(7);
    const auto   draw = [&]() { return random() / 2147483648. - 1; };
    for (std::size_t p = 0; p < points.size; ++p)
      for (int d = 0; d < dim; ++d)
        for (int k = 0; k < dim; ++k)
          if (double *const component = points.domain[d * dim + k])
            component[p] =
              component[p] * (1 + 0.5 * draw()) + (d == k ? 0 : 0.02 * draw());
  }



  template <int dim>
  void
  expect_exact_functions(const std::string &kernel)
  {
    SCOPED_TRACE(kernel + ", dim " + std::to_string(dim));
    SceneRun<dim>        run    = block_on_three_sizes<dim>(kernel);
    const PointView<dim> points = run.points();
    strain_domains(points);
    const GridView<dim>                             grid = run.nodes.view();
    std::map<std::uint32_t, const HangingNode *>    hanging;
    std::map<std::uint32_t, dealii::Tensor<1, dim>> places;
    for (const HangingNode &node : run.grid.vertices.hanging)
      hanging[node.node] = &node;
    for (const auto &cell : run.grid.geometry)
      for (int i = 0; i < 1 << dim; ++i)
        for (int d = 0; d < dim; ++d)
          places[cell.node[i] / NodeLayout<dim>::stride][d] =
            cell.origin[d] + (i >> d & 1) / cell.inverse_edge[d];

    unsigned int n_across = 0;
    for (std::size_t p = 0; p < points.size; ++p)
      {
        const ConvectedDomain<dim> domain(points, grid, points.cell[p], p);
        const auto                 inverse = domain.inverse();
        double                     sum = 0, largest = 0;
        dealii::Tensor<1, dim>     place, slopes;
        dealii::Tensor<2, dim>     unit;
        bool                       hangs = false;
        for (int n = 0; n < domain.n_pieces; ++n)
          for (int i = 0; i < 1 << dim; ++i)
            {
              const auto         &piece = domain.pieces[n];
              const std::uint32_t node =
                grid.cells[piece.cell].node[i] / NodeLayout<dim>::stride;
              dealii::Tensor<1, dim> slope;
              for (int e = 0; e < dim; ++e)
                for (int k = 0; k < dim; ++k)
                  slope[e] += piece.along[k][i] * inverse[k][e];
              const auto add = [&](const std::uint32_t master,
                                   const double        share) {
                sum += share * piece.weight[i];
                place += share * piece.weight[i] * places.at(master);
                slopes += share * slope;
                unit += share * outer_product(places.at(master), slope);
              };
              largest = std::max(largest, slope.norm());
              if (hanging.count(node) == 0)
                add(node, 1);
              else
                {
                  hangs = hangs || piece.weight[i] > 0;
                  for (const auto &[master, share] : hanging[node]->masters)
                    add(master, share);
                }
            }
        n_across += hangs;
        EXPECT_NEAR(sum, 1, 1e-13);
        EXPECT_LT((place - run.position(p)).norm(), 1e-13 * 4);
        EXPECT_LT(slopes.norm(), 1e-13 * largest);
        for (int d = 0; d < dim; ++d)
          unit[d][d] -= 1;
        EXPECT_LT(unit.norm(), 1e-13 * 4 * largest);
      }
    EXPECT_GT(n_across, 20u);
  }



  // sum_i f_i . v_i of what random stresses give to the nodes is the power of
  // these stresses with the gradients of the velocity that hanging nodes take
  // from their masters.
  template <int dim>
  void
  expect_adjoint(const std::string &kernel)
  {
    SCOPED_TRACE(kernel + ", dim " + std::to_string(dim));
    using Layout      = NodeLayout<dim>;
    using Window      = RecordWindow<dim, Layout::force, 2 * dim>;
    SceneRun<dim> run = block_on_three_sizes<dim>(kernel);
    strain_domains(run.points());
    run.integrator.reinit();
    const PointView<dim> points = run.points();
    const GridView<dim>  grid   = run.nodes.view();
    std::mt19937         random(13);
    const auto           draw = [&]() { return random() / 2147483648. - 1; };
    run.nodes.clear();
    for (const std::uint32_t node : run.nodes.active_nodes())
      for (int d = 0; d < dim; ++d)
        run.nodes.record(node)[Layout::velocity + d] = draw();
    run.nodes.interpolate_hanging();

    double of_points = 0, scale = 0;
    for (std::size_t p = 0; p < points.size; ++p)
      {
        const ConvectedDomain<dim> domain(points, grid, points.cell[p], p);
        const FieldsOnDomain<dim, Window> fields(domain, grid);
        const auto                        inverse = domain.inverse();
        SmallMatrix<dim, double>          along{};
        for (int d = 0; d < dim; ++d)
          for (int e = 0; e < dim; ++e)
            {
              const double stress = draw();
              const double power =
                stress * fields.slope(inverse, Layout::velocity + d, e);
              of_points += power;
              scale += std::abs(power);
              for (int k = 0; k < dim; ++k)
                along[k][d] += stress * inverse[k][e];
            }
        domain.for_nodes(
          grid, [&](const auto &piece, const int i, double *const record) {
            for (int k = 0; k < dim; ++k)
              for (int d = 0; d < dim; ++d)
                record[Layout::force + d] += piece.along[k][i] * along[k][d];
          });
      }
    run.nodes.start_sum(Layout::force, Layout::force + dim);
    run.nodes.finish_sum();
    double of_nodes = 0;
    for (const std::uint32_t node : run.nodes.active_nodes())
      for (int d = 0; d < dim; ++d)
        of_nodes += run.nodes.record(node)[Layout::force + d] *
                    run.nodes.record(node)[Layout::velocity + d];
    EXPECT_NEAR(of_nodes, of_points, 1e-13 * scale);
  }
} // namespace



// sum N = 1, sum N x_i = x, sum grad N = 0, sum x_i grad N = 1
TEST(DomainsAtJumps, ReproduceLinearFunctions)
{
  for (const std::string kernel : {"gimp", "cpgimp", "cpdi"})
    {
      expect_exact_functions<2>(kernel);
      expect_exact_functions<3>(kernel);
    }
}



TEST(DomainsAtJumps, GiveAndTakeAreAdjoint)
{
  for (const std::string kernel : {"gimp", "cpgimp", "cpdi"})
    {
      expect_adjoint<2>(kernel);
      expect_adjoint<3>(kernel);
    }
}
