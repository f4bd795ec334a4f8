// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_particle_shifting_h
#define limber_time_particle_shifting_h

#include <limber/time/integrator.h>
#include <limber/time/nodal_volumes.h>
#include <limber/time/shifting_potential.h>
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
   * follow the velocity at their own places: they clump where its divergence is
   * below the mean, and a clump is heavier than the pressure of its cells
   * accounts for. It sinks, and the liquid loses volume. So points move down
   * the gradient of the relative overfill g of nodes,
   *
   *   g_i = sum_p N_i(x_p) V_p / R_i - 1,
   *   delta_p = - C s h^2 grad (g + alpha phi)(x_p),
   *
   * and, as a uniform overfill has no gradient, of the potential phi that makes
   * room for it (ShiftingPotential; compare the implicit density projection of
   * T. Kugelstadt, A. Longva, N. Thuerey and J. Bender, IEEE TVCG 27, 2021).
   * R_i is the nodal volume, the integral of N_i over what obstacles leave of
   * the box; s, in cells, is how far the fastest point has moved since the last
   * time, and C the body's 'Particle shifting'.
   *
   * A density that alternates from cell to cell (stripes two cells wide, or a
   * checkerboard) is in the null space of g: every node has as much of one as
   * of the other. So the fillings of cells diffuse as well: across a face
   * between the cells L and R points move by
   *
   *   C s h / (4 dim) (e_L - e_R),   e = V_in / V_cell - 1,
   *
   * with the volume V_in of the points in a cell, a point being a box that may
   * cover parts of several cells, so that e is no noise where rows of points
   * pass faces; and within a cell by the linear interpolation between opposite
   * faces (lowest order Raviart-Thomas). It takes C s / dim of stripes. Of the
   * difference only what is more than noise counts.
   *
   * Next to cells at a free surface R_i is not known to be filled: only an
   * excess of nodes counts there, and nothing passes faces, nor those where the
   * size of cells changes. Nothing is done beside solids and other fields. On
   * cells of several sizes there is no phi. Velocities stay; the potential
   * energy that this takes is on record as removed with histories.
   *
   * For linear functions with means over cells, and quadratic splines with
   * means over cells or around nodes. Theory: doc/theory/treatments.md.
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

    /** Liquids of one nodal field; other bodies of this field, which take part
     * of its nodal volumes; and bodies of other fields. */
    struct Group
    {
      std::vector<MaterialBody *> liquids, neighbours, others;
    };

    /** Whose points a cell holds, bit by bit. */
    enum Holder : std::uint8_t
    {
      of_liquids    = 1,
      of_neighbours = 2,
      of_others     = 4
    };

    /** By direction, at both ends. */
    using Faces = std::array<std::array<double, 2>, dim>;

    /**
     * Offsets by vertex: volume of points around it (m^3), later the overfill
     * g; more than zero next to a cell at a free surface, or next to one with
     * bodies of other fields.
     */
    struct Record
    {
      static constexpr unsigned int excess     = 0;
      static constexpr unsigned int at_surface = 1;
      static constexpr unsigned int shared     = 2;
      // Of the cells around it, by the corner of the cell that it is: the
      // volume in them of points to which it is the nearest vertex (m^3), and
      // how far they are filled
      static constexpr unsigned int parts    = 3;
      static constexpr unsigned int fillings = parts + n_corners;
      static constexpr unsigned int stride   = fillings + n_corners;
    };

    void
    find_excess(const Group &group);
    double
    way_left() const;
    void
    find_holders(const Group &group);
    void
    add_potential();
    void
    add_volumes(MaterialBody &body);
    void
    mark_nodes();
    void
    add_parts(std::uint32_t                  cell,
              const std::array<double, dim> &xi,
              double                         volume);
    void
    find_fillings();
    Faces
    shifts_at_faces(std::uint32_t cell, double factor);
    void
    move_points(MaterialBody &body);

    double
    nodal_volume_at(std::uint32_t node) const;

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
    NodalVolumes<dim>          nodal_volumes;
    ShiftingPotential<dim>     potential;
    LazyArray<double>          records;           // by vertex
    LazyArray<std::uint8_t>    holders;           // by cell
    LazyArray<bool>            at_change_of_size; // by vertex
    RecordExchange             exchange{Record::stride};
    std::vector<double>        volume_ratios; // of the points of a body
    double                     travelled = 0; // in cells
  };
} // namespace limber

#endif
