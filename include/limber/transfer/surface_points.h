// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_surface_points_h
#define limber_transfer_surface_points_h

#include <limber/transfer/meeting_bodies.h>
#include <limber/transfer/surface_fit.h>

/**
 * @file Contact between bodies: the points next to the surface of a body in the
 * cells where it meets others, and the planes through them.
 */
namespace limber
{
  /** Those in a cell, [begin, end) of SurfacePoints, with the corners [first,
   * last) of the cell. */
  struct SurfaceBatch
  {
    std::uint32_t cell, first, last;
    std::size_t   begin, end;
  };



  /** Those of one body: one array per quantity. */
  template <int dim>
  struct SurfacePoints
  {
    std::vector<SurfaceBatch>            batches;
    std::vector<std::uint32_t>           points;  // their numbers in the body
    std::array<std::vector<double>, dim> upwards; // out of the body, of length
                                                  // 1, or 0 if nothing is known
    std::vector<double> stretch; // of the material in this direction

    void
    find(const PointView<dim> &points, const MeetingBatches &batches);

    /** Point upwards along the mean of the guesses at the nodes around. */
    void
    turn(const PointView<dim>  &points,
         const GridView<dim>   &grid,
         const MeetingCorner   *corners,
         const SurfaceFit<dim> *fits);

    /** Add the points to the fits at the nodes around. */
    void
    add_to_fits(const PointView<dim> &points,
                const GridView<dim>  &grid,
                const MeetingCorner  *corners,
                SurfaceFit<dim>      *fits) const;
  };
} // namespace limber

#endif
