// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/records_of_ranks.h>
#include <limber/grid/node_places.h>
#include <limber/time/full_mass_filter.h>
#include <limber/transfer/grid_to_points.h>

#include <algorithm>

namespace limber
{
  template <int dim>
  FullMassFilter<dim>::FullMassFilter(const BackgroundGrid<dim>     &grid,
                                      const BoundaryConditions<dim> &boundaries,
                                      const unsigned int             n_fields)
    : grid(grid)
    , table(grid.nodes())
    , boundaries(boundaries)
    , fields(n_fields)
    , on_points(dim)
  {
    // A rank may hold a neighbour of a held node without holding that node, so
    // that its share of mass would be missing.
    if (grid.description.kernel == KernelKind::cubic &&
        dealii::Utilities::MPI::n_mpi_processes(grid.communicator) > 1)
      throw InputError(
        "The transfers 'fmpm' and 'xpic' with 'Kernel = cubic' are for one "
        "rank only. Usually a scene that ran on one was started with mpirun. "
        "Set 'Method/Kernel = quadratic', or run it on one rank.");
    reinit();
  }



  template <int dim>
  void
  FullMassFilter<dim>::reinit()
  {
    for (Field &each : fields)
      {
        each.records.reinit(std::size_t(table.n()) * Layout::stride);
        each.lumped.reinit(std::size_t(table.n()) * dim);
        each.force.reinit(std::size_t(table.n()) * dim);
        each.filtered.reinit(table.n());
      }
  }



  template <int dim>
  std::vector<FilteredNode<dim>>
  FullMassFilter<dim>::filtered_nodes() const
  {
    const std::vector<std::uint64_t> places = places_of_nodes(grid);
    std::vector<FilteredNode<dim>>   own, result;
    for (unsigned int f = 0; f < fields.size(); ++f)
      for (std::uint32_t node = 0; node < table.n_owned; ++node)
        if (fields[f].filtered[node] == step)
          {
            const double *const record =
              fields[f].records.data() + std::size_t(node) * Layout::stride;
            FilteredNode<dim> known;
            known.place = places[node];
            known.field = f;
            known.mass  = record[Layout::mass];
            for (int d = 0; d < dim; ++d)
              known.velocity[d] = record[Layout::velocity + d];
            own.push_back(known);
          }
    for (const auto &of_rank : gather_records(own, grid.communicator, true))
      result.insert(result.end(), of_rank.begin(), of_rank.end());
    return result;
  }



  template <int dim>
  void
  FullMassFilter<dim>::restore(const std::vector<FilteredNode<dim>> &former)
  {
    if (former.empty())
      return;
    std::unordered_multimap<std::uint64_t, const FilteredNode<dim> *> known_at;
    for (const FilteredNode<dim> &known : former)
      known_at.emplace(known.place, &known);
    const std::vector<std::uint64_t> places = places_of_nodes(grid);
    for (std::uint32_t node = 0; node < places.size(); ++node)
      {
        const auto known = known_at.equal_range(places[node]);
        for (auto it = known.first; it != known.second; ++it)
          {
            Field        &of = fields.at(it->second->field);
            double *const record =
              of.records.data() + std::size_t(node) * Layout::stride;
            record[Layout::mass] = it->second->mass;
            for (int d = 0; d < dim; ++d)
              record[Layout::velocity + d] = it->second->velocity[d];
            of.filtered[node] = step;
          }
      }
  }



  template <int dim>
  double
  FullMassFilter<dim>::note_forces(NodalFields<dim>             &nodes,
                                   const dealii::Tensor<1, dim> &gravity)
  {
    const double before = step++;
    double       result = 0;
    for_each_field(nodes, [&]() {
      for (const std::uint32_t node : nodes.active_nodes_of_field())
        {
          const double *const own  = nodes.record(node);
          const double        mass = own[Layout::mass];
          const double *const v    = record(node) + Layout::velocity;
          // Not a node with little mass in that step: its velocity was
          // arbitrary, and the forces on it have changed since.
          const bool strained =
            fields[field].filtered.data()[node] == before && mass > 0 &&
            record(node)[Layout::mass] > 0.5 * mass && nodes.owns(node);
          // At components held by sides the mapped velocity strains nothing.
          // Sides that have let go since left a zero velocity there.
          const auto held = this->held(nodes, node);
          const bool side = table.sides[node] != 0;
          for (int d = 0; d < dim; ++d)
            {
              force(node)[d] = own[Layout::force + d] + mass * gravity[d];
              if (strained && held[d] == 0 && !(side && v[d] == 0))
                result +=
                  force(node)[d] * (v[d] - own[Layout::momentum + d] / mass);
            }
        }
    });
    return result;
  }



