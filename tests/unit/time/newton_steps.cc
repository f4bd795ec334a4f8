// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/fem/free_motions.h>

#include <gtest/gtest.h>
#include <support/held_strip.h>
#include <support/scene_run.h>

#include <array>
#include <cmath>

/**
 * @file Steps that Newton's method solves: equilibrium under growing loads, and
 * the trapezoidal rule (NewtonIntegrator).
 */

using namespace limber;

namespace
{
  // A column between slip walls on a slip floor, E = rho g H
  const std::string column = R"(
    set End time = 1
    set Bodies = column
    subsection Body column
      subsection Box
        set Upper corner = 1, 16
      end
      set Points per cell edge = 2
      set Material = neo hookean
      subsection Neo hookean
        set Density = 100
        set Young's modulus = 1.6e4
        set Poisson's ratio = 0
      end
    end
    subsection Grid
      set Upper corner = 1, 18
      set Cells = 1, 18
    end
    subsection Loads
      set Gravity = 0, -10
    end
    subsection Method
      set Time integration = quasi-static
    end)";

  /** Of all points, m. */
  double
  mean_height(SceneRun<2> &run)
  {
    const auto points = run.points();
    double     result = 0;
    for (std::size_t p = 0; p < points.size; ++p)
      result += points.position[1][p] / double(points.size);
    return result;
  }
} // namespace



namespace
{
  // Neo-Hookean solid that is held laterally, E = 1: Kirchhoff stress and
  // energy per initial volume at a stretch.
  struct HeldLaterally
  {
    explicit HeldLaterally(const double nu)
      : G(1 / (2 * (1 + nu)))
      , K(1 / (3 * (1 - 2 * nu)))
    {}

    double
    pressure(const double l) const
    {
      return -K / 2 * (l * l - 1);
    }
    double
    stress(const double l) const
    {
      return G * 2. / 3. * std::pow(l, -2. / 3.) * (l * l - 1) - pressure(l);
    }
    double
    energy(const double l) const
    {
      return G / 2 * (std::pow(l, -2. / 3.) * (l * l + 2) - 3) +
             K / 2 * ((l * l - 1) / 2 - std::log(l));
    }

    /** Under the nominal stress -load. */
    double
    stretch(const double load) const
    {
      const auto unbalance = [&](const double l) {
        return stress(l) / l + load;
      };
      double l = 1;
      for (int i = 0; i < 100; ++i)
        l -=
          unbalance(l) / ((unbalance(l + 1e-7) - unbalance(l - 1e-7)) / 2e-7);
      return l;
    }

    const double G, K;
  };



  // Of a column under its weight, rho g H / E = q: how far the top and the mean
  // of all places sink, over H.
  std::array<double, 2>
  sinking(const double q, const double nu)
  {
    const HeldLaterally solid(nu);
    const int           n   = 2000;
    double              top = 0, mean = 0;
    for (int k = 0; k < n; ++k)
      {
        const double shortening =
          (1 - solid.stretch(q * (1 - (k + 0.5) / n))) / n;
        mean += (top + 0.5 * shortening) / n;
        top += shortening;
      }
    return {{top, mean}};
  }
} // namespace



// A cantilever 0.3 cells thick under a small weight, in one step and in ten:
// the strain energy of a beam, q^2 L^5 / (40 E' I).
TEST(NewtonSteps, BodiesThinnerThanACell)
{
  const double thickness = 0.015, weight = 0.9; // m, N/m^3
  for (const double step : {1., 0.1})
    {
      SceneRun<2> run(held_strip,
                      {"Body strip/Box/Lower corner=0, 0.5",
                       "Body strip/Box/Upper corner=1, " +
                         digits(0.5 + thickness),
                       "Body strip/Frame=initial",
                       "Grid/Upper corner=1.2, 1",
                       "Grid/Cells=24, 20",
                       "Loads/Gravity=0, " + digits(-weight / 1000),
                       "Method/Time integration=quasi-static",
                       "Method/Time step=" + digits(step)});
      run.advance_to(1);
      const double modulus = 1e6 / (1 - 0.3 * 0.3), load = weight * thickness;
      const double exact =
        load * load / (40 * modulus * std::pow(thickness, 3) / 12);
      std::printf("step %g s: %.4f of the energy of a beam\n",
                  step,
                  run.totals().all.strain_energy / exact);
      EXPECT_NEAR(run.totals().all.strain_energy, exact, 0.03 * exact);
    }
}



