// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_nodal_fields_h
#define limber_grid_nodal_fields_h

#include <limber/base/lazy_array.h>
#include <limber/grid/background_grid.h>

#include <memory>

namespace limber
{
  /**
   * The records of all nodes (NodeLayout), owned and ghost, and the active
   * cells and nodes of a step. Sweeps access both through view(); communication
   * and hanging nodes are dealt with here. Every rank that holds an active node
   * does the same operations on it, from the same sums.
   */
  template <int dim>
  class NodalFields
  {
  public:
    using Layout = NodeLayout<dim>;

    /** For the nodes of the kernel of the grid. */
    explicit NodalFields(const BackgroundGrid<dim> &grid);

    /**
     * Have @p n nodal fields, one for each group of bodies that may separate
     * (contact): @p n records per node. All fields have the same active nodes.
     */
    void
    set_n_fields(unsigned int n);
    unsigned int
    n_fields() const
    {
      return parked.size();
    }

    /** Select the field that view(), record() and sums refer to. */
    void
    select(unsigned int field);
    unsigned int
    selected_field() const
    {
      return selected;
    }

    /** Call work() with each field selected; the first remains selected. */
    template <class Work>
    void
    for_each_field(const Work &work)
    {
      for (unsigned int field = n_fields(); field-- > 0;)
        {
          select(field);
          work();
        }
    }

    /** Adopt a changed mesh: all records zero, nothing active. */
    void
    reinit();

    GridView<dim>
    view();

    /** The same for a given field. */
    GridView<dim>
    view(unsigned int field);

    /**
     * Set the occupied cells (local numbers, sorted), plus those that ranks
     * have agreed on, which may be empty. With @p agree, collective, they agree
     * first.
     */
    void
    set_occupied(std::vector<std::uint32_t> &&cells, bool agree = false);

    /** Activate the cells that points have entered since. */
    void
    add_entered();

    /**
     * Reduce communication: ranks agree on the nodes and cells that they have
     * to sum up for each other as long as points stay in the cells occupied
     * now; collective. Otherwise all shared ones are summed up.
     */
    void
    agree_on_sums();

    /**
     * The vertices of the same cells, for projections on nodes and other Q1
     * data; this object itself if the kernel is linear.
     */
    NodalFields &
    vertices()
    {
      return of_vertices ? *of_vertices : *this;
    }
    const NodalFields &
    vertices() const
    {
      return of_vertices ? *of_vertices : *this;
    }

    /** Whether points have entered ghost cells since clear(). */
    bool
    has_entered_ghosts() const
    {
      return in_ghosts;
    }

    /** Whether points have entered cells that the agreement does not cover. */
    bool
    has_entered_shared() const;

    /** Owned cells that may contain points of any rank. */
    const std::vector<std::uint32_t> &
    owned_occupied_cells() const
    {
      return occupied_owned;
    }

    /** Ghost cells that may contain points of any rank. */
    const std::vector<std::uint32_t> &
    ghost_occupied_cells() const
    {
      return occupied_ghost;
    }

    /** What ranks exchange when nodes, or cells, are summed up. */
    const ExchangePlan &
    node_plan() const
    {
      return nodes_to_share;
    }
    const ExchangePlan &
    cell_plan() const
    {
      return cells_to_share;
    }

    /** Whether points have left the cells of this rank since clear(). */
    bool
    points_have_left() const
    {
      return left;
    }

    /** Set the records of all active nodes to zero, in all fields. */
    void
    clear();

    /**
     * Complete the P2G sums in slots [first, last): add hanging nodes to their
     * masters, and sum up over ranks. These slots must not change between start
     * and finish.
     */
    void
    start_sum(unsigned int first = 0, unsigned int last = Layout::stride);
    void
    finish_sum();

    /** Set the values of hanging nodes from those of their masters. */
    void
    interpolate_hanging();

    /**
     * Give hanging nodes temporarily the mass of their lightest master, for
     * what depends on whether nodes are light.
     */
    void
    lend_mass_to_hanging();
    void
    take_mass_from_hanging();

    /** Active nodes, owned and ghost, by local number. */
    const std::vector<std::uint32_t> &
    active_nodes() const
    {
      return active;
    }

    /** Active nodes on a side of the box. */
    const std::vector<std::uint32_t> &
    active_boundary_nodes() const
    {
      return active_boundary;
    }