  template <int dim>
  double
  FullMassFilter<dim>::energy_of_step(NodalFields<dim> &nodes)
  {
    double result = 0;
    for_each_field(nodes, [&]() {
      for (const std::uint32_t node : nodes.active_nodes_of_field())
        if (nodes.owns(node))
          {
            const double *const own = nodes.record(node);
            for (int d = 0; d < dim; ++d)
              result +=
                own[Layout::mass] * own[Layout::increment + d] *
                (own[Layout::velocity + d] - 0.5 * own[Layout::increment + d]);
          }
    });
    return result;
  }



  template <int dim>
  double
  FullMassFilter<dim>::power(NodalFields<dim> &nodes)
  {
    double result = 0;
    for_each_field(nodes, [&]() {
      for (const std::uint32_t node : nodes.active_nodes_of_field())
        {
          const double *const own = nodes.record(node);
          if (!nodes.owns(node) || !(own[Layout::mass] > 0))
            continue;
          for (int d = 0; d < dim; ++d)
            result += force(node)[d] * own[Layout::velocity + d];
        }
    });
    return result;
  }



  template <int dim>
  typename FullMassFilter<dim>::SideAction
  FullMassFilter<dim>::apply(NodalFields<dim>  &nodes,
                             Bodies            &bodies,
                             const unsigned int order,
                             const bool         former_only,
                             const Hold        &hold)
  {
    former = former_only;
    SideAction result;
    for_each_field(nodes, [&]() {
      start(nodes);
      result += action_of_start(nodes);
    });
    for (unsigned int j = 1; j < order; ++j)
      {
        result = {};
        for_each_field(nodes, [&]() {
          multiply_by_full_mass(nodes, bodies);
          result += action_until(nodes);
          correct(nodes);
        });
        if (hold)
          result += hold_as_new(nodes, hold);
      }
    for_each_field(nodes, [&]() { store(nodes); });
    return result;
  }



  // Constrain v(j) by contact, which acts on the nodes' own records. Sides act
  // last: they restore the components that they hold.
  template <int dim>
  typename FullMassFilter<dim>::SideAction
  FullMassFilter<dim>::hold_as_new(NodalFields<dim> &nodes, const Hold &hold)
  {
    for_each_field(nodes, [&]() {
      for (const std::uint32_t node : nodes.active_nodes_of_field())
        {
          double *const       own  = nodes.record(node);
          const double *const v    = record(node) + Layout::velocity;
          const auto          held = this->held(nodes, node);
          for (int d = 0; d < dim; ++d)
            own[Layout::remapped + d] =
              v[d] + (held[d] == 0 ? apart(own, d) : 0);
        }
    });
    hold(Layout::remapped);
    SideAction result;
    for_each_field(nodes, [&]() {
      for_each_held(nodes,
                    [&](const std::uint32_t node,
                        const std::uint32_t /*neighbour*/,
                        const int          d,
                        const unsigned int directions) {
                      const double *const own = nodes.record(node);
                      add_impulse(result,
                                  node,
                                  d,
                                  directions,
                                  own[Layout::mass] *
                                    (record(node)[Layout::velocity + d] -
                                     own[Layout::remapped + d]));
                    });
      for (const std::uint32_t node : nodes.active_nodes_of_field())
        {
          const double *const own  = nodes.record(node);
          double *const       v    = record(node) + Layout::velocity;
          const auto          held = this->held(nodes, node);
          for (int d = 0; d < dim; ++d)
            if (held[d] == 0)
              v[d] = own[Layout::remapped + d] - apart(own, d);
        }
    });
    return result;
  }



