// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/numbers.h>

#include <limber/output/health.h>
#include <limber/output/health_figures.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sample_run.h"
#include "support/scene_run.h"

/** @file What is judged good and bad, and the figures behind it. */
namespace limber::test
{
  namespace
  {
    /** A body with nothing to be said against it. */
    HealthFigures
    sound()
    {
      BodyFigures body;
      body.name   = "beam";
      body.points = 400;
      body.volume = body.shape_volume = 1;
      body.cells                      = 100;
      body.inner_cells                = 64;
      body.strain_energy              = 20;
      HealthFigures figures;
      figures.bodies       = {body};
      figures.energy_scale = figures.inner_scale = 100;
      figures.kinetic                            = 50;
      return figures;
    }



    HealthLine
    line(const std::string &name, const HealthFigures &figures)
    {
      const auto lines = judge(figures);
      const auto found =
        std::find_if(lines.begin(), lines.end(), [&](const HealthLine &line) {
          return line.name == name;
        });
      EXPECT_NE(found, lines.end()) << name;
      return found == lines.end() ? HealthLine() : *found;
    }



    unsigned int
    n_words(const std::string &text)
    {
      std::istringstream words(text);
      unsigned int       n = 0;
      for (std::string word; words >> word; ++n)
        ;
      return n;
    }



    /** The line is bad, says so briefly and names an entry with these words. */
    void
    expect_bad(const std::string   &name,
               const HealthFigures &figures,
               const std::string   &entry)
    {
      const HealthLine bad = line(name, figures);
      EXPECT_EQ(bad.verdict, Verdict::bad) << name << ": " << bad.text;
      EXPECT_NE(bad.entry.find(entry), std::string::npos) << bad.entry;
      EXPECT_LT(n_words(bad.text), 60u) << bad.text;
      EXPECT_EQ(bad.text.find("nan"), std::string::npos) << bad.text;
      for (const HealthLine &other : judge(figures))
        EXPECT_TRUE(other.name == name || other.verdict == Verdict::good)
          << other.name << ": " << other.text;
    }
  } // namespace



  TEST(Health, NothingIsSaidAgainstASoundBody)
  {
    const auto lines = judge(sound());
    EXPECT_EQ(lines.size(), 10u);
    for (const HealthLine &line : lines)
      EXPECT_EQ(line.verdict, Verdict::good) << line.name << ": " << line.text;
    const std::string text = health_text(lines);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
    EXPECT_NE(text.find("health good: unseen, energy, impacts"),
              std::string::npos);
  }



  TEST(Health, EveryLineCanBeBad)
  {
    HealthFigures figures = sound();

    figures.bodies[0].unseen_energy = 30; // of 50 J
    expect_bad("unseen", figures, "Blend time");

    figures       = sound();
    figures.drift = -0.2;
    expect_bad("energy", figures, "Courant number");
    figures.step_entry = "Method/Time step";
    expect_bad("energy", figures, "Method/Time step");

    figures         = sound();
    figures.may_hit = true;
    figures.contact = 15;
    expect_bad("impacts", figures, "Grid/Cells");
    EXPECT_NE(line("impacts", figures)
                .text.find("15 % of the energy scale was "
                           "lost"),
              std::string::npos);
    figures.contact = -15;
    expect_bad("impacts", figures, "Grid/Cells");
    HealthLine created = line("impacts", figures);
    EXPECT_EQ(created.text.find("15 % of the energy scale was created"), 0u)
      << created.text;
    EXPECT_EQ(created.text.find("Courant"), std::string::npos) << created.text;
    EXPECT_NE(created.text.find("Placement = cut"), std::string::npos);
    figures.bodies[0].is_cut = true;
    created                  = line("impacts", figures);
    EXPECT_EQ(created.text.find("Placement"), std::string::npos);

    figures              = sound();
    figures.points       = 400;
    figures.put_back     = 50;
    figures.put_back_way = 0.1;
    expect_bad("put back", figures, "Courant number");

    figures                  = sound();
    figures.bodies[0].volume = 0.904;
    expect_bad("mass", figures, "Body beam/Placement");

    figures                         = sound();
    figures.bodies[0].overlap       = 0.3;
    figures.bodies[0].overlaps_with = "floor";
    expect_bad("overlap", figures, "Body beam/Shape");

    figures                = sound();
    figures.bodies[0].gaps = 10;
    expect_bad("gaps", figures, "Split stretched points");
    figures.bodies[0].is_plastic = true;
    expect_bad("gaps", figures, "Points per cell edge");

    figures                        = sound();
    figures.bodies[0].single_cells = 40;
    expect_bad("points", figures, "Points per cell edge");

    figures                           = sound();
    figures.bodies[0].smallest_volume = 0.05;
    expect_bad("volume", figures, "Grid/Cells");
  }



