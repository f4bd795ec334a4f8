// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/spline_factors.h>
#include <limber/time/body_sweeps.h>
#include <limber/time/contact.h>

#include <gtest/gtest.h>
#include <support/scene_parts.h>
#include <support/scene_run.h>

/**
 * @file Impulses at places: two places against the solution of their equations,
 * and bodies that meet at an angle against what holds for any of them: nothing
 * is made or lost, nothing is pulled, and friction stays within its cone.
 */

using namespace limber;

namespace
{
  // A block beside a tilted one, with a face in common; what it does is up to
  // the tests.
  const std::string meeting_blocks = R"(
    set Bodies = left, right
    subsection Body left
      set Shape = block
      subsection Block
        set Corners = 0.2, 0.2; 0.46, 0.2; 0.61, 0.8; 0.2, 0.8
      end
)" + rubber("1e3", "0.3") + R"(
    end
    subsection Body right
      set Shape = block
      subsection Block
        set Corners = 0.46, 0.2; 0.9, 0.2; 0.9, 0.8; 0.61, 0.8
      end
)" + rubber("1e3", "0.3") + R"(
    end
    subsection Contact
      set Pairs = faces
      subsection Pair faces
        set Bodies = left, right
      end
    end
    subsection Grid
      set Cells = 16, 16
    end)" + free_sides;



  using Vector = dealii::Tensor<1, 2>;

  /** The scene, with what points have given to the nodes. */
  struct Meeting
  {
    Meeting(const std::string              &kernel,
            const Vector                   &of_left,
            const Vector                   &of_right,
            const std::vector<std::string> &settings = {},
            const Vector                   &apart    = Vector())
      : run(meeting_blocks, with_kernel(kernel, settings))
      , parts{run.problem, run.grid, run.nodes, run.bodies, run.ledger}
      , contact(parts)
    {
      run.translate(Vector()); // cells anew, where bodies are moved
      for (unsigned int b = 0; b < 2; ++b)
        {
          const auto points = run.points(b);
          for (std::size_t p = 0; p < points.size; ++p)
            for (int d = 0; d < 2; ++d)
              {
                // with a little of their own
                points.velocity[d][p] =
                  (b == 0 ? of_left : of_right)[d] * (1 + 0.1 * (p % 7));
                points.position[d][p] += b == 0 ? 0 : apart[d];
              }
        }
      run.translate(Vector());
      run.integrator.reorganise(run.time);
      run.nodes.clear();
      BodySweeps<2> sweeps(parts);
      P2GOptions    what;
      what.force = false;
      sweeps.points_to_grid(what);
      run.nodes.for_each_field([&]() {
        for (const std::uint32_t node : run.nodes.active_nodes())
          {
            double *const record = run.nodes.record(node);
            for (int d = 0; d < 2; ++d)
              {
                if (record[Layout::mass] > 0)
                  record[Layout::velocity + d] =
                    record[Layout::momentum + d] / record[Layout::mass];
                record[Layout::increment + d] = 0;
              }
          }
      });
      contact.find(1e-4);
      contact.exchange();
    }

    using Layout = NodeLayout<2>;

    static std::vector<std::string>
    with_kernel(const std::string &kernel, std::vector<std::string> settings)
    {
      settings.push_back("Method/Kernel=" + kernel);
      return settings;
    }

    Vector
    momentum_gained(const unsigned int field) const
    {
      Vector result;
      for_each_gain(field,
                    [&](std::uint32_t, const Vector &gain) { result += gain; });
      return result;
    }

    /** About the origin; nodes are where linear fields have their values. */
    double
    moment_gained(const unsigned int field)
    {
      std::map<std::uint32_t, dealii::Point<2>> places;
      const GridView<2>                         view = run.nodes.view();
      for (std::uint32_t cell = 0; cell < run.grid.n_cells(); ++cell)
        {
          std::array<std::array<double, 3>, 2> along;
          for (int d = 0; d < 2; ++d)
            along[d] = SplineFactors<2>::places(view.quadratics[cell].lower[d],
                                                view.quadratics[cell].upper[d]);
          for (int k = 0; k < 9; ++k)
            for (int d = 0; d < 2; ++d)
              places[view.quadratics[cell].node[k] / Layout::stride][d] =
                view.cells[cell].origin[d] + along[d][d == 0 ? k % 3 : k / 3] /
                                               view.cells[cell].inverse_edge[d];
        }
      double result = 0;
      for_each_gain(field, [&](const std::uint32_t node, const Vector &gain) {
        result += places[node][0] * gain[1] - places[node][1] * gain[0];
      });
      return result;
    }

    template <class Work>
    void
    for_each_gain(const unsigned int field, const Work &work) const
    {
      for (const std::uint32_t node : run.nodes.active_nodes())
        {
          const double *const record = run.nodes.record(field, node);
          Vector              gain;
          for (int d = 0; d < 2; ++d)
            gain[d] = record[Layout::mass] * record[Layout::increment + d];
          work(node, gain);
        }
    }

    SceneRun<2>       run;
    const RunParts<2> parts;
    Contact<2>        contact;
  };

  // Out of the left block, across the face from (0.46, 0.2) to (0.61, 0.8)
  const Vector across =
    dealii::Point<2>(0.6, -0.15) / std::sqrt(0.6 * 0.6 + 0.15 * 0.15);
  const Vector along = dealii::Point<2>(-across[1], across[0]);
} // namespace



