// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_meeting_bodies_h
#define limber_transfer_meeting_bodies_h

#include <limber/points/cell_batch.h>

#include <cmath>
#include <vector>

/**
 * @file What is summed up over the points of bodies that meet at nodes, each in
 * two slots there: one for each of two bodies. Nothing else is met by these
 * sweeps.
 */
namespace limber
{
  /**
   * A node of a cell at which bodies meet, or one that hangs on such a node and
   * has a share of its function.
   */
  struct MeetingCorner
  {
    std::uint32_t slot; // 2 * number of the meeting, 1 more for the second body
    std::uint32_t k;    // its number in the cell
    double        share = 1;
  };



  /** Points of a body in a cell with such corners: [first, last) of all. */
  struct MeetingBatch
  {
    CellBatch     batch;
    std::uint32_t body;
    std::uint32_t first, last;
  };



  /** Whether a point is one of those next to the surface of its body. */
  template <int dim>
  inline bool
  is_at_surface(const PointView<dim> &points, const std::size_t p)
  {
    return points.reach != nullptr && points.reach[p] > 0;
  }



  /**
   * From a point to where its material ends, m, before it is stretched: at the
   * surface of the body, otherwise at that of a cube of its volume.
   */
  template <int dim>
  inline double
  reach_of(const PointView<dim> &points,
           const std::size_t     p,
           const double          half_edge)
  {
    return is_at_surface(points, p) ? points.reach[p] : half_edge;
  }



  /** Those of one body side by side. */
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



  /** Add sum_p V_p grad N_i(x_p), m^(dim-1), to dim numbers in each slot. */
  template <int dim>
  void
  add_volume_gradients(const PointView<dim> &points,
                       const GridView<dim>  &grid,
                       const MeetingBatches &batches,
                       double               *gradients);



  /** Directions along which two bodies may be apart at a meeting. */
  inline constexpr int n_separations = 3;

  /**
   * Of each of n meetings, from the gradients g_a and g_b in its slots: the
   * directions of g_a, of -g_b and of the sum of these; zero of zero.
   */
  template <int dim>
  void
  find_directions(std::size_t n, const double *gradients, double *directions);

  /**
   * How far points and their material go along these: the second bodies
   * against them. In each slot, lane by lane; see find_largest().
   */
  template <int dim>
  struct Extents
  {
    static constexpr int lanes = 4;
    static constexpr int n     = n_separations * lanes; // numbers a slot

    std::vector<double> numbers; // -1e300 where nothing is

    void
    clear(std::size_t n_slots);

    void
    add(const PointView<dim> &points,
        const MeetingBatches &batches,
        const double         *directions); // n_separations * dim a meeting

    /** In the first of the lanes. */
    void
    find_largest();
  };



  /**
   * Where a body ends, as seen from another at a node: the normal there, out of
   * the first one, and how far both go along it, the second against it, m.
   */
  template <int dim>
  struct Faces
  {
    std::array<double, dim> normal;
    std::array<double, 2>   furthest;
  };



  /**
   * List points whose material may end at another body: not further from the
   * face of that than they could be, along some normal that their cell sees,
   * with what room it takes that these differ.
   */
  template <int dim>
  void
  list_near_points(const PointView<dim> &points,
                   const MeetingBatch   &batch,
                   const MeetingCorner  *corners,
                   double                inverse_density,
                   const Faces<dim>     *faces,   // of each meeting
                   double                stretch, // across the surface
                   double largest_reach, // of points that may be met, m
                   std::vector<std::uint32_t> &near);
} // namespace limber

#endif
