// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_side_constraints_h
#define limber_grid_side_constraints_h

#include <limber/grid/nodal_fields.h>
#include <limber/problem/side_conditions.h>

#include <vector>

namespace limber
{
  /** A component of the velocity of a node that a side of the box holds. */
  struct Constraint
  {
    std::uint32_t node; // local number
    std::uint8_t  component, side;
    bool          one_sided; // only against motion outward, see Side
    double        value;     // m/s
  };



  /**
   * The constraints that the sides of the box lay on the active nodes, as a
   * list: those of a node follow each other in the order in which its sides
   * act, so that of several for one component the last counts. The list is
   * made anew only when nodes have become active or inactive, and its values
   * only at another time.
   */
  template <int dim>
  class SideConstraints
  {
  public:
    explicit SideConstraints(const Sides<dim> &sides);

    /** All of active nodes, owned and ghost, at @p time, s. */
    const std::vector<Constraint> &
    at(const NodalFields<dim> &nodes, double time);

    /** What the sides that a node lies in hold, in the same order. */
    const std::vector<HeldComponent> &
    of_sides(const std::uint8_t set) const
    {
      return held[set];
    }

  private:
    void
    rebuild(const NodalFields<dim> &nodes);
    void
    evaluate(const NodalFields<dim> &nodes, double time);

    const Sides<dim>                                      &sides;
    std::array<std::vector<HeldComponent>, 1 << (2 * dim)> held; // by sets
    std::vector<Constraint>                                list;
    std::vector<std::size_t> moving;      // of them: those with a formula
    std::uint64_t            version = 0; // of the active nodes in the list
    double                   time_of_values = 0; // s
    bool                     has_values     = false;
  };
} // namespace limber

#endif