    /**
     * With several fields: register which cells contain points of which. Call
     * begin_noting() after P2G, then note_cell() for each cell with points of a
     * field; known cells need not be repeated unless begin_noting() returns
     * true. Not used with hanging nodes, nor with domains of points, which
     * reach into cells that these are not in.
     */
    bool
    begin_noting();
    void
    note_cell(const unsigned int field, const std::uint32_t cell)
    {
      if (notes_fields() && !of_fields[field].has_cell[cell])
        add_cell(field, cell);
    }

    /**
     * Active nodes that may have mass in the selected field; at others its
     * records are zero.
     */
    const std::vector<std::uint32_t> &
    active_nodes_of_field() const
    {
      return is_noted ? of_fields[selected].nodes : active;
    }

    /** Active nodes that may have mass in two fields (contact). */
    const std::vector<std::uint32_t> &
    nodes_of_two_fields() const
    {
      return is_noted ? of_two_fields : active;
    }

    /** Changes whenever these lists change. */
    std::uint64_t
    version_of_active() const
    {
      return version;
    }

    /**
     * Whether this rank owns the node; sums over all ranks count owned nodes.
     */
    bool
    owns(const std::uint32_t node) const
    {
      return node < table.n_owned;
    }

    double *
    record(const std::uint32_t node)
    {
      return values.data() + std::size_t(node) * Layout::stride;
    }

    const double *
    record(const std::uint32_t node) const
    {
      return values.data() + std::size_t(node) * Layout::stride;
    }

    /** Mass of a node in all fields, kg. */
    double
    mass(const std::uint32_t node) const
    {
      double result = 0;
      for (unsigned int field = 0; field < n_fields(); ++field)
        result += record(field, node)[Layout::mass];
      return result;
    }

    /** The record in a given field. */
    double *
    record(const unsigned int field, const std::uint32_t node)
    {
      return of_field(field).data() + std::size_t(node) * Layout::stride;
    }

    const double *
    record(const unsigned int field, const std::uint32_t node) const
    {
      return (field == selected ? values : parked[field]).data() +
             std::size_t(node) * Layout::stride;
    }

    const BackgroundGrid<dim> &grid;
    const NodeTable<dim>      &table;

  private:
    /** Cells and nodes that points of a field occupy or have occupied. */
    struct FieldPlaces
    {
      std::vector<std::uint32_t> cells, nodes;
      LazyArray<std::uint8_t>    has_cell, has_node;
    };

    bool
    notes_fields() const
    {
      return !of_fields.empty() && table.hanging.empty() &&
             !has_domains(grid.description.kernel);
    }

    void
    add_cell(unsigned int field, std::uint32_t cell);
    void
    add_node(unsigned int field, std::uint32_t node);
    void
    forget_fields();

    LazyArray<double> &
    of_field(const unsigned int field)
    {
      return field == selected ? values : parked[field];
    }

    NodalFields(const BackgroundGrid<dim> &grid, const NodeTable<dim> &table);

    template <class Work>
    void
    for_each_node(std::uint32_t cell, const Work &work) const;
    void
    set_entered(const std::vector<std::uint32_t> &cells);
    void
    activate(std::uint32_t cell);
    void
    activate_node(std::uint32_t node);
    void
    activate_masters();
    void
    activate_agreed();

    bool
    is_at_border(std::uint32_t cell) const;
    void
    plan_sums();
    void
    find_roles();

    // How other ranks may contribute to a node, directly or via hanging nodes
    static constexpr std::uint8_t is_shared        = 1;
    static constexpr std::uint8_t is_of_owned_cell = 2;
    static constexpr std::uint8_t may_be_added_to  = 4; // as agreed on

    LazyArray<double>              values; // of the selected field
    std::vector<LazyArray<double>> parked =
      std::vector<LazyArray<double>>(1); // of the other fields
    unsigned int               selected = 0;
    LazyArray<std::uint8_t>    roles; // of nodes
    RecordExchange             exchange{Layout::stride};
    ExchangePlan               nodes_to_share, cells_to_share;
    std::vector<std::uint32_t> border_cells; // with a shared node
    std::vector<std::uint32_t> with_own_points, occupied_owned, occupied_ghost;
    std::vector<std::uint32_t> entered, active, active_boundary;
    std::uint64_t              version = 0; // of the active nodes
    std::vector<FieldPlaces>   of_fields;   // if there are several
    std::vector<std::uint32_t> of_two_fields;
    std::uint64_t              noted_version = 0; // at the last begin_noting()
    bool                       is_noted      = false;
    LazyArray<std::uint8_t>    has_own_points, is_occupied, is_active;
    bool                       left = false, in_ghosts = false;

    std::unique_ptr<NodalFields> of_vertices; // unless the kernel is linear
  };
} // namespace limber

#endif
