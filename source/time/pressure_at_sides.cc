// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/node_vector.h>
#include <limber/time/pressure_system.h>

#include <algorithm>

/**
 * @file The equations of the implicit pressure at the sides of the box.
 * Components that they hold are removed from M^-1. One-sided sides hold only
 * nodes that press, and their friction depends on this force: both depend on
 * the pressures, so they are found by fixed-point iteration. A node that a side
 * held or let go against what the equations assumed would leave a divergence,
 * and this times the bulk modulus as an error of the pressure.
 */

namespace limber
{
  namespace
  {
    // Tolerance of the iteration: relative change of the friction at a node.
    constexpr double friction_known = 1e-6;
  } // namespace



  template <int dim>
  void
  PressureSystem<dim>::hold_by_sides(const double end)
  {
    const auto hold = [this](const std::uint32_t node,
                             const unsigned int  d,
                             const double        value) {
      mobility[std::size_t(node) * dim + d] = 0;
      velocity[std::size_t(node) * dim + d] = value;
    };
    for (const AtSide &one : at_sides)
      for (int d = 0; d < dim; ++d)
        if (one.holds(d))
          hold(one.node, d, 0);
        else
          velocity[std::size_t(one.node) * dim + d] += one.friction[d];
    boundaries.for_each_constrained(parts.nodes,
                                    end,
                                    [&](const std::uint32_t     node,
                                        const Constraint *const first,
                                        const Constraint *const last) {
                                      for (auto c = first; c != last; ++c)
                                        if (!c->one_sided)
                                          hold(node, c->component, c->value);
                                    });
  }



  // What one-sided sides do under the forces of all pressures. Nodes come in
  // the same order throughout a step: meet_sides() compares entry by entry.
  template <int dim>
  std::vector<typename PressureSystem<dim>::AtSide>
  PressureSystem<dim>::find_at_sides(const double end, const double step)
  {
    std::vector<AtSide> found;
    boundaries.for_each_constrained(
      parts.nodes,
      end,
      [&](const std::uint32_t     node,
          const Constraint *const first,
          const Constraint *const last) {
        if (std::none_of(first, last, [](const Constraint &constraint) {
              return constraint.one_sided;
            }))
          return;
        const double *const record = parts.nodes.record(node);
        const Vector        free   = vector_in<dim>(record + Layout::velocity) +
                            step / record[Layout::mass] *
                              vector_in<dim>(record + Layout::pressure_force);
        const Vector velocity = boundaries.constrained(first, last, free);
        found.push_back({node, 0, velocity - free});
        for (int d = 0; d < dim; ++d)
          if (velocity[d] == 0 && free[d] != 0)
            found.back().held |= 1u << d;
      });
    return found;
  }



  template <int dim>
  void
  PressureSystem<dim>::expect_at_sides(const double end, const double step)
  {
    at_sides = find_at_sides(end, step);
  }



  template <int dim>
  bool
  PressureSystem<dim>::meet_sides(const double end,
                                  const double step,
                                  const bool   may_release)
  {
    const std::vector<AtSide> former = at_sides;
    at_sides                         = find_at_sides(end, step);
    int is_new                       = 0;
    for (std::size_t k = 0; k < at_sides.size(); ++k)
      {
        AtSide       &now    = at_sides[k];
        const AtSide &before = former[k];
        if (!may_release)
          now.held |= before.held;
        const double known = friction_known * now.friction.norm();
        for (int d = 0; d < dim; ++d)
          if (now.holds(d) != before.holds(d) ||
              (!now.holds(d) &&
               std::abs(now.friction[d] - before.friction[d]) > known))
            is_new = 1;
      }
    return dealii::Utilities::MPI::max(is_new, parts.grid.communicator) > 0;
  }



  template void
  PressureSystem<2>::hold_by_sides(double);
  template std::vector<PressureSystem<2>::AtSide>
  PressureSystem<2>::find_at_sides(double, double);
  template void
  PressureSystem<2>::expect_at_sides(double, double);
  template bool
  PressureSystem<2>::meet_sides(double, double, bool);
  template void
  PressureSystem<3>::hold_by_sides(double);
  template std::vector<PressureSystem<3>::AtSide>
  PressureSystem<3>::find_at_sides(double, double);
  template void
  PressureSystem<3>::expect_at_sides(double, double);
  template bool
  PressureSystem<3>::meet_sides(double, double, bool);
} // namespace limber
