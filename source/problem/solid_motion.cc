// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/numbers.h>
#include <deal.II/base/symmetric_tensor.h>

#include <limber/base/text.h>
#include <limber/problem/ball.h>
#include <limber/problem/block.h>
#include <limber/problem/body_at_sides.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/words.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

/** @file Notes on motions of solids that frame and kernel do badly. */
namespace limber
{
  namespace
  {
    // The torsional vibration of a bar n cells thick is too slow by this over
    // n^2 (doc/theory/initial_frame.md).
    constexpr double torsion_of_linear = 1.5, torsion_of_splines = 3.3;

    // Turns in the run from which FLIP loses a share of the spin worth a note.
    constexpr double fewest_turns = 0.1;



    /**
     * Bending with linear functions, where there is no creep, is right along
     * the axes of the cells only: at an angle they contain no field of constant
     * curvature.
     */
    template <int dim>
    void
    warn_of_bending_across_cells(Problem<dim> &problem)
    {
      if (problem.grid.kernel != KernelKind::linear)
        return;
      const bool is_newton = is_solved_by_newton(problem.method.integration);
      for (const auto &body : problem.bodies)
        if (!body.is_liquid && !body.is_plastic && !is_upright(*body.shape) &&
            (body.frame == Frame::initial || is_newton))
          problem.notes.push_back(
            "Body " + in_quotes(body.name) +
            ": where it bends across the cells, linear functions store too "
            "little energy, 20 % two cells deep, 6 % four, 2 % eight. Set " +
            (body.frame == Frame::current ||
                 !problem.grid.against_splines.empty() ?
               "more" :
               "'Method/Kernel = quadratic', or more") +
            " 'Grid/Cells', if it is thin.");
    }



    /** Call work(place) for the places inside a body of a lattice of n^dim in
     * its bounding box. */
    template <int dim, class Work>
    void
    for_each_sample(const Body<dim>   &body,
                    const unsigned int n,
                    const Work        &work)
    {
      const Corners<dim> box = body.shape->bounding_box();
      for (unsigned int i = 0; i < dealii::Utilities::pow(n, dim); ++i)
        {
          dealii::Point<dim> place;
          for (unsigned int d = 0, rest = i; d < dim; ++d, rest /= n)
            place[d] = box.first[d] +
                       (rest % n + 0.5) / n * (box.second[d] - box.first[d]);
          if (body.shape->contains(place))
            work(place);
        }
    }



    /**
     * Cells that the mean initial velocity of a body carries it past until the
     * end, if nothing stops it. Sampled on a lattice.
     */
    template <int dim>
    double
    cells_on_its_way(const Body<dim> &body, const Problem<dim> &problem)
    {
      if (body.initial_velocity.empty())
        return 0;
      dealii::Tensor<1, dim> sum;
      double                 count = 0;
      for_each_sample(body, 8, [&](const dealii::Point<dim> &place) {
        sum += body.initial_velocity.vector(place, 0);
        ++count;
      });
      double result = 0;
      for (unsigned int d = 0; d < dim && count > 0; ++d)
        result = std::max(result,
                          std::abs(sum[d]) / count * problem.end_time /
                            problem.grid.edge(d));
      return result;
    }



    /**
     * Linear functions that the scene asks for, and a solid under load whose
     * points will cross cells: it creeps with any transfer. ('auto' says itself
     * why it takes linear functions.)
     */
    template <int dim>
    void
    warn_of_creep(const Section &root, Problem<dim> &problem)
    {
      const std::string word = root.subsection("Method").text("Kernel");
      if (word == "auto" || problem.grid.kernel != KernelKind::linear)
        return;
      const std::string kernel =
        problem.grid.against_splines.empty() ?
          "'Method/Kernel = quadratic', or " :
        problem.method.integration == TimeIntegration::explicit_steps &&
            !is_affine(problem.method.transfer) ?
          "'Method/Kernel = cpdi', or " :
          "";
      const Section loads      = root.subsection("Loads");
      const auto    is_load_of = [&](const Body<dim>   &body,
                                  const std::string &load) {
        return loads.subsection("Face load " + load).text("Body") == body.name;
      };
      for (const Body<dim> &body : problem.bodies)
        {
          const bool keeps_strain =
            !body.is_liquid && (!body.is_plastic || body.keeps_surface);
          const auto   names     = loads.list("Face loads");
          const bool   is_loaded = std::any_of(names.begin(),
                                             names.end(),
                                             [&](const std::string &load) {
                                               return is_load_of(body, load);
                                             });
          const double cells     = cells_on_its_way(body, problem);
          if (!keeps_strain || body.frame != Frame::current || !is_loaded ||
              !(cells > 1.5))
            continue;
          problem.notes.push_back(
            "Warning: body " + in_quotes(body.name) +
            " is under load while it moves through about " +
            brief(std::round(cells)) +
            " cells: with linear functions it creeps at each. Set " + kernel +
            "'Body " + body.name +
            "/Frame = initial', if it touches no other body.");
        }
    }



