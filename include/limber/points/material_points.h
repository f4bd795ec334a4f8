// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_points_material_points_h
#define limber_points_material_points_h

#include <deal.II/particles/particle_handler.h>

#include <limber/grid/background_grid.h>
#include <limber/points/point_view.h>

#include <string>
#include <vector>

namespace limber
{
  /** Which quantities the points of a body have to carry. */
  struct PointLayout
  {
    bool         deviator   = false;
    unsigned int n_history  = 0;
    int          volumetric = -1; // history variable; -1: the pressure
    bool         affine     = false;
    bool         reference  = false; // reference position, for displacements
  };



  /** A point that had to be taken out of the computation. */
  template <int dim>
  struct LostPoint
  {
    dealii::types::particle_index id = 0;
    dealii::Point<dim>            position;
    dealii::Tensor<1, dim>        momentum; // kg m/s
    double                        mass         = 0;
    bool                          left_the_box = false;
  };



  /**
   * The points of one body. A deal.II ParticleHandler carries them across
   * ranks and changes of the mesh; it is the truth when points are
   * synchronised. In between, the sweeps work on arrays, one per quantity,
   * and points that change cell only get a new cell number.
   */
  template <int dim>
  class MaterialPoints
  {
  public:
    MaterialPoints(const BackgroundGrid<dim> &grid, const PointLayout &layout);

    /** A new point in a locally owned cell; mass in kg. */
    void
    add(const typename dealii::Triangulation<dim>::active_cell_iterator &cell,
        const dealii::Point<dim>                                        &place,
        double                                                           mass);

    /** After all add(): number the points over all ranks and gather them. */
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

    dealii::types::particle_index
    id(const std::size_t p) const;

    /** Where the point was at the start; needs PointLayout::reference. */
    dealii::Point<dim>
    reference_position(const std::size_t p) const;

    /** Changes whenever points change their places in the arrays. */
    unsigned long
    order() const
    {
      return n_reorderings;
    }

    /** Put the arrays into the order of cells (counting sort). */
    void
    sort_by_cell();

    /** Local numbers of the cells that hold points, ascending. */
    void
    collect_cells(std::vector<std::uint32_t> &cells) const;

    /** Take out the points without a cell and say which they were. */
    std::vector<LostPoint<dim>>
    remove_lost();

    /**
     * Write the arrays back into the ParticleHandler, hand points over to the
     * ranks that own their cells, and gather the arrays anew. Points must not
     * have gone beyond the ghost layer since the last time. On one rank, where
     * the handler carries nothing, the arrays are only sorted.
     */
    void
    synchronise();

    /** Before and after the mesh is partitioned anew, on several ranks. */
    void
    prepare_mesh_change();
    void
    finish_mesh_change();

    /** Memory of the arrays, bytes. */
    std::size_t
    memory_consumption() const;

    dealii::Particles::ParticleHandler<dim> handler;

  private:
    void
    write_back();
    void
    hand_over();
    bool
    is_carried() const;
    void
    gather();
    void
    resize(std::size_t n);

    const BackgroundGrid<dim> &grid;
    const PointLayout          layout;
    const unsigned int         n_fields;     // arrays
    const unsigned int         n_properties; // doubles in the handler

    const unsigned int first_carried; // property

    // Position, velocity, mass, pressure, deviator, history, affine part. The
    // properties of the handler are the reference position, if asked for, and
    // then, where there are several ranks, the same without the position.
    std::vector<std::vector<double>> fields;
    std::vector<std::uint32_t>       cell;
    std::vector<std::uint32_t>       handle; // slot in the handler's pool
    std::vector<std::uint32_t>       lost_handles;
    std::vector<std::uint32_t>       offset;        // per cell, for sorting
    std::vector<double>              seeded_masses; // until finish_adding()
    unsigned long                    n_reorderings = 0;
  };
} // namespace limber

#endif
