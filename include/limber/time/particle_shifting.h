// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_particle_shifting_h
#define limber_time_particle_shifting_h

#include <limber/time/integrator.h>
#include <limber/time/node_rooms.h>
#include <limber/time/room_potential.h>
#include <limber/time/surroundings.h>

#include <vector>

namespace limber
{
  /**
   * Keeps the points of liquids evenly spread (particle shifting; S. J. Lind,
   * R. Xu, P. K. Stansby and B. D. Rogers, J. Comput. Phys. 231, 2012,
   * 1499-1523).
   *
   * The mean divergence of a cell conserves the volume of the flow, but points
   * follow the velocity at their own places: they gather where its divergence
   * is below the mean, and what has clumped weighs more than the pressure of
   * its cells can tell. It sinks, and the liquid loses volume. So points move
   * down the gradient of the excess g of what nodes hold,
   *
   *   g_i = sum_p N_i(x_p) V_p / R_i - 1,
   *   delta_p = - C s h^2 grad (g + alpha phi)(x_p),
   *
   * and, as an excess that is even has no gradient, of the potential phi that
   * makes room for it (RoomPotential; compare the implicit density projection
   * of T. Kugelstadt, A. Longva, N. Thuerey and J. Bender, IEEE TVCG 27, 2021),
   * with the room R_i of a node, the integral of N_i over what obstacles leave
   * of the box; s, in cells, is how far the fastest point has moved since the
   * last time, and C the body's 'Particle shifting'. Next to cells at a surface
   * R_i is not known to be filled: only an excess counts there. Nothing is done
   * beside solids and other fields. Velocities stay; the potential energy that
   * this takes is on record as removed with histories.
   *
   * For linear functions, with means over cells. Theory:
   * doc/theory/treatments.md.
   */
  template <int dim>
  class ParticleShifting
  {
  public:
    /** Cells that obstacles cut, or null. */
    ParticleShifting(const RunParts<dim> &parts,
                     const CutCells<dim> *cut_cells);

    /** Adopt a mesh; collective. */
    void
    reinit();

    /** Tell how far the last step has moved the fastest point, in cells. */
    void
    follow(const double displacement)
    {
      travelled += displacement;
    }

    /** Whether points have moved so far that shift() has something to do; the
     * same on all ranks. */
    bool
    is_due() const;

    /** Move points, and tell their new cells; the caller sorts them and sums up
     * the cells anew. No point may be in a ghost cell. Collective. */
    void
    shift();

    /** s, in cells, for checkpoints. */
    double
    way_since() const
    {
      return travelled;
    }
    void
    restore(const double way)
    {
      travelled = way;
    }

  private:
    using MaterialBody                      = limber::MaterialBody<dim>;
    static constexpr unsigned int n_corners = 1 << dim;

    /** Liquids that give to the same nodes; other bodies that do, which take
     * their room; and those with nodes of their own. */
    struct Group
    {
      std::vector<MaterialBody *> liquids, neighbours, others;
    };

    /** Of a vertex: the volume of points around it (m^3), later the excess g;
     * more than zero next to a cell at a surface, or one that others share. */
    struct Record
    {
      static constexpr unsigned int excess     = 0;
      static constexpr unsigned int at_surface = 1;
      static constexpr unsigned int shared     = 2;
      static constexpr unsigned int stride     = 3;
    };

    void
    find_excess(const Group &group);
    void
    make_room(const Group &group);
    void
    add_volumes(MaterialBody &body);
    void
    mark_cells(const Group &group);
    void
    move_points(MaterialBody &body);
    bool
    holds(const std::vector<MaterialBody *> &bodies, std::uint32_t cell) const;

    double
    room_at(std::uint32_t node) const;

    double *
    record(const std::uint32_t node)
    {
      return records.data() + std::size_t(node) * Record::stride;
    }

    const RunParts<dim>        parts;
    const CutCells<dim> *const cut_cells;        // or null
    const bool                 controls_density; // with implicit pressures
    std::vector<Group>         groups;
    Surroundings<dim>          surroundings;
    NodeRooms<dim>             rooms;
    RoomPotential<dim>         potential;
    LazyArray<double>          records; // by vertex
    RecordExchange             exchange{Record::stride};
    std::vector<double>        volume_ratios; // of the points of a body
    double                     travelled = 0; // in cells
  };
} // namespace limber

#endif
