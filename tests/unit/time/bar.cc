// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <support/scene_run.h>

/**
 * @file The axial vibration of a bar of length L, held at the left and free at
 * the right, in its first mode: u = v0 / w sin(k x) sin(w t), k = pi / 2L,
 * w = k c (prm/verification/bar.prm). So small that no point changes cell.
 */

using namespace limber;

namespace
{
  constexpr double length = 25, wave_speed = 10, v0 = 1e-6;
  constexpr double k      = 0.5 * dealii::numbers::PI / length;
  constexpr double omega  = k * wave_speed;
  constexpr double period = 2 * dealii::numbers::PI / omega;

  std::string
  bar(const unsigned int n_cells)
  {
    const std::string edge = digits(length / n_cells);
    return R"(
    set Bodies = bar
    subsection Body bar
      subsection Box
        set Upper corner = 25, )" +
           edge + R"(
      end
      set Initial velocity = 1e-6 * sin(pi * x / 50); 0
      subsection Linear elastic
        set Density = 1
        set Young's modulus = 100
        set Poisson's ratio = 0
      end
      set Locking treatment = none
    end
    subsection Grid
      set Upper corner = )" +
           digits(length + length / n_cells) + ", " + edge + R"(
      set Cells = )" +
           std::to_string(n_cells + 1) + R"(, 1
    end
    subsection Boundaries
      set right = free
    end)";
  }



  /** Root mean square errors over the amplitudes. */
  struct Errors
  {
    double displacement = 0, velocity = 0;
  };



  /** Displacements and velocities by id of point, over their amplitudes. */
  std::vector<std::array<double, 2>>
  motion(const unsigned int n_cells,
         const std::string &order,
         const double       time,
         const unsigned int n_steps)
  {
    SceneRun<2> run(bar(n_cells), {"Method/Stress update=" + order});
    const auto  start = run.positions();
    run.advance(time / n_steps, n_steps);
    const auto                         end = run.positions();
    std::vector<std::array<double, 2>> result(start.size());
    for (std::size_t p = 0; p < start.size(); ++p)
      {
        const unsigned int id = run.bodies[0]->points.id(p);
        result[id][0]         = (end[id] - start[id])[0] * omega / v0;
        result[id][1]         = run.velocity(p)[0] / v0;
      }
    return result;
  }



  template <class Exact>
  Errors
  compare(const std::vector<std::array<double, 2>> &values, const Exact &exact)
  {
    Errors result;
    for (std::size_t p = 0; p < values.size(); ++p)
      {
        const std::array<double, 2> e = exact(p);
        result.displacement += std::pow(values[p][0] - e[0], 2);
        result.velocity += std::pow(values[p][1] - e[1], 2);
      }
    result.displacement = std::sqrt(result.displacement / values.size());
    result.velocity     = std::sqrt(result.velocity / values.size());
    return result;
  }



  Errors
  errors(const unsigned int n_cells,
         const std::string &order,
         const double       time,
         const unsigned int n_steps)
  {
    SceneRun<2> run(bar(n_cells));
    const auto  start = run.positions();
    return compare(motion(n_cells, order, time, n_steps),
                   [&](const std::size_t p) {
                     const double shape = std::sin(k * start[p][0]);
                     return std::array<double, 2>{
                       {shape * std::sin(omega * time),
                        shape * std::cos(omega * time)}};
                   });
  }
} // namespace



TEST(Bar, SecondOrderInSpace)
{
  const double time = 0.85 * period;
  for (const std::string &order : stress_update_orders)
    {
      SCOPED_TRACE(order);
      std::vector<Errors> found;
      for (const unsigned int n : {8u, 16u, 32u, 64u})
        // dt ~ h^2: the first order in time does not show
        {
          found.push_back(errors(n, order, time, 20 * n * n));
          printf("%s n %u u %.3e v %.3e\n", order.c_str(), n, found.back().displacement, found.back().velocity);
        }
    }
}

TEST(Bar, OrderInTime)
{
  const double time = 0.85 * period;
  for (const std::string &order : stress_update_orders)
    {
      const auto fine = motion(32, order, time, 200000);
      for (const unsigned int n : {200u, 400u, 800u, 1600u})
        {
          const auto e = compare(motion(32, order, time, n), [&](const std::size_t p) { return fine[p]; });
          printf("%s steps %u u %.3e v %.3e\n", order.c_str(), n, e.displacement, e.velocity);
        }
    }
}
