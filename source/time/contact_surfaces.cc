// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/node_vector.h>
#include <limber/state/stretch.h>
#include <limber/time/cell_functions.h>
#include <limber/time/contact.h>

/**
 * @file Contact normals at nodes by a least-squares fit of a plane to the
 * points at the surface of a body, see SurfaceFit.
 */
namespace limber
{
  template <int dim>
  void
  Contact<dim>::fit_surfaces()
  {
    fits.clear();
    for (std::size_t slot = 0; slot < 2 * contact_nodes.size(); ++slot)
      fits.emplace_back(vector_in<dim>(&volume_gradients[slot * dim]),
                        edge[slot % 2 == 0 ? contact_nodes[slot / 2].a :
                                             contact_nodes[slot / 2].b]);
    with_degree(grid, [&](const auto degree) {
      for (const Group &group : groups)
        if (points[group.body].reach != nullptr)
          add_to_fits<decltype(degree)::value>(group);
    });
    share(fits_of_ranks, [this](const std::size_t t) {
      constexpr int               n = SurfaceFit<dim>::n;
      std::array<double *, 2 * n> slots;
      for (int k = 0; k < 2 * n; ++k)
        slots[k] = &fits[2 * t + k / n].sums[k % n];
      return slots;
    });
    for (std::size_t slot = 0; slot < fits.size(); ++slot)
      store_vector<dim>(fits[slot].normal(), &volume_gradients[slot * dim]);
    end_at_sides();
  }



  // The stretch of a point differs little between the normals of a cell's
  // nodes: it is evaluated once, along their mean.
  template <int dim>
  template <int degree>
  void
  Contact<dim>::add_to_fits(const Group &group)
  {
    const PointView<dim>    &of_body = points[group.body];
    const MaterialBody<dim> &body    = *parts.bodies[group.body];
    for (std::size_t b = group.first; b < group.last; ++b)
      {
        const MeetingBatch        &some = batches[b];
        const CellGeometry<dim>   &cell = grid.cells[some.batch.cell];
        CellFunctions<dim, degree> functions(grid, some.batch.cell);
        for (std::size_t p = some.batch.begin; p < some.batch.end; ++p)
          {
            if (!is_at_surface(of_body, p))
              continue;
            functions.go_to(of_body, p);
            const auto xi = natural_place(of_body, cell, p);
            Vector     upwards;
            for (std::uint32_t c = some.first; c < some.last; ++c)
              upwards +=
                functions.value(corners[c].k) * fits[corners[c].slot].guess();
            const double length = upwards.norm();
            if (!(length > 0))
              continue;
            const double reach =
              of_body.reach[p] *
              stretch_along(body, of_body, p, upwards / length);
            for (std::uint32_t c = some.first; c < some.last; ++c)
              {
                // A master of hanging nodes counts only in its own cells.
                const MeetingCorner &corner = corners[c];
                if (functions.node(corner.k) !=
                    contact_nodes[corner.slot / 2].node)
                  continue;
                Vector place; // from the node
                for (int d = 0; d < dim; ++d)
                  place[d] = (xi[d] - functions.digit(corner.k, d)) /
                             cell.inverse_edge[d];
                fits[corner.slot].add(place, reach, functions.value(corner.k));
              }
          }
      }
  }



  template void
  Contact<2>::fit_surfaces();
  template void
  Contact<3>::fit_surfaces();
} // namespace limber
