// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/obstacle_contact.h>

#include <algorithm>

/** @file Contact of liquids with the surfaces of obstacles in cut cells. */

namespace limber
{
  // Whether a node belongs to a cut cell: the surfaces there have the contact.
  template <int dim>
  bool
  ObstacleContact<dim>::is_met_by_surface(const unsigned int  field,
                                          const std::uint32_t node) const
  {
    return cut_cells != nullptr && cut_cells->knows(field) &&
           cut_cells->is_cut(node);
  }



  // One contact per surface, for the mean flow through it: a_pi are the means
  // of N_i over the surface. One in the face of a cell counts where it ends at
  // a cut cell.
  template <int dim>
  void
  ObstacleContact<dim>::add_cut_cells(const std::vector<Way> &ways,
                                      const double            step)
  {
    for (unsigned int field = 0; field < parts.nodes.n_fields(); ++field)
      {
        if (!cut_cells->knows(field))
          continue;
        double density = 0; // of the heaviest liquid, kg/m^3
        for (const auto &body : parts.bodies)
          if (body->description.is_liquid &&
              body->description.nodal_field == field)
            density = std::max(density, body->stress->density());
        for (const auto &cell : cut_cells->all())
          {
            if (cell.number >= parts.grid.n_owned_cells() ||
                !cut_cells->wets(cell.number, field))
              continue;
            const CellGeometry<dim> &geometry =
              parts.grid.geometry[cell.number];
            for (unsigned int s = 0; s < cell.surfaces.size(); ++s)
              {
                const auto &surface = cell.surfaces[s];
                if (!cut_cells->meets_cut(cell, surface))
                  continue;
                surface_places.push_back(
                  {cell.number, s, impulses.all().size()});
                Place &place = impulses.add_place();
                place.normal = surface.normal;
                place.friction =
                  parts.problem.obstacles[surface.obstacle].friction;
                place.mass = density * surface.area * parts.grid.smallest_edge;
                if (parts.problem.obstacles[surface.obstacle].moves())
                  place.velocity =
                    ways[surface.obstacle].velocity(surface.place);
                for (unsigned int a = 0; a < 1u << dim; ++a)
                  if (surface.functions[a] > 0)
                    impulses.add_share(field,
                                       geometry.node[a] / Layout::stride,
                                       surface.functions[a]);
                touches.push_back(
                  {surface.obstacle,
                   surface.place - ways[surface.obstacle].before.centre(),
                   step * density * surface.area * surface.beyond});
              }
          }
      }
  }



  template bool
  ObstacleContact<2>::is_met_by_surface(unsigned int, std::uint32_t) const;
  template void
  ObstacleContact<2>::add_cut_cells(const std::vector<Way> &, double);
  template bool
  ObstacleContact<3>::is_met_by_surface(unsigned int, std::uint32_t) const;
  template void
  ObstacleContact<3>::add_cut_cells(const std::vector<Way> &, double);
} // namespace limber
