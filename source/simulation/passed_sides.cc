// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/read_parts.h>
#include <limber/simulation/passed_sides.h>

#include <algorithm>
#include <limits>
#include <sstream>

namespace limber
{
  namespace
  {
    // A side may be overstepped by that share of an edge: by round-off, or by
    // a body that vibrates in touch with it.
    constexpr double chance_overstep = 1e-3;



    /**
     * How far the points of a body are from each side, outward, over all
     * ranks, m.
     */
    template <int dim>
    std::array<double, 2 * dim>
    farthest(const State<dim> &state, const MaterialBody<dim> &body)
    {
      const GridDescription<dim> &box    = state.problem.grid;
      const PointView<dim>        points = body.points.view();
      std::array<double, 2 * dim> result;
      result.fill(-std::numeric_limits<double>::max());
      for (int d = 0; d < dim; ++d)
        for (std::size_t p = 0; p < points.size; ++p)
          {
            const double x    = points.position[d][p];
            result[2 * d]     = std::max(result[2 * d], box.lower[d] - x);
            result[2 * d + 1] = std::max(result[2 * d + 1], x - box.upper[d]);
          }
      MPI_Allreduce(MPI_IN_PLACE,
                    result.data(),
                    result.size(),
                    MPI_DOUBLE,
                    MPI_MAX,
                    state.grid.communicator);
      return result;
    }
  } // namespace



  template <int dim>
  void
  check_passed_sides(const State<dim> &state)
  {
    for (const auto &body : state.bodies)
      {
        if (body->description.frame != Frame::initial)
          continue;
        const auto beyond = farthest(state, *body);
        for (unsigned int side = 0; side < 2 * dim; ++side)
          {
            if (state.problem.sides[side].held == HeldComponents::none ||
                beyond[side] <=
                  chance_overstep * state.problem.grid.edge(side / 2))
              continue;
            const std::string  name = side_names(dim)[side];
            std::ostringstream text;
            text << "Body " << in_quotes(body->description.name)
                 << " has passed the side '" << name << "' by " << beyond[side]
                 << " m at time " << state.time
                 << " s: in its initial frame it feels a side only where it "
                    "touched it at the start. Set 'Body "
                 << body->description.name
                 << "/Frame = current', or 'Boundaries/" << name
                 << " = free' if it may leave there.";
            throw ComputationError(text.str(), FailureKind::passed_side);
          }
      }
  }



  template void
  check_passed_sides(const State<2> &);
  template void
  check_passed_sides(const State<3> &);
} // namespace limber
