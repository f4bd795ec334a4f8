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
  /** Which quantities the points of a body have to carry. */
  struct PointLayout
  {
    bool         deviator     = false;
    unsigned int n_history    = 0;
    int          volumetric   = -1; // history variable; -1: the pressure
    bool         affine       = false;
    bool         acceleration = false; // of the time integration
    bool         crossings    = false; // how many cells it has entered
    bool         reach        = false; // how far its material goes
    bool         stretch      = false; // how it is deformed, at surfaces
    DomainForm   domains      = DomainForm::none; // GIMP, CPDI
    bool         reference    = false; // reference position, for displacements
    bool         size_class   = false; // the level of cells they are made for
    bool         edges        = false; // of what they stand for, at the start
    // Functions of the initial places: also the reference position and F.
    bool initial_frame = false;

    bool
    has_reference() const
    {
      return reference || initial_frame;
    }
  };



  /** A point that is to become several in a row. */
  template <int dim>
  struct Division
  {
    std::size_t            point;
    dealii::Tensor<1, dim> half_edge; // to the end of the row, m
    unsigned int           direction; // axis, or edge of a parallelepiped
    unsigned int           parts;     // if there is one in the middle, it stays
    double                 rate = 0;  // at which it becomes longer, 1/s
  };



  /** A point that had to be taken out of the computation. */
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
   * The points of one body: one array per quantity, on which the sweeps work.
   * Points that change cell only get a new cell number; hand_over() gives those
   * that have entered cells of other ranks to these. deal.II's
   * ParticleHandler takes all of them through a change of the mesh and is
   * empty otherwise.
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
     * A new point in an owned cell, by local number, and of its size; mass in
     * kg, half edges of its domain as columns in m.
     */
    void
    add(std::uint32_t                 cell,
        const dealii::Point<dim>     &place,
        double                        mass,
        const dealii::Tensor<2, dim> &half_edges = {});

    /** After all add(): number the points over all ranks. Collective. */
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

    /** The number that the point keeps for good, its own on all ranks. */
    std::uint64_t
    id(const std::size_t p) const
    {
      return ids[p];
    }

    /**
     * The level of the cells whose size the point has: cells of this level
     * would hold as many of its kind as 'Points per cell edge' says.
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

    /** Of all points; empty where all are of one size. */
    const std::vector<char> &
    all_size_classes() const
    {
      return size_classes;
    }

    /** Where the point was at the start; needs has_reference(). */
    dealii::Point<dim>
    reference_position(const std::size_t p) const;

    bool
    has_reference() const
    {
      return layout.has_reference();
    }

    /** Changes whenever points change their places in the arrays. */
    unsigned long
    order() const
    {
      return n_reorderings;
    }

    /**
     * Put the arrays into the order of cells (counting sort), and return the
     * local numbers of the cells that hold points, ascending. All points have
     * a cell.
     */
    std::vector<std::uint32_t>
    sort_by_cell();

    /** Take out the points without a cell and say which they were. */
    std::vector<LostPoint<dim>>
    remove_lost();

    /**
     * Give the points in ghost cells to the ranks that own these; what comes
     * stands last. All points have a cell: none may have gone beyond the ghost
     * layer since the last time. Collective.
     */
    void
    hand_over();

    /**
     * Before and after the mesh is partitioned anew; in between there are no
     * arrays. Collective.
     */
    void
    prepare_mesh_change();
    void
    finish_mesh_change();

    /**
     * After cells have been divided or joined, with the points in cells of this
     * rank and none of these given away: the numbers of their cells.
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
     * Let each of these points become @p parts (2 or 3) along each edge, side
     * by side in its cell, that share its mass and are otherwise what it was.
     * So sums over points and, as linear functions see them, over nodes do not
     * change. Their initial places, if known, are shifted by the linear
     * function of the present place that those in the cell follow. A domain is
     * divided likewise. With @p spacing of points of size class 0, m, that have
     * none. The first of two or the middle of three along each edge, which
     * stays where it is, keeps the number, the others get numbers from
     * @p next_id on. Of points at the surface whose outward normal there is
     * among the @p normals (zero: not known), no part sticks out: each ends at
     * the surface as the whole does.
     */
    void
    split(const std::vector<std::size_t>            &which,
          unsigned int                               parts,
          const std::array<double, dim>             &spacing,
          std::uint64_t                              next_id,
          const std::vector<dealii::Tensor<1, dim>> &normals = {});

    /**
     * Let each of these points become some that share its mass, its domain or
     * edge, and stand where the rows that they divide have their middles, in
     * this cell or the next. The one in the middle or, of two, the first keeps
     * the number, the others get numbers from @p next_id on. They part as the
     * material does, along their row: momentum and its moment stay. Returns the
     * kinetic energy that they have more than before, J.
     */
    double
    divide(const std::vector<Division<dim>> &which, std::uint64_t next_id);

    /**
     * Let the points of each of these sets, which are in one cell and of one
     * size class, become one of the next coarser class. It has their mass and
     * the mean by mass of all else, so that mass, momentum and the centre of
     * mass stay; and the number of the first. No point has parts of a domain.
     */
    void
    join(const std::vector<std::vector<std::size_t>> &sets);

    /** What a point carries, as "mass" or "velocity x", in a fixed order. */
    std::vector<std::string>
    field_names() const;

    /** The array of a field, by its place among the names. */
    const std::vector<double> &
    field(const unsigned int f) const
    {
      return fields[f];
    }

    /** The field with the place in the grid along x; see PointView. */
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

    /** Forget all points, to take others from elsewhere. */
    void
    clear();

    /**
     * Points with a number already, in owned cells; a vector per field, and
     * size classes where there are any.
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
    shift_point(std::size_t                   p,
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

    // A point as consecutive numbers: its fields, its id, its size class if
    // there are any.
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
