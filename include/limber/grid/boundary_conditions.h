// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_boundary_conditions_h
#define limber_grid_boundary_conditions_h

#include <limber/grid/side_constraints.h>

#include <functional>

namespace limber
{
  /**
   * What the constraints of the sides (SideConstraints) do to nodes that an
   * explicit step has moved: one after another they change a velocity, and the
   * impulses that this takes are those of the sides. A one-sided constraint
   * lets the material part, and bears friction.
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

    explicit BoundaryConditions(const Sides<dim> &sides);

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

    /**
     * Change the velocity that begins at @p slot of the records
     * likewise; impulses of such a trial velocity do not reach the points. A
     * node that sticks to a side with friction, given its new velocity, sticks
     * here too.
     */
    void
    apply_trial(NodalFields<dim> &nodes, unsigned int slot, double time);

    using Hold = std::function<
      void(std::uint32_t node, unsigned int component, double value)>;

    /**
     * The components of new velocities that sides hold at @p time, and the
     * velocities of the sides, m/s; of several for a component the last one
     * counts. One-sided constraints hold what does not leave the side.
     */
    void
    for_each_held(const NodalFields<dim> &nodes, double time, const Hold &hold);

    /**
     * For each component of the new velocity of a node the directions (bits)
     * in which a side holds it, so that nothing may change it. Sides with
     * friction hold what they have brought to rest.
     */
    std::array<unsigned int, dim>
    held(const NodalFields<dim> &nodes, std::uint32_t node) const;

  private:
    using Velocity = dealii::Tensor<1, dim>;

    template <class Work>
    void
    for_each_node(const NodalFields<dim> &nodes, double time, const Work &work);
    void
    act(const Constraint &constraint,
        Velocity         &velocity,
        const Velocity   *new_velocity) const;
    void
    act_one_sided(const Constraint &constraint,
                  Velocity         &velocity,
                  const Velocity   *new_velocity) const;

    static Action
    action(const Velocity &change,
           const Velocity &former_change,
           const Velocity &velocity,
           const Velocity &increment,
           double          mass,
           double          flip_share);

    const Sides<dim>    &sides;
    SideConstraints<dim> constraints;
  };
} // namespace limber

#endif
