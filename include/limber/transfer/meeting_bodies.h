// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_meeting_bodies_h
#define limber_transfer_meeting_bodies_h

#include <limber/points/cell_batch.h>

#include <cmath>
#include <vector>

/**
 * @file Contact between bodies: sums over the points of bodies that meet at
 * nodes, in two slots per meeting, one for each of the two bodies. These sweeps
 * visit only the cells concerned.
 */
namespace limber
{
  /**
   * A node of a cell at which bodies meet, or a hanging node with such a node
   * as master and its share of that function.
   */
  struct MeetingCorner
  {
    std::uint32_t slot; // 2 * number of the meeting, 1 more for the second body
    std::uint32_t k;    // local number of the node in the cell
    double        share = 1;

    bool
    is_of_hanging_node() const
    {
      return share < 1;
    }
  };



  /**
   * Points of a body in a cell, with the corners [first, last) where it meets
   * others.
   */
  struct MeetingBatch
  {
    CellBatch     batch;
    std::uint32_t body;
    std::uint32_t first, last;
  };



  /** Whether a point is adjacent to the surface of its body. */
  template <int dim>
  inline bool
  is_at_surface(const PointView<dim> &points, const std::size_t p)
  {
    return points.reach != nullptr && points.reach[p] > 0;
  }



  /**
   * Undeformed distance from a point to the end of its material, m: to the
   * surface of the body for surface points, else half the edge of a cube of its
   * volume.
   */
  template <int dim>
  inline double
  reach_of(const PointView<dim> &points,
           const std::size_t     p,
           const double          half_edge)
  {
    return is_at_surface(points, p) ? points.reach[p] : half_edge;
  }



  /** The batches of one body. */
  struct MeetingBatches
  {
    const MeetingBatch  *begin, *end;
    const MeetingCorner *corners;
    double               inverse_density; // of the body, m^3/kg
  };



  /** Half the edge, m, of a cube of this volume, m^dim. */
  template <int dim>
  inline double
  half_edge_of(const double volume)
  {
    return 0.5 * (dim == 2 ? std::sqrt(volume) : std::cbrt(volume));
  }



  /**
   * Add sum_p V_p grad N_i(x_p), m^(dim-1), which gives the normal, to dim
   * numbers in each slot.
   */
  template <int dim>
  void
  add_volume_gradients(const PointView<dim> &points,
                       const GridView<dim>  &grid,
                       const MeetingBatches &batches,
                       double               *gradients);



  /** Number of candidate normals along which two bodies are compared. */
  inline constexpr int n_separations = 3;

  /**
   * Candidate normals of each of n meetings, from the gradients g_a and g_b in
   * its slots: the unit vectors of g_a, of -g_b and of their sum; zero for
   * zero.
   */
  template <int dim>
  void
  find_directions(std::size_t n, const double *gradients, double *directions);

  /**
   * How far points with their material extend along the candidate normals
   * (second bodies: along their negatives), m.
   */
  template <int dim>
  struct Extents
  {
    /** n_separations in each slot, -1e300 if there is no point. */
    std::vector<double> largest;

    void
    clear(std::size_t n_slots);

    void
    add(const PointView<dim> &points,
        const MeetingBatches &batches,
        const double         *directions); // n_separations * dim a meeting

    /** To be called after the last points have been added. */
    void
    find_largest();

  private:
    std::vector<double> of_lanes; // of packs of points, lane by lane
  };



  /**
   * The surfaces at a meeting: the normal out of the first body, and how far
   * both bodies extend along it (the second along its negative), m.
   */
  template <int dim>
  struct Faces
  {
    std::array<double, dim> normal;
    std::array<double, 2>   furthest;
  };



  /**
   * List points whose material may touch another body: not further from the
   * surface of that than is possible, along some normal of the nodes of their
   * cell, with a margin for the difference of these normals.
   */
  template <int dim>
  void
  list_near_points(const PointView<dim> &points,
                   const MeetingBatch   &batch,
                   const MeetingCorner  *corners,
                   double                inverse_density,
                   const Faces<dim>     *faces,   // of each meeting
                   double                stretch, // across the surface
                   double largest_reach, // of points of the other body, m
                   std::vector<std::uint32_t> &near);
} // namespace limber

#endif
