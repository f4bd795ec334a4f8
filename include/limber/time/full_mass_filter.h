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
   * The filtered nodal velocity of FMPM(k) and XPIC(k), by an approximate
   * inverse of the consistent (full) mass matrix. With the lumped mass
   * v = p / m is too smooth: interpolated to the points (S) and mapped back
   * (S^T M) it becomes M_full v = S^T M S v, which is not p. The velocity v(k)
   * comes from k - 1 steps of Richardson's iteration for M_full v = p,
   *
   *   v(1) = D^-1 p,  v(j + 1) = v(j) + D^-1 (p - M_full v(j)),
   *
   * the first k terms of the Neumann series of the inverse. So waves of some
   * cells keep their amplitude in v <- S v(k), while null-space motion of the
   * points is gone after one step. Components held by sides are not changed.
   *
   * D is the lumped mass. Next to a side that holds a component, splines have
   * that of mirrored material: the mass of the held node, or a part of it
   * (NodeTable::inward_share), joins that of its neighbour inward. Without it
   * the first guess would be poor there: with quadratic splines p / m of a
   * linear field is 3/4 instead of 1/2 a cell from the side.
   *
   * Bodies with nodal fields of their own are filtered separately. In active
   * contacts each v(j) is constrained as the new velocity has been: with the
   * projection P on what contact allows, v(j + 1) - v(j) is
   * P (1 - D^-1 M_full) times the change before, the series of the constrained
   * inverse.
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

    /** State that note_forces() of the next step needs, for checkpoints;
     * gathered from all ranks on the first. Collective. */
    std::vector<FilteredNode<dim>>
    filtered_nodes() const;

    /** Restore this state, also on other ranks with other nodes. */
    void
    restore(const std::vector<FilteredNode<dim>> &former);

    /** Reaction of sides at owned nodes that they hold against the filter. */
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

    /** Constrain a velocity, at a slot of the records of all fields, by the
     * active contacts; see Contact::hold(). */
    using Hold = std::function<void(unsigned int slot)>;

    /**
     * Store the forces of stress and gravity, before others are added, and
     * return their power, W, on the difference between the velocity that
     * strained the points in the step before and the one mapped from them now.
     */
    double
    note_forces(NodalFields<dim> &nodes, const dealii::Tensor<1, dim> &gravity);

    /** Kinetic energy gained by the nodes of this rank in the step, J. */
    double
    energy_of_step(NodalFields<dim> &nodes);

    /** Power, W, of the stored forces on the velocity of the nodes of this
     * rank. */
    double
    power(NodalFields<dim> &nodes);

    /**
     * Replace the new velocity of active nodes by v(@p order), or, with
     * @p former_only (XPIC), by the filtered velocity before the step plus the
     * increment of the step. @p hold, if not empty, constrains every v(j) by
     * contact, and Layout::remapped is overwritten. Collective.
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

    // Records and vectors of the selected field
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

    /** Mass of a held node that is added to D of its neighbour inward in these
     * directions, kg. */
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

    /** See BoundaryConditions::held(); zero for nodes inside the box. */
    std::array<unsigned int, dim>
    held(const NodalFields<dim> &nodes, const std::uint32_t node) const
    {
      return table.sides[node] ? boundaries.held(nodes, node) :
                                 std::array<unsigned int, dim>{};
    }

    /** Component of the momentum p that is filtered: new, or before the step.
     */
    double
    momentum(const double *own, int d) const
    {
      return own[Layout::mass] * (own[Layout::velocity + d] - apart(own, d));
    }

    /** Part of the new velocity that is not filtered (XPIC: the increment),
     * m/s. */
    double
    apart(const double *own, int d) const
    {
      return former ? own[Layout::increment + d] : 0;
    }

    // Records in the nodes' layout: v(j) is at Layout::velocity, M_full v(j) at
    // Layout::remapped
    struct Field
    {
      LazyArray<double> records;
      LazyArray<double> lumped;   // D, by node and component, kg
      LazyArray<double> force;    // stored by note_forces(), likewise, N
      LazyArray<double> filtered; // last step in which a node was filtered
    };

    const BackgroundGrid<dim>       &grid;
    const NodeTable<dim>            &table;
    const BoundaryConditions<dim>   &boundaries;
    bool                             former = false;
    std::vector<Field>               fields;
    unsigned int                     field = 0; // the selected one
    double                           step  = 1; // number, of the stored forces
    RecordExchange                   exchange{Layout::stride};
    std::vector<std::vector<double>> on_points; // S v(j); buffer
  };
} // namespace limber

#endif
