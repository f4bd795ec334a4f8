// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_side_constraints_h
#define limber_grid_side_constraints_h

#include <limber/grid/covered_sides.h>
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
   * made anew only when nodes have become active or inactive or obstacles have
   * moved that cover sides, and its values only at another time.
   */
  template <int dim>
  class SideConstraints
  {
  public:
    /** @p covered outlives this object; null: no side can be. */
    explicit SideConstraints(const Sides<dim>        &sides,
                             const CoveredSides<dim> *covered = nullptr);

    /** All of active nodes, owned and ghost, at @p time, s. */
    const std::vector<Constraint> &
    at(const NodalFields<dim> &nodes, double time);

    /** What the sides that a node lies in hold, in the same order. */
    const std::vector<HeldComponent> &
    of_sides(const std::uint8_t set) const
    {
      return held[set];
    }

    /** The same of a node, less what obstacles have covered. */
    const std::vector<HeldComponent> &
    of_node(const NodalFields<dim> &nodes, std::uint32_t node) const;

  private:
    void
    rebuild(const NodalFields<dim> &nodes);
    void
    evaluate(const NodalFields<dim> &nodes, double time);

    const Sides<dim>                                      &sides;
    const CoveredSides<dim> *const                         covered; // or null
    std::array<std::vector<HeldComponent>, 1 << (2 * dim)> held;    // by sets
    std::vector<Constraint>                                list;
    std::vector<std::size_t> moving;      // of them: those with a formula
    std::uint64_t            version = 0; // of the active nodes in the list
    std::uint64_t            version_of_covered = 0;
    double                   time_of_values     = 0; // s
    bool                     has_values         = false;
  };
} // namespace limber

#endif
