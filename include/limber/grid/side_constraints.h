// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_side_constraints_h
#define limber_grid_side_constraints_h

#include <limber/grid/covered_sides.h>
#include <limber/grid/nodal_fields.h>
#include <limber/problem/side_conditions.h>

#include <vector>

namespace limber
{
  /** A velocity component of a node that a side of the box prescribes. */
  struct Constraint
  {
    std::uint32_t node; // local number
    std::uint8_t  component, side;
    bool          one_sided; // only against outward motion, see Side
    double        value;     // m/s
  };



  /**
   * The constraints of the sides of the box on the active nodes, as a list:
   * those of a node are consecutive, in the order in which its sides act, so
   * that the last one for a component counts. The list is rebuilt only when
   * active nodes change or obstacles that cover sides have moved, its values
   * when the time changes.
   */
  template <int dim>
  class SideConstraints
  {
  public:
    /** @p covered must outlive this object; null: no side can be covered. */
    explicit SideConstraints(const Sides<dim>        &sides,
                             const CoveredSides<dim> *covered = nullptr);

    /** All of active nodes, owned and ghost, at @p time, s. */
    const std::vector<Constraint> &
    at(const NodalFields<dim> &nodes, double time);

    /** The components held by a set of sides, in the same order. */
    const std::vector<HeldComponent> &
    of_sides(const std::uint8_t set) const
    {
      return held[set];
    }

    /** The same for a node, without sides covered by obstacles. */
    const std::vector<HeldComponent> &
    of_node(const NodalFields<dim> &nodes, std::uint32_t node) const;

  private:
    void
    rebuild(const NodalFields<dim> &nodes);
    void
    evaluate(const NodalFields<dim> &nodes, double time);

    const Sides<dim>                                      &sides;
    const CoveredSides<dim> *const                         covered; // or null
    std::array<std::vector<HeldComponent>, 1 << (2 * dim)> held;    // by set
    std::vector<Constraint>                                list;
    std::vector<std::size_t> moving;      // indices of those with a formula
    std::uint64_t            version = 0; // of the active nodes in the list
    std::uint64_t            version_of_covered = 0;
    double                   time_of_values     = 0; // s
    bool                     has_values         = false;
  };
} // namespace limber

#endif
