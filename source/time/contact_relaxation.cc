// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/contact_impulses.h>

#include <algorithm>

/**
 * @file Preparation of the projected Jacobi method of ContactImpulses:
 * boundary conditions at the nodes that places see, M_i, and relaxation factors
 * m_p / s_p.
 */
namespace limber
{
  namespace
  {
    // A node counts at a place only if the part of the normal that sides leave
    // unconstrained there, |P n|, is at least this. In flatter wedges impulses
    // would grow without bound.
    constexpr double least_free = 0.1;
  } // namespace



  // Friction acts in all directions: only where a place has none do these
  // differ.
  template <int dim>
  void
  ContactImpulses<dim>::find_borne()
  {
    bears.assign(seen.size() * Borne::stride, 0.);
    const bool differ =
      std::any_of(places.begin(), places.end(), [](const Place &place) {
        return !(place.friction > 0);
      });
    for (std::size_t p = 0; p < places.size(); ++p)
      for (std::size_t k = shares.begin[p]; k < shares.begin[p + 1]; ++k)
        {
          const Place  &place   = places[p];
          const double  mass    = free_share(place, k) * place.mass;
          double *const of_node = &bears[shares.all[k].node * Borne::stride];
          of_node[Borne::all] += mass;
          if (differ)
            for (int d = 0; d < dim; ++d)
              of_node[Borne::along + d] +=
                mass * (place.friction > 0 ? 1 : std::abs(place.normal[d]));
        }
    if (!differ)
      for (std::size_t i = 0; i < seen.size(); ++i)
        {
          double *const of_node = &bears[i * Borne::stride];
          std::fill_n(of_node + Borne::along, dim, of_node[Borne::all]);
        }
  }



  template <int dim>
  void
  ContactImpulses<dim>::find_relaxation()
  {
    find_held();
    find_borne();
    if (!at_nodes && shares_nodes())
      {
        see_those_of_others();
        find_held();
      }

    inverse_mass.resize(seen.size());
    for (std::size_t i = 0; i < seen.size(); ++i)
      {
        const double mass = seen[i].record[Layout::mass];
        inverse_mass[i]   = mass > 0 ? 1 / mass : 0;
      }
    velocity.assign(seen.size() * lanes, 0.);
    momentum.assign(seen.size() * lanes, 0.);
    relative.assign(places.size() * lanes, 0.);
    given_by_place.assign(places.size() * lanes, 0.);
    takes_part.assign(places.size(), 1);

    for (std::size_t p = 0; p < places.size(); ++p)
      {
        double sum = 0; // s_p
        for (std::size_t k = shares.begin[p]; k < shares.begin[p + 1]; ++k)
          {
            PlaceShare &share = shares.all[k];
            // At the edge of its support a function has a slope, but the node
            // has no mass.
            if (inverse_mass[share.node] == 0)
              share.value = 0;
            sum += free_share(places[p], k) *
                   borne_along(places[p], share.node) *
                   inverse_mass[share.node];
          }
        relative[p * lanes] = sum;
      }
    complete();
    for (std::size_t p = 0; p < places.size(); ++p)
      places[p].relaxation =
        relative[p * lanes] > 0 ? places[p].mass / relative[p * lanes] : 0;
  }



  // M_i as it matters for a place: without friction at most sum of m_q
  // |n_q . n_p|, as places with normals across do not affect each other.
  template <int dim>
  double
  ContactImpulses<dim>::borne_along(const Place        &place,
                                    const std::uint32_t node) const
  {
    const double *const of_node = &bears[node * Borne::stride];
    if (place.friction > 0)
      return of_node[Borne::all];
    double along = 0;
    for (int d = 0; d < dim; ++d)
      along += std::abs(place.normal[d]) * of_node[Borne::along + d];
    return std::min(of_node[Borne::all], along);
  }



  template <int dim>
  void
  ContactImpulses<dim>::add_side_constraints(
    const unsigned int             field,
    const std::vector<Constraint> &constraints)
  {
    if (!constraints.empty())
      side_constraints.emplace_back(field, &constraints);
  }



  template <int dim>
  void
  ContactImpulses<dim>::find_held()
  {
    if (side_constraints.empty())
      return;
    held.clear();
    held_components.assign(seen.size(), 0);
    holding_side.assign(seen.size() * dim, 0);
    for (const auto &[field, constraints] : side_constraints)
      for (const Constraint &constraint : *constraints)
        if (const std::uint32_t as = seen_as[field][constraint.node]; as != 0)
          {
            held.push_back({as - 1, &constraint});
            if (!constraint.one_sided)
              {
                held_components[as - 1] |= 1u << constraint.component;
                holding_side[(as - 1) * dim + constraint.component] =
                  constraint.side;
              }
          }
  }



  // |a_pi| times |P n|, with P n the part of the normal that sides leave free;
  // with friction |a_pi|, as nodes are moved along the surface as well.
  template <int dim>
  double
  ContactImpulses<dim>::share_beside_sides(const Place      &place,
                                           const std::size_t share) const
  {
    const double        size = share_sizes[share];
    const std::uint32_t node = shares.all[share].node;
    if (held_components[node] == 0)
      return size;
    Vector free = place.normal;
    for (int d = 0; d < dim; ++d)
      if (held_components[node] >> d & 1)
        free[d] = 0;
    const double norm = free.norm();
    if (norm < least_free)
      return 0;
    return size * (place.friction > 0 ? 1 : norm);
  }



  // Sum M_i over ranks and add nodes that only places of other ranks see: they
  // get impulses as well.
  template <int dim>
  void
  ContactImpulses<dim>::see_those_of_others()
  {
    const auto record_of = [this](const unsigned int  field,
                                  const std::uint32_t node) {
      return given[field].records.data() + node * Given::stride + Given::borne;
    };
    for (std::size_t i = 0; i < seen.size(); ++i)
      std::copy_n(&bears[i * Borne::stride],
                  Borne::stride,
                  record_of(seen[i].field, seen[i].number));
    for (unsigned int field = 0; field < given.size(); ++field)
      {
        const auto clear_unseen = [&](const std::vector<std::uint32_t> &some) {
          for (const std::uint32_t node : some)
            if (seen_as[field][node] == 0)
              std::fill_n(record_of(field, node), Borne::stride, 0.);
        };
        for (const auto &neighbour : nodes.node_plan().neighbours)
          clear_unseen(neighbour.send);
        clear_unseen(nodes.node_plan().received);
      }
    sum_given(Given::borne, Given::borne + Borne::stride);
    for (unsigned int field = 0; field < given.size(); ++field)
      for (const std::uint32_t node : nodes.node_plan().received)
        if (record_of(field, node)[Borne::all] > 0)
          see(field, node);
    bears.resize(seen.size() * Borne::stride);
    for (std::size_t i = 0; i < seen.size(); ++i)
      std::copy_n(record_of(seen[i].field, seen[i].number),
                  Borne::stride,
                  &bears[i * Borne::stride]);
  }



  template void
  ContactImpulses<2>::find_relaxation();
  template void
  ContactImpulses<2>::add_side_constraints(unsigned int,
                                           const std::vector<Constraint> &);
  template void
  ContactImpulses<3>::find_relaxation();
  template void
  ContactImpulses<3>::add_side_constraints(unsigned int,
                                           const std::vector<Constraint> &);
} // namespace limber