  TEST(Health, PointsInsideObstaclesAreSaid)
  {
    HealthFigures figures = sound();
    figures.obstacles     = {{"wall", 0, 0}, {"disc", 4, 0.96}};
    expect_bad("obstacles", figures, "Grid/Cells");
    EXPECT_NE(line("obstacles", figures).text.find("'disc'"),
              std::string::npos);
    figures.obstacles[1] = {"disc", 3, 0.2};
    EXPECT_EQ(line("obstacles", figures).verdict, Verdict::look);
    figures.obstacles[1] = {"disc", 0, 0};
    figures.put_out      = 7;
    EXPECT_EQ(line("obstacles", figures).verdict, Verdict::good);
    EXPECT_NE(line("obstacles", figures).text.find("7 times"),
              std::string::npos);
  }



  TEST(Health, RotationIsToldOfLawsThatCannotBearIt)
  {
    HealthFigures figures      = sound();
    figures.bodies[0].rotation = 1;
    for (const HealthLine &one : judge(figures))
      EXPECT_NE(one.name, "rotation");
    figures.bodies[0].stays_upright = true;
    expect_bad("rotation", figures, "Body beam/Material");
    figures.bodies[0].rotation = 0.05;
    EXPECT_EQ(line("rotation", figures).verdict, Verdict::good);
  }



  TEST(Health, CreepIsBadWhereTheBalanceMissesWhatItTakes)
  {
    HealthFigures figures                    = sound();
    figures.bodies[0].crossings_under_strain = 40;
    EXPECT_EQ(line("crossings", figures).verdict, Verdict::look);
    figures.drift        = -0.03;
    const HealthLine bad = line("crossings", figures);
    EXPECT_EQ(bad.verdict, Verdict::bad);
    EXPECT_EQ(bad.entry, "Body beam/Frame");
    EXPECT_LT(n_words(bad.text), 60u) << bad.text;
  }



  // A bar pulled past a third of a cell is a quarter too soft with three points
  // along an edge, and no energy is missing.
  TEST(Health, BarsUnderTensionSoftenWithLinearFunctions)
  {
    HealthFigures figures       = sound();
    BodyFigures  &body          = figures.bodies[0];
    body.crossings              = 0.46;
    body.crossings_under_strain = 0.36;
    EXPECT_EQ(line("crossings", figures).verdict, Verdict::good);
    body.share_in_tension = 1;
    const HealthLine bad  = line("crossings", figures);
    EXPECT_EQ(bad.verdict, Verdict::bad);
    EXPECT_NEAR(bad.value,
                3. / (body.points_per_edge * body.points_per_edge) * 0.46,
                1e-12);
    EXPECT_NE(bad.text.find("under tension"), std::string::npos);
    EXPECT_LT(n_words(bad.text), 60u) << bad.text;
    body.kernel = KernelKind::cpdi;
    EXPECT_EQ(line("crossings", figures).verdict, Verdict::good);
  }



  // The loads of a bar that creeps go on working, and no energy is missing. Of
  // a ball that turns as much is in tension.
  TEST(Health, CreepOfBarsUnderTensionIsBad)
  {
    HealthFigures figures       = sound();
    BodyFigures  &body          = figures.bodies[0];
    body.crossings_under_strain = 30;
    body.share_in_tension       = 0.78;
    EXPECT_EQ(line("crossings", figures).verdict, Verdict::look);
    figures.loads = 2 * body.strain_energy;
    EXPECT_EQ(line("crossings", figures).verdict, Verdict::bad);
    body.share_in_tension = 0.5; // it bends
    EXPECT_EQ(line("crossings", figures).verdict, Verdict::look);
  }



