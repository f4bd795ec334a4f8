// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_boundary_conditions_h
#define limber_grid_boundary_conditions_h

#include <limber/grid/nodal_fields.h>

#include <functional>

namespace limber
{
  /**
   * What the sides of the box do to the velocity of their nodes:
   *  - free: nothing; points may leave;
   *  - slip: the normal velocity is zero;
   *  - no slip: the velocity is zero;
   *  - friction: the normal velocity is not outward, and a contact impulse
   *    J_n bears a tangential one of at most the friction coefficient times
   *    J_n against the motion (Coulomb); the material may part from the side;
   *  - velocity: a formula of place and time.
   * Where sides meet they act one after the other, in deal.II's order.
   */
  template <int dim>
  class BoundaryConditions
  {
  public:
    /** Impulse of a side on a node (kg m/s) and its work (J). */
    using Account = std::function<
      void(unsigned int side, const dealii::Tensor<1, dim> &, double work)>;

    explicit BoundaryConditions(const std::array<Side<dim>, 2 * dim> &sides);

    /**
     * Change the new velocity of the nodes, and their increment with it, so
     * that points near a side receive its impulse. Owned nodes are accounted
     * for.
     */
    void
    apply(NodalFields<dim> &nodes, double time, const Account &account) const;

    /**
     * Change the velocity that begins at slot @p first of the records
     * likewise; impulses of such a trial velocity do not reach the points. A
     * node that sticks to a side with friction, given its new velocity, sticks
     * here too.
     */
    void
    apply_trial(NodalFields<dim> &nodes, unsigned int first, double time) const;

    /**
     * For each component of the new velocity of a node the directions (bits)
     * in which a side holds it, so that nothing may change it. Sides with
     * friction hold what they have brought to rest.
     */
    std::array<unsigned int, dim>
    held(const NodalFields<dim> &nodes, std::uint32_t node) const;

  private:
    bool
    act(unsigned int                  side,
        const NodeTable<dim>         &nodes,
        std::uint32_t                 node,
        double                        time,
        dealii::Tensor<1, dim>       &velocity,
        const dealii::Tensor<1, dim> *sticking) const;

    const std::array<Side<dim>, 2 * dim> &sides;
  };
} // namespace limber

#endif
