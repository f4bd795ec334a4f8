// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/materials/law_list.h>
#include <limber/problem/body_at_sides.h>
#include <limber/problem/read_parts.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace limber
{
  namespace
  {
    // Share of an edge by which a side may move inward. Its condition acts on
    // nodes that stay in place: beyond that these lose the points, and the side
    // lets go what it holds (doc/theory/boundaries_and_loads.md).
    constexpr double reach_of_side = 0.5;

    // The same where liquids fill the box again behind a side that does not
    // move in fact: less is sound, not a piston.
    constexpr double noticed_by_liquid = 0.05;

    // The last row of cells at such a side is filled less and less, and gives
    // way as if it were softer: with 0.3 of 8 cells the stress of a block is
    // 9 % too small, with 0.3 of 16 5 %.
    constexpr double noticed_by_solid = 0.1;



    /**
     * Largest inward displacement of a side until @p end (s), m. Integrated in
     * time steps in which it moves by a small part of its limit, so that an
     * oscillating side does not seem to move away; of a very long run only the
     * beginning.
     */
    template <int dim>
    double
    farthest_inward(const unsigned int          side,
                    const Formula<dim>         &velocity,
                    const GridDescription<dim> &grid,
                    const double                end)
    {
      constexpr double   coarse = 4000, most = 2e5; // parts
      const unsigned int normal = side / 2;
      const auto inward = [&](const dealii::Point<dim> &place, const double t) {
        return velocity.is_finite(place, t) ?
                 (side % 2 == 0 ? 1 : -1) * velocity.value(place, t, normal) :
                 0.;
      };
      double result = 0;
      for (const dealii::Point<dim> &place : places_in_side(side, grid))
        {
          double fastest = 0;
          for (double n = 0; n < coarse; ++n)
            fastest =
              std::max(fastest,
                       std::abs(inward(place, (n + 0.5) / coarse * end)));
          const double dt =
            std::min(end / coarse,
                     0.1 * reach_of_side * grid.finest_edge(normal) /
                       std::max(fastest, 1e-300));
          double way = 0;
          for (double n = 0; n < most && (n + 0.5) * dt < end; ++n)
            {
              way += dt * inward(place, (n + 0.5) * dt);
              result = std::max(result, way);
            }
        }
      return result;
    }
  } // namespace



  template <int dim>
  bool
  has_face_in(const unsigned int          side,
              const Body<dim>            &body,
              const GridDescription<dim> &grid)
  {
    const unsigned int normal    = side / 2;
    const Corners<dim> box       = body.shape->bounding_box();
    const double       tolerance = 1e-6 * grid.edge(normal);

    dealii::Point<dim> place;
    place[normal] = side % 2 == 0 ? grid.lower[normal] + tolerance :
                                    grid.upper[normal] - tolerance;
    if (place[normal] < box.first[normal] || place[normal] > box.second[normal])
      return false;
    // Two places in a cell at least: the box may be far larger than the body
    std::array<std::size_t, dim> samples;
    std::size_t                  count = 1;
    for (unsigned int d = 0; d < dim; ++d)
      {
        samples[d] = d == normal ?
                       1 :
                       std::clamp(std::ceil(2 * (box.second[d] - box.first[d]) /
                                            grid.finest_edge(d)),
                                  16.,
                                  1024.);
        count *= samples[d];
      }
    for (std::size_t i = 0; i < count; ++i)
      {
        std::size_t rest = i;
        for (unsigned int d = 0; d < dim; ++d)
          {
            if (d != normal)
              place[d] = box.first[d] + (rest % samples[d] + 0.5) / samples[d] *
                                          (box.second[d] - box.first[d]);
            rest /= samples[d];
          }
        if (body.shape->contains(place))
          return true;
      }
    return false;
  }



  template <int dim>
  bool
  stays_clear(const bool          face_loads,
              const Body<dim>    &body,
              const Problem<dim> &problem)
  {
    if (problem.loads.body_force || problem.loads.gravity.norm() > 0 ||
        face_loads)
      return false;
    constexpr unsigned int          n   = dim == 2 ? 64 : 20;
    const Corners<dim>              box = body.shape->bounding_box();
    std::vector<dealii::Point<dim>> inside;
    for (unsigned int i = 0; i < dealii::Utilities::pow(n, dim); ++i)
      {
        dealii::Point<dim> place;
        for (unsigned int d = 0, rest = i; d < dim; ++d, rest /= n)
          place[d] = box.first[d] +
                     (rest % n + 0.5) / n * (box.second[d] - box.first[d]);
        if (body.shape->contains(place))
          inside.push_back(place);
      }
    if (inside.empty())
      return false;
    dealii::Point<dim>     centre;
    dealii::Tensor<1, dim> mean; // velocity, m/s
    double                 fastest = 0, radius = 0;
    for (const auto &place : inside)
      {
        centre += place / double(inside.size());
        if (body.initial_velocity.empty())
          continue;
        const auto velocity = body.initial_velocity.vector(place, 0);
        mean += velocity / double(inside.size());
        fastest = std::max(fastest, velocity.norm());
      }
    if (mean.norm() > 1e-9 * fastest)
      return false;
    for (const auto &place : inside)
      radius = std::max(radius, place.distance(centre));
    radius += 0.5 / n * box.first.distance(box.second);
    for (unsigned int side = 0; side < 2 * dim; ++side)
      {
        const unsigned int d = side / 2;
        const double room = side % 2 == 0 ? centre[d] - problem.grid.lower[d] :
                                            problem.grid.upper[d] - centre[d];
        if (problem.sides[side].held != HeldComponents::none &&
            room < 1.2 * radius + problem.grid.edge(d))
          return false;
      }
    return true;
  }



  template <int dim>
  bool
  is_held(const Body<dim> &body, const Problem<dim> &problem)
  {
    std::array<bool, dim> holds{};
    for (unsigned int side = 0; side < 2 * dim; ++side)
      {
        const Side<dim> &wall = problem.sides[side];
        if (wall.held == HeldComponents::none || wall.one_sided ||
            !has_face_in(side, body, problem.grid))
          continue;
        if (wall.held == HeldComponents::all)
          return true;
        holds[side / 2] = true;
      }
    return is_solved_by_newton(problem.method.integration) &&
           std::all_of(holds.begin(), holds.end(), [](const bool of_direction) {
             return of_direction;
           });
  }



  template <int dim>
  bool
  are_one_piece(const Problem<dim> &problem)
  {
    constexpr unsigned int per_edge  = 4; // places in a cell
    using Node                       = std::array<int, dim>;
    const GridDescription<dim> &grid = problem.grid;
    std::vector<std::set<Node>> pieces; // disjoint sets of nodes
    for (const Body<dim> &body : problem.bodies)
      {
        const Corners<dim>                   box = body.shape->bounding_box();
        std::array<int, dim>                 first;
        std::array<std::vector<double>, dim> places;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double part = grid.edge(d) / per_edge;
            first[d]       = std::floor((box.first[d] - grid.lower[d]) / part);
            const int last = std::ceil((box.second[d] - grid.lower[d]) / part);
            for (int k = first[d]; k < last; ++k)
              places[d].push_back(grid.lower[d] + (k + 0.5) * part);
          }
        std::set<Node>     nodes;
        std::size_t        count = 1;
        dealii::Point<dim> place;
        for (const auto &of_direction : places)
          count *= of_direction.size();
        for (std::size_t i = 0; i < count; ++i)
          {
            Node cell;
            for (std::size_t d = 0, rest = i; d < dim; ++d)
              {
                const int k = rest % places[d].size();
                rest /= places[d].size();
                place[d] = places[d][k];
                cell[d]  = std::floor((first[d] + k + 0.5) / per_edge);
              }
            if (!body.shape->contains(place))
              continue;
            for (unsigned int corner = 0; corner < 1u << dim; ++corner)
              {
                Node node = cell;
                for (unsigned int d = 0; d < dim; ++d)
                  node[d] += corner >> d & 1;
                nodes.insert(node);
              }
          }
        // merge with all pieces that share a node
        std::vector<std::set<Node>> others;
        for (auto &piece : pieces)
          if (std::any_of(piece.begin(), piece.end(), [&](const Node &node) {
                return nodes.count(node) > 0;
              }))
            nodes.merge(piece);
          else
            others.push_back(std::move(piece));
        others.push_back(std::move(nodes));
        pieces = std::move(others);
      }
    return pieces.size() <= 1;
  }



  namespace
  {
    /** The softest solid of a scene, if it has a face in this side in the
     * current frame; null if not: what a stiff one does there hardly matters.
     */
    template <int dim>
    const Body<dim> *
    softest_at(const unsigned int side, const Problem<dim> &problem)
    {
      const Body<dim> *result   = nullptr;
      double           softness = 0;
      for (const Body<dim> &body : problem.bodies)
        if (!body.is_liquid)
          {
            const double of_body = 1 / moduli_of(body.law, body.material).shear;
            const bool   touches = body.frame == Frame::current &&
                                 has_face_in(side, body, problem.grid);
            if (of_body > softness)
              result = touches ? &body : nullptr;
            else if (of_body == softness && touches)
              result = &body;
            softness = std::max(softness, of_body);
          }
      return result;
    }
  } // namespace



  template <int dim>
  std::vector<std::string>
  check_moving_sides(const Problem<dim> &problem)
  {
    const auto in_current_frame = [](const Body<dim> &candidate) {
      return candidate.frame == Frame::current;
    };
    const auto is_shifted = [](const Body<dim> &candidate) {
      return candidate.particle_shifting > 0 || candidate.density_control > 0;
    };
    const auto &bodies = problem.bodies;
    const auto  body =
      std::find_if(bodies.begin(), bodies.end(), in_current_frame);
    const auto liquid = std::find_if(bodies.begin(), bodies.end(), is_shifted);
    std::vector<std::string> warnings;
    if (body == bodies.end())
      return warnings;
    for (unsigned int side = 0; side < 2 * dim; ++side)
      {
        const Formula<dim> &velocity = problem.sides[side].velocity;
        if (velocity.empty() || velocity.is_zero())
          continue;
        const double way =
          farthest_inward(side, velocity, problem.grid, problem.end_time);
        const double      edge  = problem.grid.finest_edge(side / 2);
        const std::string moves = "The side '" + side_names(dim)[side] +
                                  "' moves inward by " + brief(way) + " m, " +
                                  brief(way / edge) + " cells";
        if (way > reach_of_side * edge)
          throw InputError(
            moves + ": after half a cell it lets go of body " +
            in_quotes(body->name) +
            (body->is_liquid ?
               ". Use an obstacle 'half-space' that moves ('Displacement')." :
               (problem.method.integration == TimeIntegration::explicit_steps ?
                  ". Use an obstacle 'half-space' that moves ('Displacement') "
                  "with 'Law = stick', or set 'Body " :
                  ". Set 'Body ") +
                 body->name + "/Frame = initial'."));
        if (const auto *const pressed = softest_at(side, problem);
            pressed != nullptr && way > noticed_by_solid * edge)
          warnings.push_back(
            moves + ". Its cells hold less and less of " +
            in_quotes(pressed->name) +
            " then, which gives way there: stresses are too small by some per "
            "cent, the more, the fewer cells it has. Use 'Body " +
            pressed->name +
            "/Frame = initial' if it touches no other body, more 'Grid/Cells'" +
            (problem.method.integration == TimeIntegration::explicit_steps ?
               ", or an obstacle 'half-space' that moves ('Displacement')." :
               "."));
        if (liquid != bodies.end() && way > noticed_by_liquid * edge)
          warnings.push_back(moves + ", which displaces nothing of liquid " +
                             in_quotes(liquid->name) +
                             ": its points spread evenly in the whole box. An "
                             "obstacle 'half-space' that moves "
                             "('Displacement') pushes it.");
      }
    return warnings;
  }



  template bool
  has_face_in(unsigned int, const Body<2> &, const GridDescription<2> &);
  template bool
  stays_clear(bool, const Body<2> &, const Problem<2> &);
  template bool
  is_held(const Body<2> &, const Problem<2> &);
  template bool
  are_one_piece(const Problem<2> &);
  template std::vector<std::string>
  check_moving_sides(const Problem<2> &);
  template bool
  has_face_in(unsigned int, const Body<3> &, const GridDescription<3> &);
  template bool
  stays_clear(bool, const Body<3> &, const Problem<3> &);
  template bool
  is_held(const Body<3> &, const Problem<3> &);
  template bool
  are_one_piece(const Problem<3> &);
  template std::vector<std::string>
  check_moving_sides(const Problem<3> &);
} // namespace limber
