// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_nodal_fields_h
#define limber_grid_nodal_fields_h

#include <limber/base/lazy_array.h>
#include <limber/grid/background_grid.h>

#include <memory>

namespace limber
{
  /**
   * The records of all nodes (NodeLayout), owned and ghost, and the cells and
   * nodes that take part in a step. Sweeps reach both through view();
   * communication and hanging nodes are dealt with here. What is done to an
   * active node every rank that holds it does alike, from the same sums.
   */
  template <int dim>
  class NodalFields
  {
  public:
    using Layout = NodeLayout<dim>;

    /** Of the nodes of the grid's kernel. */
    explicit NodalFields(const BackgroundGrid<dim> &grid);

    /**
     * Have @p n records for each node, one for each group of bodies that may
     * part from the others: fields. All of them have the same active nodes.
     */
    void
    set_n_fields(unsigned int n);
    unsigned int
    n_fields() const
    {
      return parked.size();
    }

    /** Let view(), record() and sums speak of a field, until told otherwise. */
    void
    select(unsigned int field);
    unsigned int
    selected_field() const
    {
      return selected;
    }

    /** Call work() with each field selected; the first remains it. */
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

    /** The same of a field, whichever is selected. */
    GridView<dim>
    view(unsigned int field);

    /**
     * Make these cells the occupied ones (local numbers, sorted), and those
     * that ranks have agreed on, whether they still hold points or not. With
     * @p agree, collective, they agree first.
     */
    void
    set_occupied(std::vector<std::uint32_t> &&cells, bool agree = false);

    /** Let cells that points have entered since take part. */
    void
    add_entered();

    /**
     * Let ranks agree on the nodes and cells that they have to sum up for
     * each other while their points are in the cells that are occupied now;
     * collective. Without it they sum up all that they share.
     */
    void
    agree_on_sums();

    /**
     * The vertices of the same cells, for means around them and for what else
     * is linear in a cell: the object itself where the kernel is linear.
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

    /** Whether points have entered cells that such an agreement lacks. */
    bool
    has_entered_shared() const;

    /** Owned cells that may hold points of this rank or of others. */
    const std::vector<std::uint32_t> &
    owned_occupied_cells() const
    {
      return occupied_owned;
    }

    /** Ghost cells that may. */
    const std::vector<std::uint32_t> &
    ghost_occupied_cells() const
    {
      return occupied_ghost;
    }

    /** What travels between ranks when nodes, or cells, are summed up. */
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
     * Complete the sums over points in slots [first, last) of the records:
     * hand those of hanging nodes to their masters, send to other ranks, and
     * add what they send. Between start and finish these slots must not
     * change.
     */
    void
    start_sum(unsigned int first = 0, unsigned int last = Layout::stride);
    void
    finish_sum();

    /** Give hanging nodes the values that follow from their masters. */
    void
    interpolate_hanging();

    /** Let hanging nodes show the mass of their lightest master, as what is
     * light moves as it likes, until it is taken from them again. */
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

    /** Those of them that lie on a side of the box. */
    const std::vector<std::uint32_t> &
    active_boundary_nodes() const
    {
      return active_boundary;
    }

    /**
     * Where there are several fields: tell which cells hold points of which.
     * Call begin_noting() after points have given to the nodes, then
     * note_cell() for each cell with points of a field; what is known already
     * need not be told again unless begin_noting() returns true. Hanging nodes
     * get what others have: with cells of several sizes nothing is noted.
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
     * Those active nodes that may have anything in the selected field. Of other
     * nodes the records of the field are zero.
     */
    const std::vector<std::uint32_t> &
    active_nodes_of_field() const
    {
      return is_noted ? of_fields[selected].nodes : active;
    }

    /** Those that may have mass in two fields. */
    const std::vector<std::uint32_t> &
    nodes_of_two_fields() const
    {
      return is_noted ? of_two_fields : active;
    }

    /** Another number whenever these lists have changed. */
    std::uint64_t
    version_of_active() const
    {
      return version;
    }

    /** Sums over the nodes of all ranks meet each node once, where this is. */
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

    /** Of a node, of all fields, kg. */
    double
    mass(const std::uint32_t node) const
    {
      double result = 0;
      for (unsigned int field = 0; field < n_fields(); ++field)
        result += record(field, node)[Layout::mass];
      return result;
    }

    /** Of a field, whichever is selected. */
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
    /** Where points of the bodies of a field are, or have been. */
    struct FieldPlaces
    {
      std::vector<std::uint32_t> cells, nodes;
      LazyArray<std::uint8_t>    has_cell, has_node;
    };

    bool
    notes_fields() const
    {
      return !of_fields.empty() && table.hanging.empty();
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

    // What a node has to do with other ranks, directly or through masters
    static constexpr std::uint8_t is_shared        = 1;
    static constexpr std::uint8_t is_of_owned_cell = 2;
    static constexpr std::uint8_t may_be_added_to  = 4; // as agreed

    LazyArray<double>              values; // of the selected field
    std::vector<LazyArray<double>> parked =
      std::vector<LazyArray<double>>(1); // of the others
    unsigned int               selected = 0;
    LazyArray<std::uint8_t>    roles; // of nodes
    RecordExchange             exchange{Layout::stride};
    ExchangePlan               nodes_to_share, cells_to_share;
    std::vector<std::uint32_t> border_cells; // with a node that is shared
    std::vector<std::uint32_t> with_own_points, occupied_owned, occupied_ghost;
    std::vector<std::uint32_t> entered, active, active_boundary;
    std::uint64_t              version = 0; // of the active nodes
    std::vector<FieldPlaces>   of_fields;   // where there are several
    std::vector<std::uint32_t> of_two_fields;
    std::uint64_t              noted_version = 0; // when shared nodes were
    bool                       is_noted      = false;
    LazyArray<std::uint8_t>    has_own_points, is_occupied, is_active;
    bool                       left = false, in_ghosts = false;

    std::unique_ptr<NodalFields> of_vertices; // where these are others
  };
} // namespace limber

#endif
