// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/node_vector.h>
#include <limber/time/contact.h>
#include <limber/time/contact_geometry.h>

#include <algorithm>

namespace limber
{
  template <int dim>
  unsigned int
  n_nodal_fields(const Problem<dim> &problem)
  {
    unsigned int result = 0;
    for (const Body<dim> &body : problem.bodies)
      result = std::max(result, body.nodal_field + 1);
    return result;
  }



  template <int dim>
  Contact<dim>::Contact(const RunParts<dim> &parts)
    : parts(parts)
    , n_fields(n_nodal_fields(parts.problem))
    , laws(n_fields * n_fields)
    , edge(n_fields)
    , impulses(parts.nodes)
    , at_nodes(parts.problem.grid.kernel == KernelKind::linear)
    , this_rank(
        dealii::Utilities::MPI::this_mpi_process(parts.grid.communicator))
  {
    for (const ContactPair &pair : parts.problem.contacts)
      {
        const unsigned int a = parts.problem.bodies[pair.bodies[0]].nodal_field,
                           b = parts.problem.bodies[pair.bodies[1]].nodal_field;
        laws[a * n_fields + b] =
          laws[b * n_fields + a] = {pair.law, pair.friction};
        if (pair.law == ContactLaw::separate)
          parting.push_back({{std::min(a, b), std::max(a, b)}});
      }
    for (const auto &body : parts.bodies)
      {
        const PointView<dim> points  = body->points.view();
        double               largest = 0; // kg
        for (std::size_t p = 0; p < points.size; ++p)
          largest = std::max(largest, points.mass[p]);
        double &of_field = edge[body->description.nodal_field];
        of_field =
          std::max(of_field,
                   2 * half_edge_of<dim>(dealii::Utilities::MPI::max(
                                           largest, parts.grid.communicator) /
                                         body->stress->density()));
      }
    reinit();
  }



  // What one field would have: the means over masses.
  template <int dim>
  void
  Contact<dim>::join(const unsigned int slot)
  {
    for (const Touch &touch : touches)
      if (law(touch.a, touch.b).law == ContactLaw::stick)
        {
          double *const        a   = parts.nodes.record(touch.a, touch.node),
                        *const b   = parts.nodes.record(touch.b, touch.node);
          const double         m_a = a[Layout::mass], m_b = b[Layout::mass];
          for (unsigned int d = slot; d < slot + dim; ++d)
            a[d] = b[d] = (m_a * a[d] + m_b * b[d]) / (m_a + m_b);
        }
  }



  template <int dim>
  void
  Contact<dim>::hold(const unsigned int slot)
  {
    join(slot);
    if (impulses.any())
      impulses.hold(slot);
  }



  template <int dim>
  void
  Contact<dim>::hold_before(const unsigned int slot, const double step)
  {
    join(slot);
    if (!impulses.any())
      return;
    holds_before = true;
    impulses.expect(step, parts.problem.loads.gravity);
    const std::vector<Vector> &held = impulses.hold(slot);
    for (std::size_t p = 0; p < exchanges.size(); ++p)
      exchanges[p].held = held[p];
  }



  // See ObstacleContact::exchange().
  template <int dim>
  void
  Contact<dim>::exchange()
  {
    join(Layout::velocity);
    join(Layout::increment);
    if (!impulses.any())
      return;
    const auto &places = impulses.all();
    impulses.find_relative(Layout::increment);
    for (std::size_t p = 0; p < places.size(); ++p)
      exchanges[p].increase = places[p].relative;
    impulses.find_relative(Layout::velocity);
    for (std::size_t p = 0; p < places.size(); ++p)
      exchanges[p].brought = places[p].relative - exchanges[p].increase;
    impulses.exchange();
    impulses.find_relative(Layout::velocity);
    for (std::size_t p = 0; p < places.size(); ++p)
      {
        exchanges[p].after = places[p].relative;
        account(exchanges[p].brought + exchanges[p].after,
                exchanges[p].held,
                p,
                0.5);
      }
  }



  template <int dim>
  void
  Contact<dim>::hold_after(const unsigned int slot, const double flip_share)
  {
    join(slot);
    if (!impulses.any())
      return;
    impulses.find_relative(slot);
    for (std::size_t p = 0; p < exchanges.size(); ++p)
      exchanges[p].brought = impulses.all()[p].relative;
    const std::vector<Vector> &held = impulses.hold(slot);
    for (std::size_t p = 0; p < exchanges.size(); ++p)
      account(exchanges[p].brought - exchanges[p].after,
              holds_before ? held[p] : 2 * held[p],
              p,
              0.5 * flip_share);
  }



  // Where places are nodes, what strains the points has nothing left of what is
  // held, and forces lose nothing to it. What is lost across the surface is
  // that of the impact, along it heat.
  template <int dim>
  void
  Contact<dim>::account(const Vector     &velocity,
                        const Vector     &held,
                        const std::size_t p,
                        const double      share)
  {
    const auto &place = impulses.all()[p];
    if (!place.is_own || (at_nodes && !place.presses()))
      return;
    const Vector  normal   = place.normal;
    const Vector &increase = exchanges[p].increase;
    const Vector  holds =
      !at_nodes ?
         held :
         -place.mass * (place.sticks ? velocity : (velocity * normal) * normal);
    const double all    = increase * holds - place.impulse * velocity;
    const double across = (increase * normal) * (holds * normal) -
                          (place.impulse * normal) * (velocity * normal);
    parts.ledger.contact += share * across;
    parts.ledger.friction += share * (all - across);
  }



  template unsigned int
  n_nodal_fields(const Problem<2> &);
  template unsigned int
  n_nodal_fields(const Problem<3> &);
  template class Contact<2>;
  template class Contact<3>;
} // namespace limber
