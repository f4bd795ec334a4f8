// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/node_vector.h>
#include <limber/time/contact_geometry.h>
#include <limber/time/contact_impulses.h>

#include <algorithm>
#include <utility>

namespace limber
{
  namespace
  {
    constexpr int tag_of_places = 4711;
  } // namespace



  template <int dim>
  ContactImpulses<dim>::ContactImpulses(NodalFields<dim> &nodes,
                                        const bool        leapfrogs)
    : nodes(nodes)
    , leapfrogs(leapfrogs)
    , seen_as(nodes.n_fields())
    , given(nodes.n_fields())
  {
    reinit();
  }



  template <int dim>
  void
  ContactImpulses<dim>::reinit()
  {
    const std::size_t n = nodes.table.n();
    seen.clear();
    clear();
    former_places.clear();
    for (auto &of_field : seen_as)
      of_field.reinit(n);
    for (Given &of_field : given)
      of_field.records.reinit(shares_nodes() ? n * Given::stride : 0);
    hanging.clear();
    if (!nodes.table.hanging.empty())
      hanging.resize(n);
    for (std::size_t k = 0; k < nodes.table.hanging.size(); ++k)
      hanging[nodes.table.hanging[k].node] = k + 1;
  }



  template <int dim>
  bool
  ContactImpulses<dim>::shares_nodes() const
  {
    return !nodes.table.shared.neighbours.empty();
  }



  template <int dim>
  void
  ContactImpulses<dim>::clear()
  {
    for (const Node &node : seen)
      seen_as[node.field][node.number] = 0;
    if (leapfrogs)
      {
        places.swap(former_places);
        std::swap(shares, former_shares);
        seen.swap(former_seen);
      }
    places.clear();
    shares.begin.resize(1);
    seen.clear();
    after_share.clear();
    peers.clear();
    side_constraints.clear();
    held.clear();
    held_components.clear();
    any_place = holds_before = gives_some = false;
  }



  template <int dim>
  typename ContactImpulses<dim>::Place &
  ContactImpulses<dim>::add_place()
  {
    places.emplace_back();
    first_share = shares.begin.back();
    shares.begin.push_back(first_share);
    return places.back();
  }



  template <int dim>
  void
  ContactImpulses<dim>::finish_adding(std::vector<Peer> &&of_places,
                                      const unsigned int  passes,
                                      const bool          hurry)
  {
    peers    = std::move(of_places);
    at_nodes = false;
    n_passes = passes;
    hurries  = hurry;
    any_place =
      dealii::Utilities::MPI::max<unsigned int>(places.empty() ? 0 : 1,
                                                nodes.grid.communicator) > 0;
    if (any_place)
      find_relaxation();
  }



  // If no node has two places, these are not coupled and one pass is exact.
  template <int dim>
  void
  ContactImpulses<dim>::finish_adding_nodes()
  {
    at_nodes  = true;
    any_place = !places.empty();
    n_passes  = 1;
    hurries   = false;
    for (std::size_t p = 1; p < places.size(); ++p)
      if (seen[shares.all[shares.begin[p]].node].number ==
          seen[shares.all[shares.begin[p - 1]].node].number)
        n_passes = passes_of_points;
    find_relaxation();
  }



  // Sum relative velocities of places over the ranks of their nodes: the owner
  // adds up the parts and sends back the sum, so that all ranks go on with the
  // same value.
  template <int dim>
  void
  ContactImpulses<dim>::complete()
  {
    if (peers.empty())
      return;
    const auto exchange = [this](const auto send, const auto take) {
      std::vector<std::vector<double>> sent(peers.size()),
        received(peers.size());
      std::vector<MPI_Request> requests;
      for (std::size_t k = 0; k < peers.size(); ++k)
        {
          const auto &from = peers[k].*send;
          const auto &to   = peers[k].*take;
          for (const std::uint32_t p : from)
            for (int d = 0; d < dim; ++d)
              sent[k].push_back(relative[p * lanes + d]);
          received[k].resize(to.size() * dim);
          if (!to.empty())
            MPI_Irecv(received[k].data(),
                      static_cast<int>(received[k].size()),
                      MPI_DOUBLE,
                      static_cast<int>(peers[k].rank),
                      tag_of_places,
                      nodes.grid.communicator,
                      &requests.emplace_back());
          if (!from.empty())
            MPI_Isend(sent[k].data(),
                      static_cast<int>(sent[k].size()),
                      MPI_DOUBLE,
                      static_cast<int>(peers[k].rank),
                      tag_of_places,
                      nodes.grid.communicator,
                      &requests.emplace_back());
        }
      MPI_Waitall(static_cast<int>(requests.size()),
                  requests.data(),
                  MPI_STATUSES_IGNORE);
      for (std::size_t k = 0; k < peers.size(); ++k)
        for (std::size_t i = 0; i < (peers[k].*take).size(); ++i)
          {
            const std::size_t p = (peers[k].*take)[i];
            for (int d = 0; d < dim; ++d)
              {
                double &of_place = relative[p * lanes + d];
                of_place =
                  (places[p].is_own ? of_place : 0) + received[k][i * dim + d];
              }
          }
    };
    exchange(&Peer::parts, &Peer::own);
    exchange(&Peer::own, &Peer::parts);
  }



