// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/study/advice.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace limber
{
  namespace
  {
    // CPU time of a point and step in three dimensions over two
    // (doc/developer/speed.md).
    constexpr double cost_of_third_dimension = 1.3;
    // Share of a step that a treatment takes: cell 10 %, others more; a row of
    // the statistics in every step 20 %.
    constexpr double cost_of_treatment = 1.1;
    constexpr double cost_of_rows      = 1.2;



    std::string
    percent(const double share)
    {
      return brief(100 * share) + " %";
    }



    /** A lattice of places within the box of a body. */
    template <int dim>
    std::vector<dealii::Point<dim>>
    sample_places(const Body<dim> &body)
    {
      const auto                      box = body.shape->bounding_box();
      constexpr unsigned int          n   = 5;
      std::vector<dealii::Point<dim>> places;
      for (unsigned int i = 0; i < std::pow(n, dim); ++i)
        {
          dealii::Point<dim> place;
          unsigned int       index = i;
          for (unsigned int d = 0; d < dim; ++d, index /= n)
            place[d] = box.first[d] +
                       (index % n + 0.5) / n * (box.second[d] - box.first[d]);
          places.push_back(place);
        }
      return places;
    }



    /** No component changes along the axis, and its own one is zero. */
    template <int dim>
    bool
    is_even_along(const Formula<dim> &formula,
                  const unsigned int  axis,
                  const Body<dim>    &body)
    {
      if (formula.empty() || formula.is_zero())
        return true;
      const auto box = body.shape->bounding_box();
      for (const auto &place : sample_places(body))
        {
          auto other  = place;
          other[axis] = 0.7 * box.first[axis] + 0.3 * box.second[axis];
          for (const double time : {0., 0.37})
            for (unsigned int c = 0; c < formula.n_components(); ++c)
              {
                const double here  = formula.value(place, time, c);
                const double there = formula.value(other, time, c);
                if (std::abs(here - there) > 1e-12 * std::abs(here) ||
                    (c == axis && formula.n_components() == dim && here != 0))
                  return false;
              }
        }
      return true;
    }



    /** Bodies from side to side, slip on both, nothing that changes along it.
     */
    template <int dim>
    bool
    is_plane_along(const Problem<dim> &problem, const unsigned int axis)
    {
      for (const unsigned int side : {2 * axis, 2 * axis + 1})
        if (problem.sides[side].condition != SideCondition::slip)
          return false;
      if (problem.loads.gravity[axis] != 0 || !problem.loads.faces.empty())
        return false;
      for (const Body<dim> &body : problem.bodies)
        {
          const auto box  = body.shape->bounding_box();
          const auto grid = problem.grid;
          const auto edge = (grid.upper[axis] - grid.lower[axis]);
          const bool spans =
            dynamic_cast<const BoxShape<dim> *>(body.shape.get()) != nullptr &&
            std::abs(box.first[axis] - grid.lower[axis]) < 1e-9 * edge &&
            std::abs(box.second[axis] - grid.upper[axis]) < 1e-9 * edge;
          if (!spans || body.placement == Placement::jittered ||
              !is_even_along(body.initial_velocity, axis, body) ||
              (body.initial_pressure &&
               !is_even_along(*body.initial_pressure, axis, body)) ||
              (problem.loads.body_force &&
               !is_even_along(*problem.loads.body_force, axis, body)))
            return false;
        }
      return true;
    }



    template <int dim>
    void
    advise_dimension(const Problem<dim> &problem, std::vector<Advice> &advice)
    {
      if constexpr (dim == 3)
        for (unsigned int axis = 0; axis < dim; ++axis)
          if (is_plane_along(problem, axis))
            {
              const unsigned int layers =
                problem.grid.cells[axis] *
                problem.bodies.front().points_per_cell_edge[axis];
              advice.push_back(
                {"Dimension",
                 std::string("Nothing changes along ") + "xyz"[axis] +
                   ": the bodies reach from side to side, both are 'slip', "
                   "and no load, velocity or pressure depends on it. Plane "
                   "strain computes the same without " +
                   std::to_string(layers) +
                   " layers of points. Set 'Dimension = 2' and leave out the "
                   "third numbers, or keep one cell with one point along it.",
                 {},
                 layers * cost_of_third_dimension});
              return;
            }
    }



    template <int dim>
    void
    advise_bulk_modulus(const SceneFile     &scene,
                        const Problem<dim>  &problem,
                        std::vector<Advice> &advice)
    {
      for (const Body<dim> &body : problem.bodies)
        {
          const std::string section = "Body " + body.name + "/Newtonian fluid/";
          if (body.law != "newtonian fluid")
            continue;
          std::vector<std::string> setting = {section + "Bulk modulus=auto"};
          double                   enough  = 0;
          try
            {
              const SceneFile softer(ParameterText{scene.original_text(),
                                                   scene.original_name() ==
                                                       "original.json" ?
                                                     FileFormat::json :
                                                     FileFormat::prm,
                                                   "the scene"},
                                     setting);
              for (const Body<dim> &other : read_problem<dim>(softer).bodies)
                if (other.name == body.name)
                  enough = other.material[1];
            }
          catch (const InputError &)
            {
              continue; // no velocity to go by
            }
          if (body.material[1] > 1.5 * enough)
            advice.push_back(
              {"Bulk modulus",
               "Body '" + body.name + "': a bulk modulus of " +
                 brief(body.material[1]) +
                 " Pa keeps the Mach number far "
                 "below 0.1; " +
                 brief(enough) +
                 " Pa does for the velocities that gravity and the start can "
                 "give, with changes of volume below 1 %. Set '" +
                 setting.front() + "'.",
               setting});
        }
    }



    template <int dim>
    void
    advise_points(const Problem<dim>  &problem,
                  const double         error,
                  std::vector<Advice> &advice)
    {
      for (const Body<dim> &body : problem.bodies)
        {
          const bool         fluid  = body.is_liquid;
          const unsigned int enough = fluid ? 3 : 2;
          const unsigned int most =
            *std::max_element(body.points_per_cell_edge.begin(),
                              body.points_per_cell_edge.end());
          // Below that, refinement is what is wanted, not points.
          if (most <= enough || error < 0.005)
            continue;
          advice.push_back(
            {"Points per cell edge",
             "Body '" + body.name + "': " + std::to_string(most) +
               " points per cell edge; for an error of " + percent(error) +
               ", " + std::to_string(enough) +
               (fluid ?
                  " do in liquids (the front of the dam break moves by "
                  "1.2 %, and the tank at rest stays still)" :
                  " do in solids (the frequency of the cantilever four cells "
                  "deep moves by 0.4 %)") +
               ", unless the material is stretched so far that its points come "
               "to lie a cell apart. Set 'Body " +
               body.name + "/Points per cell edge=" + std::to_string(enough) +
               "'.",
             {"Body " + body.name +
              "/Points per cell edge=" + std::to_string(enough)}});
        }
    }



    /**
     * Relative error of a bending frequency without treatment, as the
     * effective stiffness of Q1 cells says (doc/theory/locking.md): EI_eff /
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
    smallest_depth_in_cells(const Problem<dim> &problem, const Body<dim> &body)
    {
      const auto box   = body.shape->bounding_box();
      double     depth = 1e300;
      for (unsigned int d = 0; d < dim; ++d)
        depth =
          std::min(depth,
                   (box.second[d] - box.first[d]) * problem.grid.cells[d] /
                     (problem.grid.upper[d] - problem.grid.lower[d]));
      return depth;
    }



    template <int dim>
    void
    advise_treatment(const Problem<dim>  &problem,
                     const double         error,
                     std::vector<Advice> &advice)
    {
      for (const Body<dim> &body : problem.bodies)
        {
          if (body.treatment == Projection::none)
            continue;
          const std::string entry = "Body " + body.name + "/Locking treatment=";
          const std::string no_control =
            "Body " + body.name + "/Hourglass control=0";
          const auto points = body.points_per_cell_edge;
          const bool alone =
            std::all_of(points.begin(), points.end(), [](const unsigned int n) {
              return n == 1;
            });
          if (alone)
            {
              advice.push_back(
                {"Locking treatment",
                 "Body '" + body.name +
                   "': with one point per cell there is nothing to average "
                   "until points cross, and no locking. Set '" +
                   entry + "none'.",
                 {entry + "none", no_control},
                 cost_of_treatment});
              continue;
            }
          const bool fluid = body.law == "newtonian fluid";
          if (fluid && body.material[2] == 0 &&
              body.treatment != Projection::cell)
            advice.push_back(
              {"Locking treatment",
               "Body '" + body.name +
                 "': an inviscid fluid bears no shear stress, so averaging "
                 "more than its volume has no effect. Set '" +
                 entry + "cell'.",
               {entry + "cell"},
               cost_of_treatment});
          // of these the third entry is Poisson's ratio
          if (body.law != "linear elastic" && body.law != "neo hookean")
            continue;
          const double depth = smallest_depth_in_cells(problem, body);
          const double without =
            untreated_error(body.material[2], depth, points[0]);
          if (without < 0.5 * error)
            advice.push_back(
              {"Locking treatment",
               "Body '" + body.name + "': with Poisson's ratio " +
                 brief(body.material[2]) + " and " + brief(depth) +
                 " cells over its smallest extent, frequencies in bending "
                 "without treatment err by " +
                 percent(without) + " only. Set '" + entry +
                 "none', unless stresses within cells matter.",
               {entry + "none", no_control},
               cost_of_treatment});
        }
    }



    /** The farthest that anything may get in a direction, m: an upper bound. */
    template <int dim>
    double
    reach(const Problem<dim> &problem)
    {
      double speed = 0, fall = 0;
      for (const Body<dim> &body : problem.bodies)
        {
          for (const auto &place : sample_places(body))
            if (!body.initial_velocity.is_zero() &&
                body.initial_velocity.is_finite(place, 0))
              speed =
                std::max(speed, body.initial_velocity.vector(place, 0).norm());
        }
      // down the whole box, and then away along the floor
      for (unsigned int d = 0; d < dim; ++d)
        fall =
          std::max(fall,
                   std::sqrt(2 * std::abs(problem.loads.gravity[d]) *
                             (problem.grid.upper[d] - problem.grid.lower[d])));
      return (speed + fall) * problem.end_time;
    }



    template <int dim>
    void
    advise_box(const Problem<dim> &problem, std::vector<Advice> &advice)
    {
      if (problem.loads.body_force || !problem.loads.faces.empty())
        return; // what these do is not known beforehand
      for (const Side<dim> &side : problem.sides)
        if (side.condition == SideCondition::velocity)
          return;
      const double             way = reach(problem);
      std::vector<std::string> trims;
      double                   kept = 1;
      for (unsigned int d = 0; d < dim; ++d)
        {
          const double h = (problem.grid.upper[d] - problem.grid.lower[d]) /
                           problem.grid.cells[d];
          double lower = problem.grid.upper[d], upper = problem.grid.lower[d];
          for (const Body<dim> &body : problem.bodies)
            {
              lower = std::min(lower, body.shape->bounding_box().first[d]);
              upper = std::max(upper, body.shape->bounding_box().second[d]);
            }
          // a free layer of two cells, so that nothing feels the side
          lower = std::max(problem.grid.lower[d], lower - way - 2 * h);
          upper = std::min(problem.grid.upper[d], upper + way + 2 * h);
          const double share =
            (upper - lower) / (problem.grid.upper[d] - problem.grid.lower[d]);
          if (share < 0.999)
            trims.push_back(std::string(1, "xyz"[d]) + " from " + brief(lower) +
                            " to " + brief(upper) + " m");
          kept *= share;
        }
      // Walls that nothing can reach may go; empty cells cost memory alone.
      if (kept < 0.5)
        {
          double cells = 1;
          for (unsigned int d = 0; d < dim; ++d)
            cells *= problem.grid.cells[d];
          const double bytes = (dim == 2 ? 346. : 587.) * (1 - kept) * cells;
          advice.push_back(
            {"Grid",
             "Nothing gets farther than " + brief(way) +
               " m within the end time, so a box with " + join(trims, ", ") +
               " does, " + percent(kept) +
               " of the cells. Empty cells cost no time, but memory, here " +
               brief(bytes / 1048576) + " MB.",
             {},
             1});
        }
    }



    template <int dim>
    void
    advise_output(const Problem<dim>  &problem,
                  const double         first_step,
                  std::vector<Advice> &advice)
    {
      const double interval = problem.output.time_interval;
      if (interval > 0 && interval < 2 * first_step)
        advice.push_back(
          {"Output",
           "Pictures every " + brief(interval) + " s are finer than a step, " +
             brief(first_step) +
             " s, and shorten it to that. Set 'Output/Time interval=" +
             brief(problem.end_time / 50) + "' for fifty of them.",
           {"Output/Time interval=" + brief(problem.end_time / 50)},
           std::max(1., 2 * first_step / interval)});

      const double   steps = problem.end_time / first_step;
      constexpr auto rows  = 2000;
      if (steps > 5 * rows && problem.output.statistics_interval <
                                static_cast<unsigned int>(steps / rows) / 2)
        {
          const auto enough = static_cast<unsigned int>(steps / rows);
          advice.push_back(
            {"Statistics",
             "Some " +
               std::to_string(static_cast<unsigned long>(
                 steps / problem.output.statistics_interval)) +
               " rows of statistics, each a pass over all points. Set "
               "'Output/Statistics interval=" +
               std::to_string(enough) + "' for " + std::to_string(rows) + ".",
             {},
             1 + (cost_of_rows - 1) / problem.output.statistics_interval});
        }
    }



    template <int dim>
    void
    advise_step(const Problem<dim> &problem, std::vector<Advice> &advice)
    {
      const Method &method = problem.method;
      if (method.order == StressUpdateOrder::last)
        return; // its limit tends to zero with the filling of a cell
      if (method.time_step > 0)
        return;
      if (method.courant_number < 0.3)
        advice.push_back(
          {"Courant number",
           "Courant number " + brief(method.courant_number) +
             ": with this stress update 0.4 is stable with a wide margin. "
             "Set 'Method/Courant number=0.4', unless the first-order error in "
             "time is what you study.",
           {"Method/Courant number=0.4"}});
    }
  } // namespace



  template <int dim>
  std::vector<Advice>
  advise(const SceneFile    &scene,
         const Problem<dim> &problem,
         const double        error,
         const double        first_step)
  {
    std::vector<Advice> advice;
    advise_dimension(problem, advice);
    advise_bulk_modulus(scene, problem, advice);
    advise_points(problem, error, advice);
    advise_treatment(problem, error, advice);
    advise_step(problem, advice);
    advise_box(problem, advice);
    advise_output(problem, first_step, advice);
    return advice;
  }



  template std::vector<Advice>
  advise<2>(const SceneFile &, const Problem<2> &, double, double);
  template std::vector<Advice>
  advise<3>(const SceneFile &, const Problem<3> &, double, double);
} // namespace limber