// A cantilever of square section, one cell thick and two, under a small weight:
// its width is free to contract where it is bent, and is not to do so twice.
// Reference: bending and shear of a beam; its clamp is stiffer, the more the
// nearer Poisson's ratio is to 0.5.
TEST(NewtonSteps, BeamsOfFewCellsBendInSpace)
{
  const double length = 2, width = 0.2, weight = 20; // m, N/m^3
  struct Case
  {
    double       nu;
    unsigned int cells; // across
    double       tolerance;
  };
  for (const Case &known :
       {Case{0.3, 1, 0.03}, Case{0.3, 2, 0.03}, Case{0.48, 1, 0.05}})
    {
      const std::string n = std::to_string(6 * known.cells);
      SceneRun<3>       run(R"(
        set Dimension = 3
        set End time = 1
        set Bodies = beam
        subsection Body beam
          subsection Box
            set Lower corner = 0, 0.6, 0
            set Upper corner = 2, 0.8, 0.2
          end
          set Frame = initial
          set Locking treatment = assumed strain
          set Material = neo hookean
          subsection Neo hookean
            set Density = 1000
            set Young's modulus = 1e6
            set Poisson's ratio = )" +
                      digits(known.nu) + R"(
          end
        end
        subsection Grid
          set Upper corner = 2.4, 1.2, 1.2
          set Cells = )" +
                      std::to_string(12 * known.cells) + ", " + n + ", " + n +
                      R"(
        end
        subsection Boundaries
          set left = no slip
          set right = free
          set bottom = free
          set top = free
          set back = free
          set front = free
        end
        subsection Loads
          set Gravity = 0, )" +
                      digits(-weight / 1000) + R"(, 0
        end
        subsection Method
          set Time integration = quasi-static
          set Time step = 1
        end)");
      run.advance_to(1);
      const double area = width * width, load = weight * area, modulus = 1e6;
      const double exact =
        load * load *
        (std::pow(length, 5) / (40 * modulus * area * area / 12) +
         std::pow(length, 3) * 2 * (1 + known.nu) /
           (6 * 5. / 6 * modulus * area));
      std::printf("nu %g, %u cells: %.4f of the energy of a beam\n",
                  known.nu,
                  known.cells,
                  run.totals().all.strain_energy / exact);
      EXPECT_NEAR(run.totals().all.strain_energy,
                  exact,
                  known.tolerance * exact);
    }
}



// Nominal stress - rho g (H - Z) at any deformation; the shortening of the
// column by quadrature of the stretch that the law has under it.
TEST(NewtonSteps, ColumnSettlesUnderItsWeight)
{
  struct Case
  {
    double      q, nu, shortening; // of the column, over its height
    std::string frame, kernel = "linear";
  };
  double worst = 0;
  for (const Case &known : {Case{0.05, 0, .02423, "initial"},
                            Case{0.2, 0, .08869, "initial"},
                            Case{0.5, 0, .18921, "initial"},
                            Case{1, 0, .30428, "initial"},
                            Case{0.05, 0.3, .01823, "initial"},
                            Case{0.2, 0.3, .06899, "initial"},
                            Case{0.5, 0.3, .15502, "initial"},
                            Case{1, 0.3, .26355, "initial"},
                            Case{0.05, 0.49, .00146, "initial"},
                            Case{0.2, 0.49, .00582, "initial"},
                            Case{0.5, 0.49, .01446, "initial"},
                            Case{1, 0.49, .02863, "initial"},
                            // without crossing cells
                            Case{0.01, 0, 0, "current"},
                            Case{0.01, 0.3, 0, "current"},
                            Case{0.2, 0.49, .00582, "current"},
                            Case{0.05, 0.3, .01823, "initial", "quadratic"},
                            Case{1, 0, .30428, "initial", "quadratic"},
                            Case{1, 0.49, .02863, "initial", "quadratic"}})
    {
      SCOPED_TRACE(known.kernel + ", " + known.frame + ", q " +
                   digits(known.q) + ", nu " + digits(known.nu));
      SceneRun<2> run(
        column,
        {"Body column/Frame=" + known.frame,
         "Method/Kernel=" + known.kernel,
         "Body column/Locking treatment=cell",
         "Body column/Neo hookean/Poisson's ratio=" + digits(known.nu),
         "Body column/Neo hookean/Young's modulus=" + digits(1.6e4 / known.q)});
      const double before = mean_height(run);
      run.advance_to(1);
      const auto [top, mean] = sinking(known.q, known.nu);
      if (known.shortening > 0)
        {
          EXPECT_NEAR(top, known.shortening, 2e-5);
        }
      const double error = ((before - mean_height(run)) / 16 - mean) / mean;
      EXPECT_LT(std::abs(error), 0.005);
      worst = std::max(worst, std::abs(error));
      EXPECT_EQ(run.n_done, 10u);
    }
  std::printf("columns: %.2g of the sinking at most\n", worst);
}