  template <int dim>
  void
  ContactImpulses<dim>::sum_given(const unsigned int first,
                                  const unsigned int last)
  {
    for (Given &of_field : given)
      {
        of_field.exchange.start(nodes.node_plan(),
                                of_field.records.data(),
                                first,
                                last);
        of_field.exchange.finish(of_field.records.data());
      }
  }



  template <int dim>
  void
  ContactImpulses<dim>::load(const unsigned int slot)
  {
    for (std::size_t i = 0; i < seen.size(); ++i)
      for (int d = 0; d < dim; ++d)
        velocity[i * lanes + d] = seen[i].record[slot + d];
  }



  template <int dim>
  void
  ContactImpulses<dim>::store_velocity(const unsigned int slot)
  {
    for (std::size_t i = 0; i < seen.size(); ++i)
      for (int d = 0; d < dim; ++d)
        seen[i].record[slot + d] = velocity[i * lanes + d];
  }



  // Relative velocities w_p: of all places, or only those in active contact.
  template <int dim>
  void
  ContactImpulses<dim>::find_relative(const bool only_of_pressing,
                                      const Seen seen_as)
  {
    for (std::size_t p = 0; p < places.size(); ++p)
      takes_part[p] = !only_of_pressing || places[p].presses();
    if (!held.empty())
      see_what_sides_leave(seen_as);
    sum_at_places<dim>(shares,
                       takes_part,
                       held.empty() ? velocity.data() : left_velocity.data(),
                       relative.data());
    for (std::size_t p = 0; p < places.size(); ++p)
      if (places[p].is_own)
        for (int d = 0; d < dim; ++d)
          relative[p * lanes + d] -= places[p].velocity[d];
    complete();
  }



  template <int dim>
  void
  ContactImpulses<dim>::see_what_sides_leave(const Seen seen_as)
  {
    left_velocity = velocity;
    for (const HeldOfNode &of_node : held)
      {
        const Constraint &side = *of_node.constraint;
        double &left = left_velocity[of_node.node * lanes + side.component];
        if (!side.one_sided)
          left = seen_as == Seen::increment ? 0 : side.value;
        else if (seen_as == Seen::pressing)
          left = side.side % 2 == 0 ? std::max(left, 0.) : std::min(left, 0.);
      }
  }



  // Distribute impulses of places that take part to the velocities of nodes.
  template <int dim>
  void
  ContactImpulses<dim>::give_impulses()
  {
    give_to_nodes<dim>(shares,
                       takes_part,
                       given_by_place.data(),
                       momentum.data());
    if (!at_nodes && shares_nodes())
      {
        const auto record = [this](const std::size_t i) {
          return given[seen[i].field].records.data() +
                 std::size_t(seen[i].number) * Given::stride + Given::momentum;
        };
        for (std::size_t i = 0; i < seen.size(); ++i)
          store_vector<dim>(vector_at(momentum, i), record(i));
        sum_given(Given::momentum, Given::momentum + dim);
        for (std::size_t i = 0; i < seen.size(); ++i)
          store_at(vector_in<dim>(record(i)), i, momentum);
      }
    take_given<dim>(seen.size(),
                    inverse_mass.data(),
                    momentum.data(),
                    velocity.data());
  }



