// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_nodal_fields_h
#define limber_grid_nodal_fields_h

#include <deal.II/lac/la_parallel_vector.h>

#include <limber/grid/background_grid.h>

namespace limber
{
  /**
   * The records of all nodes (NodeLayout) in one distributed vector, and the
   * cells and nodes that take part in a step. Sweeps reach both through
   * view(); communication and hanging nodes are dealt with here.
   */
  template <int dim>
  class NodalFields
  {
  public:
    using Layout = NodeLayout<dim>;

    explicit NodalFields(const BackgroundGrid<dim> &grid);

    /** Adopt a changed mesh: all records zero, nothing active. */
    void
    reinit();

    GridView<dim>
    view();

    /** Make exactly these cells the occupied ones (local numbers, sorted). */
    void
    set_occupied(std::vector<std::uint32_t> &&cells);

    /** Let cells that points have entered since take part. */
    void
    add_entered();

    /**
     * Cells that may hold points, here or, for owned cells next to other
     * ranks, there.
     */
    const std::vector<std::uint32_t> &
    occupied_cells() const
    {
      return occupied;
    }

    /** Those of them that this rank owns. */
    const std::vector<std::uint32_t> &
    owned_occupied_cells() const
    {
      return occupied_owned;
    }

    /** Whether points have left the cells of this rank since clear(). */
    bool
    points_have_left() const
    {
      return left;
    }

    /** Set the records of all active nodes to zero. */
    void
    clear();

    /**
     * Complete the sums over points in slots [first, last) of the records:
     * hand those of hanging nodes to their masters and add what other ranks
     * have contributed. Other slots stay on the owners.
     */
    void
    sum_shared(unsigned int first = 0, unsigned int last = Layout::stride);

    /**
     * Give other ranks, and hanging nodes, the values of their nodes. Between
     * start and end other messages may be under way.
     */
    void
    start_share();
    void
    end_share();

    /** Records of active nodes that this rank owns, by local number. */
    const std::vector<std::uint32_t> &
    active_nodes() const
    {
      return active_owned;
    }

    /** Those of them that lie on a side of the box. */
    const std::vector<std::uint32_t> &
    active_boundary_nodes() const
    {
      return active_boundary;
    }

    double *
    record(const std::uint32_t node)
    {
      return values.begin() + std::size_t(node) * Layout::stride;
    }

    const double *
    record(const std::uint32_t node) const
    {
      return values.begin() + std::size_t(node) * Layout::stride;
    }

    const BackgroundGrid<dim> &grid;

  private:
    void
    activate(std::uint32_t cell);

    dealii::LinearAlgebra::distributed::Vector<double> values;

    std::vector<std::uint32_t> occupied, occupied_owned, entered;
    std::vector<std::uint8_t>  is_occupied, is_active;
    std::vector<std::uint32_t> active_owned, active_boundary;
    bool                       parallel = false;
    bool                       left     = false;
  };



  /**
   * The sums of one body in each cell (CellSums), in distributed vectors over
   * DGQ0: those of the present places of the points, complete on every rank
   * that knows the cell, and those of the next places, which sweeps gather.
   */
  template <int dim>
  class CellFields
  {
  public:
    explicit CellFields(const BackgroundGrid<dim> &grid);

    void
    reinit();

    CellSums<dim>
    view();

    /** The sums of the present places. */
    const double *
    record(const std::uint32_t cell) const
    {
      return now.begin() + std::size_t(cell) * CellSums<dim>::stride;
    }

    /**
     * Complete the sums gathered since the last time with those of other
     * ranks and make them the present ones. Then clear the next ones of the
     * given cells, which are all that may have been touched, for the next
     * gathering.
     */
    void
    complete(const std::vector<std::uint32_t> &cells);

  private:
    const BackgroundGrid<dim>                         &grid;
    dealii::LinearAlgebra::distributed::Vector<double> now, next;
    bool                                               parallel = false;
  };
} // namespace limber

#endif