// Two places on nodes of their own, of mass 1, against one of mass m: they
// approach at u and v. Without friction the sum and the difference of their
// impulses J obey
//
//   (1 + 2/m) (J_1 + J_2) = u + v,   J_1 - J_2 = u - v.
//
// One pass has the sum, and leaves 2/m / (1 + 2/m) of what the difference
// lacks.
TEST(ContactImpulses, TwoPlacesMeetOneNode)
{
  SceneRun<2> run(meeting_blocks);
  using Layout                             = NodeLayout<2>;
  NodalFields<2>                    &nodes = run.nodes;
  const double                       m = 8, u = 0.7, v = 0.4;
  const std::array<std::uint32_t, 3> at    = {{20, 21, 40}};
  const std::array<double, 3>        mass  = {{1, 1, m}};
  const std::array<double, 3>        speed = {{-u, -v, 0}};
  for (unsigned int k = 0; k < 3; ++k)
    {
      double *const record = nodes.record(k < 2 ? 0 : 1, at[k]);
      std::fill_n(record, Layout::stride, 0.);
      record[Layout::mass]         = mass[k];
      record[Layout::velocity]     = 0.3;
      record[Layout::velocity + 1] = speed[k];
    }
  ContactImpulses<2> impulses(nodes);
  for (unsigned int k = 0; k < 2; ++k)
    {
      auto &place  = impulses.add_place();
      place.normal = dealii::Point<2>(0, 1);
      place.mass   = 1;
      impulses.add_share(0, at[k], 0.75);
      impulses.add_share(0, at[k], 0.25); // the same node once more
      impulses.add_share(1, at[2], -1);
    }
  impulses.finish_adding();
  ASSERT_TRUE(impulses.any());
  const auto   loss             = impulses.exchange();
  const double sum              = (u + v) / (1 + 2 / m),
               left             = std::pow(2 / m / (1 + 2 / m), 4),
               difference       = (u - v) * (1 - left);
  const std::array<double, 2> J = {
    {(sum + difference) / 2, (sum - difference) / 2}};
  for (unsigned int k = 0; k < 2; ++k)
    {
      EXPECT_NEAR(impulses.all()[k].impulse[1], J[k], 1e-14);
      EXPECT_EQ(impulses.all()[k].impulse[0], 0);
      EXPECT_NEAR(nodes.record(0, at[k])[Layout::velocity + 1],
                  speed[k] + J[k],
                  1e-14);
      EXPECT_NEAR(nodes.record(0, at[k])[Layout::increment + 1], J[k], 1e-14);
      EXPECT_EQ(nodes.record(0, at[k])[Layout::velocity], 0.3);
    }
  EXPECT_NEAR(nodes.record(1, at[2])[Layout::velocity + 1], -sum / m, 1e-14);
  // what PIC loses is the kinetic energy that is gone
  double before = 0, after = 0;
  for (unsigned int k = 0; k < 3; ++k)
    {
      const double now =
        nodes.record(k < 2 ? 0 : 1, at[k])[Layout::velocity + 1];
      before += 0.5 * mass[k] * speed[k] * speed[k];
      after += 0.5 * mass[k] * now * now;
    }
  EXPECT_NEAR(loss.across, before - after, 1e-14);
  EXPECT_NEAR(loss.along, 0, 1e-14);
}