  template <int dim>
  void
  FullMassFilter<dim>::store(NodalFields<dim> &nodes)
  {
    for (const std::uint32_t node : nodes.active_nodes_of_field())
      {
        double *const own = nodes.record(node);
        double *const v   = record(node) + Layout::velocity;
        if (!(own[Layout::mass] > 0))
          continue;
        const auto held = this->held(nodes, node);
        for (int d = 0; d < dim; ++d)
          if (held[d] == 0)
            own[Layout::velocity + d] = v[d] + apart(own, d);
        std::copy_n(own + Layout::velocity, dim, v);
        record(node)[Layout::mass]          = own[Layout::mass];
        fields[field].filtered.data()[node] = step;
      }
    nodes.interpolate_hanging();
  }



  // Call work(node, neighbour, d, directions) for each component d of a node of
  // this rank that sides in these directions hold; the neighbour is the one
  // inward that gets a part of its mass, else the node itself.
  template <int dim>
  template <class Work>
  void
  FullMassFilter<dim>::for_each_held(const NodalFields<dim> &nodes,
                                     const Work             &work) const
  {
    for (const std::uint32_t node : nodes.active_boundary_nodes())
      {
        if (!nodes.owns(node) || !(nodes.record(node)[Layout::mass] > 0))
          continue;
        const auto held = this->held(nodes, node);
        for (int d = 0; d < dim; ++d)
          if (held[d] != 0)
            {
              const std::uint32_t neighbour =
                table.inward.empty() ? node : table.inward.at(node)[held[d]];
              work(node, neighbour, d, held[d]);
            }
      }
  }



  // Divide an impulse equally between the sides that hold the component.
  template <int dim>
  void
  FullMassFilter<dim>::add_impulse(SideAction         &action,
                                   const std::uint32_t node,
                                   const int           d,
                                   const unsigned int  directions,
                                   const double        impulse)
  {
    unsigned int n_sides = 0;
    for (int e = 0; e < dim; ++e)
      n_sides += directions >> e & 1;
    for (unsigned int side = 0; side < 2 * dim; ++side)
      if ((table.sides[node] >> side & 1) && (directions >> side / 2 & 1))
        action.impulse[side][d] += impulse / n_sides;
    action.work += impulse * record(node)[Layout::velocity + d];
  }



  // Impulse of sides in v(1): the change m v(1) - p of momentum at the free
  // neighbours of held nodes, whose D contains mass of these.
  template <int dim>
  typename FullMassFilter<dim>::SideAction
  FullMassFilter<dim>::action_of_start(const NodalFields<dim> &nodes)
  {
    SideAction result;
    for_each_held(nodes,
                  [&](const std::uint32_t node,
                      const std::uint32_t neighbour,
                      const int           d,
                      const unsigned int  directions) {
                    if (this->held(nodes, neighbour)[d] != 0)
                      return;
                    const double *const own = nodes.record(neighbour);
                    const double mass = mass_inward(nodes, node, directions);
                    const double impulse =
                      mass *
                      (own[Layout::mass] * record(node)[Layout::velocity + d] -
                       momentum(own, d)) /
                      lumped_mass(neighbour)[d];
                    add_impulse(result, node, d, directions, impulse);
                  });
    return result;
  }



  // Impulse of sides in all passes until v(j + 1). With r = p - M_full v(j) the
  // momentum P = sum m v, which is that of M_full v as well, changes by
  // sum m / D r over free nodes, while the sum of r over all nodes is
  // P(0) - P(j). So P(j + 1) - P(0) is minus the part of r that sides take:
  // that at the nodes that they hold, and the share of their mass in D.
  template <int dim>
  typename FullMassFilter<dim>::SideAction
  FullMassFilter<dim>::action_until(const NodalFields<dim> &nodes)
  {
    SideAction result;
    for_each_held(nodes,
                  [&](const std::uint32_t node,
                      const std::uint32_t neighbour,
                      const int           d,
                      const unsigned int  directions) {
                    const double  mass = nodes.record(node)[Layout::mass];
                    const double *v    = record(node);
                    double        impulse =
                      v[Layout::remapped + d] - mass * v[Layout::velocity + d];
                    if (this->held(nodes, neighbour)[d] == 0)
                      impulse -= mass_inward(nodes, node, directions) /
                                 lumped_mass(neighbour)[d] *
                                 (momentum(nodes.record(neighbour), d) -
                                  record(neighbour)[Layout::remapped + d]);
                    add_impulse(result, node, d, directions, impulse);
                  });
    return result;
  }



