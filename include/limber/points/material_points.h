// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_points_material_points_h
#define limber_points_material_points_h

#include <deal.II/particles/particle_handler.h>

#include <limber/grid/background_grid.h>
#include <limber/points/point_view.h>

#include <memory>
#include <string>
#include <vector>

namespace limber
{
  /** The quantities that the points of a body store. */
  struct PointLayout
  {
    bool         deviator     = false;
    unsigned int n_history    = 0;
    int          volumetric   = -1; // history variable; -1: the pressure
    bool         affine       = false;
    bool         acceleration = false; // of the time integration
    bool         crossings    = false; // count of cell crossings
    bool         reach        = false; // distance to the surface, for contact
    bool         stretch      = false; // b = F F^T at the surface, for contact
    DomainForm   domains      = DomainForm::none; // GIMP, CPDI
    bool         reference    = false; // reference position, for displacements
    bool         size_class   = false; // level of cells they are made for
    bool         edges        = false; // initial edges of their boxes
    // Total Lagrangian: reference position and F as well.
    bool initial_frame = false;

    bool
    has_reference() const
    {
      return reference || initial_frame;
    }
  };



  /** A point that is to be split into several in a row. */
  template <int dim>
  struct Division
  {
    std::size_t            point;
    dealii::Tensor<1, dim> half_edge; // half the length of the row, m
    unsigned int           direction; // axis, or edge of a parallelepiped
    unsigned int           parts;     // if odd, the middle one stays
    double                 rate = 0;  // stretch rate along the row, 1/s
  };



  /** A point that had to be removed from the computation. */
  template <int dim>
  struct LostPoint
  {
    std::uint64_t          id = 0;
    dealii::Point<dim>     position;
    dealii::Tensor<1, dim> momentum; // kg m/s
    double                 mass         = 0;
    bool                   left_the_box = false;
  };



  /**
   * The points of one body: one array per quantity, on which the sweeps work. A
   * point that changes its cell only gets a new cell number; hand_over() sends
   * those in ghost cells to the ranks that own these. deal.II's ParticleHandler
   * holds the points during a change of the mesh only.
   */
  template <int dim>
  class MaterialPoints
  {
  public:
    MaterialPoints(const BackgroundGrid<dim> &grid, const PointLayout &layout);

    /** Make room for this many points, so that add() need not. */
    void
    reserve(std::size_t n);

    /**
     * Add a point in an owned cell (local number), of the size class of that
     * cell; mass in kg, half edges of its domain as columns in m.
     */
    void
    add(std::uint32_t                 cell,
        const dealii::Point<dim>     &place,
        double                        mass,
        const dealii::Tensor<2, dim> &half_edges = {});

    /** After all add(): give the points ids, over all ranks. Collective. */
    void
    finish_adding();

    /** Arrays of the points on this rank. */
    PointView<dim>
    view();
    PointView<dim>
    view() const; // to be read only

    std::size_t
    size() const
    {
      return cell.size();
    }

    /** Over all ranks; collective. */
    std::size_t
    n_global() const;

    /** The global id of the point, which never changes. */
    std::uint64_t
    id(const std::size_t p) const
    {
      return ids[p];
    }

    /**
     * The refinement level of the cells for which the point is made: cells of
     * this level would hold as many such points as 'Points per cell edge' says.
     */
    unsigned int
    size_class(const std::size_t p) const
    {
      return layout.size_class ? size_classes[p] : 0;
    }

    bool
    has_size_classes() const
    {
      return layout.size_class;
    }

    /** Of all points; empty if all have the same size. */
    const std::vector<char> &
    all_size_classes() const
    {
      return size_classes;
    }

    /** The initial position; needs has_reference(). */
    dealii::Point<dim>
    reference_position(const std::size_t p) const;

    bool
    has_reference() const
    {
      return layout.has_reference();
    }

    /** Changes whenever points change their indices in the arrays. */
    unsigned long
    order() const
    {
      return n_reorderings;
    }

    /**
     * Sort the points by cells (counting sort), and return the local numbers of
     * the cells that contain points, ascending. All points must have a cell.
     */
    std::vector<std::uint32_t>
    sort_by_cell();

    /** Remove the points without a cell and return them. */
    std::vector<LostPoint<dim>>
    remove_lost();

    /**
     * Send the points in ghost cells to the ranks that own these; received
     * points are appended. All points must have a cell: none may have left the
     * ghost layer since the last call. Collective.
     */
    void
    hand_over();

    /**
     * To be called before and after the mesh is changed or repartitioned; the
     * arrays are empty in between. Collective.
     */
    void
    prepare_mesh_change();
    void
    finish_mesh_change();

    /**
     * Find the cells of all points after cells have been refined or coarsened,
     * if all points remain in cells of this rank.
     */
    void
    find_cells();