// A homogeneous state is found exactly, wherever the points are.
TEST(NewtonSteps, OedometerIsExact)
{
  const double        nu = 0.49, E = 1.6e4, stretch = 0.9;
  const HeldLaterally solid(nu);
  struct Choice
  {
    std::string treatment, frame, kernel;
  };
  for (const auto &[treatment, frame, kernel] :
       {Choice{"none", "initial", "linear"},
        Choice{"cell", "initial", "linear"},
        Choice{"none", "current", "linear"},
        Choice{"cell", "current", "linear"},
        Choice{"none", "initial", "quadratic"},
        Choice{"cell", "initial", "quadratic"}})
    {
      SCOPED_TRACE(treatment + ", " + frame + ", " + kernel);
      // in the current frame the side leaves the body after a step
      const unsigned int n_steps = frame == "initial" ? 4 : 1;
      SceneRun<2>        run(column,
                      {"Body column/Frame=" + frame,
                              "Method/Kernel=" + kernel,
                              "Body column/Locking treatment=" + treatment,
                              "Body column/Neo hookean/Poisson's ratio=" + digits(nu),
                              "Grid/Upper corner=1, 16",
                              "Grid/Cells=2, 16",
                              "Boundaries/top=velocity",
                              "Boundaries/Side top/Velocity=0; " +
                                digits(-16 * (1 - stretch)),
                              "Loads/Gravity=0, 0",
                              "Method/Newton tolerance=1e-12"});
      const auto         before = run.positions();
      run.advance(1. / n_steps, n_steps);
      const auto   after  = run.positions();
      const auto   points = run.points();
      const double p      = E * solid.pressure(stretch);
      for (std::size_t k = 0; k < points.size; ++k)
        {
          EXPECT_NEAR(after[k][0], before[k][0], 1e-10);
          EXPECT_NEAR(after[k][1], stretch * before[k][1], 1e-10 * 16);
          EXPECT_NEAR(points.pressure[k], p, 1e-10 * p);
        }
      const double energy = 16 * E * solid.energy(stretch);
      EXPECT_NEAR(run.totals().all.strain_energy, energy, 1e-10 * energy);
    }
}



// Sides work and loads work as much as strain stores.
TEST(NewtonSteps, WorkOfLoadsIsStored)
{
  SceneRun<2> run(held_strip,
                  {"Method/Time integration=quasi-static",
                   "Loads/Gravity=0, -2",
                   "Body strip/Frame=initial"});
  run.advance_to(1);
  EXPECT_LT(std::abs(run.totals().energy_drift), 2e-3);
}



namespace
{
  // A column that is pressed together from above by two fifths of E
  const std::vector<std::string> pressed = {
    "Loads/Gravity=0, 0",
    "Loads/Face loads=weight",
    "Loads/Face load weight/Body=column",
    "Loads/Face load weight/Face=top",
    "Loads/Face load weight/Traction=0; -6400",
    "Body column/Locking treatment=cell",
    "Method/Newton tolerance=1e-10"};

  struct EnergyOfColumn
  {
    EnergyOfColumn(std::vector<std::string> changes, const double step)
    {
      changes.insert(changes.begin(), pressed.begin(), pressed.end());
      changes.push_back("Method/Time step=" + digits(step));
      SceneRun<2> run(column, changes);
      run.totals(); // what it starts with
      run.advance(step, std::lround(1 / step));
      const auto totals = run.totals();
      drift             = totals.energy_drift;
      lost              = run.ledger.viscous / run.ledger.load_work;
      std::printf("step %g s: drift %.2e, on record as lost %.2e\n",
                  step,
                  drift,
                  lost);
    }
    double drift, lost;
  };
} // namespace



// Loads work with the mean of the ends of a step: an error of second order,
// where no point crosses a cell.
TEST(NewtonSteps, WorkOfLoadsIsOfSecondOrder)
{
  const std::string    frame = "Body column/Frame=initial";
  const EnergyOfColumn coarse({frame}, 0.1), fine({frame}, 0.05);
  EXPECT_NEAR(coarse.drift / fine.drift, 4, 0.4);
  EXPECT_LT(std::abs(fine.lost), 1e-8);
}



// Nor does metal lose anything there, which is where 'auto' puts it.
TEST(NewtonSteps, MetalLosesNothingInItsInitialFrame)
{
  const EnergyOfColumn energy({"Body column/Frame=auto",
                               "Body column/Material=j2",
                               "Body column/J2/Density=100",
                               "Body column/J2/Young's modulus=1.6e4",
                               "Body column/J2/Poisson's ratio=0",
                               "Body column/J2/Yield stress=1e3",
                               "Body column/J2/Hardening modulus=1.6e3"},
                              0.025);
  EXPECT_LT(std::abs(energy.lost), 1e-8);
  EXPECT_LT(std::abs(energy.drift), 2e-3);
}