  // The balance does not miss plastic work.
  TEST(Health, CreepOfWhatFlowsInTensionIsBad)
  {
    HealthFigures figures = sound();
    BodyFigures  &body    = figures.bodies[0];
    body.is_plastic       = true;
    figures.plastic       = 0.999 * figures.energy_scale;
    body.strain_energy    = 0.0005 * figures.energy_scale;

    body.crossings_under_strain = 60;
    EXPECT_EQ(line("crossings", figures).verdict, Verdict::look);
    body.share_in_tension = 0.9;
    const HealthLine bad  = line("crossings", figures);
    EXPECT_EQ(bad.verdict, Verdict::bad);
    EXPECT_EQ(bad.entry, "Method/Kernel");
    EXPECT_LT(n_words(bad.text), 60u) << bad.text;
    body.keeps_surface = false; // a fluid with a yield stress
    EXPECT_EQ(line("crossings", figures).verdict, Verdict::look);
    body.elastic_share = 1e-3; // that has flowed
    EXPECT_EQ(line("crossings", figures).verdict, Verdict::good);
    body.elastic_share   = 1;
    body.keeps_surface   = true;
    body.kernel          = KernelKind::quadratic;
    body.points_per_edge = 3;
    EXPECT_EQ(line("crossings", figures).verdict, Verdict::look);
  }



  TEST(Health, RemedyForCreepIsNotWhatTheSceneHas)
  {
    HealthFigures figures       = sound();
    BodyFigures  &body          = figures.bodies[0];
    body.kernel                 = KernelKind::quadratic;
    body.crossings_under_strain = 400;
    body.points_per_edge        = 2;
    EXPECT_EQ(line("crossings", figures).entry,
              "Body beam/Points per cell edge");
    body.points_per_edge        = 3;
    body.crossings_under_strain = 4000;
    EXPECT_EQ(line("crossings", figures).entry, "Method/Kernel");
    body.kernel                 = KernelKind::cubic;
    body.crossings_under_strain = 4e6;
    EXPECT_EQ(line("crossings", figures).entry,
              "Body beam/Points per cell edge");
  }



  // Of the same crossings linear functions make much permanent, smooth ones
  // little, and convected domains nothing.
  TEST(Health, CreepIsThatOfTheKernel)
  {
    const auto of = [](const KernelKind kernel, const double points_per_edge) {
      HealthFigures figures       = sound();
      BodyFigures  &body          = figures.bodies[0];
      body.kernel                 = kernel;
      body.points_per_edge        = points_per_edge;
      body.crossings_under_strain = 10;
      figures.drift               = -0.03;
      return line("crossings", figures).verdict;
    };
    EXPECT_EQ(of(KernelKind::linear, 3), Verdict::bad);
    EXPECT_EQ(of(KernelKind::quadratic, 2), Verdict::look);
    EXPECT_EQ(of(KernelKind::quadratic, 3), Verdict::good);
    EXPECT_EQ(of(KernelKind::cubic, 3), Verdict::good);
    EXPECT_EQ(of(KernelKind::gimp, 2), Verdict::look);
    EXPECT_EQ(of(KernelKind::gimp, 3), Verdict::good);
    EXPECT_EQ(of(KernelKind::cpgimp, 2), Verdict::look);
    EXPECT_EQ(of(KernelKind::cpgimp, 3), Verdict::look);
    EXPECT_EQ(of(KernelKind::ddmp, 2), Verdict::bad);
    EXPECT_EQ(of(KernelKind::ddmp, 3), Verdict::look);
    EXPECT_EQ(of(KernelKind::cpdi, 2), Verdict::good);
    EXPECT_EQ(of(KernelKind::cpdi2, 2), Verdict::good);
  }



