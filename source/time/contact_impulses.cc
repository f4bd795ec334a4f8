// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/node_vector.h>
#include <limber/time/contact_geometry.h>
#include <limber/time/contact_impulses.h>

#include <algorithm>

namespace limber
{
  namespace
  {
    // After four, what is pressed and what rolls does what it does after
    // sixteen.
    constexpr unsigned int passes_of_places = 4;

    constexpr int tag_of_places = 4711;
  } // namespace



  template <int dim>
  ContactImpulses<dim>::ContactImpulses(NodalFields<dim> &nodes)
    : nodes(nodes)
    , given(nodes.n_fields())
    , expected(nodes.n_fields())
  {
    reinit();
  }



  template <int dim>
  void
  ContactImpulses<dim>::reinit()
  {
    const std::size_t n = nodes.table.n();
    clear();
    former_places.clear();
    for (Given &of_field : given)
      of_field.records.reinit(n * Given::stride);
    for (auto &velocities : expected)
      velocities.reinit(n * dim);
    hanging.clear();
    if (!nodes.table.hanging.empty())
      hanging.resize(n);
    for (std::size_t k = 0; k < nodes.table.hanging.size(); ++k)
      hanging[nodes.table.hanging[k].node] = k + 1;
  }



  template <int dim>
  void
  ContactImpulses<dim>::clear()
  {
    for (Given &of_field : given)
      {
        for (const std::uint32_t node : of_field.nodes)
          of_field.records[node * Given::stride + Given::mass] = 0;
        of_field.nodes.clear();
      }
    places.swap(former_places);
    shares.swap(former_shares);
    places.clear();
    shares.clear();
    peers.clear();
    any_place = false;
  }



  template <int dim>
  typename ContactImpulses<dim>::Place &
  ContactImpulses<dim>::add_place()
  {
    places.emplace_back();
    places.back().begin = places.back().end = shares.size();
    return places.back();
  }



  template <int dim>
  void
  ContactImpulses<dim>::add_share(const unsigned int  field,
                                  const std::uint32_t node,
                                  const double        share)
  {
    if (share != 0)
      for_each_master(node,
                      [&](const std::uint32_t master, const double weight) {
                        shares.push_back({master, field, weight * share});
                      });
    places.back().end = shares.size();
  }



  template <int dim>
  void
  ContactImpulses<dim>::finish_adding(std::vector<Peer> &&of_places)
  {
    peers      = std::move(of_places);
    everywhere = false;
    n_passes   = passes_of_places;
    any_place =
      dealii::Utilities::MPI::max<unsigned int>(places.empty() ? 0 : 1,
                                                nodes.grid.communicator) > 0;
    if (any_place)
      find_relaxation();
  }



  // Where no node has two of them, they do not know of each other: one pass is
  // exact.
  template <int dim>
  void
  ContactImpulses<dim>::finish_adding_nodes()
  {
    everywhere = true;
    any_place  = !places.empty();
    n_passes   = 1;
    for (std::size_t p = 1; p < places.size(); ++p)
      if (shares[places[p].begin].node == shares[places[p - 1].begin].node)
        n_passes = passes_of_places;
    find_relaxation();
  }



  template <int dim>
  void
  ContactImpulses<dim>::find_relaxation()
  {
    const auto mass = [this](const Share &share) -> double & {
      return given[share.field]
        .records[share.node * Given::stride + Given::mass];
    };
    for (const Place &place : places)
      for (std::size_t k = place.begin; k < place.end; ++k)
        mass(shares[k]) += std::abs(shares[k].value) * place.mass;
    for (Given &of_field : given)
      {
        sum_given(of_field, Given::mass, Given::mass + 1);
        for (const std::uint32_t node : nodes.active_nodes())
          if (of_field.records[node * Given::stride + Given::mass] > 0)
            of_field.nodes.push_back(node);
      }
    for (Place &place : places)
      {
        place.relative = 0;
        for (std::size_t k = place.begin; k < place.end; ++k)
          place.relative[0] +=
            std::abs(shares[k].value) * mass(shares[k]) /
            nodes.record(shares[k].field, shares[k].node)[Layout::mass];
      }
    complete();
    for (Place &place : places)
      place.relaxation = place.mass / place.relative[0];
  }