    /**
     * Mean angular velocity of the initial velocity of a body, about, 1/s.
     * Sampled on a lattice.
     */
    template <int dim>
    double
    spin(const Body<dim> &body)
    {
      if (body.initial_velocity.empty())
        return 0;
      std::vector<dealii::Point<dim>>     places;
      std::vector<dealii::Tensor<1, dim>> velocities;
      dealii::Tensor<1, dim>              place_sum, velocity_sum;
      for_each_sample(
        body, dim == 2 ? 24 : 10, [&](const dealii::Point<dim> &place) {
          places.push_back(place);
          velocities.push_back(body.initial_velocity.vector(place, 0));
          place_sum += place;
          velocity_sum += velocities.back();
        });
      std::array<double, 3> momentum{};
      double                squares = 0; // of the distance from the centre
      for (std::size_t i = 0; i < places.size(); ++i)
        {
          const dealii::Tensor<1, dim> x = places[i] -
                                           place_sum / double(places.size()),
                                       v = velocities[i] -
                                           velocity_sum / double(places.size());
          squares += x * x;
          for (unsigned int a = 0; a < dim; ++a)
            for (unsigned int b = a + 1; b < dim; ++b)
              momentum[a + b - 1] += x[a] * v[b] - x[b] * v[a];
        }
      double norm = 0;
      for (const double component : momentum)
        norm += component * component;
      // in space with the moment of inertia of a ball
      return squares > 0 ? std::sqrt(norm) / (2. / dim * squares) : 0;
    }



    /**
     * Angle, degrees per turn, by which a body that spins freely falls behind
     * with FLIP and linear functions in the initial frame: nodes carry its mass
     * further out than points, by h^2 / 6 along each axis, and its moment of
     * inertia is larger by that share. As for a ball in its bounding box;
     * measured 28 degrees where this gives 24, with four cells along the
     * longest radius of an ellipsoid.
     */
    template <int dim>
    double
    lag_per_turn(const Body<dim> &body, const GridDescription<dim> &grid)
    {
      const Corners<dim> box       = body.shape->bounding_box();
      double             variances = 0, of_nodes = 0;
      for (unsigned int d = 0; d < dim; ++d)
        {
          const double half = 0.5 * (box.second[d] - box.first[d]);
          variances += half * half / (dim + 2) / dim;
          of_nodes += grid.edge(d) * grid.edge(d) / 6 / dim;
        }
      return 360 * of_nodes / variances;
    }



    /**
     * What helps in the initial frame, as far as the placement of points lets
     * it.
     */
    template <int dim>
    std::string
    remedy_for_lag(const Problem<dim> &problem)
    {
      return std::all_of(problem.bodies.begin(),
                         problem.bodies.end(),
                         [&](const Body<dim> &body) {
                           return bounds_gradients(body, problem.grid);
                         }) ?
               "'Method/Transfer = aflip' keeps up, and so do implicit steps; "
               "or set more 'Grid/Cells'." :
               "Implicit steps keep up; or set more 'Grid/Cells'.";
    }



    /**
     * With FLIP rows of points that rotate through the cells take the mean of
     * the velocity next to them, and the spin that is lost becomes vibration
     * (doc/theory/transfers.md). In the initial frame a body turns too slowly.
     */
    template <int dim>
    void
    warn_of_rotation(Problem<dim> &problem)
    {
      constexpr double noted_lag = 5; // degrees per turn
      // implicit steps have the consistent mass, quasi-static ones none
      if (problem.method.transfer != Transfer::flip ||
          is_solved_by_newton(problem.method.integration))
        return;
      for (const Body<dim> &body : problem.bodies)
        {
          const double turns = initial_rotation(body, problem.end_time) /
                               (2 * dealii::numbers::PI);
          if (body.is_liquid || !(turns > fewest_turns))
            continue;
          const std::string what = "Body " + in_quotes(body.name) + " makes " +
                                   brief(turns) + " turns, if nothing stops it";
          if (body.frame == Frame::current)
            {
              if (is_spline(problem.grid.kernel))
                problem.notes.push_back(
                  what + ": with the transfer 'flip' and few cells over its "
                         "width it falls behind, and its spin becomes noise. "
                         "'Method/Transfer = aflip' keeps it.");
              continue;
            }
          const double lag = lag_per_turn(body, problem.grid);
          if (problem.grid.kernel == KernelKind::linear && lag > noted_lag &&
              !is_held(body, problem))
            problem.notes.push_back(
              what + ", and falls behind by about " + brief(std::round(lag)) +
              " degrees in each, as nodes carry the mass further out than "
              "points. " +
              remedy_for_lag(problem));
        }
    }



