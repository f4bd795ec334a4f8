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
    /** Impulse of a side on a node (kg m/s) and its work (J). */
    using Account = std::function<
      void(unsigned int side, const dealii::Tensor<1, dim> &, double work)>;

    explicit BoundaryConditions(const Sides<dim> &sides);

    /**
     * Change the new velocity of the nodes, and their increment with it, so
     * that points near a side receive its impulse. Owned nodes are accounted
     * for.
     */
    void
    apply(NodalFields<dim> &nodes, double time, const Account &account);

    /**
     * Change the velocity that begins at @p slot of the records
     * likewise; impulses of such a trial velocity do not reach the points. A
     * node that sticks to a side with friction, given its new velocity, sticks
     * here too.
     */
    void
    apply_trial(NodalFields<dim> &nodes, unsigned int slot, double time);

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

    const Sides<dim>    &sides;
    SideConstraints<dim> constraints;
  };
} // namespace limber

#endif