  // Projected Jacobi method with the Coulomb law (radial return of the
  // tangential impulse), starting from the present impulses, which the velocity
  // includes already. With `hurries` each pass starts ahead of the last, where
  // the one before it and the last point to (Nesterov 1983).
  template <int dim>
  void
  ContactImpulses<dim>::press(bool relative_is_known)
  {
    for (Place &place : places)
      place.ahead = place.impulse;
    for (unsigned int pass = 0; pass < n_passes; ++pass)
      {
        const double further =
          hurries && pass + 1 < n_passes ? pass / (pass + 3.) : 0;
        if (!std::exchange(relative_is_known, false))
          find_relative(false, Seen::pressing);
        for (std::size_t p = 0; p < places.size(); ++p)
          {
            Place       &place = places[p];
            const Vector wanted =
              place.ahead + place.relaxation * (place.least * place.normal -
                                                vector_at(relative, p));
            const double pressing =
              (place.is_given ? place.impulse : wanted) * place.normal;
            Vector impulse;
            place.sticks = false;
            if (pressing > 0)
              {
                Vector       along   = along_surface(wanted, place.normal);
                const double rubbing = along.norm();
                const double most    = place.friction * pressing;
                place.sticks         = place.friction > 0 && rubbing <= most;
                if (rubbing > most)
                  along *= most / rubbing;
                impulse = pressing * place.normal + along;
              }
            const Vector ahead = impulse + further * (impulse - place.impulse);
            takes_part[p]      = ahead != place.ahead;
            store_at(ahead - place.ahead, p, given_by_place);
            place.ahead   = ahead;
            place.impulse = impulse;
          }
        give_impulses();
      }
  }



  template <int dim>
  void
  ContactImpulses<dim>::expect(const double step, const Vector &gravity)
  {
    for (std::size_t i = 0; i < seen.size(); ++i)
      store_at(inverse_mass[i] *
                   (vector_in<dim>(seen[i].record + Layout::momentum) +
                    step * vector_in<dim>(seen[i].record + Layout::force)) +
                 step * gravity,
               i,
               velocity);
    press(false);
  }



  template <int dim>
  void
  ContactImpulses<dim>::hold_before(const unsigned int slot,
                                    const double       step,
                                    const Vector      &gravity)
  {
    if (!any())
      return;
    holds_before = true;
    expect(step, gravity);
    hold_and_tell(slot, true);
  }



  // The velocity b at the start of the step is the new one without impulses,
  // less the increment.
  template <int dim>
  ContactLoss
  ContactImpulses<dim>::exchange()
  {
    ContactLoss loss;
    account_former(loss);
    if (!any())
      return loss;
    load(Layout::increment);
    find_relative(false, Seen::increment);
    for (std::size_t p = 0; p < places.size(); ++p)
      places[p].increase = vector_at(relative, p) + places[p].velocity;
    load(Layout::velocity);
    find_relative(false, Seen::velocity);
    for (std::size_t p = 0; p < places.size(); ++p)
      places[p].brought = vector_at(relative, p) - places[p].increase;
    const bool starts = holds_before || gives_some;
    if (starts)
      {
        for (std::size_t p = 0; p < places.size(); ++p)
          {
            takes_part[p] = places[p].presses();
            store_at(places[p].impulse, p, given_by_place);
          }
        give_impulses();
      }
    press(!starts && held.empty());
    for (std::size_t i = 0; i < seen.size(); ++i)
      {
        double *const        new_velocity = seen[i].record + Layout::velocity,
                      *const increment    = seen[i].record + Layout::increment;
        for (int d = 0; d < dim; ++d)
          if (!is_held(i, d))
            {
              increment[d] += velocity[i * lanes + d] - new_velocity[d];
              new_velocity[d] = velocity[i * lanes + d];
            }
      }
    find_relative(true, Seen::velocity);
    for (std::size_t p = 0; p < places.size(); ++p)
      {
        Place &place = places[p];
        place.after  = vector_at(relative, p);
        account(loss,
                place,
                place.brought + place.after,
                leapfrogs ? Vector() : place.held,
                0.5);
      }
    return loss;
  }



