// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/point_support.h>
#include <limber/points/cell_batch.h>
#include <limber/time/averaged_volumes.h>
#include <limber/time/newton_equations.h>
#include <limber/time/newton_tangent.h>
#include <limber/time/nodal_mass.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace limber
{
  namespace
  {
    // The bulk modulus that remains in the matrix of displacements in mixed
    // form, in shear moduli (nu = .35): multigrid then sees a compressible
    // material, not the deviator alone. In cut cells it is more, over the
    // square root of the filled fraction: their nodes depend on those of
    // others, which are stiffer. Found by counting iterations.
    constexpr double kept_bulk = 3;
  } // namespace



  template <int dim>
  NewtonEquations<dim>::NewtonEquations(const RunParts<dim> &parts,
                                        const std::size_t    largest_direct,
                                        const double         mixed_beyond,
                                        const std::size_t    most_factorised,
                                        const unsigned int   most_iterations)
    : parts(parts)
    , largest_direct(largest_direct)
    , most_factorised(most_factorised)
    , constraints(parts.problem.sides)
    , nodes(parts)
    , reset(nodes)
    , tangent(std::make_unique<NewtonTangent<dim>>(nodes, held))
    , volumes(std::make_unique<AveragedVolumes<dim>>(nodes, held))
    , most_iterations(most_iterations)
  {
    for (const auto &body : parts.bodies)
      {
        responses.push_back(make_trial_stress<dim>(body->description.law,
                                                   body->description.material,
                                                   body->description.treatment,
                                                   body->description.hourglass,
                                                   body->description.frame,
                                                   parts.problem.grid.kernel));
        factorises_all |= !responses.back()->has_symmetric_tangent();
        // the preconditioner of the pressures is for linear functions
        mixed |= parts.problem.grid.kernel == KernelKind::linear &&
                 responses.back()->bulk_over_shear() > mixed_beyond;
      }
  }



  template <int dim>
  NewtonEquations<dim>::~NewtonEquations() = default;



  template <int dim>
  bool
  NewtonEquations<dim>::begin_step()
  {
    const bool renumbered = nodes.update();
    if (renumbered)
      find_held();
    find_places();
    // in motion nodes have inertia, and the penalty would damp it
    if (parts.problem.method.ghost_penalty > 0 &&
        parts.problem.method.integration == TimeIntegration::quasi_static)
      {
        std::vector<double> now = moduli_of_penalty();
        if (renumbered || now != moduli)
          ghost.find(nodes, now);
        moduli = std::move(now);
      }
    // at rest the points start each step in balance with what they are
    if (parts.problem.method.integration == TimeIntegration::implicit_steps)
      reset.find(parts, responses);
    begin_of_jumps.assign(size(), 0.);
    is_factorised = set_up_serves = false;
    if (renumbered)
      tangent->reinit(ghost);
    displacement_of_tangent.clear();
    known_at.clear();
    total_forces.assign(size(), 0.);
    forces_of_followers.assign(size(), 0.);
    if (followers != nullptr)
      followers->find();
    noise = 1e-14 * largest_modulus() *
            std::pow(parts.grid.smallest_edge, dim - 1) *
            std::sqrt(double(size()));
    return renumbered;
  }



  template <int dim>
  double
  NewtonEquations<dim>::round_off(const std::vector<double> &displacement) const
  {
    double largest = 0;
    for (const double way : displacement)
      largest = std::max(largest, std::abs(way));
    return noise * (1 + largest / parts.grid.smallest_edge);
  }



  // Young's modulus of the stiffest body
  template <int dim>
  double
  NewtonEquations<dim>::largest_modulus() const
  {
    double result = 0;
    for (const auto &response : responses)
      result = std::max(result, response->young_modulus());
    return result;
  }



  // Stiffness of the ghost penalty: g E of the softest body in each cell, Pa.
  template <int dim>
  std::vector<double>
  NewtonEquations<dim>::moduli_of_penalty() const
  {
    std::vector<double> result(nodes.n_cells(), largest_modulus());
    for (std::size_t b = 0; b < responses.size(); ++b)
      {
        const double modulus = responses[b]->young_modulus();
        for_each_batch(parts.bodies[b]->points.view(),
                       [&](const CellBatch &batch) {
                         double &of_cell = result[nodes.number_of(batch.cell)];
                         of_cell         = std::min(of_cell, modulus);
                       });
      }
    if (nodes.is_parallel())
      dealii::Utilities::MPI::min(result, parts.grid.communicator, result);
    for (double &modulus : result)
      modulus *= parts.problem.method.ghost_penalty;
    return result;
  }



  // Of several sides for a component the last counts, as in explicit steps.
  template <int dim>
  void
  NewtonEquations<dim>::find_held()
  {
    held.assign(size(), 0);
    side_of.assign(size(), 0);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (const HeldComponent &entry : constraints.of_sides(nodes.sides(i)))
        {
          held[i * dim + entry.component]    = 1;
          side_of[i * dim + entry.component] = entry.side;
        }
  }



  template <int dim>
  std::vector<double>
  NewtonEquations<dim>::held_velocities(const double time)
  {
    std::vector<double> result(size());
    for (std::size_t k = 0; k < size(); ++k)
      if (is_held(k))
        result[k] = parts.problem.sides[side_of[k]].prescribed_velocity(
          nodes.places()[k / dim], time, k % dim);
    return result;
  }



  template <int dim>
  std::optional<FreeMotion<dim>>
  NewtonEquations<dim>::free_motion() const
  {
    // Connected components by union-find with path halving
    std::vector<std::uint32_t> root(nodes.n_cells());
    std::iota(root.begin(), root.end(), 0);
    const auto find = [&](std::uint32_t i) {
      while (root[i] != i)
        i = root[i] = root[root[i]];
      return i;
    };
    if (parts.problem.grid.kernel == KernelKind::linear)
      {
        for (std::uint32_t c = 0; c < root.size(); ++c)
          for (int d = 0; d < dim; ++d)
            for (const std::size_t next : nodes.neighbours(c, d, 1).cells)
              root[find(next)] = find(c);
      }
    else
      {
        std::vector<std::uint32_t> first_cell(nodes.size(), invalid_cell);
        for (std::uint32_t c = 0; c < root.size(); ++c)
          for (const std::uint32_t node : nodes.of_cell(c))
            if (first_cell[node] == invalid_cell)
              first_cell[node] = c;
            else
              root[find(c)] = find(first_cell[node]);
      }

    std::vector<std::vector<std::uint32_t>> of_parts;
    std::vector<std::uint32_t>              part_of(root.size(), invalid_cell);
    for (std::uint32_t c = 0; c < root.size(); ++c)
      {
        std::uint32_t &part = part_of[find(c)];
        if (part == invalid_cell)
          {
            part = of_parts.size();
            of_parts.emplace_back();
          }
        const auto numbers = nodes.of_cell(c);
        of_parts[part].insert(of_parts[part].end(),
                              numbers.begin(),
                              numbers.end());
      }
    for (auto &part : of_parts)
      {
        std::sort(part.begin(), part.end());
        part.erase(std::unique(part.begin(), part.end()), part.end());
      }

    std::vector<std::array<bool, dim>> held_there(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (int d = 0; d < dim; ++d)
        held_there[i][d] = is_held(i * dim + d);
    return free_rigid_motion<dim>(nodes.places(), held_there, of_parts);
  }



  template <int dim>
  void
  NewtonEquations<dim>::spread(const std::vector<double> &displacement,
                               std::vector<double>       &on_grid) const
  {
    on_grid.resize(std::size_t(parts.nodes.table.n()) * dim);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (const std::uint32_t node = nodes.on_grid()[i]; node != invalid_cell)
        std::copy_n(&displacement[i * dim],
                    dim,
                    &on_grid[std::size_t(node) * dim]);
    parts.nodes.table.take_from_masters(on_grid.data(), dim, 0, dim);
  }



  // Follower loads depend on the time as well.
  template <int dim>
  bool
  NewtonEquations<dim>::knows_forces_at(
    const std::vector<double> &displacement) const
  {
    int known =
      (followers == nullptr || !followers->any()) && displacement == known_at;
    if (nodes.is_parallel())
      known = dealii::Utilities::MPI::min(known, parts.grid.communicator);
    return known;
  }



  template <int dim>
  bool
  NewtonEquations<dim>::evaluate(const std::vector<double>       &displacement,
                                 const Inertia<dim> *const        inertia,
                                 const std::vector<double> *const former)
  {
    if (inertia == nullptr && knows_forces_at(displacement))
      return true;
    known_at.clear();
    spread(displacement, by_node);
    if (former != nullptr)
      spread(*former, former_by_node);
    std::fill(total_forces.begin(), total_forces.end(), 0.);
    total_energy = 0;
    if (inertia != nullptr)
      {
        tangent->clear();
        volumes->clear();
        is_factorised           = false;
        displacement_of_tangent = displacement;
      }
    int admissible = 1;
    for (std::size_t b = 0; b < responses.size() && admissible; ++b)
      if (!responses[b]->respond(
            parts.bodies[b]->points.view(),
            parts.nodes.view(),
            by_node.data(),
            former != nullptr ? former_by_node.data() : nullptr,
            inertia != nullptr,
            [&](const std::uint32_t cell, CellResponse &response) {
              const std::size_t number  = nodes.number_of(cell);
              const auto        numbers = nodes.of_cell(number);
              nodes.hanging_corners(number).condense(response.force.data(),
                                                     dim);
              total_energy += response.energy;
              for (unsigned int i = 0; i < numbers.size(); ++i)
                for (int d = 0; d < dim; ++d)
                  total_forces[std::size_t(numbers[i]) * dim + d] +=
                    response.force[i * dim + d];
              if (inertia == nullptr)
                return;
              nodes.hanging_corners(number).condense_matrix(
                response.tangent.data(), dim);
              nodes.hanging_corners(number).condense(response.volume_row.data(),
                                                     dim);
              add_volume(b, number, response);
              tangent->add(numbers.data(),
                           numbers.size(),
                           response.tangent.data());
            }))
        admissible = 0;
    if (nodes.is_parallel())
      admissible =
        dealii::Utilities::MPI::min(admissible, parts.grid.communicator);
    if (!admissible)
      return false;
    nodes.sum(total_forces);
    nodes.sum(&total_energy, 1);
    if (followers != nullptr && followers->any())
      {
        std::fill(forces_of_followers.begin(), forces_of_followers.end(), 0.);
        followers->add_forces(displacement, forces_of_followers);
        nodes.sum(forces_of_followers);
        if (inertia != nullptr)
          followers->add_tangent(displacement,
                                 is_iterated(),
                                 [&](const std::uint32_t *const numbers,
                                     const unsigned int         n_nodes,
                                     const double *const        block) {
                                   tangent->add(numbers, n_nodes, block);
                                 });
      }
    if (inertia != nullptr)
      {
        tangent->sum_over_ranks(parts.grid.communicator);
        if (nodes.is_parallel())
          volumes->unite_ranks(parts.grid.communicator);
      }
    energy_of_jumps = work_on_jumps = 0;
    if (!ghost.faces().empty())
      {
        const auto work_of_forces = [&]() {
          return 0.5 * std::inner_product(total_forces.begin(),
                                          total_forces.end(),
                                          displacement.begin(),
                                          0.);
        };
        since_jumps = displacement;
        for (std::size_t k = 0; k < size(); ++k)
          since_jumps[k] -= begin_of_jumps[k];
        const double without = work_of_forces();
        energy_of_jumps      = ghost.add_forces(since_jumps, total_forces);
        work_on_jumps        = work_of_forces() - without;
      }
    total_energy += energy_of_jumps +
                    reset.add_forces(displacement, total_forces, work_on_reset);
    known_at = displacement;
    if (inertia == nullptr)
      return true;

    ghost.add_tangent([&](const std::uint32_t *const numbers,
                          const unsigned int         n_nodes,
                          const double *const        block) {
      tangent->add(numbers, n_nodes, block);
    });
    reset.add_tangent([&](const std::uint32_t *const numbers,
                          const unsigned int         n_nodes,
                          const double *const        block) {
      tangent->add(numbers, n_nodes, block);
    });
    if (inertia->factor > 0)
      inertia->mass.add_to(*tangent, inertia->factor);
    tangent->finish();
    return true;
  }



  // Volumetric stiffness of a cell: into the tangent, but for the part that the
  // mixed form has in its pressure unknowns.
  template <int dim>
  void
  NewtonEquations<dim>::add_volume(const std::size_t body,
                                   const std::size_t cell,
                                   CellResponse     &response)
  {
    const auto   numbers         = nodes.of_cell(cell);
    const double bulk_over_shear = responses[body]->bulk_over_shear();
    const double shear           = response.volume_stiffness / bulk_over_shear;
    const double of_full_cell    = responses[body]->young_modulus() *
                                (3 + 1 / bulk_over_shear) / 9 *
                                nodes.volume_of_cell(cell);
    const double to_keep =
      kept_bulk * std::sqrt(shear * std::max(shear, of_full_cell));
    double kept = response.volume_stiffness;
    if (is_iterated() && mixed && kept > to_keep)
      {
        kept = to_keep;
        typename AveragedVolumes<dim>::Volume volume;
        volume.body = body;
        std::copy(numbers.begin(), numbers.end(), volume.numbers.begin());
        std::copy(response.volume_row.begin(),
                  response.volume_row.end(),
                  volume.row.begin());
        volume.stiffness = response.volume_stiffness - kept;
        volume.kept      = kept;
        volume.shear     = shear;
        volumes->add(volume);
      }
    response.add_volume_stiffness(kept);
  }



  // Static condensation of the pressures of the mixed form, for a factorisation
  template <int dim>
  void
  NewtonEquations<dim>::condense_volumes()
  {
    CellResponse response(dim << dim);
    for (const auto &volume : volumes->all())
      {
        response.clear();
        std::copy(volume.row.begin(),
                  volume.row.end(),
                  response.volume_row.begin());
        response.add_volume_stiffness(volume.stiffness);
        tangent->add(volume.numbers.data(),
                     volume.numbers.size(),
                     response.tangent.data());
      }
    volumes->clear();
    tangent->finish();
  }



  // Positions of the nodes at the start of the step. In the initial frame the
  // lattice stays where the body was at first; the current position of a node
  // follows from the points in its cells, extrapolated by their F: exactly for
  // a linear motion.
  template <int dim>
  void
  NewtonEquations<dim>::find_places()
  {
    places = nodes.places();
    if (std::none_of(parts.bodies.begin(),
                     parts.bodies.end(),
                     [](const auto &body) {
                       return body->points.view().in_initial_frame();
                     }))
      return;
    constexpr unsigned int n = dim + 1; // numbers of a node: sum and weight
    std::vector<double>    sums(nodes.size() * n);
    for (const auto &body : parts.bodies)
      {
        const PointView<dim> points = body->points.view();
        for (std::size_t p = 0; p < points.size; ++p)
          for (const std::uint32_t number : nodes.numbers_in(points.cell[p]))
            {
              double *const sum = &sums[number * n];
              for (int d = 0; d < dim; ++d)
                {
                  double place = points.position[d][p];
                  for (int e = 0; e < dim; ++e)
                    place += (points.in_initial_frame() ?
                                points.deformation[d * dim + e][p] :
                                double(d == e)) *
                             (nodes.places()[number][e] - points.place[e][p]);
                  sum[d] += points.mass[p] * place;
                }
              sum[dim] += points.mass[p];
            }
      }
    nodes.sum(sums);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (int d = 0; d < dim; ++d)
        places[i][d] = sums[i * n + d] / sums[i * n + dim];
  }



  // Rigid body modes (for multigrid), one after the other, in the configuration
  // of the last tangent
  template <int dim>
  std::vector<double>
  NewtonEquations<dim>::rigid_motions() const
  {
    std::vector<double> result(n_rigid_motions<dim> * size());
    for (std::size_t i = 0; i < nodes.size(); ++i)
      {
        dealii::Point<dim> place = places[i];
        for (int d = 0; d < dim; ++d)
          place[d] += displacement_of_tangent[i * dim + d];
        for (unsigned int m = 0; m < n_rigid_motions<dim>; ++m)
          for (int d = 0; d < dim; ++d)
            result[m * size() + i * dim + d] =
              rigid_motion<dim>(m, d, place, places[0]);
      }
    return result;
  }



  template <int dim>
  double
  NewtonEquations<dim>::longest_way(const std::vector<double> &displacement)
  {
    spread(displacement, by_node);
    const GridView<dim> grid   = parts.nodes.view();
    double              result = 0;
    for (const auto &body : parts.bodies)
      {
        const PointView<dim> points = body->points.view();
        for (std::size_t p = 0; p < points.size; ++p)
          {
            const auto at = support_of_point<dim, false>(grid, points, p);
            for (int d = 0; d < dim; ++d)
              {
                double way = 0;
                for (int i = 0; i < at.n; ++i)
                  way +=
                    at.value[i] * by_node[std::size_t(at.node[i]) * dim + d];
                result = std::max(result, std::abs(way) / nodes.finest_edge(d));
              }
          }
      }
    return dealii::Utilities::MPI::max(result, parts.grid.communicator);
  }



  template <int dim>
  AcceptedMotion
  NewtonEquations<dim>::accept(const std::vector<double> &displacement)
  {
    spread(displacement, by_node);
    AcceptedMotion result;
    for (std::size_t b = 0; b < responses.size(); ++b)
      {
        const AcceptedMotion of_body =
          responses[b]->accept(parts.bodies[b]->points.view(),
                               parts.nodes.view(),
                               by_node.data());
        result.longest_way = std::max(result.longest_way, of_body.longest_way);
        result.plastic_work += of_body.plastic_work;
      }
    return result;
  }



  template class NewtonEquations<2>;
  template class NewtonEquations<3>;
} // namespace limber
