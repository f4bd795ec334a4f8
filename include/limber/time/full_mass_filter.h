// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_full_mass_filter_h
#define limber_time_full_mass_filter_h

#include <limber/grid/boundary_conditions.h>
#include <limber/state/material_body.h>
#include <limber/time/filtered_node.h>

#include <functional>
#include <vector>

namespace limber
{
  /**
   * The velocity of the nodes that points take with FMPM(k) and XPIC(k). With
   * the lumped mass v = p / m is too smooth: taken by the points (S) and given
   * back (S^T M) it returns as M_full v = S^T M S v, which is not p. The
   * velocity v(k) comes from k - 1 steps of Richardson's iteration towards
   * M_full v = p,
   *
   *   v(1) = D^-1 p,  v(j + 1) = v(j) + D^-1 (p - M_full v(j)),
   *
   * the first k terms of the series of the inverse. So waves of some cells keep
   * their amplitude in v <- S v(k), while what no node sees of the motion of
   * points is gone after one step. What sides hold stays as it is.
   *
   * D is the lumped mass. Next to a side that holds a component, splines have
   * that of mirrored material: the mass of the held node, or a part of it
   * (NodeTable::inward_share), joins that of its neighbour inward. Without it
   * the iteration would begin far off there, where p / m of a linear field is
   * 3/4 instead of 1/2 a cell from the side with quadratic splines.
   *
   * Bodies with nodal fields of their own are filtered apart from each other.
   * Where they press, each v(j) is held as the new velocity has been: with the
   * projection P on what contact allows v(j + 1) - v(j) is P (1 - D^-1 M_full)
   * times the change before, the series of the constrained inverse.
   *
   * (Nairn and Hammerquist, CMAME 380, 2021; Hammerquist and Nairn, CMAME 318,
   * 2017 for XPIC)
   */
  template <int dim>
  class FullMassFilter
  {
  public:
    FullMassFilter(const BackgroundGrid<dim>     &grid,
                   const BoundaryConditions<dim> &boundaries,
                   unsigned int                   n_fields);

    /** Adopt a changed mesh. */
    void
    reinit();

    /** What note_forces() of the next step needs to know of this one; of all
     * ranks, on the first. Collective. */
    std::vector<FilteredNode<dim>>
    filtered_nodes() const;

    /** Know it again; the ranks and their nodes may be others. */
    void
    restore(const std::vector<FilteredNode<dim>> &former);

    /** What sides do to owned nodes by holding them against the filter. */
    struct SideAction
    {
      std::array<dealii::Tensor<1, dim>, 2 * dim> impulse;  // kg m/s
      double                                      work = 0; // J

      void
      operator+=(const SideAction &other)
      {
        for (unsigned int side = 0; side < 2 * dim; ++side)
          impulse[side] += other.impulse[side];
        work += other.work;
      }
    };

    /** Hold a velocity, at a slot of the records of all fields, as contact
     * holds the new one. */
    using Hold = std::function<void(unsigned int slot)>;

    /**
     * Remember the forces of stress and gravity, before others join them, and
     * return their power, W, on the velocity by which the step before has
     * strained points, beyond that on what they bring of it.
     */
    double
    note_forces(NodalFields<dim> &nodes, const dealii::Tensor<1, dim> &gravity);

    /** What the nodes of this rank have gained of kinetic energy, J. */
    double
    energy_of_step(NodalFields<dim> &nodes);

    /** The power of these forces, W, on the velocity of the nodes of this rank.
     */
    double
    power(NodalFields<dim> &nodes);

    /**
     * Put v(@p order) in the place of the new velocity of active nodes or,
     * with @p former_only, that of the velocity before the step plus the
     * increment of the step. Between bodies that touch, @p hold acts on every
     * v(j); it may be empty. Overwrites Layout::remapped then. Collective.
     */
    SideAction
    apply(NodalFields<dim>                                &nodes,
          std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies,
          unsigned int                                     order,
          bool                                             former_only,
          const Hold                                      &hold);

  private:
    using Layout = NodeLayout<dim>;
    using Bodies = std::vector<std::unique_ptr<MaterialBody<dim>>>;

    void
    start(const NodalFields<dim> &nodes);
    void
    correct(const NodalFields<dim> &nodes);
    SideAction
    action_of_start(const NodalFields<dim> &nodes);
    SideAction
    action_until(const NodalFields<dim> &nodes);
    SideAction
    hold_as_new(NodalFields<dim> &nodes, const Hold &hold);
    void
    store(NodalFields<dim> &nodes);
    template <class Work>
    void
    for_each_held(const NodalFields<dim> &nodes, const Work &work) const;
    void
    add_impulse(SideAction   &action,
                std::uint32_t node,
                int           d,
                unsigned int  directions,
                double        impulse);
    void
    multiply_by_full_mass(NodalFields<dim> &nodes, Bodies &bodies);

    // Of the selected field
    double *
    record(const std::uint32_t node)
    {
      return fields[field].records.data() + std::size_t(node) * Layout::stride;
    }

    double *
    lumped_mass(const std::uint32_t node)
    {
      return fields[field].lumped.data() + std::size_t(node) * dim;
    }

    double *
    force(const std::uint32_t node)
    {
      return fields[field].force.data() + std::size_t(node) * dim;
    }

    /** Call work() with each field selected, here and in the nodes. */
    template <class Work>
    void
    for_each_field(NodalFields<dim> &nodes, const Work &work)
    {
      nodes.for_each_field([&]() {
        field = nodes.selected_field();
        work();
      });
    }

    /** What joins the lumped mass of the neighbour in these directions, kg. */
    double
    mass_inward(const NodalFields<dim> &nodes,
                const std::uint32_t     node,
                const unsigned int      directions) const
    {
      double result = nodes.record(node)[Layout::mass];
      for (int d = 0; d < dim; ++d)
        if (directions >> d & 1)
          result *= table.inward_share;
      return result;
    }

    /** See BoundaryConditions::held(); nothing holds nodes in the middle. */
    std::array<unsigned int, dim>
    held(const NodalFields<dim> &nodes, const std::uint32_t node) const
    {
      return table.sides[node] ? boundaries.held(nodes, node) :
                                 std::array<unsigned int, dim>{};
    }

    /** p of a component, or of that before the step. */
    double
    momentum(const double *own, int d) const
    {
      return own[Layout::mass] * (own[Layout::velocity + d] - apart(own, d));
    }

    /** What is not filtered of the new velocity, m/s. */
    double
    apart(const double *own, int d) const
    {
      return former ? own[Layout::increment + d] : 0;
    }

    // As the nodes' own: v(j) is their velocity, M_full v(j) is re-mapped.
    struct Field
    {
      LazyArray<double> records;
      LazyArray<double> lumped;   // D, by node and component, kg
      LazyArray<double> force;    // that has been noted, the same way, N
      LazyArray<double> filtered; // in which step a node was, last
    };

    const BackgroundGrid<dim>       &grid;
    const NodeTable<dim>            &table;
    const BoundaryConditions<dim>   &boundaries;
    bool                             former = false;
    std::vector<Field>               fields;
    unsigned int                     field = 0; // the selected one
    double                           step  = 1; // whose forces are noted
    RecordExchange                   exchange{Layout::stride};
    std::vector<std::vector<double>> on_points; // velocities; refilled
  };
} // namespace limber

#endif