    /**
     * Variances of the places inside a shape along its principal axes, the
     * largest first, m^2: L^2 / 12 of an edge L. From places on a lattice.
     */
    std::array<double, 3>
    principal_variances(const Shape<3> &shape)
    {
      constexpr unsigned int        n   = 24;
      const Corners<3>              box = shape.bounding_box();
      dealii::Tensor<1, 3>          sum;
      dealii::SymmetricTensor<2, 3> squares;
      double                        count = 0;
      for (unsigned int i = 0; i < n * n * n; ++i)
        {
          dealii::Point<3> place;
          for (unsigned int d = 0, rest = i; d < 3; ++d, rest /= n)
            place[d] = box.first[d] +
                       (rest % n + 0.5) / n * (box.second[d] - box.first[d]);
          if (!shape.contains(place))
            continue;
          const dealii::Tensor<1, 3> x = place - box.first;
          sum += x;
          squares += symmetrize(outer_product(x, x));
          ++count;
        }
      if (count == 0)
        return {};
      return eigenvalues(squares / count -
                         symmetrize(outer_product(sum, sum)) / (count * count));
    }



    /**
     * Nodes carry the mass of points h^2/6 further out (mean square, with
     * linear functions; h^2/4 with splines), which increases the moment of
     * inertia: in torsion a bar n cells thick is slower by about twice that
     * share of its polar moment (doc/theory/initial_frame.md).
     */
    template <int dim>
    void
    warn_of_torsion(Problem<dim> &problem)
    {
      if constexpr (dim == 3)
        {
          const bool linear = problem.grid.kernel == KernelKind::linear;
          if (problem.method.integration == TimeIntegration::quasi_static ||
              !(linear || problem.grid.kernel == KernelKind::quadratic))
            return;
          double edge = 0; // mean square
          for (unsigned int d = 0; d < dim; ++d)
            edge += problem.grid.edge(d) * problem.grid.edge(d) / dim;
          edge = std::sqrt(edge) / (1 << problem.grid.levels);
          for (const auto &body : problem.bodies)
            {
              if (body.is_liquid || !is_held(body, problem))
                continue;
              const auto   spread = principal_variances(*body.shape);
              const double across = spread[1] + spread[2];
              // of a square section; bars alone, twice as long as thick
              const double n = std::sqrt(6 * across) / edge;
              const double slowness =
                (linear ? torsion_of_linear : torsion_of_splines) / (n * n);
              if (spread[0] > 2 * across && slowness > 0.05)
                problem.notes.push_back(
                  "Body " + in_quotes(body.name) + ": about " +
                  brief(std::round(10 * n) / 10) +
                  " cells across, it vibrates in torsion some " +
                  std::to_string(std::lround(100 * slowness)) +
                  " % too slowly, as nodes carry the mass further out than "
                  "points. If it twists, set more 'Grid/Cells'; the error "
                  "falls with their square.");
            }
        }
    }
  } // namespace



  template <int dim>
  double
  initial_rotation(const Body<dim> &body, const double end_time)
  {
    return spin(body) * end_time;
  }



  template <int dim>
  bool
  is_compact(const Shape<dim> &shape)
  {
    // longest over shortest edge, beyond which it may fold in an impact
    constexpr double slender = 4;
    const auto      *block   = dynamic_cast<const BlockShape<dim> *>(&shape);
    if (block == nullptr)
      return dynamic_cast<const BallShape<dim> *>(&shape) != nullptr;
    using Info     = dealii::GeometryInfo<dim>;
    double longest = 0, shortest = std::numeric_limits<double>::max();
    for (unsigned int line = 0; line < Info::lines_per_cell; ++line)
      {
        const double edge =
          block->vertices[Info::line_to_cell_vertices(line, 0)].distance(
            block->vertices[Info::line_to_cell_vertices(line, 1)]);
        longest  = std::max(longest, edge);
        shortest = std::min(shortest, edge);
      }
    return longest <= slender * shortest;
  }



  template <int dim>
  bool
  bounds_gradients(const Body<dim> &body, const GridDescription<dim> &grid)
  {
    return grid.kernel != KernelKind::linear ||
           !(body.frame == Frame::current ||
             body.placement == Placement::fitted ||
             body.placement == Placement::cut ||
             body.placement == Placement::gauss);
  }



  template <int dim>
  void
  warn_of_solid_motion(const Section &root, Problem<dim> &problem)
  {
    warn_of_creep(root, problem);
    warn_of_bending_across_cells(problem);
    warn_of_torsion(problem);
    warn_of_rotation(problem);
  }



  template double
  initial_rotation(const Body<2> &, double);
  template double
  initial_rotation(const Body<3> &, double);
  template bool
  is_compact(const Shape<2> &);
  template bool
  is_compact(const Shape<3> &);
  template bool
  bounds_gradients(const Body<2> &, const GridDescription<2> &);
  template bool
  bounds_gradients(const Body<3> &, const GridDescription<3> &);
  template void
  warn_of_solid_motion(const Section &, Problem<2> &);
  template void
  warn_of_solid_motion(const Section &, Problem<3> &);
} // namespace limber