// Points that cross cells give their forces to other nodes, and what is loaded
// springs to its new place, which costs energy whatever the step: a quarter of
// the work here, an eighth where the column yields. That is on record, but for
// a tenth of it; the tenth was chosen when .012 and .049 had been seen.
TEST(NewtonSteps, WhatCrossingsCostIsOnRecord)
{
  const std::vector<std::string> elastic = {"Body column/Frame=current"};
  std::vector<std::string>       plastic = elastic;
  plastic.insert(plastic.end(),
                 {"Body column/Material=j2",
                  "Body column/J2/Density=100",
                  "Body column/J2/Young's modulus=1.6e4",
                  "Body column/J2/Poisson's ratio=0",
                  "Body column/J2/Yield stress=1e3",
                  "Body column/J2/Hardening modulus=1.6e3"});
  for (const auto &changes : {elastic, plastic})
    {
      const EnergyOfColumn energy(changes, 0.025);
      EXPECT_GT(energy.lost, 0.05);
      EXPECT_LT(std::abs(energy.drift), 0.1 * energy.lost);
    }
}



TEST(NewtonSteps, FewIterationsWhereABeamTurns)
{
  SceneRun<2> run(held_strip,
                  {"Method/Time integration=quasi-static",
                   "Loads/Gravity=0, -2",
                   "Body strip/Frame=initial"});
  run.advance_to(1);
  const std::string effort = run.integrator.effort();
  EXPECT_NE(effort.find("steps halved: 0"), std::string::npos) << effort;
  EXPECT_EQ(run.n_done, 10u);
}



// Without a load nothing is left to compare forces out of balance with but what
// has been; a checkpoint knows it.
TEST(NewtonSteps, WhatIsUnloadedComesBackAndStays)
{
  SceneRun<2> run(held_strip,
                  {"Method/Time integration=quasi-static",
                   "Method/Ghost penalty=0",
                   "End time=1.5",
                   "Loads/Gravity=0, -2",
                   "Loads/Load factor=if(t<0.5, 2*t, max(0, 2-2*t))",
                   "Body strip/Frame=initial"});
  const auto  before = run.positions();
  run.advance(0.25, 6);
  const auto        after  = run.positions();
  const std::string effort = run.integrator.effort();
  EXPECT_NE(effort.find("steps halved: 0"), std::string::npos) << effort;
  double way = 0;
  for (std::size_t p = 0; p < before.size(); ++p)
    way = std::max(way, after[p].distance(before[p]));
  EXPECT_LT(way, 1e-5);

  auto state = run.integrator.state();
  EXPECT_GT(state.largest_force, 1e3);
  state.largest_force *= 2;
  run.integrator.restore(state);
  EXPECT_EQ(run.integrator.state().largest_force, state.largest_force);
}



// With the default penalty a strip that is bent and let go comes back to 1e-4
// of its sag; resisted over the whole step, to 1.1 %.
TEST(NewtonSteps, TheGhostPenaltyLetsGo)
{
  SceneRun<2> run(held_strip,
                  {"Method/Time integration=quasi-static",
                   "Loads/Gravity=0, -4",
                   "Loads/Load factor=if(t<0.5, 2*t, max(0, 2-2*t))",
                   "Body strip/Frame=initial"});
  const auto  before = run.positions();
  const auto  sag    = [&]() {
    const auto after = run.positions();
    double     most  = 0;
    for (std::size_t p = 0; p < before.size(); ++p)
      most = std::max(most, after[p].distance(before[p]));
    return most;
  };
  run.advance(0.1, 5);
  const double largest = sag();
  run.advance(0.1, 5);
  EXPECT_GT(largest, 0.1);
  EXPECT_LT(sag(), 1e-4 * largest);
}



// A string under tension vibrates and gains nothing, in steps as short as one
// likes: forces by which the grid is set back act within the step (GridReset).
// When they came a step later, 0.06 J grew to 114 J.
TEST(NewtonSteps, AStringUnderTensionGainsNothing)
{
  const std::string string = R"(
    set Bodies = string
    subsection Body string
      subsection Box
        set Lower corner = 0, 0.05
        set Upper corner = 2, 0.1
      end
      set Material = neo hookean
      subsection Neo hookean
        set Density = 1000
        set Young's modulus = 1e6
        set Poisson's ratio = 0.3
      end
      set Initial stress = xx: 100000
      set Initial velocity = 0; 0.05*sin(pi/2*x)
    end
    subsection Grid
      set Upper corner = 2, 0.15
      set Cells = 40, 3
    end
    subsection Boundaries
      set left = no slip
      set right = no slip
      set bottom = free
      set top = free
    end
    subsection Method
      set Time integration = implicit
      set Time step = 0.0025
    end)";
  for (const std::string radius : {"1", "0.9"})
    {
      SCOPED_TRACE("r = " + radius);
      SceneRun<2> run(string, {"Method/Spectral radius at infinity=" + radius});
      const double before = run.totals().all.kinetic_energy;
      for (unsigned int k = 0; k < 200; ++k)
        {
          run.advance(0.0025);
          ASSERT_LT(run.totals().all.kinetic_energy, 1.01 * before) << k;
        }
      EXPECT_LT(std::abs(run.totals().energy_drift), 1e-9);
    }
}



