// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/study/advice.h>

#include <algorithm>
#include <cmath>
#include <sstream>

/**
 * @file Where a scene may be made cheaper: stiffness of liquids, number of
 * points, locking treatments, time steps.
 */
namespace limber
{
  namespace
  {
    /** Bulk modulus of a body after @p setting; 0 where it is unknown. */
    template <int dim>
    double
    bulk_modulus_with(const SceneFile   &scene,
                      const std::string &setting,
                      const std::string &name)
    {
      std::ostringstream entries;
      scene.parameters().print(entries, PrintStyle::prm);
      try
        {
          const SceneFile softer(ParameterText{entries.str(),
                                               FileFormat::prm,
                                               "the scene"},
                                 {setting});
          for (const Body<dim> &body : read_problem<dim>(softer).bodies)
            if (body.name == name)
              return body.material[1];
        }
      catch (const InputError &)
        {} // 'auto' has no velocity to choose a modulus by
      return 0;
    }



    template <int dim>
    void
    advise_bulk_modulus(const SceneFile     &scene,
                        const Body<dim>     &body,
                        std::vector<Advice> &advice)
    {
      if (body.law != "newtonian fluid")
        return;
      const std::string setting =
        "Body " + body.name + "/Newtonian fluid/Bulk modulus=auto";
      const double enough = bulk_modulus_with<dim>(scene, setting, body.name);
      if (enough == 0 || body.material[1] <= 1.5 * enough)
        return;
      Advice found;
      found.what = "Bulk modulus";
      found.text = "Body '" + body.name + "': a bulk modulus of " +
                   brief(body.material[1]) +
                   " Pa keeps the Mach number far below 0.1; " + brief(enough) +
                   " Pa does for the velocities that gravity and the start "
                   "can give";
      found.changes  = "volumes, by up to 1 %, and with them places and the "
                       "pressure of impacts";
      found.settings = {setting};
      advice.push_back(found);
    }



    /** Points matter for creep in solids, for the surface and the state of rest
     * in liquids. */
    template <int dim>
    void
    advise_points(const Body<dim>     &body,
                  const double         error,
                  std::vector<Advice> &advice)
    {
      const unsigned int enough = body.is_liquid ? 3 : 2;
      const unsigned int most =
        *std::max_element(body.points_per_cell_edge.begin(),
                          body.points_per_cell_edge.end());
      // For smaller errors cells should be refined instead.
      if (most <= enough || error < 0.005)
        return;
      Advice found;
      found.what = "Points per cell edge";
      found.text = "Body '" + body.name + "': " + std::to_string(enough) +
                   " points per cell edge for " + std::to_string(most);
      if (body.is_liquid)
        found.changes = "the smoothness of the surface, and how still water "
                        "at rest is";
      else
        {
          found.changes = "permanent strain of points that cross cells, and "
                          "the stretch at which points lose each other";
          found.longest_way = 0.25;
        }
      found.settings = {"Body " + body.name +
                        "/Points per cell edge=" + std::to_string(enough)};
      advice.push_back(found);
    }



    /**
     * Relative error of a bending frequency without locking treatment, from the
     * effective bending stiffness of Q1 cells (doc/theory/locking.md): EI_eff /
     * EI = 1 - 1/n^2 + (1 - 1/p^2) k / (n^2 E'), with k = C11 + G.
     */
    double
    untreated_error(const double poisson, const double n, const double points)
    {
      const double C11 = (1 - poisson) * (1 - poisson) / (1 - 2 * poisson);
      const double G   = (1 - poisson) / 2;
      const double ratio =
        1 - 1 / (n * n) + (1 - 1 / (points * points)) * (C11 + G) / (n * n);
      return std::abs(std::sqrt(ratio) - 1);
    }



    template <int dim>
    double
    smallest_depth_in_cells(const GridDescription<dim> &grid,
                            const Body<dim>            &body)
    {
      const auto box   = body.shape->bounding_box();
      double     depth = 1e300;
      for (unsigned int d = 0; d < dim; ++d)
        depth = std::min(depth, (box.second[d] - box.first[d]) / grid.edge(d));
      return depth;
    }



    /** Why @p body may need no treatment; empty where it does. */
    template <int dim>
    Advice
    without_treatment(const GridDescription<dim> &grid,
                      const Body<dim>            &body,
                      const double                error)
    {
      Advice            found;
      const auto        points = body.points_per_cell_edge;
      const std::string start  = "Body " + body.name + "/";
      found.settings           = {start + "Locking treatment=none",
                                  start + "Hourglass control=0"};
      if (std::all_of(points.begin(), points.end(), [](const unsigned int n) {
            return n == 1;
          }))
        {
          found.text = "Body '" + body.name +
                       "': with one point per cell there is nothing to "
                       "average, and no locking, until points cross";
          found.changes     = "stiffness, where points come to share a cell";
          found.longest_way = 0.25;
          return found;
        }
      // the third parameter of these is Poisson's ratio
      if (body.law != "linear elastic" && body.law != "neo hookean")
        return found;
      const double depth = smallest_depth_in_cells(grid, body);
      const double without =
        untreated_error(body.material[2], depth, points[0]);
      if (without >= 0.5 * error)
        return found;
      found.text = "Body '" + body.name + "': with Poisson's ratio " +
                   brief(body.material[2]) + " and " + brief(depth) +
                   " cells over its smallest extent, frequencies in bending "
                   "without treatment err by " +
                   brief(100 * without) + " % only";
      found.changes = "stiffness where it bends more sharply than that, and "
                      "stress within cells";
      return found;
    }



