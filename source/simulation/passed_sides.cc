// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/read_parts.h>
#include <limber/simulation/passed_sides.h>
#include <limber/transfer/point_sums.h>

#include <algorithm>
#include <limits>

namespace limber
{
  namespace
  {
    // Share of an edge by which any point may pass a side: by round-off, or in
    // the vibrations of a body in contact with it.
    constexpr double chance_overstep = 1e-3;
    // The same for points that were within 'neighbourhood' edges of the side at
    // the start: a body that is bent or pressed bulges next to where it is
    // held.
    constexpr double widest_bulge = 0.5, neighbourhood = 2;
    // The same for bodies with contact at their surface.
    constexpr double deepest_dent = 0.5;



    /**
     * Signed distance of a body's points beyond a side, m, outward positive.
     */
    struct Overstep
    {
      double neighbours = -std::numeric_limits<double>::max();
      double others     = -std::numeric_limits<double>::max();
    };

    /** Whether any point is beyond a side that holds something, by more than
     * chance: as good as never. Collective. */
    template <int dim>
    bool
    any_beyond_held_side(const State<dim> &state, const PointView<dim> &points)
    {
      const GridDescription<dim> &box    = state.problem.grid;
      const PositionBounds<dim>   bounds = bounds_of_positions(points);
      bool                        found  = false;
      for (int side = 0; side < 2 * dim; ++side)
        {
          const int    d      = side / 2;
          const double beyond = side % 2 != 0 ? bounds.upper[d] - box.upper[d] :
                                                box.lower[d] - bounds.lower[d];
          found |= state.problem.sides[side].held != HeldComponents::none &&
                   beyond > chance_overstep * box.edge(d);
        }
      return dealii::Utilities::MPI::max<unsigned int>(
               found, state.grid.communicator) > 0;
    }



    /** Largest over all points on all ranks, by sides; neighbours are those
     * that were next to the side at the start. */
    template <int dim>
    std::array<Overstep, 2 * dim>
    farthest(const State<dim> &state, const PointView<dim> &points)
    {
      const GridDescription<dim>   &box = state.problem.grid;
      std::array<Overstep, 2 * dim> result;
      for (int side = 0; side < 2 * dim; ++side)
        {
          const int    d       = side / 2;
          const bool   upper   = side % 2 != 0;
          const double near    = neighbourhood * box.edge(d);
          const auto   outward = [&](const double x) {
            return upper ? x - box.upper[d] : box.lower[d] - x;
          };
          for (std::size_t p = 0; p < points.size; ++p)
            {
              double &most = outward(points.place[d][p]) > -near ?
                               result[side].neighbours :
                               result[side].others;
              most         = std::max(most, outward(points.position[d][p]));
            }
        }
      MPI_Allreduce(MPI_IN_PLACE,
                    result.data(),
                    2 * result.size(),
                    MPI_DOUBLE,
                    MPI_MAX,
                    state.grid.communicator);
      return result;
    }
  } // namespace



  template <int dim>
  void
  check_passed_sides(const State<dim> &state, Console &console)
  {
    for (const auto &body : state.bodies)
      {
        if (body->description.frame != Frame::initial ||
            !any_beyond_held_side(state, body->points.view()))
          continue;
        const auto beyond = farthest(state, body->points.view());
        for (unsigned int side = 0; side < 2 * dim; ++side)
          {
            const double     edge   = state.problem.grid.edge(side / 2);
            const double     chance = chance_overstep * edge;
            const Overstep  &by     = beyond[side];
            const double     most   = std::max(by.neighbours, by.others);
            const Side<dim> &wall   = state.problem.sides[side];
            // A moving side takes along what it holds, so all else is compared
            // with that.
            const bool moves =
              !wall.velocity.empty() && !wall.velocity.is_zero();
            const double taken_along = moves ? std::max(0., by.neighbours) : 0;
            if (wall.held == HeldComponents::none ||
                most <= taken_along + chance)
              continue;
            const std::string name = side_names(dim)[side];
            const std::string who = "Body " + in_quotes(body->description.name);
            if (wall.meets_surfaces &&
                state.problem.meets_sides(body->description.nodal_field))
              {
                if (most > deepest_dent * edge)
                  throw ComputationError(
                    who + " has been pressed through the side '" + name +
                      "' by " + brief(most) + " m at time " +
                      brief(state.time) +
                      " s. Usually the steps are too long for what hits it. "
                      "Lower 'Method/Courant number', or 'Time step' if it is "
                      "set, or take smaller cells.",
                    FailureKind::passed_side);
                continue;
              }
            const std::string how =
              " the side '" + name + "' by " + brief(most) + " m at time " +
              brief(state.time) +
              " s: in its initial frame it feels a side only where it touched "
              "it at the start";
            const std::string what =
              " Set 'Body " + body->description.name + "/Frame = current'";
            if (by.others > chance || by.neighbours > widest_bulge * edge)
              throw ComputationError(who + " has passed" + how + "." + what +
                                       ", or 'Boundaries/" + name +
                                       " = free' if it may leave there.",
                                     FailureKind::passed_side);
            console.warn_once("bulge at side '" + name + "'",
                              who + " bulges beyond" + how +
                                ", as finite elements of the scene would." +
                                what + " if the side should hold that back.");
          }
      }
  }



  template void
  check_passed_sides(const State<2> &, Console &);
  template void
  check_passed_sides(const State<3> &, Console &);
} // namespace limber