// Forces are round-off: nothing is to be solved. A side that carries the body
// along leaves more of it.
TEST(NewtonSteps, NothingLoadsABodyYet)
{
  const std::vector<std::string> carried = {
    "Boundaries/left=velocity", "Boundaries/Side left/Velocity=0.01; 0.02"};
  for (const std::string kind : {"implicit", "quasi-static"})
    for (const std::string frame : {"current", "initial"})
      for (const bool is_carried : {false, true})
        {
          if (is_carried && kind == "implicit")
            continue; // its inertia is a load
          SCOPED_TRACE(kind + " " + frame + (is_carried ? " carried" : ""));
          std::vector<std::string> variant = {"Method/Time integration=" + kind,
                                              "Body strip/Frame=" + frame,
                                              "End time=1",
                                              "Loads/Gravity=0, 0"};
          if (kind == "implicit")
            variant.push_back("Method/Time step=0.25");
          if (is_carried)
            variant.insert(variant.end(), carried.begin(), carried.end());
          SceneRun<2> run(held_strip, variant);
          const auto  before = run.positions();
          run.advance(0.25, 4);
          const auto        after  = run.positions();
          const std::string effort = run.integrator.effort();
          EXPECT_NE(effort.find("steps halved: 0"), std::string::npos)
            << effort;
          const dealii::Tensor<1, 2> way =
            is_carried ? dealii::Point<2>(0.01, 0.02) : dealii::Point<2>();
          for (std::size_t p = 0; p < before.size(); ++p)
            EXPECT_LT((after[p] - before[p] - way).norm(), 1e-12);
          EXPECT_NEAR(run.totals().energy_drift, 0, 0.05);
        }
}



// Sand without cohesion has no shear stiffness before it bears its weight, and
// yet settles as K0 says: by rho g (2 H y - y^2) / (2 M).
TEST(NewtonSteps, SandWithoutCohesionSettles)
{
  const std::string sand = R"(
    set Dimension = 2
    set End time = 1
    set Bodies = sand
    subsection Body sand
      set Shape = box
      set Material = drucker prager
      subsection Drucker prager
        set Density = 2000
        set Young's modulus = 1e8
        set Poisson's ratio = 0.3
        set Friction angle = 30
      end
    end
    subsection Grid
      set Upper corner = 1, 1.1
      set Cells = 10, 11
    end
    subsection Boundaries
      set left = slip
      set right = slip
      set bottom = slip
    end
    subsection Loads
      set Gravity = 0, -10
    end
    subsection Method
      set Time integration = quasi-static
    end)";
  for (const std::string frame : {"initial", "current"})
    {
      SCOPED_TRACE(frame);
      SceneRun<2> run(sand, {"Body sand/Frame=" + frame});
      const auto  before = run.positions();
      run.advance_to(1);
      const auto   after   = run.positions();
      const double modulus = 1e8 * 0.7 / (1.3 * 0.4);
      for (std::size_t p = 0; p < before.size(); ++p)
        {
          const double y = before[p][1];
          EXPECT_NEAR(before[p][1] - after[p][1],
                      2e4 / (2 * modulus) * (2 * y - y * y),
                      2e-6);
        }
    }
}



// Two bars in a row, the first one stiffer by a factor, are pulled: where they
// meet the strain jumps, which costs next to nothing.
TEST(NewtonSteps, SoftBodiesAreAsSoftBesideStiffOnes)
{
  const std::string bar  = R"(
      set Points per cell edge = 2
      set Material = linear elastic
      subsection Linear elastic
        set Young's modulus = 1e6
        set Poisson's ratio = 0
      end
      )";
  const std::string bars = R"(
    set End time = 1
    set Bodies = first, second
    subsection Body first
      subsection Box
        set Upper corner = 4, 3
      end)" + bar + R"(
    end
    subsection Body second
      subsection Box
        set Lower corner = 4, 0
        set Upper corner = 8, 3
      end)" + bar + R"(
    end
    subsection Grid
      set Upper corner = 10, 5
      set Cells = 10, 5
    end
    subsection Boundaries
      set right = free
      set top = free
    end
    subsection Loads
      set Face loads = pull
      subsection Face load pull
        set Body = second
        set Face = right
        set Traction = 1000; 0
      end
    end
    subsection Method
      set Time integration = quasi-static
    end)";
  for (const double ratio : {1., 1e2, 1e5})
    {
      SceneRun<2> run(bars,
                      {"Body first/Linear elastic/Young's modulus=" +
                       digits(1e6 * ratio)});
      const auto  before = run.positions(1);
      run.advance(1);
      const auto after = run.positions(1);
      double     error = 0;
      for (std::size_t p = 0; p < after.size(); ++p)
        error = std::max(error,
                         std::abs((after[p] - before[p])[0] -
                                  1e-3 * (4 / ratio + before[p][0] - 4)));
      EXPECT_LT(error, 2e-3 * 4e-3) << ratio;
    }
}