  // v(1)
  template <int dim>
  void
  FullMassFilter<dim>::start(const NodalFields<dim> &nodes)
  {
    for (const std::uint32_t node : nodes.active_nodes_of_field())
      {
        const double *const own = nodes.record(node);
        double *const       v   = record(node) + Layout::velocity;
        std::fill_n(record(node), Layout::stride, 0.);
        std::fill_n(lumped_mass(node), dim, own[Layout::mass]);
        const auto held = this->held(nodes, node);
        for (int d = 0; d < dim; ++d)
          v[d] = own[Layout::velocity + d] - (held[d] == 0 ? apart(own, d) : 0);
      }
    if (table.inward_share == 0)
      return;

    // D v(1) = p plus the momentum of the mass from held nodes
    const auto add = [&](const std::uint32_t to,
                         const int           d,
                         const double        mass,
                         const double        velocity) {
      double &D = lumped_mass(to)[d], &v = record(to)[Layout::velocity + d];
      v = (D * v + mass * velocity) / (D + mass);
      D += mass;
    };
    for (const std::uint32_t node : nodes.active_boundary_nodes())
      if (nodes.record(node)[Layout::mass] > 0)
        {
          const auto held = this->held(nodes, node);
          for (int d = 0; d < dim; ++d)
            if (held[d] != 0)
              add(table.inward.at(node)[held[d]],
                  d,
                  mass_inward(nodes, node, held[d]),
                  record(node)[Layout::velocity + d]);
        }
  }



  template <int dim>
  void
  FullMassFilter<dim>::correct(const NodalFields<dim> &nodes)
  {
    for (const std::uint32_t node : nodes.active_nodes_of_field())
      {
        const double *const own = nodes.record(node);
        if (!(own[Layout::mass] > 0))
          continue;
        double *const v       = record(node) + Layout::velocity;
        double *const product = record(node) + Layout::remapped;
        const auto    held    = this->held(nodes, node);
        for (int d = 0; d < dim; ++d)
          {
            if (held[d] == 0)
              v[d] += (momentum(own, d) - product[d]) / lumped_mass(node)[d];
            product[d] = 0;
          }
      }
  }



  // M_full v = S^T M S v by the sweep of G2P with re-mapping, as PIC, on
  // velocities that are not those of the points.
  template <int dim>
  void
  FullMassFilter<dim>::multiply_by_full_mass(NodalFields<dim> &nodes,
                                             Bodies           &bodies)
  {
    constexpr std::size_t room    = 1 << dim; // padding that sweeps need
    double *const         records = fields[field].records.data();
    table.take_from_masters(records,
                            Layout::stride,
                            Layout::velocity,
                            Layout::stride);
    GridView<dim> grid = nodes.view();
    grid.nodes         = records;
    G2POptions take;
    take.flip_share = 0;
    take.remap      = true;
    for (auto &body : bodies)
      if (body->description.nodal_field == field)
        {
          PointView<dim> points = body->points.view();
          for (int d = 0; d < dim; ++d)
            {
              on_points[d].assign(points.size + room, 0.);
              points.velocity[d] = on_points[d].data();
            }
          grid_to_points<dim>(points, grid, take, nullptr);
        }
    table.give_to_masters(records,
                          Layout::stride,
                          Layout::remapped,
                          Layout::remapped + dim);
    exchange.start(nodes.node_plan(),
                   records,
                   Layout::remapped,
                   Layout::remapped + dim);
    exchange.finish(records);
  }



  template class FullMassFilter<2>;
  template class FullMassFilter<3>;
} // namespace limber
