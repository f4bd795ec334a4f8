// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/ball.h>
#include <limber/problem/body_at_sides.h>
#include <limber/problem/cylinder.h>
#include <limber/problem/formula_shape.h>
#include <limber/problem/mesh_shape.h>
#include <limber/problem/point_list.h>
#include <limber/problem/polygon.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/stl.h>
#include <limber/problem/union_of_shapes.h>
#include <limber/problem/words.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  template <int dim>
  bool
  is_upright(const Shape<dim> &shape)
  {
    const auto *block = dynamic_cast<const BlockShape<dim> *>(&shape);
    if (block == nullptr)
      return false;
    const Corners<dim> box = block->bounding_box();
    for (unsigned int d = 0; d < dim; ++d)
      for (unsigned int i = 0; i < block->vertices.size(); ++i)
        if (std::abs(block->vertices[i][d] -
                     (i >> d & 1 ? box.second[d] : box.first[d])) >
            1e-6 * (box.second[d] - box.first[d]))
          return false;
    return true;
  }



  namespace
  {
    template <int dim>
    void
    read_points(const Section      &section,
                const Problem<dim> &problem,
                Body<dim>          &body)
    {
      const std::string   entry = "Points per cell edge";
      std::vector<double> points;
      if (section.text(entry) != "auto")
        points = section.numbers(entry);
      else
        // A liquid that flows stretches its lattice of points; at twice the
        // length there are empty cells between two columns of points, and the
        // pressure is noise. With two points solids with splines creep some ten
        // times as much with every cell crossing; and a cantilever sags by 14 %
        // too much in fifty quasi-static steps, with three by 2 %, which costs
        // a third of the time (doc/theory/implicit_steps.md).
        points = {body.is_liquid ||
                      (body.frame == Frame::current &&
                       (is_spline(problem.grid.kernel) ||
                        is_solved_by_newton(problem.method.integration))) ?
                    3. :
                    2.};
      for (unsigned int d = 0; d < dim; ++d)
        body.points_per_cell_edge[d] =
          static_cast<unsigned int>(points[points.size() == 1 ? 0 : d]);
      body.placement = read_word(section, "Placement", placement_words());
    }



    /** A point list prescribes places and sizes of the points. */
    template <int dim>
    void
    check_point_list(const Section              &section,
                     const GridDescription<dim> &grid,
                     const Body<dim>            &body)
    {
      if (dynamic_cast<const PointListShape<dim> *>(body.shape.get()) ==
          nullptr)
        return;
      if (body.placement != Placement::regular)
        throw InputError("The placement " +
                         in_quotes(section.text("Placement")) + " in " +
                         section.where("Placement") +
                         " has no effect on a point list, which says where "
                         "each point is. Usually the shape was changed. Set "
                         "'Placement = regular'.");
      if (grid.levels > 0)
        throw InputError("The point list in " + section.where("Shape") +
                         " does not go with 'Grid/Levels', which need to know "
                         "what cells points were made for. Set 'Levels = 0', "
                         "or fill a shape with points.");
    }



    /** Spacing of the points of 'regular', m, in cells of this edge length. */
    template <int dim>
    double
    spacing_along(const unsigned int direction,
                  const double       edge,
                  const Body<dim>   &body)
    {
      return edge / body.points_per_cell_edge[direction];
    }



    /**
     * Number of points of 'fitted' in a direction of the block: its longest
     * edge there in spacings of the smallest cells, rounded up.
     */
    template <int dim>
    unsigned int
    parts_of_edges(const BlockShape<dim>      &block,
                   const unsigned int          direction,
                   const Body<dim>            &body,
                   const GridDescription<dim> &grid)
    {
      double longest = 0;
      for (unsigned int i = 0; i < block.vertices.size(); ++i)
        {
          const auto edge =
            block.vertices[i | 1 << direction] - block.vertices[i];
          double square = 0;
          for (unsigned int d = 0; d < dim; ++d)
            {
              const double spacing =
                spacing_along(d, grid.finest_edge(d), body);
              square += edge[d] / spacing * edge[d] / spacing;
            }
          longest = std::max(longest, std::sqrt(square));
        }
      // Decimal fractions may differ by round-off.
      return std::lround(std::clamp(std::ceil(longest - 1e-6), 1., 1e9));
    }



    /**
     * Whether faces normal to the axes coincide with borders of the points'
     * parts of cells in 'regular', on every level.
     */
    template <int dim>
    bool
    is_in_lattice(const BlockShape<dim>      &block,
                  const Body<dim>            &body,
                  const GridDescription<dim> &grid)
    {
      const Corners<dim> box = block.bounding_box();
      for (unsigned int d = 0; d < dim; ++d)
        for (const double face : {box.first[d], box.second[d]})
          {
            const double parts =
              (face - grid.lower[d]) / spacing_along(d, grid.edge(d), body);
            if (std::abs(parts - std::round(parts)) > 1e-6)
              return false;
          }
      return true;
    }



    /**
     * Volume that points of 'regular' give an upright block, in the largest
     * cells, over its own volume.
     */
    template <int dim>
    double
    filled_by_regular(const BlockShape<dim>      &block,
                      const Body<dim>            &body,
                      const GridDescription<dim> &grid)
    {
      constexpr double   tolerance = 1e-6; // places on a face are inside
      const Corners<dim> box       = block.bounding_box();
      double             result    = 1;
      for (unsigned int d = 0; d < dim; ++d)
        {
          const double spacing = spacing_along(d, grid.edge(d), body);
          const double first   = std::ceil(
            (box.first[d] - grid.lower[d]) / spacing - 0.5 - tolerance);
          const double last = std::floor(
            (box.second[d] - grid.lower[d]) / spacing - 0.5 + tolerance);
          result *=
            (last - first + 1) * spacing / (box.second[d] - box.first[d]);
        }
      return result;
    }



    /** For shapes that are cheap to test for inside and outside. */
    template <int dim>
    bool
    has_curved_surface(const Shape<dim> &shape)
    {
      return dynamic_cast<const BallShape<dim> *>(&shape) ||
             dynamic_cast<const CylinderShape<dim> *>(&shape) ||
             dynamic_cast<const FormulaShape<dim> *>(&shape);
    }



    /**
     * Error of mass, weight and stiffness of a block that 'regular' may make.
     */
    constexpr double least_misfill = 0.02;

    /** The same of a liquid, whose level and weight at rest are known. */
    constexpr double least_misfill_of_liquid = 1e-3;



    /**
     * Whether 'regular' is good enough for an upright block. Bodies side by
     * side or in contact need their faces exactly in place, as do bodies under
     * stress at the start, which would not be at rest, and liquids in cells of
     * several sizes, whose level would differ from one to the next.
     */
    template <int dim>
    bool
    suits(const BlockShape<dim> &block,
          const Meetings        &meets,
          const Body<dim>       &body,
          const Problem<dim>    &problem)
    {
      return is_in_lattice(block, body, problem.grid) ||
             (problem.bodies.size() == 1 && !meets.bodies && !meets.obstacles &&
              !body.initial_stress && !meets.sides &&
              !(body.is_liquid && problem.grid.levels > 0) &&
              std::abs(filled_by_regular(block, body, problem.grid) - 1) <=
                (body.is_liquid ? least_misfill_of_liquid : least_misfill));
    }



    /**
     * Whether the surface of a shape is independent of cells and points, so
     * that parts counted as a whole miss its volume. Pixels and point lists
     * bring parts of their own.
     */
    template <int dim>
    bool
    has_faces_of_its_own(const Shape<dim> &shape)
    {
      return has_curved_surface(shape) ||
             dynamic_cast<const PolygonShape<dim> *>(&shape) ||
             dynamic_cast<const StlShape<dim> *>(&shape) ||
             dynamic_cast<const MeshShape<dim> *>(&shape) ||
             dynamic_cast<const UnionShape<dim> *>(&shape);
    }



    // Placement of the word 'auto', from experience with each:
    //
    // 'regular' counts the part of a cell that belongs to a point in or out as
    // a whole, so a block may be too thick or too thin by one of them.
    //
    // 'fitted', a lattice of its own, fills the cells unevenly: a body under
    // stress is then not in equilibrium, and softer. Kernels with domains need
    // it; so do blocks in contact with linear functions, where bodies touch at
    // the edges of points: with 'cut', thin parts would touch from afar.
    //
    // 'cut' is uneven at the surface only. With splines, away from contact, a
    // ball of ten cells has its exact mass instead of 1.4 % more and, bouncing
    // off a side, a tenth of the error of its energy; thin parts of an STL body
    // may otherwise miss a fifth of theirs. In an impact it is better than
    // 'gauss' for small-cut cells: a ball of twelve cells that has fallen on a
    // side has nodes of 13 m/s with 'gauss', of 3 m/s with 'cut'.
    //
    // Liquids are cut at obstacles, where they need the mass of what they fill:
    // counted by whole parts, water of 93 J moves beside a wall at which it
    // should rest. So are boxes of a liquid, whose level would be off, and
    // waves, as the staircase of whole parts has a third less energy; but with
    // APIC small-cut points at the surface of a wave of 64 cells turn inside
    // out.
    //
    // 'gauss' (Gauss-Legendre points in the filled part of each cell) is for
    // bodies in the initial frame that meet nothing: rows at the centres of
    // parts have a smaller second moment, and bend too easily. (That
    // compensates in part for linear functions without a treatment, which lock
    // in bending: a disk that swirls errs by a third less.) Not for a round
    // body that turns freely in space: a ball of eight cells has points with
    // volume ratios from 0.1 to 4.3 after three turns with 'gauss', from .96 on
    // with 'cut', .994 to 1.009 with 'regular'.
    template <int dim>
    void
    choose_placement(const Section  &section,
                     const Meetings &meets,
                     Body<dim>      &body,
                     Problem<dim>   &problem)
    {
      const bool touches = meets.obstacles || meets.bodies;
      if (body.placement != Placement::automatic)
        return;
      body.placement = Placement::regular;
      const auto *block =
        dynamic_cast<const BlockShape<dim> *>(body.shape.get());
      const auto choose = [&](const Placement    placement,
                              const std::string &word,
                              const std::string &reason) {
        body.placement = placement;
        problem.notes.push_back("Body " + in_quotes(body.name) +
                                ": placement 'auto' is " + in_quotes(word) +
                                ", as " + reason + ".");
      };
      if (block != nullptr && !section.is_empty("Points along edges"))
        return choose(Placement::fitted,
                      "fitted",
                      "'Points along edges' are given");
      if (body.is_liquid && meets.obstacles &&
          problem.grid.kernel == KernelKind::linear &&
          (block != nullptr ?
             !is_upright(*block) || !is_in_lattice(*block, body, problem.grid) :
             has_faces_of_its_own(*body.shape)))
        return choose(Placement::cut,
                      "cut",
                      "a liquid beside obstacles rests with the mass of what "
                      "it fills");
      if (block != nullptr && body.is_liquid && !touches &&
          problem.grid.kernel == KernelKind::linear && is_upright(*block) &&
          !suits(*block, meets, body, problem))
        return choose(Placement::cut,
                      "cut",
                      "its faces do not lie between the points of 'regular'");
      if (body.is_liquid && !touches &&
          problem.grid.kernel == KernelKind::linear &&
          (problem.method.transfer == Transfer::flip ||
           problem.method.transfer == Transfer::pic) &&
          has_faces_of_its_own(*body.shape))
        return choose(Placement::cut,
                      "cut",
                      "its surface runs across the cells");
      // 'fitted', which solids with domains or in contact may need, does not
      // go with cells of several sizes.
      if (body.is_liquid || (problem.grid.levels > 0 &&
                             (touches || has_domains(problem.grid.kernel))))
        return;
      const bool stays =
        body.frame == Frame::initial && !touches && !meets.sides;
      const bool is_round = block == nullptr && has_curved_surface(*body.shape);
      constexpr double free_turning = 0.5; // rad
      if (dim == 3 && stays && is_round && !is_held(body, problem) &&
          !is_solved_by_newton(problem.method.integration) &&
          initial_rotation(body, problem.end_time) > free_turning)
        return;
      if (stays && (block != nullptr || is_round) &&
          (is_spline(problem.grid.kernel) || body.treatment != Treatment::none))
        return choose(Placement::gauss,
                      "gauss",
                      "points in the initial frame keep their places in cells");
      if (has_faces_of_its_own(*body.shape) && !touches &&
          (body.frame == Frame::initial || is_spline(problem.grid.kernel)))
        choose(Placement::cut, "cut", "its surface runs across the cells");
      if (block == nullptr)
        return;
      const bool upright = is_upright(*block);
      if (upright && suits(*block, meets, body, problem))
        return;
      if (has_domains(problem.grid.kernel) ||
          (upright && touches && !is_spline(problem.grid.kernel)))
        choose(Placement::fitted,
               "fitted",
               "its faces do not lie between the points of 'regular'");
      else if (upright)
        choose(Placement::cut,
               "cut",
               "its faces do not lie between the points of 'regular'");
      else
        choose(Placement::cut, "cut", "its faces run across the cells");
    }



    template <int dim>
    void
    read_lattice(const Section              &section,
                 const GridDescription<dim> &grid,
                 Body<dim>                  &body)
    {
      const auto *block =
        dynamic_cast<const BlockShape<dim> *>(body.shape.get());
      const bool fitted = body.placement == Placement::fitted;
      if (fitted && block == nullptr)
        throw InputError("The placement 'fitted' in " +
                         section.where("Placement") +
                         " needs the corners of a box or block, but 'Shape' "
                         "is " +
                         in_quotes(section.text("Shape")) +
                         ". Set 'Placement = cut', or give the body "
                         "another shape.");
      const std::string entry = "Points along edges";
      if (!fitted && !section.is_empty(entry))
        throw InputError("The numbers " + in_quotes(section.text(entry)) +
                         " in " + section.where(entry) +
                         " have no effect with the placement " +
                         in_quotes(section.text("Placement")) +
                         ". Usually that was not changed along with them. Set "
                         "'Placement = fitted'.");
      if (block != nullptr)
        for (unsigned int d = 0; d < dim; ++d)
          body.lattice[d] = section.is_empty(entry) ?
                              parts_of_edges(*block, d, body, grid) :
                              section.numbers(entry)[d];
    }
  } // namespace



  template <int dim>
  void
  read_placement(const Section  &section,
                 const Meetings &meets,
                 Body<dim>      &body,
                 Problem<dim>   &problem)
  {
    read_points(section, problem, body);
    choose_placement(section, meets, body, problem);
    check_point_list(section, problem.grid, body);
    read_lattice(section, problem.grid, body);
  }



  template bool
  is_upright(const Shape<2> &);
  template bool
  is_upright(const Shape<3> &);
  template void
  read_placement(const Section &, const Meetings &, Body<2> &, Problem<2> &);
  template void
  read_placement(const Section &, const Meetings &, Body<3> &, Problem<3> &);
} // namespace limber