  // Each rank knows the velocity of the nodes that its part of a place sees.
  // The owner adds them up and tells the sum: all do the same with it.
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
              sent[k].push_back(places[p].relative[d]);
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
            Place &place = places[(peers[k].*take)[i]];
            if (!place.is_own)
              place.relative = 0;
            for (int d = 0; d < dim; ++d)
              place.relative[d] += received[k][i * dim + d];
          }
    };
    exchange(&Peer::parts, &Peer::own);
    exchange(&Peer::own, &Peer::parts);
  }



  template <int dim>
  template <class Velocity>
  void
  ContactImpulses<dim>::find_relative_of(const Velocity &velocity)
  {
    for (Place &place : places)
      {
        place.relative = 0;
        if (place.is_own)
          place.relative -= place.velocity;
        for (std::size_t k = place.begin; k < place.end; ++k)
          place.relative +=
            shares[k].value *
            vector_in<dim>(velocity(shares[k].field, shares[k].node));
      }
    complete();
  }



  template <int dim>
  void
  ContactImpulses<dim>::find_relative(const unsigned int slot)
  {
    find_relative_of([&](const unsigned int field, const std::uint32_t node) {
      return nodes.record(field, node) + slot;
    });
  }



  template <int dim>
  typename ContactImpulses<dim>::Vector
  ContactImpulses<dim>::sum(const Place              &place,
                            const std::vector<Share> &of_places,
                            const unsigned int        slot) const
  {
    Vector result;
    for (std::size_t k = place.begin; k < place.end; ++k)
      result += of_places[k].value *
                vector_in<dim>(
                  nodes.record(of_places[k].field, of_places[k].node) + slot);
    return result;
  }



  template <int dim>
  typename ContactImpulses<dim>::Vector
  ContactImpulses<dim>::at(const Place &place, const unsigned int slot) const
  {
    return sum(place, shares, slot);
  }



  template <int dim>
  typename ContactImpulses<dim>::Vector
  ContactImpulses<dim>::at_former(const Place       &place,
                                  const unsigned int slot) const
  {
    return sum(place, former_shares, slot);
  }



  template <int dim>
  void
  ContactImpulses<dim>::give(const Place &place, const Vector &impulse)
  {
    for (std::size_t k = place.begin; k < place.end; ++k)
      {
        double *const record = given[shares[k].field].records.data() +
                               std::size_t(shares[k].node) * Given::stride +
                               Given::momentum;
        for (int d = 0; d < dim; ++d)
          record[d] += shares[k].value * impulse[d];
      }
  }



  template <int dim>
  void
  ContactImpulses<dim>::sum_given(Given             &of_field,
                                  const unsigned int first,
                                  const unsigned int last)
  {
    if (everywhere)
      return;
    of_field.exchange.start(nodes.node_plan(),
                            of_field.records.data(),
                            first,
                            last);
    of_field.exchange.finish(of_field.records.data());
  }



  // add(field, node, change of velocity)
  template <int dim>
  template <class Add>
  void
  ContactImpulses<dim>::add_given(const Add &add)
  {
    for (unsigned int field = 0; field < given.size(); ++field)
      {
        double *const records = given[field].records.data();
        sum_given(given[field], Given::momentum, Given::momentum + dim);
        for (const std::uint32_t node : given[field].nodes)
          {
            double *const momentum =
              records + std::size_t(node) * Given::stride + Given::momentum;
            add(field,
                node,
                vector_in<dim>(momentum) /
                  nodes.record(field, node)[Layout::mass]);
            std::fill_n(momentum, dim, 0.);
          }
      }
  }



  // From the impulses that places have and the velocity has.
  template <int dim>
  template <class Velocity, class Add>
  void
  ContactImpulses<dim>::press(const Velocity &velocity, const Add &add)
  {
    for (unsigned int pass = 0; pass < n_passes; ++pass)
      {
        find_relative_of(velocity);
        for (Place &place : places)
          {
            const Vector wanted =
              place.impulse +
              place.relaxation * (place.least * place.normal - place.relative);
            const double pressing = std::max(0., wanted * place.normal);
            Vector       along    = along_surface(wanted, place.normal);
            const double rubbing  = along.norm();
            // not mu J_n where mu may be infinite and J_n zero
            const double most = pressing > 0 ? place.friction * pressing : 0;
            place.sticks      = pressing > 0 && rubbing <= most;
            if (rubbing > most)
              along *= most / rubbing;
            const Vector impulse = pressing * place.normal + along;
            give(place, impulse - place.impulse);
            place.impulse = impulse;
          }
        add_given(add);
      }
  }



  template <int dim>
  void
  ContactImpulses<dim>::expect(const double step, const Vector &gravity)
  {
    for (Place &place : places)
      place.impulse = 0;
    const auto velocity = [this](const unsigned int  field,
                                 const std::uint32_t node) {
      return expected[field].data() + std::size_t(node) * dim;
    };
    for (unsigned int field = 0; field < given.size(); ++field)
      for (const std::uint32_t node : given[field].nodes)
        {
          const double *const record = nodes.record(field, node);
          store_vector<dim>((vector_in<dim>(record + Layout::momentum) +
                             step * vector_in<dim>(record + Layout::force)) /
                                record[Layout::mass] +
                              step * gravity,
                            velocity(field, node));
        }
    press(velocity,
          [&](const unsigned int  field,
              const std::uint32_t node,
              const Vector       &change) {
            for (int d = 0; d < dim; ++d)
              velocity(field, node)[d] += change[d];
          });
  }



  template <int dim>
  void
  ContactImpulses<dim>::exchange()
  {
    const auto add = [this](const unsigned int  field,
                            const std::uint32_t node,
                            const Vector       &change) {
      double *const record = nodes.record(field, node);
      for (int d = 0; d < dim; ++d)
        {
          record[Layout::velocity + d] += change[d];
          record[Layout::increment + d] += change[d];
        }
    };
    for (const Place &place : places)
      give(place, place.impulse);
    add_given(add);
    press(
      [this](const unsigned int field, const std::uint32_t node) {
        return nodes.record(field, node) + Layout::velocity;
      },
      add);
  }



  template <int dim>
  const std::vector<typename ContactImpulses<dim>::Vector> &
  ContactImpulses<dim>::hold(const unsigned int slot)
  {
    holding.assign(places.size(), Vector());
    const auto velocity = [&](const unsigned int  field,
                              const std::uint32_t node) {
      return nodes.record(field, node) + slot;
    };
    for (unsigned int pass = 0; pass < n_passes; ++pass)
      {
        find_relative(slot);
        for (std::size_t p = 0; p < places.size(); ++p)
          {
            const Place &place = places[p];
            if (!place.presses())
              continue;
            Vector lacking = place.least * place.normal - place.relative;
            if (!place.sticks)
              lacking -= along_surface(lacking, place.normal);
            const Vector impulse = place.relaxation * lacking;
            give(place, impulse);
            holding[p] += impulse;
          }
        add_given([&](const unsigned int  field,
                      const std::uint32_t node,
                      const Vector       &change) {
          for (int d = 0; d < dim; ++d)
            velocity(field, node)[d] += change[d];
        });
      }
    return holding;
  }



  template class ContactImpulses<2>;
  template class ContactImpulses<3>;
} // namespace limber
