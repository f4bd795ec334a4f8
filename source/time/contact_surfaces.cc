// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/state/stretch.h>
#include <limber/time/contact.h>

#include <algorithm>

/**
 * @file Contact normals at nodes by a least-squares fit of a plane to the
 * points at the surface of a body, see SurfaceFit.
 */
namespace limber
{
  // The stretch of a point differs little between the normals of a cell's
  // nodes: it is evaluated once, along their mean.
  template <int dim>
  void
  Contact<dim>::fit_surfaces()
  {
    fits.clear();
    for (std::size_t slot = 0; slot < 2 * contact_nodes.size(); ++slot)
      {
        const ContactNode      &contact = contact_nodes[slot / 2];
        std::array<double, dim> guess;
        std::copy_n(&volume_gradients[slot * dim], dim, guess.begin());
        fits.emplace_back(guess, edge[slot % 2 == 0 ? contact.a : contact.b]);
      }
    for (const Group &group : groups)
      {
        const PointView<dim> &of_body = points[group.body];
        surface.find(of_body, batches_of(group));
        surface.turn(of_body, grid, corners.data(), fits.data());
        std::array<const double *, dim> upwards;
        for (int d = 0; d < dim; ++d)
          upwards[d] = surface.upwards[d].data();
        stretches_along<dim>(*parts.bodies[group.body],
                             of_body,
                             surface.points.size(),
                             surface.points.data(),
                             upwards,
                             surface.stretch.data());
        surface.add_to_fits(of_body, grid, corners.data(), fits.data());
      }
    share(fits_of_ranks, [this](const std::size_t t) {
      constexpr int               n = SurfaceFit<dim>::n;
      std::array<double *, 2 * n> slots;
      for (int k = 0; k < 2 * n; ++k)
        slots[k] = &fits[2 * t + k / n].sums[k % n];
      return slots;
    });
    for (std::size_t slot = 0; slot < fits.size(); ++slot)
      {
        const auto normal = fits[slot].normal();
        std::copy_n(normal.begin(), dim, &volume_gradients[slot * dim]);
      }
    end_at_sides();
  }



  template void
  Contact<2>::fit_surfaces();
  template void
  Contact<3>::fit_surfaces();
} // namespace limber