  // With leapfrogs: K_r of the step before is K_b of this one.
  template <int dim>
  void
  ContactImpulses<dim>::account_former(ContactLoss &loss)
  {
    for (std::size_t p = 0; p < former_places.size(); ++p)
      {
        Place &place   = former_places[p];
        place.increase = 0;
        for (std::size_t k = former_shares.begin[p];
             k < former_shares.begin[p + 1];
             ++k)
          place.increase +=
            former_shares.all[k].value *
            vector_in<dim>(former_seen[former_shares.all[k].node].record +
                           Layout::increment);
        account(loss, place, {}, place.held, 0.5);
      }
    for (const Action &action : former_actions)
      {
        const Vector increase =
          vector_in<dim>(nodes.record(action.node) + Layout::increment);
        loss.across += action.across * increase;
        loss.along += action.along * increase;
      }
    former_actions.clear();
  }



  // What account_former() sums up for a place, split by the nodes that its
  // increase is a sum over.
  template <int dim>
  std::vector<typename ContactImpulses<dim>::Action>
  ContactImpulses<dim>::actions_to_come() const
  {
    std::vector<Action> result;
    if (!any() || at_nodes)
      return result;
    for (std::size_t p = 0; p < places.size(); ++p)
      if (const Place &place = places[p]; place.is_own)
        {
          const Vector across = place.sticks ?
                                  place.held :
                                  (place.held * place.normal) * place.normal;
          for (std::size_t k = shares.begin[p]; k < shares.begin[p + 1]; ++k)
            {
              const double half = 0.5 * shares.all[k].value;
              result.push_back({seen[shares.all[k].node].number,
                                half * across,
                                half * (place.held - across)});
            }
        }
    return result;
  }



  template <int dim>
  void
  ContactImpulses<dim>::restore(std::vector<Action> &&actions)
  {
    former_actions = std::move(actions);
  }



  template <int dim>
  ContactLoss
  ContactImpulses<dim>::hold_after(const unsigned int slot,
                                   const double       flip_share)
  {
    ContactLoss loss;
    if (!any())
      return loss;
    hold_and_note(slot);
    for (const Place &place : places)
      account(loss,
              place,
              place.brought - place.after,
              holds_before || leapfrogs ? place.held : 2 * place.held,
              0.5 * flip_share);
    return loss;
  }



  template <int dim>
  void
  ContactImpulses<dim>::hold(const unsigned int slot)
  {
    hold_and_tell(slot, false);
  }



  template <int dim>
  void
  ContactImpulses<dim>::hold_and_note(const unsigned int slot)
  {
    for (Place &place : places)
      place.held = 0;
    hold_and_tell(slot, true);
  }



  // Constrain a velocity at a slot. With @p tell, places keep the velocity
  // before that and the impulse that constrains it (K), for account().
  template <int dim>
  void
  ContactImpulses<dim>::hold_and_tell(const unsigned int slot, const bool tell)
  {
    if (!any())
      return;
    load(slot);
    for (unsigned int pass = 0; pass < n_passes; ++pass)
      {
        find_relative(true, Seen::pressing);
        for (std::size_t p = 0; p < places.size(); ++p)
          {
            Place &place = places[p];
            if (!takes_part[p])
              continue;
            const Vector now     = vector_at(relative, p);
            Vector       lacking = place.least * place.normal - now;
            if (!place.sticks)
              lacking -= along_surface(lacking, place.normal);
            const Vector impulse = place.relaxation * lacking;
            store_at(impulse, p, given_by_place);
            if (!tell)
              continue;
            if (pass == 0)
              place.brought = now;
            place.held += impulse;
          }
        give_impulses();
      }
    store_velocity(slot);
  }



  template <int dim>
  void
  ContactImpulses<dim>::account(ContactLoss  &loss,
                                const Place  &place,
                                const Vector &velocity,
                                const Vector &held,
                                const double  share) const
  {
    if (!place.is_own || (at_nodes && !place.presses()))
      return;
    const Vector &normal = place.normal;
    const Vector  holds =
      !at_nodes ?
         held :
         -place.mass * (place.sticks ? velocity : (velocity * normal) * normal);
    const double all    = place.increase * holds - place.impulse * velocity;
    const double across = place.sticks ?
                            all :
                            (place.increase * normal) * (holds * normal) -
                              (place.impulse * normal) * (velocity * normal);
    loss.across += share * across;
    loss.along += share * (all - across);
  }



  template class ContactImpulses<2>;
  template class ContactImpulses<3>;
} // namespace limber
