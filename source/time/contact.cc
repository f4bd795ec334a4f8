// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/time/contact.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  namespace
  {
    template <int dim>
    dealii::Tensor<1, dim>
    vector_at(const double *const values)
    {
      dealii::Tensor<1, dim> result;
      for (int d = 0; d < dim; ++d)
        result[d] = values[d];
      return result;
    }



    template <int dim>
    void
    put(const dealii::Tensor<1, dim> &vector, double *const values)
    {
      for (int d = 0; d < dim; ++d)
        values[d] = vector[d];
    }



    /** Its direction; zero of zero. */
    template <int dim>
    dealii::Tensor<1, dim>
    unit(const dealii::Tensor<1, dim> &vector)
    {
      const double length = vector.norm();
      return length > 0 ? vector / length : vector;
    }



    /** The part of a vector across a normal. */
    template <int dim>
    dealii::Tensor<1, dim>
    across(const dealii::Tensor<1, dim> &vector,
           const dealii::Tensor<1, dim> &normal)
    {
      return vector - (vector * normal) * normal;
    }
  } // namespace



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
    // Which points are the outermost along a normal is not asked of others.
    if (dealii::Utilities::MPI::n_mpi_processes(parts.grid.communicator) > 1)
      throw InputError(
        "Bodies that touch ('Contact/Pairs') are for one rank only. Usually a "
        "scene that ran on one was started with mpirun. Run it on one rank, or "
        "set 'Law = stick' for all pairs.");
    for (const ContactPair &pair : parts.problem.contacts)
      {
        const unsigned int a = parts.problem.bodies[pair.bodies[0]].nodal_field,
                           b = parts.problem.bodies[pair.bodies[1]].nodal_field;
        laws[a * n_fields + b] =
          laws[b * n_fields + a] = {pair.law, pair.friction};
      }
  }



  template <int dim>
  void
  Contact<dim>::find()
  {
    find_nodes();
    find_neighbours();
    find_gradients();
    find_normals();
  }



  template <int dim>
  void
  Contact<dim>::find_nodes()
  {
    if (first_of.size() != parts.nodes.table.n())
      first_of.reinit(parts.nodes.table.n());
    for (const Touch &touch : touches)
      first_of[touch.node] = 0;
    touches.clear();
    for (const std::uint32_t node : parts.nodes.active_nodes())
      for (unsigned int a = 0; a + 1 < n_fields; ++a)
        {
          if (!(parts.nodes.record(a, node)[Layout::mass] > 0))
            continue;
          for (unsigned int b = a + 1; b < n_fields; ++b)
            if (parts.nodes.record(b, node)[Layout::mass] > 0)
              {
                Touch touch;
                touch.node = node;
                touch.a    = a;
                touch.b    = b;
                touches.push_back(touch);
                if (first_of[node] == 0)
                  first_of[node] = static_cast<std::uint32_t>(touches.size());
              }
        }
  }



  // Batches with a node at which their body may part from another one. Most
  // points are met by nothing but the look at the nodes of their cell.
  template <int dim>
  void
  Contact<dim>::find_neighbours()
  {
    neighbours.clear();
    corners.clear();
    if (touches.empty())
      return;
    const GridView<dim> grid = parts.nodes.view();
    for (unsigned int b = 0; b < parts.bodies.size(); ++b)
      for_each_batch(
        parts.bodies[b]->points.view(), [&](const CellBatch &batch) {
          const std::size_t first = corners.size();
          add_corners(b, grid.cells[batch.cell]);
          if (corners.size() > first)
            neighbours.push_back({b, batch, first, corners.size()});
        });
  }



  template <int dim>
  void
  Contact<dim>::add_corners(const unsigned int       body,
                            const CellGeometry<dim> &cell)
  {
    const unsigned int field = parts.bodies[body]->description.nodal_field;
    for (unsigned int k = 0; k < cell.node.size(); ++k)
      {
        const std::uint32_t node = cell.node[k] / Layout::stride;
        if (first_of[node] == 0)
          continue;
        for (std::size_t t = first_of[node] - 1;
             t < touches.size() && touches[t].node == node;
             ++t)
          if ((touches[t].a == field || touches[t].b == field) &&
              law(touches[t].a, touches[t].b).law == ContactLaw::separate)
            corners.push_back({static_cast<std::uint32_t>(t), k});
      }
  }



  // work(neighbours, points, p, volume) for each point of the batches.
  template <int dim>
  template <class Work>
  void
  Contact<dim>::for_each_neighbour(const Work &work)
  {
    for (const Neighbours &some : neighbours)
      {
        MaterialBody<dim>   &body            = *parts.bodies[some.body];
        const PointView<dim> points          = body.points.view();
        const unsigned int   field           = body.description.nodal_field;
        const double         inverse_density = 1 / body.stress->density();
        for (std::size_t p = some.batch.begin; p < some.batch.end; ++p)
          work(some, field, points, p, points.mass[p] * inverse_density);
      }
  }



  template <int dim>
  void
  Contact<dim>::find_gradients()
  {
    const GridView<dim> grid = parts.nodes.view();
    for_each_neighbour([&](const Neighbours     &some,
                           const unsigned int    field,
                           const PointView<dim> &points,
                           const std::size_t     p,
                           const double          volume) {
      const CellGeometry<dim> &cell = grid.cells[some.batch.cell];
      const auto               xi   = natural_place(points, cell, p);
      for (std::size_t c = some.first; c < some.last; ++c)
        {
          const unsigned int k     = corners[c].k;
          Touch             &touch = touches[corners[c].touch];
          Vector            &gradient =
            field == touch.a ? touch.gradient_a : touch.gradient_b;
          for (int d = 0; d < dim; ++d)
            {
              double slope =
                (k >> d & 1 ? 1 : -1) * volume * cell.inverse_edge[d];
              for (int e = 0; e < dim; ++e)
                if (e != d)
                  slope *= k >> e & 1 ? xi[e] : 1 - xi[e];
              gradient[d] += slope;
            }
        }
    });
    // As if the material went on behind a side that holds it.
    for (Touch &touch : touches)
      for (unsigned int side = 0; side < 2 * dim; ++side)
        if ((parts.nodes.table.sides[touch.node] >> side & 1) &&
            parts.problem.sides[side].held != HeldComponents::none)
          touch.gradient_a[side / 2] = touch.gradient_b[side / 2] = 0;
  }



  // Of convex bodies the largest separation over all directions is their
  // distance. At the end of the face of one of them, its own gradient points
  // past the corner; that of the other is right, and the points are further
  // apart along it.
  template <int dim>
  void
  Contact<dim>::find_normals()
  {
    separations.assign(touches.size(), {});
    for (std::size_t t = 0; t < touches.size(); ++t)
      {
        const Vector of_a        = unit(touches[t].gradient_a),
                     of_b        = unit(touches[t].gradient_b);
        separations[t].direction = {{of_a, -1. * of_b, unit(of_a - of_b)}};
      }
    for_each_neighbour([&](const Neighbours     &some,
                           const unsigned int    field,
                           const PointView<dim> &points,
                           const std::size_t     p,
                           const double          volume) {
      const double half_edge =
        0.5 * (dim == 2 ? std::sqrt(volume) : std::cbrt(volume));
      for (std::size_t c = some.first; c < some.last; ++c)
        {
          Separation &separation = separations[corners[c].touch];
          const bool  is_a       = field == touches[corners[c].touch].a;
          for (unsigned int k = 0; k < separation.direction.size(); ++k)
            {
              double along = 0;
              for (int d = 0; d < dim; ++d)
                along += points.place[d][p] * separation.direction[k][d];
              if (is_a)
                separation.highest_a[k] =
                  std::max(separation.highest_a[k], along + half_edge);
              else
                separation.lowest_b[k] =
                  std::min(separation.lowest_b[k], along - half_edge);
            }
        }
    });
    for (std::size_t t = 0; t < touches.size(); ++t)
      {
        const Separation &separation = separations[t];
        double            largest    = -1e300;
        for (unsigned int k = 0; k < separation.direction.size(); ++k)
          if (const double distance =
                separation.lowest_b[k] - separation.highest_a[k];
              distance > largest && separation.direction[k] != Vector())
            {
              largest           = distance;
              touches[t].normal = separation.direction[k];
            }
        touches[t].points_touch = largest <= 0;
      }
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
    return across(relative, touch.normal).norm() <= law.friction * approach ?
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
          const Vector v_a      = vector_at<dim>(a + slot),
                       v_b      = vector_at<dim>(b + slot);
          const Vector relative = v_a - v_b;
          work(touch, relative, mass);
          const Vector taken =
            mass * (touch.state == State::sticking ?
                      relative :
                      (relative * touch.normal) * touch.normal);
          put<dim>(v_a - taken / m_a, a + slot);
          put<dim>(v_b + taken / m_b, b + slot);
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
          return Vector((vector_at<dim>(record + Layout::momentum) +
                         step * vector_at<dim>(record + Layout::force)) /
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
        share(touch);
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
    const Vector v_a      = vector_at<dim>(a + Layout::velocity),
                 v_b      = vector_at<dim>(b + Layout::velocity),
                 dv_a     = vector_at<dim>(a + Layout::increment),
                 dv_b     = vector_at<dim>(b + Layout::increment);
    const Vector relative = v_a - v_b;
    touch.state           = decide(touch, v_a, v_b);
    if (touch.state == State::free)
      return;

    const double pressing = mass * (relative * touch.normal); // kg m/s
    const Vector sliding  = across(relative, touch.normal);
    touch.brought         = relative - (dv_a - dv_b);
    touch.rubbing =
      touch.state == State::sticking ?
        mass * sliding :
        law(touch.a, touch.b).friction * pressing * sliding / sliding.norm();
    touch.slides = sliding - touch.rubbing / mass;

    const Vector impulse = pressing * touch.normal + touch.rubbing;
    put<dim>(v_a - impulse / m_a, a + Layout::velocity);
    put<dim>(v_b + impulse / m_b, b + Layout::velocity);
    put<dim>(dv_a - impulse / m_a, a + Layout::increment);
    put<dim>(dv_b + impulse / m_b, b + Layout::increment);

    if (!parts.nodes.owns(touch.node))
      return;
    const double normal = touch.brought * touch.normal;
    const Vector along  = across(touch.brought, touch.normal);
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
        const Vector along = across(relative, touch.normal);
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
  Contact<dim>::share(Touch &touch)
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