// A bar that yields at half of the load: hardening goes on to bear it, but it
// is fifty times as soft.
TEST(NewtonSteps, CollapseIsTold)
{
  SceneRun<2> run(R"(
    set End time = 1
    set Bodies = bar
    subsection Body bar
      subsection Box
        set Upper corner = 4, 2
      end
      set Material = j2
      subsection J2
        set Young's modulus = 1e6
        set Poisson's ratio = 0.3
        set Yield stress = 500
        set Hardening modulus = 2e4
      end
    end
    subsection Grid
      set Upper corner = 6, 3
      set Cells = 6, 3
    end
    subsection Boundaries
      set right = free
      set top = free
    end
    subsection Loads
      set Face loads = pull
      subsection Face load pull
        set Body = bar
        set Face = right
        set Traction = 1000; 0
      end
    end
    subsection Method
      set Time integration = quasi-static
    end)");
  run.advance(0.1, 4);
  EXPECT_EQ(run.integrator.warning(), "");
  run.advance(0.1, 4);
  EXPECT_NE(run.integrator.warning().find("limit load"), std::string::npos);
  EXPECT_EQ(run.integrator.warning(), "");
}



// A body that nothing holds has no place of equilibrium, and nothing has moved.
TEST(NewtonSteps, FreeMotionIsNamed)
{
  struct Case
  {
    std::vector<std::string> changes;
    std::string              motion;
  };
  for (const Case &wrong :
       {Case{{"Boundaries/left=free"}, "the translation along x"},
        Case{{"Boundaries/left=slip"}, "the translation along y"}})
    {
      std::vector<std::string> changes = wrong.changes;
      changes.push_back("Method/Time integration=quasi-static");
      changes.push_back("Loads/Gravity=0, -1");
      SceneRun<2> run(held_strip, changes);
      const auto  before = run.positions();
      try
        {
          run.advance(0.1);
          ADD_FAILURE() << "ran";
        }
      catch (const ComputationError &failure)
        {
          EXPECT_NE(std::string(failure.what()).find(wrong.motion),
                    std::string::npos)
            << failure.what();
        }
      EXPECT_EQ(before, run.positions());
    }
}



TEST(NewtonSteps, FreeMotionsOfPlaces)
{
  using Held = std::vector<std::array<bool, 3>>;
  const std::vector<dealii::Point<3>> corners = {{0, 0, 0},
                                                 {1, 0, 0},
                                                 {0, 1, 0},
                                                 {0, 0, 1}};
  const std::array<bool, 3>           all{{true, true, true}}, none{},
    z{{false, false, true}};
  const auto motion = [&](const Held &held) {
    const auto free = free_rigid_motion<3>(corners, held, {{0, 1, 2, 3}});
    return free ? free->motion : "";
  };
  EXPECT_EQ(motion({all, all, all, none}), "");
  EXPECT_EQ(motion({none, none, none, none}), "the translation along x");
  EXPECT_EQ(motion({z, z, z, none}), "the translation along x");
  // a hinge along the first axis
  EXPECT_EQ(motion({all, all, none, none}), "the rotation about x");
  EXPECT_EQ(motion({all, none, none, none}).substr(0, 12), "the rotation");
}



// Triangles between hinges: a rod on the floor, one that hangs on it, and the
// arch of two rods, which holds itself.
TEST(NewtonSteps, FreeMotionsOfHingedParts)
{
  using Held                                 = std::vector<std::array<bool, 2>>;
  const std::vector<dealii::Point<2>> places = {
    {0, 0}, {1, 1}, {0, 1}, {2, 0}, {2, 1}};
  const std::array<bool, 2>                     all{{true, true}}, none{};
  const std::vector<std::vector<std::uint32_t>> rods = {{0, 1, 2}, {1, 3, 4}};

  const auto swings =
    free_rigid_motion<2>(places, Held{all, none, all, none, none}, rods);
  ASSERT_TRUE(swings.has_value());
  EXPECT_EQ(swings->motion, "the rotation about z");
  EXPECT_EQ(swings->lower, dealii::Point<2>(1, 0));
  EXPECT_EQ(swings->upper, dealii::Point<2>(2, 1));
  EXPECT_FALSE(
    free_rigid_motion<2>(places, Held{all, none, none, all, none}, rods)
      .has_value());
  EXPECT_TRUE(
    free_rigid_motion<2>(places, Held{all, none, none, none, none}, rods)
      .has_value());
}



