// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/size_estimate.h>
#include <limber/study/advice.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>

/**
 * @file Advice on the grid: plane problems in three dimensions, empty cells.
 */
namespace limber
{
  namespace
  {
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



    /** Whether a formula is constant along the axis, with a zero component
     * there. */
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



    /** Likewise for initial stress, which must have no shear. */
    template <int dim>
    bool
    is_even_along(const InitialStress<dim> &stress,
                  const unsigned int        axis,
                  const Body<dim>          &body)
    {
      for (unsigned int k = 0; k < stress.components.size(); ++k)
        if (k < 3 ? !is_even_along(stress.components[k], axis, body) :
                    !stress.components[k].empty())
          return false;
      return is_even_along(stress.lateral_ratio, axis, body) &&
             is_even_along(stress.overburden, axis, body);
    }



    /** Whether the problem is plane: bodies reach from side to side along the
     * axis, both sides slip, and nothing varies along it. */
    template <int dim>
    bool
    is_plane_along(const Problem<dim> &problem, const unsigned int axis)
    {
      for (const unsigned int side : {2 * axis, 2 * axis + 1})
        if (problem.sides[side].held != HeldComponents::normal ||
            problem.sides[side].one_sided ||
            !problem.sides[side].velocity.empty())
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
              (body.initial_stress &&
               !is_even_along(*body.initial_stress, axis, body)) ||
              (problem.loads.body_force &&
               !is_even_along(*problem.loads.body_force, axis, body)))
            return false;
        }
      return true;
    }



    /** Upper bound of the distance that any body moves in a direction, m. */
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
      // a fall through the whole box, then the same speed along the floor
      for (unsigned int d = 0; d < dim; ++d)
        fall =
          std::max(fall,
                   std::sqrt(2 * std::abs(problem.loads.gravity[d]) *
                             (problem.grid.upper[d] - problem.grid.lower[d])));
      return (speed + fall) * problem.end_time;
    }



    /** The axis along which the problem is plane; dim where there is none. */
    template <int dim>
    unsigned int
    even_axis(const Problem<dim> &problem)
    {
      unsigned int axis = 0;
      while (axis < dim && !is_plane_along(problem, axis))
        ++axis;
      return axis;
    }



    template <int dim>
    bool
    is_moved_from_outside(const Problem<dim> &problem)
    {
      return problem.loads.body_force || !problem.loads.faces.empty() ||
             std::any_of(problem.sides.begin(),
                         problem.sides.end(),
                         [](const Side<dim> &side) {
                           return !side.velocity.empty();
                         });
    }



    /** The grid without layers of cells farther than @p way from all bodies. */
    template <int dim>
    GridDescription<dim>
    fitted(const Problem<dim> &problem, const double way)
    {
      GridDescription<dim> grid = problem.grid;
      for (unsigned int d = 0; d < dim; ++d)
        {
          const double h     = grid.edge(d);
          double       lower = grid.upper[d], upper = grid.lower[d];
          for (const Body<dim> &body : problem.bodies)
            {
              lower = std::min(lower, body.shape->bounding_box().first[d]);
              upper = std::max(upper, body.shape->bounding_box().second[d]);
            }
          // Two free layers, so that no side is felt; a whole number of cells,
          // so that points keep their places in them.
          const double low   = (lower - way - grid.lower[d]) / h - 2;
          const double high  = (grid.upper[d] - upper - way) / h - 2;
          const auto   whole = [&](const double layers) {
            return static_cast<unsigned int>(
              std::clamp(std::floor(layers), 0., double(grid.cells[d] - 1)));
          };
          const unsigned int below = whole(low), above = whole(high);
          grid.lower[d] += below * h;
          grid.upper[d] -= above * h;
          grid.cells[d] -= below + above;
        }
      return grid;
    }



    template <int dim>
    double
    number_of_cells(const GridDescription<dim> &grid)
    {
      double product = 1;
      for (const unsigned int cells : grid.cells)
        product *= cells;
      return product;
    }
  } // namespace



  namespace
  {
    /** Of an empty cell, with its nodes. */
    template <int dim>
    constexpr double bytes_per_cell = dim == 2 ? 346 : 587;



    /** How many times the lattice can be coarsened by a factor of two: all
     * numbers of cells stay even, and no cell becomes wider than a body. */
    template <int dim>
    unsigned int
    possible_levels(const Problem<dim> &problem)
    {
      constexpr unsigned int most   = 4;
      unsigned int           levels = 0;
      const auto             fits   = [&](const unsigned int n) {
        for (unsigned int d = 0; d < dim; ++d)
          {
            if (problem.grid.cells[d] % (1u << n) != 0)
              return false;
            for (const Body<dim> &body : problem.bodies)
              {
                const auto box = body.shape->bounding_box();
                if (box.second[d] - box.first[d] <
                    problem.grid.edge(d) * (1u << n))
                  return false;
              }
          }
        return true;
      };
      while (levels < most && fits(levels + 1))
        ++levels;
      return levels;
    }



    /** Estimated number of cells with so many levels and all bodies in the
     * finest. */
    template <int dim>
    double
    cells_with_levels(const Problem<dim> &problem, const unsigned int levels)
    {
      // fine cells around the body on both sides, with those not yet coarsened
      constexpr double around = dim == 2 ? 30 : 18;
      double           cells  = number_of_cells(problem.grid);
      for (unsigned int n = 0; n < levels; ++n)
        cells /= 1 << dim;
      for (const Body<dim> &body : problem.bodies)
        {
          const auto box  = body.shape->bounding_box();
          double     fine = 1;
          for (unsigned int d = 0; d < dim; ++d)
            fine *=
              (box.second[d] - box.first[d]) / problem.grid.edge(d) + around;
          cells += fine / (1 - 1. / (1 << dim)); // and the levels between
        }
      return cells;
    }



    /** The scene with other entries, if these are admissible. */
    template <int dim>
    std::optional<Problem<dim>>
    problem_with(const SceneFile                &scene,
                 const std::vector<std::string> &settings)
    {
      std::ostringstream entries;
      scene.parameters().print(entries, PrintStyle::prm);
      try
        {
          return read_problem<dim>(SceneFile(
            ParameterText{entries.str(), FileFormat::prm, "the scene"},
            settings));
        }
      catch (const InputError &)
        {
          return {};
        }
    }



    /** Whether the discrete equations are the same on another grid. */
    template <int dim>
    bool
    solve_alike(const Problem<dim> &one, const Problem<dim> &other)
    {
      if (one.grid.kernel != other.grid.kernel ||
          one.method.order != other.method.order ||
          one.method.integration != other.method.integration)
        return false;
      for (std::size_t b = 0; b < one.bodies.size(); ++b)
        if (one.bodies[b].frame != other.bodies[b].frame ||
            one.bodies[b].treatment != other.bodies[b].treatment)
          return false;
      return true;
    }



    /** Whether a body may reach the box of a refinement, by an upper bound. */
    template <int dim>
    bool
    may_be_reached(const Corners<dim> &part, const Problem<dim> &problem)
    {
      if (is_moved_from_outside(problem))
        return true;
      const double way = reach(problem);
      return std::any_of(problem.bodies.begin(),
                         problem.bodies.end(),
                         [&](const Body<dim> &body) {
                           const auto box = body.shape->bounding_box();
                           for (unsigned int d = 0; d < dim; ++d)
                             if (box.first[d] - way > part.second[d] ||
                                 box.second[d] + way < part.first[d])
                               return false;
                           return true;
                         });
    }
  } // namespace



  template <int dim>
  std::optional<Advice>
  advise_levels(const SceneFile &scene, const Problem<dim> &problem)
  {
    const unsigned int levels = possible_levels(problem);
    if (levels == 0)
      return {};
    const double cells = number_of_cells(problem.grid);
    const double left  = cells_with_levels(problem, levels);
    Advice       advice;
    advice.memory = bytes_per_cell<dim> * (cells - left);
    if (advice.memory < 0.1 * estimate_size(problem, Task::run, 1).bytes())
      return {};

    std::vector<double> coarse;
    for (const unsigned int n : problem.grid.cells)
      coarse.push_back(n >> levels);
    std::vector<std::string> names;
    for (const Body<dim> &body : problem.bodies)
      names.push_back(body.name);
    advice.settings  = {"Grid/Cells=" + entry_of(coarse),
                        "Grid/Levels=" + std::to_string(levels),
                        "Grid/Refine=bodies",
                        "Grid/Refine bodies/Criterion=body",
                        "Grid/Refine bodies/Bodies=" + join(names, ", ")};
    const auto other = problem_with<dim>(scene, advice.settings);
    if (!other || !solve_alike(problem, *other))
      return {};
    advice.what = "Levels";
    advice.text = "Most of the box is empty: with cells of " +
                  brief(problem.grid.edge(0) * (1u << levels)) +
                  " m there and the present ones going along with the bodies, "
                  "some " +
                  brief(left) + " cells do for " + brief(cells);
    advice.changes  = "nothing but the time that the mesh takes to go along";
    advice.is_exact = true;
    return advice;
  }



  template <int dim>
  std::optional<Advice>
  advise_unused_levels(const Problem<dim> &problem)
  {
    const GridDescription<dim> &grid = problem.grid;
    unsigned int                used = 0;
    for (const Refinement<dim> &refinement : grid.refinements)
      if (may_be_reached(refinement.box, problem))
        used = std::max(used, refinement.level);
    if (used == grid.levels)
      return {};
    Advice advice;
    advice.what = "Levels";
    advice.text = "The grid has " + std::to_string(grid.levels) +
                  " levels, but where anything can get within the end time no "
                  "refinement asks for more than " +
                  std::to_string(used);
    advice.changes  = "nothing";
    advice.settings = {"Grid/Levels=" + std::to_string(used)};
    if (used == 0)
      advice.settings.emplace_back("Grid/Refine=");
    advice.factor = 1;
    advice.ground = "no point gets into cells of a finer level; no run needed";
    return advice;
  }



  std::string
  entry_of(const std::vector<double> &numbers)
  {
    std::string text;
    for (const double number : numbers)
      {
        std::array<char, 32> word;
        std::snprintf(word.data(), word.size(), "%.15g", number);
        text += (text.empty() ? "" : ", ") + std::string(word.data());
      }
    return text;
  }



  template <int dim>
  std::optional<Advice>
  advise_dimension(const Problem<dim> &problem)
  {
    const unsigned int axis = even_axis(problem);
    if (dim != 3 || axis == dim)
      return {};
    const unsigned int layers =
      problem.grid.cells[axis] *
      problem.bodies.front().points_per_cell_edge[axis];
    if (layers == 1)
      return {};
    const auto with_one = [&](const auto &per_axis) {
      std::vector<double> numbers(per_axis.begin(), per_axis.end());
      numbers[axis] = 1;
      return entry_of(numbers);
    };
    Advice advice;
    advice.what = "Dimension";
    advice.text = std::string("Nothing changes along ") + "xyz"[axis] +
                  ": the bodies reach from side to side, both are 'slip', and "
                  "no load, velocity or pressure depends on it. One layer of "
                  "points does for " +
                  std::to_string(layers) +
                  "; a scene in two dimensions ('Dimension = 2') saves more";
    advice.changes = "motion along this axis, which begins from round-off";
    advice.settings.push_back("Grid/Cells=" + with_one(problem.grid.cells));
    for (const Body<dim> &body : problem.bodies)
      advice.settings.push_back("Body " + body.name + "/Points per cell edge=" +
                                with_one(body.points_per_cell_edge));
    return advice;
  }



  template <int dim>
  std::optional<Advice>
  advise_box(const Problem<dim> &problem)
  {
    if (is_moved_from_outside(problem))
      return {}; // what that does is not known beforehand
    const double               way  = reach(problem);
    const GridDescription<dim> grid = fitted(problem, way);
    const double kept = number_of_cells(grid) / number_of_cells(problem.grid);
    if (kept > 0.5)
      return {};
    Advice advice;
    advice.what = "Grid";
    advice.text = "Nothing gets farther than " + brief(way) +
                  " m within the end time, so " + brief(100 * kept) +
                  " % of the cells do";
    advice.changes    = "nothing: empty cells take memory alone";
    const auto corner = [](const dealii::Point<dim> &place) {
      std::vector<double> numbers(dim);
      for (unsigned int d = 0; d < dim; ++d)
        numbers[d] = place[d];
      return entry_of(numbers);
    };
    advice.settings = {"Grid/Lower corner=" + corner(grid.lower),
                       "Grid/Upper corner=" + corner(grid.upper),
                       "Grid/Cells=" +
                         entry_of({grid.cells.begin(), grid.cells.end()})};
    advice.memory =
      bytes_per_cell<dim> * (1 - kept) * number_of_cells(problem.grid);
    advice.is_exact = true;
    return advice;
  }



  template std::optional<Advice>
  advise_dimension(const Problem<2> &);
  template std::optional<Advice>
  advise_dimension(const Problem<3> &);
  template std::optional<Advice>
  advise_box(const Problem<2> &);
  template std::optional<Advice>
  advise_box(const Problem<3> &);
  template std::optional<Advice>
  advise_levels(const SceneFile &, const Problem<2> &);
  template std::optional<Advice>
  advise_levels(const SceneFile &, const Problem<3> &);
  template std::optional<Advice>
  advise_unused_levels(const Problem<2> &);
  template std::optional<Advice>
  advise_unused_levels(const Problem<3> &);
} // namespace limber
