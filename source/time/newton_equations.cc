// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <limber/base/exceptions.h>
#include <limber/points/cell_batch.h>
#include <limber/time/free_motions.h>
#include <limber/time/newton_equations.h>

#include <Epetra_CrsMatrix.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <tuple>

namespace limber
{
  namespace
  {
    constexpr std::uint32_t not_numbered = 0xffffffffu;

    // In mixed form the matrix keeps what volumes resist with in a material
    // whose bulk modulus is that many shear moduli (nu = .29): multigrid then
    // sees one that is well compressible, and not the deviator alone.
    constexpr double kept_bulk = 2;
    // Of what an unbounded body gives in to a pressure that alternates: the
    // share that cells know of. The rest is for surfaces and sides. Both were
    // found by counting iterations.
    constexpr double alternating_share = 0.99;
  } // namespace



  template <int dim>
  struct NewtonEquations<dim>::Matrix
  {
    /** Of the averaged volume of a body's points in a cell; mixed form alone.
     */
    struct Volume
    {
      std::size_t                         body = 0;
      std::array<std::uint32_t, 1 << dim> numbers;
      std::array<double, dim << dim>      row;       // 1/m
      double                              stiffness; // not in the matrix, J
      double                              kept;      // in the matrix, J
      double                              shear;     // G times the volume, J
    };

    dealii::TrilinosWrappers::SparseMatrix values;
    std::optional<LinearSolver>            solver;
    std::vector<Volume>                    volumes;
    dealii::SparsityPattern                volume_pattern;
    dealii::SparsityPattern                pressure_pattern;
    dealii::SparseMatrix<double>           volume_rows, of_pressure;
    std::vector<double>                    compliance, kept;
    std::optional<MixedSolver>             mixed_solver;
    // rows and columns of held components meet nothing else; this is what
    // their correction does to the others
    std::vector<std::uint32_t> rows, columns;
    std::vector<double>        of_held;
    double                     largest       = 0; // of the diagonal
    bool                       is_factorised = false;
  };



  template <int dim>
  NewtonEquations<dim>::NewtonEquations(const RunParts<dim> &parts,
                                        const std::size_t    largest_direct,
                                        const double         mixed_beyond)
    : parts(parts)
    , largest_direct(largest_direct)
    , constraints(parts.problem.sides)
    , nodes(parts)
    , matrix(std::make_unique<Matrix>())
  {
    for (const auto &body : parts.bodies)
      {
        responses.push_back(make_trial_stress<dim>(body->description.law,
                                                   body->description.material,
                                                   body->description.treatment,
                                                   body->description.hourglass,
                                                   body->description.frame));
        factorises_all |= !responses.back()->has_symmetric_tangent();
        mixed |= responses.back()->bulk_over_shear() > mixed_beyond;
      }
  }



  template <int dim>
  NewtonEquations<dim>::~NewtonEquations() = default;



  template <int dim>
  void
  NewtonEquations<dim>::begin_step()
  {
    nodes.update();
    find_held();
    find_ghost_faces();
    make_matrix();
    total_forces.assign(size(), 0.);
    noise = 1e-14 * modulus() * std::pow(parts.grid.smallest_edge, dim - 1) *
            std::sqrt(double(size()));
  }