// Where the step is too long for the sides, it is found in parts, or not at
// all; then the points are what they were.
TEST(NewtonSteps, StepsThatAreNotFoundLeaveThePoints)
{
  SceneRun<2> run(held_strip,
                  {"Method/Time integration=quasi-static",
                   "Boundaries/left=velocity",
                   "Boundaries/Side left/Velocity=100000; 0",
                   "Boundaries/right=no slip",
                   "Body strip/Box/Upper corner=10, 3"});
  const auto  before = run.positions();
  EXPECT_THROW(run.advance(1), ComputationError);
  EXPECT_EQ(before, run.positions());
}



// Nothing is lost between steps; what is missing is what the rule does not keep
// of a large motion.
TEST(NewtonSteps, SwingingStripKeepsItsEnergy)
{
  for (const double step : {0.1, 0.05})
    {
      SceneRun<2>  run(held_strip,
                      {"Method/Time integration=implicit",
                        "Method/Spectral radius at infinity=1",
                        "Method/Time step=" + digits(step),
                        "Body strip/Frame=initial",
                        "Body strip/Initial velocity=0; x*x/40"});
      const double start = run.totals().all.total_energy();
      run.advance(step, std::lround(10 / step));
      const auto totals = run.totals();
      EXPECT_LT(std::abs(totals.energy_drift), 1e-3);
      EXPECT_NEAR(totals.all.total_energy() / start, 1, 1e-3);
      EXPECT_GT(totals.all.strain_energy, 0.3 * start); // it has bent
    }
}



// With splines as well, on two cells over the depth. Explicit steps are behind
// the swing on fine cells by as much as implicit ones are ahead of it: their
// masses are lumped, these consistent.
TEST(NewtonSteps, SwingWithSplinesIsThatOfFineCells)
{
  const auto swing = [](const std::vector<std::string> &changes,
                        const double                    step) {
    std::vector<std::string> all = {"Body strip/Frame=initial",
                                    "Method/Kernel=quadratic",
                                    "Body strip/Initial velocity=0; x*x/400"};
    all.insert(all.end(), changes.begin(), changes.end());
    SceneRun<2>  run(held_strip, all);
    const double before = mean_height(run);
    run.totals();
    run.advance(step, std::lround(4 / step));
    const auto totals = run.totals();
    EXPECT_LT(std::abs(totals.energy_drift), 5e-3);
    return mean_height(run) - before;
  };
  // of either on 80 x 40 cells
  const double exact       = 0.09357;
  const double by_explicit = swing({"Method/Stress update=usavg"}, 0.002);
  const double by_newton   = swing({"Method/Time integration=implicit",
                                    "Method/Newton tolerance=1e-10",
                                    "Method/Spectral radius at infinity=1",
                                    "Method/Time step=0.025"},
                                 0.025);
  std::printf(
    "splines: explicit %.2g, implicit %.2g of the way on fine cells\n",
    by_explicit / exact - 1,
    by_newton / exact - 1);
  EXPECT_NEAR(by_explicit, exact, 5e-3 * exact);
  EXPECT_NEAR(by_newton, exact, 5e-3 * exact);
}



// A strip that stands askew in the grid, two cells thick: linear functions lack
// a fifth of the energy, splines 2.7 %.
TEST(NewtonSteps, SplinesBendAcrossTheCells)
{
  const auto energy_of = [](const std::vector<std::string> &changes) {
    std::vector<std::string> all = {
      "Method/Time integration=quasi-static",
      "Body strip/Frame=initial",
      "Body strip/Placement=gauss",
      // cut off by the side, 1 m thick and 8 m long, 30 degrees upwards
      "Body strip/Shape=block",
      "Body strip/Block/Corners=0, 1; 6.92820323, 5; 6.42820323, 5.8660254; "
      "0, 2.15470054",
      "Grid/Upper corner=10, 7",
      "Grid/Cells=20, 14",
      "Loads/Gravity=0, -0.5"};
    all.insert(all.end(), changes.begin(), changes.end());
    SceneRun<2> run(held_strip, all);
    run.advance_to(1);
    return run.totals().all.strain_energy;
  };
  const double fine =
    energy_of({"Method/Kernel=quadratic", "Grid/Cells=80, 56"});
  const double splines = energy_of({"Method/Kernel=quadratic"});
  const double linear  = energy_of({"Method/Kernel=linear"});
  std::printf(
    "two cells over the depth: splines %.2g, linear functions %.2g of "
    "the energy\n",
    splines / fine - 1,
    linear / fine - 1);
  EXPECT_NEAR(splines / fine, 1, 0.03);
  EXPECT_LT(linear / fine, 0.9);
}



