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
    , reach(n_fields)
    , impulses(parts.nodes)
    , stretches(parts.bodies.size())
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
    reinit();
  }



  template <int dim>
  void
  Contact<dim>::find_reaches()
  {
    std::fill(edge.begin(), edge.end(), 0.);
    std::fill(reach.begin(), reach.end(), 0.);
    for (const auto &body : parts.bodies)
      {
        const PointView<dim> of_body  = body->points.view();
        double               largest  = 0; // kg
        double               furthest = 0; // m
        for (std::size_t p = 0; p < of_body.size; ++p)
          largest = std::max(largest, of_body.mass[p]);
        if (of_body.reach != nullptr && of_body.size > 0)
          furthest =
            *std::max_element(of_body.reach, of_body.reach + of_body.size);
        const unsigned int field = body->description.nodal_field;
        const double       whole =
          2 * half_edge_of<dim>(largest / body->stress->density());
        edge[field]  = std::max(edge[field], whole);
        reach[field] = std::max({reach[field], furthest, whole / 2});
      }
    for (auto *const of_fields : {&edge, &reach})
      for (double &length : *of_fields)
        length = dealii::Utilities::MPI::max(length, parts.grid.communicator);
  }



  // Perfect stick: the mass-weighted mean, as one common field would have it.
  template <int dim>
  void
  Contact<dim>::join(const unsigned int slot)
  {
    for (const ContactNode &contact : contact_nodes)
      if (law(contact.a, contact.b).law == ContactLaw::stick)
        {
          double *const        a = parts.nodes.record(contact.a, contact.node),
                        *const b = parts.nodes.record(contact.b, contact.node);
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
    impulses.hold(slot);
  }



  template <int dim>
  void
  Contact<dim>::hold_before(const unsigned int slot, const double step)
  {
    join(slot);
    impulses.hold_before(slot, step, parts.problem.loads.gravity);
  }



  template <int dim>
  void
  Contact<dim>::exchange()
  {
    join(Layout::velocity);
    join(Layout::increment);
    parts.ledger.add(impulses.exchange());
  }



  template <int dim>
  void
  Contact<dim>::hold_after(const unsigned int slot, const double flip_share)
  {
    join(slot);
    parts.ledger.add(impulses.hold_after(slot, flip_share));
  }



  template unsigned int
  n_nodal_fields(const Problem<2> &);
  template unsigned int
  n_nodal_fields(const Problem<3> &);
  template class Contact<2>;
  template class Contact<3>;
} // namespace limber