  // Young's, of the stiffest body
  template <int dim>
  double
  NewtonEquations<dim>::modulus() const
  {
    double result = 0;
    for (const auto &response : responses)
      result = std::max(result, response->young_modulus());
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



  // Those of a cell that has a neighbour without points, and of its neighbours
  // with points. What lies beyond a side of the box does not count.
  template <int dim>
  void
  NewtonEquations<dim>::find_ghost_faces()
  {
    ghost_faces.clear();
    if (!(parts.problem.method.ghost_penalty > 0) ||
        parts.problem.method.integration != TimeIntegration::quasi_static)
      return; // in motion nodes have inertia, and this would damp it
    const auto                &cells = nodes.cells();
    std::vector<unsigned char> at_surface(cells.size());
    for (std::size_t c = 0; c < cells.size(); ++c)
      for (int d = 0; d < dim; ++d)
        for (const int step : {-1, 1})
          if (const auto next = nodes.neighbour(c, d, step);
              next.in_box && !next.cell)
            at_surface[c] = 1;

    for (std::size_t c = 0; c < cells.size(); ++c)
      for (int d = 0; d < dim; ++d)
        {
          const auto other = nodes.neighbour(c, d, 1).cell;
          if (!other || !(at_surface[c] || at_surface[*other]))
            continue;
          const auto &own = cells[c], &next = cells[*other];
          GhostFace   face;
          double      area = 1;
          for (int e = 0; e < dim; ++e)
            if (e != d)
              area *= nodes.edge(e);
          // h/3 area / h^2: jumps are differences over h
          face.stiffness = parts.problem.method.ghost_penalty * modulus() *
                           area / nodes.edge(d) / 3;
          unsigned int line = 0;
          for (unsigned int i = 0; i < own.size(); ++i)
            if ((i >> d & 1) == 0)
              face.lines[line++] = {
                {own[i], own[i | 1u << d], next[i | 1u << d]}};
          ghost_faces.push_back(face);
        }
  }



  namespace
  {
    /** Entry of the mass matrix of linear functions on the unit face. */
    template <int dim>
    double
    face_mass(const unsigned int i, const unsigned int j)
    {
      double result = 1;
      for (int d = 0; d < dim - 1; ++d)
        result *= (i >> d & 1) == (j >> d & 1) ? 1. / 3. : 1. / 6.;
      return result;
    }

    constexpr std::array<double, 3> second_difference{{1, -2, 1}};
  } // namespace



  template <int dim>
  void
  NewtonEquations<dim>::make_matrix()
  {
    dealii::DynamicSparsityPattern               pattern(size(), size());
    std::vector<dealii::types::global_dof_index> rows;
    const auto add = [&](const auto &numbers) {
      rows.clear();
      for (const std::uint32_t number : numbers)
        for (int d = 0; d < dim; ++d)
          rows.push_back(std::size_t(number) * dim + d);
      std::sort(rows.begin(), rows.end());
      for (const auto row : rows)
        pattern.add_entries(row, rows.begin(), rows.end(), true);
    };
    for (const auto &numbers : nodes.cells())
      add(numbers);
    for (const GhostFace &face : ghost_faces)
      {
        std::vector<std::uint32_t> numbers;
        for (const auto &line : face.lines)
          numbers.insert(numbers.end(), line.begin(), line.end());
        add(numbers);
      }
    matrix->solver.reset();
    matrix->values.reinit(pattern);
  }



  template <int dim>
  std::string
  NewtonEquations<dim>::free_motion() const
  {
    // Parts that hang together by cells
    std::vector<std::uint32_t> root(nodes.size());
    std::iota(root.begin(), root.end(), 0);
    const auto find = [&](std::uint32_t i) {
      while (root[i] != i)
        i = root[i] = root[root[i]];
      return i;
    };
    for (const auto &numbers : nodes.cells())
      {
        for (const std::uint32_t number : numbers)
          root[find(number)] = find(numbers[0]);
      }
    for (std::uint32_t r = 0; r < nodes.size(); ++r)
      {
        if (find(r) != r)
          continue;
        std::vector<dealii::Point<dim>>    of_part;
        std::vector<std::array<bool, dim>> held_there;
        for (std::uint32_t i = 0; i < nodes.size(); ++i)
          if (find(i) == r)
            {
              of_part.push_back(nodes.places()[i]);
              held_there.emplace_back();
              for (int d = 0; d < dim; ++d)
                held_there.back()[d] = is_held(std::size_t(i) * dim + d);
            }
        const std::string motion = free_rigid_motion<dim>(of_part, held_there);
        if (!motion.empty())
          return motion;
      }
    return "";
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
  }



  template <int dim>
  bool
  NewtonEquations<dim>::evaluate(const std::vector<double>       &displacement,
                                 const std::vector<double> *const inertia,
                                 const std::vector<double> *const former)
  {
    constexpr unsigned int n = 1 << dim;
    spread(displacement, by_node);
    if (former != nullptr)
      spread(*former, former_by_node);
    std::fill(total_forces.begin(), total_forces.end(), 0.);
    total_energy = 0;
    if (inertia != nullptr)
      {
        matrix->values        = 0;
        matrix->is_factorised = false;
        matrix->volumes.clear();
        matrix->mixed_solver.reset();
        matrix->rows.clear();
        matrix->columns.clear();
        matrix->of_held.clear();
      }
    int admissible = 1;
    for (std::size_t b = 0; b < responses.size() && admissible; ++b)
      if (!responses[b]->respond(
            parts.bodies[b]->points.view(),
            parts.nodes.view(),
            by_node.data(),
            former != nullptr ? former_by_node.data() : nullptr,
            inertia != nullptr,
            [&](const std::uint32_t cell, CellResponse<dim> &response) {
              const auto numbers = nodes.numbers_in(cell);
              total_energy += response.energy;
              for (unsigned int i = 0; i < n; ++i)
                for (int d = 0; d < dim; ++d)
                  total_forces[std::size_t(numbers[i]) * dim + d] +=
                    response.force[i * dim + d];
              if (inertia == nullptr)
                return;
              add_volume(b, numbers, response);
              add_to_matrix(numbers.data(), n, response.tangent.data());
            }))
        admissible = 0;
    if (nodes.is_parallel())
      admissible =
        dealii::Utilities::MPI::min(admissible, parts.grid.communicator);
    if (!admissible)
      return false;
    nodes.sum(total_forces);
    nodes.sum(&total_energy, 1);
    if (inertia != nullptr)
      sum_tangent();
    add_ghost_forces(displacement);
    total_energy += energy_of_jumps;
    if (inertia == nullptr)
      return true;

    add_ghost_tangent();
    for (std::size_t k = 0; k < size(); ++k)
      if (!is_held(k))
        matrix->values.add(k, k, (*inertia)[k]);
    fill_held_rows();
    return true;
  }



  namespace
  {
    /** Plain records of all ranks, one rank after the other. */
    template <class Plain>
    void
    unite(std::vector<Plain> &records, const MPI_Comm communicator)
    {
      std::vector<char> bytes(records.size() * sizeof(Plain));
      if (!records.empty())
        std::memcpy(bytes.data(), records.data(), bytes.size());
      const auto of_ranks =
        dealii::Utilities::MPI::all_gather(communicator, bytes);
      records.clear();
      for (const std::vector<char> &of_rank : of_ranks)
        {
          const std::size_t before = records.size();
          records.resize(before + of_rank.size() / sizeof(Plain));
          if (!of_rank.empty())
            std::memcpy(static_cast<void *>(&records[before]),
                        of_rank.data(),
                        of_rank.size());
        }
    }
  } // namespace



  // Each rank has added what its points resist with.
  template <int dim>
  void
  NewtonEquations<dim>::sum_tangent()
  {
    matrix->values.compress(dealii::VectorOperation::add);
    if (!nodes.is_parallel())
      return;
    const Epetra_CrsMatrix &rows   = matrix->values.trilinos_matrix();
    int                    *starts = nullptr, *columns = nullptr;
    double                 *values = nullptr;
    if (rows.ExtractCrsDataPointers(starts, columns, values) != 0)
      throw std::logic_error("the tangent is not stored in one piece");
    nodes.sum(values, rows.NumMyNonzeros());

    unite(matrix->rows, parts.grid.communicator);
    unite(matrix->columns, parts.grid.communicator);
    unite(matrix->of_held, parts.grid.communicator);
    unite(matrix->volumes, parts.grid.communicator);
    std::stable_sort(matrix->volumes.begin(),
                     matrix->volumes.end(),
                     [](const auto &a, const auto &b) {
                       return std::tie(a.body, a.numbers) <
                              std::tie(b.body, b.numbers);
                     });
  }



  // What is held meets nothing else, and is as stiff as the rest.
  template <int dim>
  void
  NewtonEquations<dim>::fill_held_rows()
  {
    matrix->values.compress(dealii::VectorOperation::add);
    matrix->largest = 0;
    for (std::size_t k = 0; k < size(); ++k)
      if (!is_held(k))
        matrix->largest =
          std::max(matrix->largest, matrix->values.diag_element(k));
    for (std::size_t k = 0; k < size(); ++k)
      if (is_held(k))
        matrix->values.set(k, k, matrix->largest);
    matrix->values.compress(dealii::VectorOperation::insert);
  }



  // Into the tangent, but for what pressures of the mixed form carry.
  template <int dim>
  void
  NewtonEquations<dim>::add_volume(
    const std::size_t                          body,
    const std::array<std::uint32_t, 1 << dim> &numbers,
    CellResponse<dim>                         &response)
  {
    const double bulk_over_shear = responses[body]->bulk_over_shear();
    double       kept            = response.volume_stiffness;
    if (is_iterated() && mixed && bulk_over_shear > kept_bulk &&
        response.volume_stiffness > 0)
      {
        const double shear = response.volume_stiffness / bulk_over_shear;
        kept               = kept_bulk * shear;
        matrix->volumes.push_back({body,
                                   numbers,
                                   response.volume_row,
                                   response.volume_stiffness - kept,
                                   kept,
                                   shear});
      }
    response.add_volume_stiffness(kept);
  }



  // What mixed form has kept apart, for a factorisation of the whole
  template <int dim>
  void
  NewtonEquations<dim>::condense_volumes()
  {
    CellResponse<dim> response;
    for (const typename Matrix::Volume &volume : matrix->volumes)
      {
        response.tangent.fill(0);
        response.volume_row = volume.row;
        response.add_volume_stiffness(volume.stiffness);
        add_to_matrix(volume.numbers.data(),
                      volume.numbers.size(),
                      response.tangent.data());
      }
    matrix->volumes.clear();
    fill_held_rows();
  }



  template <int dim>
  void
  NewtonEquations<dim>::make_mixed_solver(const std::vector<double> &motions)
  {
    const auto &volumes       = matrix->volumes;
    const auto  for_each_free = [&](const auto &work) {
      for (std::size_t c = 0; c < volumes.size(); ++c)
        for (unsigned int k = 0; k < volumes[c].row.size(); ++k)
          {
            const std::size_t column =
              std::size_t(volumes[c].numbers[k / dim]) * dim + k % dim;
            if (!is_held(column))
              work(c, column, volumes[c].row[k]);
          }
    };
    matrix->volume_rows.clear();
    matrix->volume_pattern.reinit(volumes.size(), size(), dim << dim);
    for_each_free([&](const std::size_t c, const std::size_t column, double) {
      matrix->volume_pattern.add(c, column);
    });
    matrix->volume_pattern.compress();
    matrix->volume_rows.reinit(matrix->volume_pattern);
    for_each_free(
      [&](const std::size_t c, const std::size_t column, const double value) {
        matrix->volume_rows.set(c, column, value);
      });
    matrix->compliance.clear();
    matrix->kept.clear();
    for (const typename Matrix::Volume &volume : volumes)
      {
        matrix->compliance.push_back(1 / volume.stiffness);
        matrix->kept.push_back(volume.kept);
      }
    fill_pressure_matrix();
    typename MixedSolver::Equations equations;
    equations.stiffness   = &matrix->values;
    equations.rows        = &matrix->volume_rows;
    equations.compliance  = &matrix->compliance;
    equations.of_pressure = &matrix->of_pressure;
    equations.kept        = &matrix->kept;
    matrix->mixed_solver.emplace(dim, motions, equations);
  }



  // What volumes give in to pressures, where the matrix keeps nothing of their
  // stiffness, 1/K + B A^-1 B^T, nearly: V/G, but nothing where pressures
  // alternate from cell to cell in two directions or more, as they move no
  // node. Of s = sin^2(k/2) along x and y, B A^-1 B^T is nearly proportional to
  // 1 - 2 s_x s_y / (s_x + s_y), and this matrix to 1 - s_x s_y, both zero in
  // the pattern alone.
  template <int dim>
  void
  NewtonEquations<dim>::fill_pressure_matrix()
  {
    constexpr unsigned int n       = 1 << dim;
    const auto            &volumes = matrix->volumes;
    using Around = std::array<std::uint32_t, n>; // volumes around a node
    std::vector<Around> complete;
    Around              nothing;
    nothing.fill(not_numbered);
    for (std::size_t begin = 0, end; begin < volumes.size(); begin = end)
      {
        std::vector<Around> around(nodes.size(), nothing);
        for (end = begin;
             end < volumes.size() && volumes[end].body == volumes[begin].body;
             ++end)
          for (unsigned int i = 0; i < n; ++i)
            around[volumes[end].numbers[i]][n - 1 - i] = end;
        for (const Around &of_node : around)
          if (std::count(of_node.begin(), of_node.end(), not_numbered) == 0)
            complete.push_back(of_node);
      }

    dealii::DynamicSparsityPattern pattern(volumes.size(), volumes.size());
    for (std::size_t c = 0; c < volumes.size(); ++c)
      pattern.add(c, c);
    for (const Around &of_node : complete)
      for (const std::uint32_t c : of_node)
        pattern.add_entries(c, of_node.begin(), of_node.end());
    matrix->of_pressure.clear();
    matrix->pressure_pattern.copy_from(pattern);
    matrix->of_pressure.reinit(matrix->pressure_pattern);
    std::vector<double> root(volumes.size());
    for (std::size_t c = 0; c < volumes.size(); ++c)
      {
        root[c] = 1 / std::sqrt(volumes[c].shear);
        matrix->of_pressure.add(c,
                                c,
                                1 / (volumes[c].kept + volumes[c].stiffness) +
                                  root[c] * root[c]);
      }
    for (const Around &of_node : complete)
      for (unsigned int directions = 0; directions < n; ++directions)
        if (__builtin_popcount(directions) >= 2)
          for (unsigned int i = 0; i < n; ++i)
            for (unsigned int j = 0; j < n; ++j)
              {
                const double sign =
                  __builtin_popcount((i ^ j) & directions) % 2 == 0 ? 1 : -1;
                matrix->of_pressure.add(of_node[i],
                                        of_node[j],
                                        -alternating_share * sign *
                                          root[of_node[i]] * root[of_node[j]] /
                                          (n * n));
              }
  }



  template <int dim>
  unsigned int
  NewtonEquations<dim>::solve_mixed(NodalVector               &solution,
                                    const NodalVector         &right_side,
                                    const std::vector<double> &of_held)
  {
    if (!matrix->mixed_solver)
      make_mixed_solver(rigid_motions());
    // what held components do to the volumes
    std::vector<double> of_volumes;
    for (const typename Matrix::Volume &volume : matrix->volumes)
      {
        of_volumes.push_back(0);
        for (unsigned int k = 0; k < volume.row.size(); ++k)
          {
            const std::size_t column =
              std::size_t(volume.numbers[k / dim]) * dim + k % dim;
            if (is_held(column))
              of_volumes.back() -= volume.row[k] * of_held[column];
          }
      }
    return matrix->mixed_solver->solve(solution, right_side, of_volumes);
  }



  // One after the other
  template <int dim>
  std::vector<double>
  NewtonEquations<dim>::rigid_motions() const
  {
    std::vector<double> result(n_rigid_motions<dim> * size());
    for (unsigned int m = 0; m < n_rigid_motions<dim>; ++m)
      for (std::size_t k = 0; k < size(); ++k)
        result[m * size() + k] = rigid_motion<dim>(m,
                                                   k % dim,
                                                   nodes.places()[k / dim],
                                                   nodes.places()[0]);
    return result;
  }



  template <int dim>
  void
  NewtonEquations<dim>::add_to_matrix(const std::uint32_t *const numbers,
                                      const unsigned int         n_nodes,
                                      const double *const        block)
  {
    constexpr unsigned int most = 3 * dim << dim; // of a cell or two
    std::array<dealii::types::global_dof_index, most> columns;
    std::array<double, most>                          values;
    const unsigned int                                n = n_nodes * dim;
    for (unsigned int k = 0; k < n; ++k)
      {
        const std::size_t row = std::size_t(numbers[k / dim]) * dim + k % dim;
        if (is_held(row))
          continue;
        unsigned int found = 0;
        for (unsigned int l = 0; l < n; ++l)
          {
            const std::size_t column =
              std::size_t(numbers[l / dim]) * dim + l % dim;
            if (is_held(column))
              {
                matrix->rows.push_back(row);
                matrix->columns.push_back(column);
                matrix->of_held.push_back(block[k * n + l]);
                continue;
              }
            columns[found]  = column;
            values[found++] = block[k * n + l];
          }
        matrix->values.add(
          row, found, columns.data(), values.data(), false, false);
      }
  }



  template <int dim>
  void
  NewtonEquations<dim>::add_ghost_forces(
    const std::vector<double> &displacement)
  {
    constexpr unsigned int n = 1 << (dim - 1);
    energy_of_jumps          = 0;
    for (const GhostFace &face : ghost_faces)
      for (int d = 0; d < dim; ++d)
        {
          std::array<double, n> jump{};
          for (unsigned int i = 0; i < n; ++i)
            for (unsigned int k = 0; k < 3; ++k)
              jump[i] += second_difference[k] *
                         displacement[std::size_t(face.lines[i][k]) * dim + d];
          for (unsigned int i = 0; i < n; ++i)
            {
              double force = 0;
              for (unsigned int j = 0; j < n; ++j)
                force += face.stiffness * face_mass<dim>(i, j) * jump[j];
              energy_of_jumps += 0.5 * force * jump[i];
              for (unsigned int k = 0; k < 3; ++k)
                total_forces[std::size_t(face.lines[i][k]) * dim + d] +=
                  second_difference[k] * force;
            }
        }
  }



  template <int dim>
  void
  NewtonEquations<dim>::add_ghost_tangent()
  {
    constexpr unsigned int n_lines = 1 << (dim - 1), n = 3 * n_lines * dim;
    std::vector<double>    block(n * n);
    std::array<std::uint32_t, 3 * n_lines> numbers;
    for (const GhostFace &face : ghost_faces)
      {
        for (unsigned int i = 0; i < n_lines; ++i)
          for (unsigned int k = 0; k < 3; ++k)
            {
              numbers[3 * i + k] = face.lines[i][k];
              for (unsigned int j = 0; j < n_lines; ++j)
                for (unsigned int l = 0; l < 3; ++l)
                  for (int d = 0; d < dim; ++d)
                    block[((3 * i + k) * dim + d) * n + (3 * j + l) * dim + d] =
                      face.stiffness * face_mass<dim>(i, j) *
                      second_difference[k] * second_difference[l];
            }
        add_to_matrix(numbers.data(), 3 * n_lines, block.data());
      }
  }



  template <int dim>
  bool
  NewtonEquations<dim>::solve(const std::vector<double> &unbalanced,
                              const std::vector<double> &of_held,
                              std::vector<double>       &correction)
  {
    if (!is_iterated() && !matrix->volumes.empty())
      condense_volumes();
    NodalVector right_side(size()), solution(size());
    for (std::size_t k = 0; k < size(); ++k)
      right_side[k] = is_held(k) ? of_held[k] * matrix->largest : unbalanced[k];
    for (std::size_t e = 0; e < matrix->rows.size(); ++e)
      right_side[matrix->rows[e]] -=
        matrix->of_held[e] * of_held[matrix->columns[e]];
    try
      {
        n_linear_iterations += matrix->volumes.empty() ?
                                 solve_condensed(solution, right_side) :
                                 solve_mixed(solution, right_side, of_held);
      }
    catch (const ComputationError &)
      {
        if (!is_iterated())
          return false;
        factorises_all = true; // from now on
        return solve(unbalanced, of_held, correction);
      }
    correction.resize(size());
    double all = 0;
    for (std::size_t k = 0; k < size(); ++k)
      {
        correction[k] = solution[k];
        all += std::abs(correction[k]);
      }
    return std::isfinite(all);
  }



  template <int dim>
  unsigned int
  NewtonEquations<dim>::solve_condensed(NodalVector       &solution,
                                        const NodalVector &right_side)
  {
    if (!matrix->solver || matrix->solver->direct == is_iterated())
      {
        matrix->is_factorised = false;
        matrix->solver.emplace(!is_iterated(), dim, rigid_motions());
      }
    if (!matrix->is_factorised)
      matrix->solver->set_matrix(matrix->values);
    matrix->is_factorised = true;
    return matrix->solver->solve(solution, right_side);
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
