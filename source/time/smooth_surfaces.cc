// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/node_vector.h>
#include <limber/time/contact_geometry.h>
#include <limber/time/smooth_surfaces.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  namespace
  {
    // Jacobi iterations: more change little, one is less; found with water
    // around a disc at rest.
    constexpr unsigned int n_passes = 2;

    /** Unit vectors across a normal. */
    template <int dim>
    std::array<dealii::Tensor<1, dim>, dim - 1>
    tangents(const dealii::Tensor<1, dim> &normal)
    {
      std::array<dealii::Tensor<1, dim>, dim - 1> result;
      if constexpr (dim == 2)
        result[0] = dealii::cross_product_2d(normal);
      else
        {
          unsigned int least = 0;
          for (unsigned int d = 1; d < dim; ++d)
            if (std::abs(normal[d]) < std::abs(normal[least]))
              least = d;
          dealii::Tensor<1, dim> axis;
          axis[least] = 1;
          result[0]   = dealii::cross_product_3d(normal, axis);
          result[0] /= result[0].norm();
          result[1] = dealii::cross_product_3d(normal, result[0]);
        }
      return result;
    }
  } // namespace



  template <int dim>
  SmoothSurfaces<dim>::SmoothSurfaces(const RunParts<dim> &parts,
                                      CutCells<dim>       &cut_cells)
    : parts(parts)
    , cut_cells(cut_cells)
  {
    reinit();
  }



  template <int dim>
  void
  SmoothSurfaces<dim>::reinit()
  {
    moments.clear();
    records.reinit(std::size_t(parts.nodes.table.n()) * stride);
  }



  // Held components are found anew, as a resumed run has no step before.
  template <int dim>
  void
  SmoothSurfaces<dim>::apply(BoundaryConditions<dim> &boundaries,
                             const double             time,
                             const double             step,
                             const double             share)
  {
    held.assign(std::size_t(parts.nodes.table.n()) * dim, 0);
    boundaries.for_each_held(parts.nodes,
                             time + step,
                             [this](const std::uint32_t node,
                                    const unsigned int  d,
                                    double) {
                               held[std::size_t(node) * dim + d] = 1;
                             });
    find_moments();
    damp(time, step, share);
  }



  template <int dim>
  void
  SmoothSurfaces<dim>::find_moments()
  {
    moments.clear();
    for (const auto &cell : cut_cells.all())
      if (cell.number < parts.grid.n_owned_cells() &&
          cut_cells.wets(cell.number, 0))
        add(cell);
    for (Moment &moment : moments)
      for (unsigned int a = 0; a < n_nodes; ++a)
        for (unsigned int d = 0; d < dim; ++d)
          if (held[std::size_t(node_of(moment.cell, a)) * dim + d])
            moment.entries[a][d] = 0;
  }



  // One (in the plane) or two moments about the centroid of each piece.
  template <int dim>
  void
  SmoothSurfaces<dim>::add(const typename CutCells<dim>::Cell &cell)
  {
    unsigned int n_pieces = 0;
    for (const auto &surface : cell.surfaces)
      n_pieces = std::max(n_pieces, surface.piece + 1);
    for (unsigned int piece = 0; piece < n_pieces; ++piece)
      {
        Vector       normal, centroid; // times the area
        double       area     = 0;
        unsigned int obstacle = 0;
        for (const auto &surface : cell.surfaces)
          if (surface.piece == piece && cut_cells.meets_cut(cell, surface))
            {
              normal += surface.area * surface.normal;
              centroid += surface.area * surface.place;
              area += surface.area;
              obstacle = surface.obstacle;
            }
        if (!(normal.norm() > 0))
          continue;
        centroid /= area;
        for (const Vector &tangent : tangents<dim>(normal / normal.norm()))
          {
            moments.push_back({cell.number, obstacle, {}});
            auto &entries = moments.back().entries;
            for (const auto &surface : cell.surfaces)
              if (surface.piece == piece && cut_cells.meets_cut(cell, surface))
                for (unsigned int a = 0; a < n_nodes; ++a)
                  entries[a] += surface.area *
                                (tangent * (surface.moments[a] -
                                            surface.functions[a] * centroid)) *
                                surface.normal;
          }
      }
  }



  template <int dim>
  void
  SmoothSurfaces<dim>::damp(const double time,
                            const double step,
                            const double share)
  {
    const NodalFields<dim> &nodes = parts.nodes;
    for (const std::uint32_t node : nodes.active_nodes())
      std::fill_n(record(node), stride, 0.);
    for (const Moment &moment : moments)
      for (unsigned int a = 0; a < n_nodes; ++a)
        record(node_of(moment.cell, a))[weight] += moment.entries[a].norm();
    exchange.start(nodes.node_plan(), records.data(), weight, stride);
    exchange.finish(records.data());

    Ways ways;
    for (const Obstacle<dim> &obstacle : parts.problem.obstacles)
      ways.emplace_back(obstacle, time, step);
    for (unsigned int pass = 0; pass < n_passes; ++pass)
      {
        damp_once(ways, share);
        exchange.start(nodes.node_plan(), records.data(), of_pass, weight);
        exchange.finish(records.data());
        for (const std::uint32_t node : nodes.active_nodes())
          for (unsigned int d = 0; d < dim; ++d)
            {
              double *const of_node = record(node);
              of_node[d] += of_node[of_pass + d];
              of_node[of_pass + d] = 0;
            }
      }
    push_nodes();
  }



  // One Jacobi iteration. The velocity of the obstacle is subtracted at the
  // nodes: it is linear in the place, as the shape functions are.
  template <int dim>
  void
  SmoothSurfaces<dim>::damp_once(const Ways &ways, const double share)
  {
    const NodalFields<dim> &nodes = parts.nodes;
    double                  given = 0; // by obstacles that move, J
    for (const Moment &moment : moments)
      {
        const ObstacleMotion<dim>  &way  = ways[moment.obstacle];
        const CellGeometry<dim>    &cell = parts.grid.geometry[moment.cell];
        std::array<Vector, n_nodes> of_wall, arms;
        double                      sum = 0, scale = 0;
        bool                        all_have_mass = true;
        for (unsigned int a = 0; a < n_nodes && all_have_mass; ++a)
          {
            const std::uint32_t node    = node_of(moment.cell, a);
            const double *const of_node = nodes.record(node);
            const double        mass    = of_node[Layout::mass];
            const double        norm    = moment.entries[a].norm();
            dealii::Point<dim>  x;
            for (unsigned int d = 0; d < dim; ++d)
              x[d] = cell.origin[d] + (a >> d & 1) / cell.inverse_edge[d];
            arms[a] = x - way.before.centre();
            if (parts.problem.obstacles[moment.obstacle].moves())
              of_wall[a] = way.velocity(x);
            if (!(norm > 0))
              continue;
            all_have_mass = mass > 0;
            const Vector velocity =
              vector_in<dim>(of_node + Layout::velocity) -
              vector_in<dim>(of_node + Layout::increment) +
              vector_in<dim>(record(node)) / mass;
            sum += moment.entries[a] * (velocity - of_wall[a]);
            scale += norm / mass * record(node)[weight];
          }
        if (!all_have_mass || !(scale > 0))
          continue;
        ObstacleAction<dim> &action = parts.ledger.obstacles[moment.obstacle];
        for (unsigned int a = 0; a < n_nodes; ++a)
          {
            const Vector impulse = -share * sum / scale * moment.entries[a];
            action.impulse += impulse;
            action.moment += moment_of<dim>(arms[a], impulse);
            given += impulse * of_wall[a];
            for (unsigned int d = 0; d < dim; ++d)
              record(node_of(moment.cell, a))[of_pass + d] += impulse[d];
          }
      }
    parts.ledger.boundary_work += given;
    parts.ledger.contact += given;
  }



  template <int dim>
  void
  SmoothSurfaces<dim>::push_nodes()
  {
    for (const std::uint32_t node : parts.nodes.active_nodes())
      {
        double *const of_node = parts.nodes.record(node);
        if (of_node[Layout::mass] > 0)
          for (unsigned int d = 0; d < dim; ++d)
            {
              const double change = record(node)[d] / of_node[Layout::mass];
              of_node[Layout::velocity + d] += change;
              of_node[Layout::increment + d] += change;
            }
      }
  }



  template <int dim>
  void
  SmoothSurfaces<dim>::account(const unsigned int velocity_after)
  {
    for (const std::uint32_t node : parts.nodes.active_nodes())
      if (parts.nodes.owns(node))
        {
          const double *const of_node = parts.nodes.record(node);
          for (unsigned int d = 0; d < dim; ++d)
            parts.ledger.contact -=
              0.5 * record(node)[d] *
              (of_node[velocity_after + d] + of_node[Layout::velocity + d] -
               of_node[Layout::increment + d]);
        }
  }



  template class SmoothSurfaces<2>;
  template class SmoothSurfaces<3>;
} // namespace limber