namespace
{
  // Mean height of a strip that swings, after four seconds of a period of 12.
  double
  height_of_swing(const std::vector<std::string> &changes, const double step)
  {
    std::vector<std::string> all = {"Body strip/Frame=initial",
                                    "Body strip/Placement=regular",
                                    "Body strip/Locking treatment=cell",
                                    "Body strip/Initial velocity=0; x*x/400"};
    all.insert(all.end(), changes.begin(), changes.end());
    SceneRun<2>  run(held_strip, all);
    const double before = mean_height(run);
    run.advance(step, std::lround(4 / step));
    return mean_height(run) - before;
  }
} // namespace



// Nothing acts: what is left of the forces is round-off, which no step can
// mend.
TEST(NewtonSteps, FreeBodiesFlyOn)
{
  SceneRun<2> run(held_strip,
                  {"Method/Time integration=implicit",
                   "Method/Time step=0.4",
                   "Body strip/Frame=current",
                   "Body strip/Box/Lower corner=1, 2",
                   "Body strip/Box/Upper corner=9, 3",
                   "Body strip/Initial velocity=0.05; 0.02",
                   "Boundaries/left=free"});
  const auto  before = run.positions();
  run.advance(0.4, 40); // through a cell and more
  const std::string effort = run.integrator.effort();
  EXPECT_NE(effort.find("steps halved: 0"), std::string::npos) << effort;
  const auto after = run.positions();
  for (std::size_t p = 0; p < after.size(); ++p)
    {
      EXPECT_NEAR(after[p][0] - before[p][0], 0.8, 1e-9);
      EXPECT_NEAR(after[p][1] - before[p][1], 0.32, 1e-9);
    }
}



// What remains in short steps is the mass, consistent here and lumped there: of
// second order in the cells.
TEST(NewtonSteps, ShortStepsOnFineCellsTendToExplicitOnes)
{
  std::array<double, 2> apart{};
  for (unsigned int i = 0; i < 2; ++i)
    {
      const std::string cells =
        "Grid/Cells=" + std::string(i == 0 ? "40, 20" : "80, 40");
      const double by_explicit =
        height_of_swing({cells, "Method/Stress update=usavg"}, 0.002);
      const double by_newton =
        height_of_swing({cells,
                         "Method/Time integration=implicit",
                         "Method/Newton tolerance=1e-10",
                         "Method/Time step=0.0125"},
                        0.0125);
      apart[i] = by_newton / by_explicit - 1;
      std::printf("%s: %.2g apart\n", cells.c_str(), apart[i]);
    }
  EXPECT_LT(std::abs(apart[0]), 2e-3);
  EXPECT_GT(apart[0] / apart[1], 2.5);
}



// A disc that turns keeps its energy and its spin: points take what the nodes
// have, but for light nodes, whose mass is lumped. In the current frame there
// are others at its rim in every step.
TEST(NewtonSteps, TurningDiscsKeepTheirSpin)
{
  for (const std::string frame : {"initial", "current"})
    {
      const double tolerance = frame == "initial" ? 1e-3 : 0.02;
      SceneRun<2>  run(R"(
        set End time = 1
        set Bodies = disc
        subsection Body disc
          set Shape = ball
          subsection Ball
            set Centre = 0, 0
            set Radius = 0.5
          end
          set Placement = gauss
          set Points per cell edge = 2
          set Initial velocity = -2*y; 2*x
          set Material = neo hookean
          subsection Neo hookean
            set Density = 1000
            set Young's modulus = 1e6
            set Poisson's ratio = 0.3
          end
        end
        subsection Grid
          set Lower corner = -0.7, -0.7
          set Upper corner = 0.7, 0.7
          set Cells = 14, 14
        end)",
                      {"Method/Time integration=implicit",
                        "Method/Time step=0.02",
                        "Body disc/Frame=" + frame});
      const double start = run.totals().all.kinetic_energy;
      const auto   spin  = [&]() {
        const PointView<2> points = run.points();
        double             sum    = 0;
        for (std::size_t p = 0; p < points.size; ++p)
          sum +=
            points.mass[p] * (points.position[0][p] * points.velocity[1][p] -
                              points.position[1][p] * points.velocity[0][p]);
        return sum;
      };
      const double spin_at_start = spin();
      run.advance(0.02, 157); // half a turn
      const auto totals = run.totals();
      std::printf("%s frame, half a turn: energy %.2g, spin %.2g\n",
                  frame.c_str(),
                  totals.all.kinetic_energy / start - 1,
                  spin() / spin_at_start - 1);
      EXPECT_NEAR(totals.all.kinetic_energy / start, 1, tolerance);
      EXPECT_NEAR(spin() / spin_at_start, 1, 0.5 * tolerance);
      EXPECT_LT(std::abs(totals.energy_drift), 1e-3);
    }
}