  // 'fitted' is refused on cells of several sizes, APIC in contact.
  TEST(Health, RemediesAreWhatTheSceneTakes)
  {
    HealthFigures figures    = sound();
    figures.bodies[0].volume = 0.9;
    EXPECT_NE(line("mass", figures).text.find("'fitted'"), std::string::npos);
    figures.has_levels      = true;
    const HealthLine levels = line("mass", figures);
    EXPECT_EQ(levels.text.find("fitted"), std::string::npos) << levels.text;
    EXPECT_NE(levels.text.find("set 'cut'"), std::string::npos);

    figures                = sound();
    figures.is_smoothed    = true;
    figures.transfer       = 60;
    figures.with_apic      = " and 'Transfer order = 4'";
    const HealthLine order = line("transfer", figures);
    EXPECT_NE(order.text.find("'Transfer = apic' and 'Transfer order = 4'"),
              std::string::npos)
      << order.text;
    EXPECT_LT(n_words(order.text), 60u);
    figures.takes_apic       = false;
    const HealthLine touches = line("transfer", figures);
    EXPECT_EQ(touches.text.find("apic"), std::string::npos) << touches.text;
    EXPECT_NE(touches.text.find("'Frame = initial'"), std::string::npos);
  }



  TEST(Health, BetweenGoodAndBadThereIsLook)
  {
    HealthFigures figures = sound();
    figures.drift         = 0.03;
    EXPECT_EQ(line("energy", figures).verdict, Verdict::look);
    figures.bodies[0].points = 9;
    EXPECT_EQ(line("points", figures).verdict, Verdict::look);
    const std::string text = health_text(judge(figures));
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3) << text;
    EXPECT_NE(text.find("health look: energy: "), std::string::npos) << text;
  }



  TEST(Health, WhatIsNotANumberIsBad)
  {
    HealthFigures figures           = sound();
    figures.drift                   = std::numeric_limits<double>::quiet_NaN();
    figures.bodies[0].unseen_energy = figures.drift;
    EXPECT_EQ(line("energy", figures).verdict, Verdict::bad);
    EXPECT_EQ(line("unseen", figures).verdict, Verdict::bad);
  }



  // Water comes to rest on a floor, clay as well.
  TEST(Health, ImpactsOfWhatIsNotElasticMayTakeEnergy)
  {
    HealthFigures figures        = sound();
    figures.may_hit              = true;
    figures.contact              = 40;
    figures.bodies[0].is_plastic = true;
    EXPECT_EQ(line("impacts", figures).verdict, Verdict::good);
    figures.contact = -3; // but none may be given
    EXPECT_EQ(line("impacts", figures).verdict, Verdict::bad);
    figures.contact = -1;
    EXPECT_EQ(line("impacts", figures).verdict, Verdict::look);
    figures.contact = -0.4; // that of scenes with a reference
    EXPECT_EQ(line("impacts", figures).verdict, Verdict::good);
    figures.bodies[0].is_plastic = false;
    figures.bodies[0].is_liquid  = true;
    EXPECT_EQ(line("impacts", figures).verdict, Verdict::good);
    figures.bodies[0].is_liquid = false;
    figures.contact             = 5;
    EXPECT_EQ(line("impacts", figures).verdict, Verdict::look);
  }



  // A clamp stops what runs against it, as a floor does.
  TEST(Health, WhatClampsTakeIsTold)
  {
    HealthFigures figures = sound();
    figures.contact       = 40;
    expect_bad("impacts", figures, "Courant number");
    EXPECT_NE(line("impacts", figures).text.find("held by sides"),
              std::string::npos);
    EXPECT_NE(line("impacts", figures).text.find("'Frame = initial'"),
              std::string::npos);
    figures.has_levels = true; // where it may be refused
    EXPECT_EQ(line("impacts", figures).text.find("'Frame = initial'"),
              std::string::npos);
    figures.contact              = 5;
    figures.bodies[0].is_plastic = true;
    EXPECT_EQ(line("impacts", figures).verdict, Verdict::good);
  }



  // What creeps within its friction has heat and a negative loss, both next to
  // nothing: only what is left of the two counts.
  TEST(Health, FrictionHeatMakesUpForNegativeLosses)
  {
    HealthFigures figures = sound();
    figures.may_hit       = true;
    figures.contact       = -3;
    EXPECT_EQ(line("impacts", figures).verdict, Verdict::bad);
    figures.friction = 3.5;
    EXPECT_EQ(line("impacts", figures).verdict, Verdict::good);
    figures.friction = 0.5;
    EXPECT_EQ(line("impacts", figures).verdict, Verdict::bad);
  }



  // Where 'Kernel = auto' does not take splines, they are no remedy.
  TEST(Health, SplinesAreNoRemedyForScenesWithWater)
  {
    HealthFigures figures                    = sound();
    figures.bodies[0].crossings_under_strain = 1000;
    const HealthLine alone                   = line("crossings", figures);
    EXPECT_NE(alone.text.find("'Method/Kernel = quadratic' with three"),
              std::string::npos);
    figures.against_splines   = "with splines liquids, like body 'water', lose "
                                "volume";
    const HealthLine in_water = line("crossings", figures);
    EXPECT_EQ(in_water.text.find("'Method/Kernel"), std::string::npos);
    EXPECT_NE(in_water.text.find("lose volume"), std::string::npos);
    EXPECT_EQ(in_water.entry, "Body beam/Points per cell edge");
    EXPECT_LT(n_words(in_water.text), 70u) << in_water.text;
  }



  TEST(Health, LiquidsMayCrossAndPart)
  {
    HealthFigures figures                    = sound();
    figures.bodies[0].is_liquid              = true;
    figures.bodies[0].crossings_under_strain = 1000;
    figures.bodies[0].gaps                   = 50;
    EXPECT_EQ(line("crossings", figures).verdict, Verdict::good);
    EXPECT_EQ(line("gaps", figures).verdict, Verdict::good);
  }



  TEST(Health, WhatIsRigidDoesNotCreepAndWhatRestsIsNotNoisy)
  {
    HealthFigures figures                    = sound();
    figures.bodies[0].crossings_under_strain = 1000;
    figures.bodies[0].strain_energy          = 1e-6;
    figures.kinetic                          = 0.01;
    figures.bodies[0].unseen_energy          = 0.009;
    EXPECT_EQ(line("crossings", figures).verdict, Verdict::good);
    EXPECT_EQ(line("unseen", figures).verdict, Verdict::good);
  }



  TEST(Health, TheWorstBodyIsNamed)
  {
    HealthFigures figures = sound();
    figures.bodies.push_back(figures.bodies[0]);
    figures.bodies[1].name   = "plate";
    figures.bodies[1].volume = 1.2;
    EXPECT_NE(line("mass", figures).text.find("'plate'"), std::string::npos);
    EXPECT_NEAR(line("mass", figures).value, 0.2, 1e-12);
  }



  // Linear motion is a function of the grid; what alternates within cells is
  // none, but for the free ends.
  TEST(Health, TheGridHoldsLinearMotionAndNoAlternatingOne)
  {
    SampleRun<2>       run(/*projected=*/true);
    const PointView<2> points  = run.points().view();
    const auto         kinetic = [&]() {
      double result = 0;
      for (std::size_t p = 0; p < points.size; ++p)
        for (int d = 0; d < 2; ++d)
          result += 0.5 * points.mass[p] * points.velocity[d][p] *
                    points.velocity[d][p];
      return dealii::Utilities::MPI::sum(result, MPI_COMM_WORLD);
    };
    EXPECT_EQ(unseen_energy(run.state)[0], 0);

    for (std::size_t p = 0; p < points.size; ++p)
      {
        points.velocity[0][p] = 3 - 2 * points.position[1][p];
        points.velocity[1][p] = 1 + 2 * points.position[0][p];
      }
    EXPECT_LT(unseen_energy(run.state)[0], 1e-3 * kinetic());

    for (std::size_t p = 0; p < points.size; ++p)
      {
        points.velocity[0][p] =
          std::fmod(points.position[0][p], 0.25) < 0.125 ? 1 : -1;
        points.velocity[1][p] = 0;
      }
    const double unseen = unseen_energy(run.state)[0];
    EXPECT_GT(unseen, 0.6 * kinetic());
    EXPECT_LE(unseen, kinetic() * (1 + 1e-12));
  }



  namespace
  {
    /** Two boxes of rubber in a unit box of 10 x 10 cells. */
    std::string
    two_boxes(const std::string &left_of_second)
    {
      const auto body = [](const std::string &name,
                           const std::string &corners) {
        return "subsection Body " + name +
               "\n set Shape = box\n subsection Box\n" + corners +
               " end\n set Material = linear elastic\n subsection Linear "
               "elastic\n set Young's modulus = 100\n set Poisson's ratio = "
               "0.3\n end\nend\n";
      };
      return "set Bodies = one, two\n" +
             body("one",
                  " set Lower corner = 0.1, 0.1\n set Upper corner = 0.4, "
                  "0.5\n") +
             body("two",
                  " set Lower corner = " + left_of_second +
                    ", 0.1\n set Upper corner = 0.7, 0.5\n") +
             "subsection Grid\n set Cells = 10, 10\nend\nsubsection "
             "Boundaries\n set left = free\n set right = free\n set bottom = "
             "free\n set top = free\nend\n";
    }



    BodyFigures
    at_start(SceneRun<2> &run)
    {
      const auto state = run.state();
      return Health<2>(state).look(state, run.totals(), {}).bodies[0];
    }
  } // namespace



  TEST(Health, BodiesThatTouchDoNotOverlap)
  {
    SceneRun<2>       touching(two_boxes("0.4")), common(two_boxes("0.3"));
    const BodyFigures none = at_start(touching), third = at_start(common);
    EXPECT_EQ(none.overlap, 0);
    EXPECT_NEAR(none.volume, none.shape_volume, 1e-12);
    EXPECT_NEAR(third.overlap, 1. / 3, 1e-12);
    EXPECT_EQ(third.overlaps_with, "two");
    EXPECT_EQ(third.overlap_place, "0.35, 0.3");
  }



  // Two and a half cells along x and a third along y, there and back again.
  TEST(Health, CrossingsAreCountedAlsoOnTheWayBack)
  {
    SceneRun<2> run(two_boxes("0.4"));
    const auto  set_velocity = [&](const double x, const double y) {
      for (unsigned int b = 0; b < 2; ++b)
        for (std::size_t p = 0; p < run.points(b).size; ++p)
          {
            run.points(b).velocity[0][p] = x;
            run.points(b).velocity[1][p] = y;
          }
    };
    set_velocity(0.25, 0.0333);
    run.advance(0.05, 20);
    set_velocity(-0.25, -0.0333);
    run.advance(0.05, 20);
    const BodyFigures body = at_start(run);
    // points at 1/4 and 3/4 of a cell: 2 or 3 crossings along x, 0 or 1 along
    // y, in each direction
    EXPECT_NEAR(body.crossings, 2 * (2.5 + 0.5), 1e-12);
    EXPECT_EQ(body.most_crossings, 8);
  }



  TEST(Health, GapsAreWhatIsEmptyBetweenPointsOfTheBody)
  {
    // # # . # . . # # . . . # in one row, and # below the first
    const std::array<unsigned int, 2> n{{12, 3}};
    CellCounts                        own, other;
    for (const unsigned int i : {0, 1, 3, 6, 7, 11})
      own.cells.push_back({12 + i, 4});
    own.cells.insert(own.cells.begin(), {0, 1});
    BodyFigures body;
    look_at_counts<2>({own, other}, n, 0, body);
    EXPECT_EQ(body.cells, 7u);
    EXPECT_EQ(body.gaps, 3u);
    other.cells.push_back({12 + 2, 4}); // the other body fills the first one
    look_at_counts<2>({own, other}, n, 0, body);
    EXPECT_EQ(body.gaps, 2u);
  }



  // A liquid of 6 x 4 cells in the corner of a grid of 8 x 8 with cells of 2
  // m^2: two sides of the grid count as neighbours, the surface does not.
  TEST(Health, FillingIsThatOfInnerCells)
  {
    const std::array<unsigned int, 2> n{{8, 8}};
    CellCounts                        own, other;
    for (unsigned int y = 0; y < 4; ++y)
      for (unsigned int x = 0; x < 6; ++x)
        own.cells.push_back({y * 8 + x, 4, x < 5 && y < 3 ? 2.2 : 0.5});
    const auto of_all = [](std::uint64_t) { return true; };
    // too few to judge: 15 inner ones
    EXPECT_EQ(filling<2>({own}, n, 2, of_all, 0), 1);
    for (unsigned int x = 0; x < 6; ++x)
      own.cells.push_back({4 * 8 + x, 4, 0.5});
    // 15 with 2.2 and the former surface, 5 with 0.5
    EXPECT_NEAR(filling<2>({own}, n, 2, of_all, 0),
                (15 * 2.2 + 5 * 0.5) / 40,
                1e-14);
    // 16 of them beyond an obstacle in four
    const auto beyond = [](std::uint64_t place) { return place >= 4; };
    EXPECT_NEAR(filling<2>({own}, n, 2, beyond, 0),
                (11 * 2.2 + 5 * 0.5) / 32,
                1e-14);
    // what another body has in them fills them as well
    other.cells.push_back({8, 4, 1});
    EXPECT_NEAR(filling<2>({own, other}, n, 2, of_all, 0),
                (15 * 2.2 + 5 * 0.5 + 1) / 40,
                1e-14);
  }



  TEST(Health, ClumpingIsJudgedWhereThereAreLiquids)
  {
    HealthFigures figures = sound();
    const auto    lines   = judge(figures);
    EXPECT_TRUE(std::none_of(lines.begin(), lines.end(), [](const auto &line) {
      return line.name == "clumping";
    }));
    figures.bodies.push_back(figures.bodies[0]);
    BodyFigures &water = figures.bodies[1];
    water.name         = "water";
    water.is_liquid    = true;
    water.filling      = 0.9; // room between drops
    EXPECT_EQ(line("clumping", figures).verdict, Verdict::good);
    EXPECT_EQ(line("clumping", figures).value, 0);
    water.filling = 1.05;
    EXPECT_EQ(line("clumping", figures).verdict, Verdict::look);
    water.filling = 1.25;
    EXPECT_EQ(line("clumping", figures).verdict, Verdict::bad);
    EXPECT_EQ(line("clumping", figures).entry, "Body water/Particle shifting");
    water.kernel = KernelKind::gimp;
    EXPECT_EQ(line("clumping", figures).entry, "Method/Kernel");
  }



  // What controls have given to points ends as such, too, and is no loss.
  TEST(Health, TellsWhatSemiImplicitStepsLose)
  {
    HealthFigures figures = sound();
    figures.energy_scale  = 100;
    figures.lost_by_steps = 60;
    for (const HealthLine &other : judge(figures))
      EXPECT_NE(other.name, "dissipation"); // of other steps
    figures.is_semi_implicit = true;
    EXPECT_EQ(line("dissipation", figures).verdict, Verdict::bad);
    EXPECT_NE(line("dissipation", figures).text.find("lost"),
              std::string::npos);
    figures.history = -40;
    EXPECT_EQ(line("dissipation", figures).verdict, Verdict::look);
    EXPECT_DOUBLE_EQ(line("dissipation", figures).value, 0.2);
    figures.history = -55;
    EXPECT_EQ(line("dissipation", figures).verdict, Verdict::good);
    figures.lost_by_steps = -30;
    figures.history       = 0;
    EXPECT_EQ(line("dissipation", figures).verdict, Verdict::look);
    EXPECT_NE(line("dissipation", figures).text.find("created"),
              std::string::npos);
  }



  // The motion of water at rest is no scale for what it loses; what stirs
  // itself is told.
  TEST(Health, LiquidsAtRestDissipateNothingThatMatters)
  {
    HealthFigures figures       = sound();
    figures.is_semi_implicit    = true;
    figures.bodies[0].is_liquid = true;
    figures.energy_scale        = 0.05;
    figures.lost_by_steps       = -0.05;
    EXPECT_EQ(line("dissipation", figures).verdict, Verdict::bad);
    figures.bodies[0].potential = 1000;
    EXPECT_EQ(line("dissipation", figures).verdict, Verdict::good);
    EXPECT_DOUBLE_EQ(line("dissipation", figures).value, 0.025);
    EXPECT_NE(line("dissipation", figures).text.find("of low waves, 2 J"),
              std::string::npos);
    figures.lost_by_steps = -10;
    figures.energy_scale  = 10;
    EXPECT_EQ(line("dissipation", figures).verdict, Verdict::bad);
    figures.lost_by_steps = 0.5;
    figures.energy_scale  = 0.05;
    EXPECT_EQ(line("dissipation", figures).verdict, Verdict::look);
  }



  // A tank of water, half a metre deep.
  TEST(Health, PotentialOfALiquidIsItsWeightTimesItsDepth)
  {
    SceneRun<2> run("set Bodies = water\nsubsection Body water\n set Shape = "
                    "box\n subsection Box\n set Lower corner = 0, 0\n set "
                    "Upper corner = 1, 0.5\n end\n set Material = newtonian "
                    "fluid\nend\nsubsection Grid\n set Cells = 10, "
                    "10\nend\nsubsection Loads\n set Gravity = 0, "
                    "-10\nend\n");
    // between the outermost points, which stand half their distance inside
    const BodyFigures water = at_start(run);
    EXPECT_NEAR(water.potential, 0.5 * 1000 * 10 * 0.5, 0.1 * 2500);
    EXPECT_LT(water.potential, 2500);
  }



  TEST(Health, TellsWhatATransferThatSmoothsTakes)
  {
    HealthFigures figures = sound();
    figures.energy_scale  = 100;
    figures.transfer      = 60;
    for (const HealthLine &other : judge(figures))
      EXPECT_NE(other.name, "transfer"); // of FLIP with blending
    figures.is_smoothed = true;
    EXPECT_EQ(line("transfer", figures).verdict, Verdict::bad);
    EXPECT_DOUBLE_EQ(line("transfer", figures).value, 0.6);
    figures.transfer = 20;
    EXPECT_EQ(line("transfer", figures).verdict, Verdict::look);
    EXPECT_EQ(line("transfer", figures).entry, "Method/Transfer");
    figures.transfer = -5; // none
    EXPECT_EQ(line("transfer", figures).verdict, Verdict::good);
  }



  // An undamped vibration in steps of a twelfth and of a fifth of its period,
  // by the trapezoidal rule.
  TEST(Health, TellsWhenImplicitStepsAreLong)
  {
    HealthFigures figures = sound();
    for (const HealthLine &other : judge(figures))
      EXPECT_NE(other.name, "steps"); // of other steps
    figures.is_implicit = true;
    EXPECT_EQ(line("steps", figures).verdict, Verdict::good); // at rest
    figures.step_entry = "Method/Time step";
    for (const int n : {5, 12, 40})
      {
        figures.kinetic_action = figures.action_of_changes = 0;
        const auto velocity                                = [n](const int k) {
          return std::sin(2 * dealii::numbers::PI * k / n);
        };
        for (int k = 0; k < 10 * n; ++k)
          {
            const double v = velocity(k), w = velocity(k + 1);
            figures.kinetic_action += (v * v + w * w) / 2;
            figures.action_of_changes += (w - v) * (w - v);
          }
        const HealthLine found = line("steps", figures);
        const double     half  = dealii::numbers::PI / n;
        EXPECT_NEAR(found.value, 1 - half / std::tan(half), 1e-12) << n;
        EXPECT_NE(found.text.find("has " + std::to_string(n) + " steps"),
                  std::string::npos)
          << found.text;
        EXPECT_EQ(found.verdict,
                  n == 5  ? Verdict::bad :
                  n == 12 ? Verdict::look :
                            Verdict::good);
        EXPECT_EQ(found.entry, "Method/Time step");
      }
  }



  TEST(Health, InnerCellsWithOnePointAreCounted)
  {
    const std::array<unsigned int, 3> n{{3, 3, 3}};
    CellCounts                        own;
    for (unsigned int place = 0; place < 27; ++place)
      own.cells.push_back({place, place == 13 ? 1u : 8u});
    BodyFigures body;
    look_at_counts<3>({own}, n, 0, body);
    EXPECT_EQ(body.inner_cells, 1u);
    EXPECT_EQ(body.single_cells, 1u);
    EXPECT_EQ(body.gaps, 0u);
  }
} // namespace limber::test
