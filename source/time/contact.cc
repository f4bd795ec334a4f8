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



  // m_r |s| <= mu J_n, where both have the reduced mass as a factor.
  template <int dim>
  typename Contact<dim>::State
  Contact<dim>::decide(const Touch  &touch,
                       const Vector &v_a,
                       const Vector &v_b) const
  {
    const Law &law = this->law(touch.a, touch.b);
    if (law.law == ContactLaw::stick)
      return State::sticking;
    const Vector relative = v_a - v_b;
    const double approach = relative * touch.normal;
    if (!(approach > 0) || !touch.points_touch)
      return State::free;
    return along_surface(relative, touch.normal).norm() <=
               law.friction * approach ?
             State::sticking :
             State::sliding;
  }



  // work(touch, relative velocity, reduced mass) before it is changed.
  template <int dim>
  template <class Work>
  void
  Contact<dim>::for_each_held(const unsigned int slot, const Work &work)
  {
    for (const Touch &touch : touches)
      if (touch.state != State::free)
        {
          double *const        a   = parts.nodes.record(touch.a, touch.node),
                        *const b   = parts.nodes.record(touch.b, touch.node);
          const double         m_a = a[Layout::mass], m_b = b[Layout::mass],
                       mass     = m_a * m_b / (m_a + m_b);
          const Vector v_a      = vector_in<dim>(a + slot),
                       v_b      = vector_in<dim>(b + slot);
          const Vector relative = v_a - v_b;
          work(touch, relative, mass);
          const Vector taken =
            mass * (touch.state == State::sticking ?
                      relative :
                      (relative * touch.normal) * touch.normal);
          store_vector<dim>(v_a - taken / m_a, a + slot);
          store_vector<dim>(v_b + taken / m_b, b + slot);
        }
  }



  template <int dim>
  void
  Contact<dim>::hold(const unsigned int slot)
  {
    for_each_held(slot, [](const Touch &, const Vector &, double) {});
  }



  template <int dim>
  void
  Contact<dim>::hold_before(const unsigned int slot, const double step)
  {
    for (Touch &touch : touches)
      {
        const auto expected = [&](const unsigned int field) {
          const double *const record = parts.nodes.record(field, touch.node);
          return Vector((vector_in<dim>(record + Layout::momentum) +
                         step * vector_in<dim>(record + Layout::force)) /
                        record[Layout::mass]);
        };
        touch.state = decide(touch, expected(touch.a), expected(touch.b));
      }
    hold(slot);
  }



  template <int dim>
  void
  Contact<dim>::exchange()
  {
    for (Touch &touch : touches)
      if (law(touch.a, touch.b).law == ContactLaw::stick)
        join(touch);
      else
        exchange(touch);
  }



  // FLIP points whose nodes bring the relative velocity w and give back w*
  // gain (J + dt f) (w + w*) / 2 and lose nothing to a strain that has none of
  // it: J + dt f = -m_r w takes m_r w (w + w*) / 2, of which the first part is
  // counted here and the second in hold_after().
  template <int dim>
  void
  Contact<dim>::exchange(Touch &touch)
  {
    double *const        a   = parts.nodes.record(touch.a, touch.node),
                  *const b   = parts.nodes.record(touch.b, touch.node);
    const double         m_a = a[Layout::mass], m_b = b[Layout::mass],
                 mass     = m_a * m_b / (m_a + m_b);
    const Vector v_a      = vector_in<dim>(a + Layout::velocity),
                 v_b      = vector_in<dim>(b + Layout::velocity),
                 dv_a     = vector_in<dim>(a + Layout::increment),
                 dv_b     = vector_in<dim>(b + Layout::increment);
    const Vector relative = v_a - v_b;
    touch.state           = decide(touch, v_a, v_b);
    if (touch.state == State::free)
      return;

    const double pressing = mass * (relative * touch.normal); // kg m/s
    const Vector sliding  = along_surface(relative, touch.normal);
    touch.brought         = relative - (dv_a - dv_b);
    touch.rubbing =
      touch.state == State::sticking ?
        mass * sliding :
        law(touch.a, touch.b).friction * pressing * sliding / sliding.norm();
    touch.slides = sliding - touch.rubbing / mass;

    const Vector impulse = pressing * touch.normal + touch.rubbing;
    store_vector<dim>(v_a - impulse / m_a, a + Layout::velocity);
    store_vector<dim>(v_b + impulse / m_b, b + Layout::velocity);
    store_vector<dim>(dv_a - impulse / m_a, a + Layout::increment);
    store_vector<dim>(dv_b + impulse / m_b, b + Layout::increment);

    if (!parts.nodes.owns(touch.node))
      return;
    const double normal = touch.brought * touch.normal;
    const Vector along  = along_surface(touch.brought, touch.normal);
    parts.ledger.contact += 0.5 * mass * normal * normal;
    parts.ledger.friction += touch.state == State::sticking ?
                               0.5 * mass * along.norm_square() :
                               0.5 * touch.rubbing * (along + touch.slides);
  }



  template <int dim>
  void
  Contact<dim>::hold_after(const unsigned int slot, const double flip_share)
  {
    for_each_held(
      slot, [&](const Touch &touch, const Vector &relative, const double mass) {
        if (!parts.nodes.owns(touch.node) ||
            law(touch.a, touch.b).law == ContactLaw::stick)
          return;
        const double share = 0.5 * flip_share;
        const Vector along = along_surface(relative, touch.normal);
        parts.ledger.contact += share * mass * (touch.brought * touch.normal) *
                                (relative * touch.normal);
        parts.ledger.friction +=
          share * (touch.state == State::sticking ?
                     mass * (touch.brought * along) :
                     touch.rubbing * (along - touch.slides));
      });
  }



  // What one field would have: the sums of masses, momenta and forces.
  template <int dim>
  void
  Contact<dim>::join(Touch &touch)
  {
    touch.state              = State::sticking;
    double *const        a   = parts.nodes.record(touch.a, touch.node),
                  *const b   = parts.nodes.record(touch.b, touch.node);
    const double         m_a = a[Layout::mass], m_b = b[Layout::mass];
    for (const unsigned int slot : {Layout::velocity, Layout::increment})
      for (int d = 0; d < dim; ++d)
        a[slot + d] = b[slot + d] =
          (m_a * a[slot + d] + m_b * b[slot + d]) / (m_a + m_b);
  }



  template unsigned int
  n_nodal_fields(const Problem<2> &);
  template unsigned int
  n_nodal_fields(const Problem<3> &);
  template class Contact<2>;
  template class Contact<3>;
} // namespace limber
