// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_boundary_conditions_h
#define limber_grid_boundary_conditions_h

#include <limber/grid/side_constraints.h>

#include <functional>
#include <vector>

namespace limber
{
  /**
   * Applies the constraints of the sides (SideConstraints) to the nodes after
   * an explicit step: one after another they change the velocity, and the
   * impulses of these changes are those of the sides.
   *
   * A one-sided constraint holds a node whose new velocity is outward, and lets
   * all others go; where it holds, friction acts. The same nodes are held in
   * every other velocity of the step: if velocities that strain points were
   * merely clipped to be not outward, noise about zero would be rectified,
   * compress the points and create energy.
   */
  template <int dim>
  class BoundaryConditions
  {
  public:
    /** Impulse and energy balance of a side at a node. */
    struct Action
    {
      dealii::Tensor<1, dim> impulse;           // on the points, kg m/s
      double                 work          = 0; // J, for FLIP points
      double                 transfer_work = 0; // J, more, for the PIC share
      double                 friction      = 0; // J, heat, not in work
      double                 loss          = 0; // J, in impact on the side
    };

    using Account = std::function<void(unsigned int side, const Action &)>;

    /** What sides need to know of a step. */
    struct Step
    {
      double begin, end; // time, s
      // FLIP share; the rest of the velocity of points is PIC
      double flip_share = 1;
      // Whether points move with the sides that always hold them; see apply()
      bool keeps_points = false;
    };

    /**
     * On the nodes of fields (by number) for which @p by_surface is true, sides
     * that act at the surface of solids (Side) do not act; none by default. Nor
     * do sides that are @p covered by obstacles; this may be null.
     */
    explicit BoundaryConditions(const Sides<dim>        &sides,
                                const std::vector<bool> &by_surface = {},
                                const CoveredSides<dim> *covered    = nullptr);

    BoundaryConditions(const BoundaryConditions &) = delete;
    BoundaryConditions &
    operator=(const BoundaryConditions &) = delete;

    /**
     * Apply the constraints to the new velocity of the nodes, and to their
     * increment as well, so that points near a side get its impulse. Calls @p
     * account for owned nodes.
     *
     * The velocity that points bring to a node against a side is taken from
     * them, as in an impact; this costs energy in every step, as points of
     * neighbouring nodes bring it anew. Not so for points that are kept by a
     * side that they move with: their increment is that of the velocity of the
     * side.
     */
    void
    apply(NodalFields<dim> &nodes, const Step &step, const Account &account);

    /** The use of a velocity other than the new one of apply(). */
    enum class Trial
    {
      strain_before, // strain before the step; no new velocity yet
      strain_after,  // strain, once there is one
      motion         // motion of points; must not penetrate a side
    };

    /**
     * Constrain the velocity that begins at @p slot of the records at the same
     * nodes as apply() has held or, before a @p step (s), is going to hold for
     * the new velocity (p + dt f) / m, with the force f in the records. Points
     * do not get these impulses.
     */
    void
    apply_trial(NodalFields<dim> &nodes,
                unsigned int      slot,
                double            time,
                Trial             kind,
                double            step = 0);

    /**
     * Additional losses and heat of friction, J, beyond those accounted for by
     * apply(), if points have re-mapped the velocity that begins at @p slot
     * (before sides are applied to it), as owned held nodes do not strain with
     * it. To be multiplied by the FLIP share.
     */
    Action
    action_on_remapped(const NodalFields<dim> &nodes, unsigned int slot) const;

    /** Whether any side is one-sided. */
    bool
    any_one_sided() const
    {
      return one_sided;
    }

    using Hold = std::function<
      void(std::uint32_t node, unsigned int component, double value)>;

    /**
     * Call @p hold for the components of new velocities that sides hold at @p
     * time, with the velocities of the sides, m/s; if several hold a component
     * the last one counts. One-sided constraints hold unless the node leaves
     * the side.
     */
    void
    for_each_held(const NodalFields<dim> &nodes, double time, const Hold &hold);

    using Visit = std::function<void(std::uint32_t     node,
                                     const Constraint *first,
                                     const Constraint *last)>;

    /**
     * Visit nodes with mass and their constraints at @p time, in the order in
     * which these act.
     */
    void
    for_each_constrained(const NodalFields<dim> &nodes,
                         double                  time,
                         const Visit            &visit);

    /** The new velocity of a node after its constraints, m/s. */
    dealii::Tensor<1, dim>
    constrained(const Constraint      *first,
                const Constraint      *last,
                dealii::Tensor<1, dim> velocity) const;

    /**
     * For each component of the new velocity of a node the directions (bits) in
     * which a side holds it, so that it must not be changed. Sides with
     * friction hold nodes that stick.
     */
    std::array<unsigned int, dim>
    held(const NodalFields<dim> &nodes, std::uint32_t node) const;

  private:
    using Velocity = dealii::Tensor<1, dim>;
    // The last side that changed each component of the velocity of a node
    using LastSides = std::array<unsigned int, dim>;

    /** Index of the constraints that act on the selected field. */
    unsigned int
    of_field(const NodalFields<dim> &nodes) const
    {
      const unsigned int field = nodes.selected_field();
      return field < by_surface.size() && by_surface[field] ? 1 : 0;
    }

    template <class Work>
    void
    for_each_node(const NodalFields<dim> &nodes, double time, const Work &work);
    void
    act(const Constraint &constraint, Velocity &velocity) const;
    void
    act_trial(const Constraint &constraint,
              Trial             kind,
              const Velocity   &new_velocity,
              Velocity         &velocity) const;

    void
    note_rubbing(unsigned int    side,
                 std::uint32_t   node,
                 const double   *record,
                 Velocity        impulse,
                 const Velocity &velocity);
    Action
    action(unsigned int     side,
           const Velocity  &change,
           const Velocity  &former_change,
           const Velocity  &velocity,
           const Velocity  &increment,
           const LastSides &last_sides,
           double           mass,
           double           flip_share) const;

    /** Friction impulse on an owned node that slides. */
    struct Rubbing
    {
      std::uint32_t node;
      const double *record; // record in its field
      Velocity      impulse;
    };

    const Sides<dim>       &sides;
    const Sides<dim>        others; // without those that act by surface
    const std::vector<bool> by_surface;
    std::array<SideConstraints<dim>, 2> constraints; // of sides, of others
    std::vector<Rubbing>                rubbing;     // of this step
    const bool one_sided; // any side, for the nodes of any field
  };
} // namespace limber

#endif