    /** Points in an owned cell, while the mesh is partitioned. */
    unsigned int
    n_in_cell(const typename dealii::Triangulation<dim>::active_cell_iterator
                &cell) const
    {
      return carrier->n_particles_in_cell(cell);
    }

    /**
     * Split each of these points into @p parts (2 or 3) along each edge, side
     * by side, which share its mass and otherwise copy it. So sums over points
     * do not change. The parts of a domain fill it, and may lie in cells around
     * that of the point (also of other ranks); without domains they stay in its
     * cell, so that with linear functions sums at nodes do not change either.
     * Initial positions, if stored, are shifted by a linear function of the
     * position, fitted in the cell. @p spacing is that of points of size class
     * 0, m, where there are no domains. The first of two
     * or the middle of three along each edge, which stays in place, keeps the
     * id, the others get ids from @p next_id on. For surface points with an
     * outward normal in @p normals (zero: unknown) no part sticks out: each
     * ends at the surface as the original does.
     */
    void
    split(const std::vector<std::size_t>            &which,
          unsigned int                               parts,
          const std::array<double, dim>             &spacing,
          std::uint64_t                              next_id,
          const std::vector<dealii::Tensor<1, dim>> &normals = {});

    /**
     * Split each of these points along a row into several that share its mass,
     * its domain or edge, in this cell or the next. The middle one or, of two,
     * the first keeps the id, the others get ids from @p next_id on. Their
     * velocities differ along the row as the material stretches; linear and
     * angular momentum are conserved. Returns the increase of kinetic energy,
     * J.
     */
    double
    divide(const std::vector<Division<dim>> &which, std::uint64_t next_id);

    /**
     * Merge the points of each of these sets, which are in one cell and of one
     * size class, into one of the next coarser class, with their mass and the
     * mass-weighted mean of everything else, so that mass, momentum and centre
     * of mass are conserved; it gets the id of the first. Not for points with
     * domains.
     */
    void
    join(const std::vector<std::vector<std::size_t>> &sets);

    /**
     * Names of the stored quantities, as "mass" or "velocity x", in fixed
     * order.
     */
    std::vector<std::string>
    field_names() const;

    /** The array of a field, by its index among the names. */
    const std::vector<double> &
    field(const unsigned int f) const
    {
      return fields[f];
    }

    /** The field of PointView::place along x. */
    unsigned int
    place_field() const
    {
      return layout.initial_frame ? fields.size() - dim : 0;
    }

    const std::vector<std::uint64_t> &
    all_ids() const
    {
      return ids;
    }

    /** Remove all points, before others are appended. */
    void
    clear();

    /**
     * Append points with ids, in owned cells; one vector per field, and size
     * classes if there are any.
     */
    void
    append(const std::vector<std::uint32_t>       &new_cells,
           const std::vector<std::uint64_t>       &new_ids,
           const std::vector<std::vector<double>> &new_fields,
           const std::vector<char>                &new_size_classes = {});

  private:
    void
    resize(std::size_t n);
    dealii::Tensor<2, dim>
    half_edges(const PointView<dim>          &points,
               std::size_t                    p,
               const std::array<double, dim> &spacing) const;
    void
    shift_point(const PointView<dim>         &points,
                std::size_t                   p,
                const dealii::Tensor<1, dim> &way,
                const dealii::Tensor<2, dim> &initial);
    std::vector<dealii::Tensor<2, dim>>
    initial_gradients(const std::vector<std::size_t> &which) const;
    double
    joint_reach(const std::vector<std::size_t> &set) const;
    double
    room_in_cell(const PointView<dim> &points,
                 std::size_t           p,
                 unsigned int          axis) const;
    void
    move(std::size_t from, std::size_t to);
    std::vector<std::uint32_t>
    occupied_cells() const;

    // Serialisation of a point: its fields, its id, its size class if any.
    std::size_t
    record_size() const
    {
      return fields.size() + (layout.size_class ? 2 : 1);
    }
    void
    write_record(std::size_t p, double *record) const;
    void
    read_record(const double *record, std::size_t p);

    const BackgroundGrid<dim> &grid;
    const PointLayout          layout;

    // Position, velocity, mass, pressure, deviator, history, affine part,
    // acceleration, crossings, reach, edges, domain, deformation gradient; the
    // reference position, if there is one, comes last.
    std::vector<std::vector<double>> fields;
    std::vector<std::uint32_t>       cell;
    std::vector<std::uint64_t>       ids;
    std::vector<char>                size_classes; // or empty
    unsigned long                    n_reorderings = 0;

    // Only while the mesh changes
    std::unique_ptr<dealii::Particles::ParticleHandler<dim>> carrier;
  };
} // namespace limber

#endif