// The least velocity is reached, what recedes faster is left alone, and
// friction brings to rest what it can and no more.
TEST(ContactImpulses, OnePlaceObeysCoulomb)
{
  using Layout = NodeLayout<2>;
  struct Case
  {
    double along, across, least, friction; // velocities, m/s
    double impulse_along, impulse_across;
    bool   sticks;
  };
  // of a mass of 2 kg against one that is as good as at rest
  for (const Case &expected : {Case{0, -1, 0, 0, 0, 2, false},
                               Case{0.5, -1, 0, 0, 0, 2, false},
                               Case{0.5, -1, 0, 0.2, -0.4, 2, false},
                               Case{-0.5, -1, 0, 0.2, 0.4, 2, false},
                               Case{0.1, -1, 0, 0.2, -0.2, 2, true},
                               Case{0.1, 1e-6, 0, 0.2, 0, 0, false},
                               Case{0.1, -1, -1.5, 0.2, 0, 0, false},
                               Case{0.1, -1, -0.75, 0.2, -0.1, 0.5, false},
                               Case{0.1, 0, 0.25, 1e300, -0.2, 0.5, true}})
    {
      SceneRun<2>   run(meeting_blocks);
      double *const record = run.nodes.record(0, 20);
      record[Layout::mass] = 2;
      ContactImpulses<2> impulses(run.nodes);
      auto              &place = impulses.add_place();
      place.normal             = along;
      place.velocity           = 0.3 * across - 0.1 * along;
      place.least              = expected.least;
      place.friction           = expected.friction;
      place.mass               = 0.3;
      const Vector velocity =
        place.velocity + expected.along * across + expected.across * along;
      for (int d = 0; d < 2; ++d)
        record[Layout::velocity + d] = velocity[d];
      impulses.add_share(0, 20, 1);
      impulses.finish_adding();
      impulses.exchange();
      const auto &found = impulses.all()[0];
      EXPECT_NEAR(found.impulse * across, expected.impulse_along, 1e-14);
      EXPECT_NEAR(found.impulse * along, expected.impulse_across, 1e-14);
      if (expected.friction > 0) // else nothing could hold it
        {
          EXPECT_EQ(found.sticks, expected.sticks);
        }
    }
}



// What one body gets the other one gives, at the same place: momentum and,
// without friction, moment of momentum, wherever the grid lies.
TEST(Contact, ActionEqualsReaction)
{
  for (const std::string kernel : {"linear", "quadratic", "cubic"})
    for (const std::string friction : {"0", "0.4"})
      {
        SCOPED_TRACE(kernel + " " + friction);
        Meeting      meeting(kernel,
                        dealii::Point<2>(1, 0.5),
                        dealii::Point<2>(-1, 0.1),
                        friction == "0" ?
                               std::vector<std::string>{} :
                               std::vector<std::string>{
                                 "Contact/Pair faces/Law=friction",
                                 "Contact/Pair faces/Friction coefficient=" +
                                   friction});
        const Vector left  = meeting.momentum_gained(0),
                     right = meeting.momentum_gained(1);
        EXPECT_LT(left * across, -1e-3); // they do press
        EXPECT_NEAR((left + right).norm(), 0, 1e-13 * left.norm());
        // the cone, around normals that differ by what the grid makes of them
        const double mu = friction == "0" ? 0 : 0.4;
        EXPECT_NEAR(std::abs(right * along),
                    mu * (right * across),
                    0.05 * (right * across));
        if (kernel != "quadratic" || mu > 0)
          continue;
        const double moment = meeting.moment_gained(0);
        EXPECT_GT(std::abs(moment), 1e-3);
        EXPECT_NEAR(moment + meeting.moment_gained(1),
                    0,
                    1e-12 * std::abs(moment));
      }
}



// Nothing pulls: bodies that recede, or are apart by more than they come
// nearer, have what they would have had.
TEST(Contact, WhatIsApartOrRecedesGetsNothing)
{
  for (const std::string kernel : {"quadratic", "cubic"})
    {
      SCOPED_TRACE(kernel);
      for (const bool recede : {true, false})
        {
          const double  sign  = recede ? -1 : 1;
          const Vector  apart = (recede ? 0 : 0.02) * across; // 0.3 cells
          const Meeting meeting(
            kernel, sign * across, -sign * across, {}, apart);
          for (unsigned int field = 0; field < 2; ++field)
            meeting.for_each_gain(field, [](std::uint32_t, const Vector &gain) {
              EXPECT_EQ(gain.norm(), 0);
            });
        }
    }
}
