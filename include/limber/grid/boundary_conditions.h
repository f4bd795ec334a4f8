// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_boundary_conditions_h
#define limber_grid_boundary_conditions_h

#include <limber/grid/side_constraints.h>

#include <functional>
#include <vector>

namespace limber
{
  /**
   * What the constraints of the sides (SideConstraints) do to nodes that an
   * explicit step has moved: one after another they change a velocity, and the
   * impulses that this takes are those of the sides.
   *
   * A one-sided constraint holds a node that would move outward with its new
   * velocity, and lets all others go; where it holds, it bears friction. The
   * same nodes are held or let go in every other velocity of the step. Were a
   * velocity that strains points only kept from going outward, noise about
   * zero would press them together and create energy.
   */
  template <int dim>
  class BoundaryConditions
  {
  public:
    /** What a side does to a node. */
    struct Action
    {
      dealii::Tensor<1, dim> impulse;           // on the points, kg m/s
      double                 work          = 0; // J, as if they were FLIP's
      double                 transfer_work = 0; // J, what it does beyond that
      double                 friction      = 0; // J, heat, not in work
      double                 loss          = 0; // J, of what lands on it
    };

    using Account = std::function<void(unsigned int side, const Action &)>;

    /** What sides have to know of a step. */
    struct Step
    {
      double begin, end; // time, s
      // Of the change of velocity that points take; the rest is new velocity
      double flip_share = 1;
      // Whether points stay with the sides that always hold them: see apply()
      bool keeps_points = false;
    };

    /**
     * On the nodes of fields for which @p by_surface is true, those sides do
     * not act that meet surfaces (Side), by number of the field; none by
     * default. Nor do those that are @p covered, which may be null.
     */
    explicit BoundaryConditions(const Sides<dim>        &sides,
                                const std::vector<bool> &by_surface = {},
                                const CoveredSides<dim> *covered    = nullptr);

    BoundaryConditions(const BoundaryConditions &) = delete;
    BoundaryConditions &
    operator=(const BoundaryConditions &) = delete;

    /**
     * Change the new velocity of the nodes, and their increment with it, so
     * that points near a side receive its impulse. Owned nodes are accounted
     * for.
     *
     * What points bring to the node against a side is taken from them, as in an
     * impact. In every step that costs energy, as the nodes next to it bring it
     * anew. Points that a side keeps, since they stay with it, are let alone:
     * their increment is that of the velocity of the side.
     */
    void
    apply(NodalFields<dim> &nodes, const Step &step, const Account &account);

    /** What a velocity is for that apply() does not know. */
    enum class Trial
    {
      strain_before, // of points, by what they bring; there is no new one yet
      strain_after,  // of points, once there is
      motion         // of points; nothing may go through a side
    };

    /**
     * Hold the velocity that begins at @p slot of the records as apply() has
     * held, or at the beginning of a @p step (s) is going to hold, the new one:
     * of (p + dt f) / m, with the force f in the records. Its impulses do not
     * reach the points.
     */
    void
    apply_trial(NodalFields<dim> &nodes,
                unsigned int      slot,
                double            time,
                Trial             kind,
                double            step = 0);

    /**
     * Losses and heat of friction, J, beyond what apply() has accounted for,
     * where points have given back the velocity that begins at @p slot, before
     * sides are applied to it: held nodes of this rank do not strain with it.
     * To be counted by the share of FLIP.
     */
    Action
    action_on_remapped(const NodalFields<dim> &nodes, unsigned int slot) const;

    /** Whether any side lets nodes go that it acts on. */
    bool
    any_one_sided() const
    {
      return one_sided;
    }

    using Hold = std::function<
      void(std::uint32_t node, unsigned int component, double value)>;

    /**
     * The components of new velocities that sides hold at @p time, and the
     * velocities of the sides, m/s; of several for a component the last one
     * counts. One-sided constraints hold what does not leave the side.
     */
    void
    for_each_held(const NodalFields<dim> &nodes, double time, const Hold &hold);

    using Visit = std::function<void(std::uint32_t     node,
                                     const Constraint *first,
                                     const Constraint *last)>;

    /** Nodes with mass and their constraints at @p time, in the order in which
     * these act. */
    void
    for_each_constrained(const NodalFields<dim> &nodes,
                         double                  time,
                         const Visit            &visit);

    /** What constraints of a node make of its new velocity, m/s. */
    dealii::Tensor<1, dim>
    constrained(const Constraint      *first,
                const Constraint      *last,
                dealii::Tensor<1, dim> velocity) const;

    /**
     * For each component of the new velocity of a node the directions (bits)
     * in which a side holds it, so that nothing may change it. Sides with
     * friction hold what they have brought to rest.
     */
    std::array<unsigned int, dim>
    held(const NodalFields<dim> &nodes, std::uint32_t node) const;

  private:
    using Velocity = dealii::Tensor<1, dim>;
    // That changed each component of the velocity of a node
    using LastSides = std::array<unsigned int, dim>;

    /** Which of the constraints act on the selected field. */
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

    /** The impulse of friction on an owned node that goes on sliding. */
    struct Rubbing
    {
      std::uint32_t node;
      const double *record; // of the field that it is of
      Velocity      impulse;
    };

    const Sides<dim>       &sides;
    const Sides<dim>        others; // those that meet surfaces are free
    const std::vector<bool> by_surface;
    std::array<SideConstraints<dim>, 2> constraints; // of all, of others
    std::vector<Rubbing>                rubbing;     // of the present step
    const bool one_sided; // any side, of the nodes of any field
  };
} // namespace limber

#endif