    template <int dim>
    void
    advise_treatment(const GridDescription<dim> &grid,
                     const Body<dim>            &body,
                     const double                error,
                     std::vector<Advice>        &advice)
    {
      if (body.treatment == Treatment::none)
        return;
      Advice found = without_treatment(grid, body, error);
      if (found.text.empty() && body.law == "newtonian fluid" &&
          body.material[2] == 0 && body.treatment != Treatment::cell)
        {
          found.text = "Body '" + body.name +
                       "': an inviscid fluid bears no shear stress, so that "
                       "averaging more than its volume has no effect";
          found.changes  = "what its controls leave of hourglass motion";
          found.settings = {"Body " + body.name + "/Locking treatment=cell"};
        }
      found.what = "Locking treatment";
      if (!found.text.empty())
        advice.push_back(found);
    }



    template <int dim>
    void
    advise_pictures(const Problem<dim>  &problem,
                    const double         first_step,
                    std::vector<Advice> &advice)
    {
      const double interval = problem.output.time_interval;
      if (interval <= 0 || interval >= 2 * first_step)
        return;
      // Steps end where a picture is due.
      const double shortened = interval / std::ceil(interval / first_step);
      const double enough =
        std::min(problem.end_time,
                 std::max(problem.end_time / 50, 10 * first_step));
      if (enough <= interval || !(shortened < 0.9 * first_step))
        return;
      Advice found;
      found.what = "Output";
      found.text = "Pictures every " + brief(interval) +
                   " s shorten the steps from " + brief(first_step) + " to " +
                   brief(shortened) + " s; one in ten steps is often enough";
      found.changes  = "nothing but the length of the steps";
      found.settings = {"Output/Time interval=" + brief(enough)};
      found.factor   = first_step / shortened;
      found.ground   = "the length of steps; no run needed";
      advice.push_back(found);
    }



    template <int dim>
    void
    advise_rows(const Problem<dim>  &problem,
                const double         first_step,
                std::vector<Advice> &advice)
    {
      constexpr unsigned int rows   = 2000;
      const double           steps  = problem.end_time / first_step;
      const auto             enough = static_cast<unsigned int>(steps / rows);
      if (steps <= 5 * rows || problem.output.statistics_interval >= enough / 2)
        return;
      Advice found;
      found.what = "Statistics";
      found.text = "Some " +
                   std::to_string(static_cast<unsigned long>(
                     steps / problem.output.statistics_interval)) +
                   " rows of statistics, each a pass over all points; " +
                   std::to_string(rows) + " do";
      found.changes  = "frequencies and checks that are taken between rows";
      found.settings = {"Output/Statistics interval=" + std::to_string(enough)};
      advice.push_back(found);
    }



    /** No advice for 'usl': its stability limit tends to zero with the filling
     * of a cell (small cut). */
    void
    advise_step(const Method &method, std::vector<Advice> &advice)
    {
      if (method.order == StressUpdateOrder::usl || method.time_step > 0 ||
          method.courant_number >= 0.3)
        return;
      Advice found;
      found.what = "Courant number";
      found.text = "Courant number " + brief(method.courant_number) +
                   ": with this stress update 0.4 is stable with a wide margin";
      found.changes  = "the error in time, of first order but for 'usavg', "
                       "and the energy of points that cross cells";
      found.settings = {"Method/Courant number=0.4"};
      advice.push_back(found);
    }
  } // namespace



  template <int dim>
  std::vector<Advice>
  find_advice(const SceneFile    &scene,
              const Problem<dim> &problem,
              const double        error,
              const double        first_step)
  {
    std::vector<Advice> advice;
    const auto          note = [&](const std::optional<Advice> &found) {
      if (found)
        advice.push_back(*found);
    };
    // How many cells there are, and over a body, is not known with levels.
    const bool has_levels = problem.grid.levels > 0;
    if (!has_levels)
      note(advise_dimension(problem));
    for (const Body<dim> &body : problem.bodies)
      {
        advise_bulk_modulus(scene, body, advice);
        advise_points(body, error, advice);
        if (!has_levels)
          advise_treatment(problem.grid, body, error, advice);
      }
    advise_step(problem.method, advice);
    if (has_levels)
      note(advise_unused_levels(problem));
    else
      {
        note(advise_box(problem));
        note(advise_levels(scene, problem));
      }
    advise_pictures(problem, first_step, advice);
    advise_rows(problem, first_step, advice);
    return advice;
  }



  template std::vector<Advice>
  find_advice<2>(const SceneFile &, const Problem<2> &, double, double);
  template std::vector<Advice>
  find_advice<3>(const SceneFile &, const Problem<3> &, double, double);
} // namespace limber
