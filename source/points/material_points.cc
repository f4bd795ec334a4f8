// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/records_of_ranks.h>
#include <limber/points/material_points.h>

#include <algorithm>
#include <map>
#include <numeric>

namespace limber
{
  namespace
  {
    // Sweeps read and write up to one pack beyond the last point.
    constexpr std::size_t padding = 8;



    template <int dim>
    unsigned int
    count_fields(const PointLayout &layout)
    {
      return 2 * dim + 2 + (layout.deviator ? n_deviator<dim> : 0) +
             layout.n_history + (layout.affine ? dim * dim : 0) +
             (layout.acceleration ? dim : 0) + (layout.crossings ? 1 : 0) +
             (layout.reach ? 1 : 0) +
             (layout.stretch ? dim * (dim + 1) / 2 : 0) +
             (layout.edges ? dim : 0) +
             n_domain_components(layout.domains, dim) +
             (layout.initial_frame ? dim * dim : 0) +
             (layout.has_reference() ? dim : 0);
    }
  } // namespace



  template <int dim>
  MaterialPoints<dim>::MaterialPoints(const BackgroundGrid<dim> &grid,
                                      const PointLayout         &layout)
    : grid(grid)
    , layout(layout)
    , fields(count_fields<dim>(layout))
  {
    resize(0);
  }



  template <int dim>
  void
  MaterialPoints<dim>::reserve(const std::size_t n)
  {
    for (auto &field : fields)
      field.reserve(n + padding);
    cell.reserve(n);
    ids.reserve(n);
    if (layout.size_class)
      size_classes.reserve(n);
  }



  template <int dim>
  void
  MaterialPoints<dim>::add(const std::uint32_t           cell,
                           const dealii::Point<dim>     &place,
                           const double                  mass,
                           const dealii::Tensor<2, dim> &half_edges)
  {
    const std::size_t p = size();
    for (auto &field : fields)
      field.push_back(0.);
    for (int d = 0; d < dim; ++d)
      {
        fields[d][p] = place[d];
        if (layout.has_reference())
          fields[fields.size() - dim + d][p] = place[d];
      }
    if (layout.initial_frame)
      for (int d = 0; d < dim; ++d)
        fields[fields.size() - dim - dim * dim + d * (dim + 1)][p] = 1;
    fields[2 * dim][p] = mass;
    if (layout.domains != DomainForm::none)
      {
        const auto domain = view().domain;
        for (int d = 0; d < dim; ++d)
          for (int k = 0; k < dim; ++k)
            if (domain[d * dim + k] != nullptr)
              domain[d * dim + k][p] = half_edges[d][k];
      }
    this->cell.push_back(cell);
    ids.push_back(p);
    if (layout.size_class)
      size_classes.push_back(char(grid.level_of(cell)));
  }



  template <int dim>
  void
  MaterialPoints<dim>::finish_adding()
  {
    // Ids are unique over all ranks: each rank continues after the previous
    // one.
    const unsigned long own    = size();
    unsigned long       before = 0;
    const int           ierr   = MPI_Exscan(
      &own, &before, 1, MPI_UNSIGNED_LONG, MPI_SUM, grid.communicator);
    AssertThrowMPI(ierr);
    if (dealii::Utilities::MPI::this_mpi_process(grid.communicator) == 0)
      before = 0;
    std::iota(ids.begin(), ids.end(), before);
    ++n_reorderings;
  }



  template <int dim>
  PointView<dim>
  MaterialPoints<dim>::view()
  {
    PointView<dim> result;
    result.size    = size();
    unsigned int f = 0;
    for (auto &array : result.position)
      array = fields[f++].data();
    for (auto &array : result.velocity)
      array = fields[f++].data();
    result.mass     = fields[f++].data();
    result.pressure = fields[f++].data();
    if (layout.deviator)
      for (auto &array : result.deviator)
        array = fields[f++].data();
    for (unsigned int k = 0; k < layout.n_history; ++k)
      result.history[k] = fields[f++].data();
    if (layout.affine)
      for (auto &array : result.affine)
        array = fields[f++].data();
    if (layout.acceleration)
      for (auto &array : result.acceleration)
        array = fields[f++].data();
    if (layout.crossings)
      result.crossings = fields[f++].data();
    if (layout.reach)
      result.reach = fields[f++].data();
    if (layout.stretch)
      for (auto &array : result.stretch)
        array = fields[f++].data();
    if (layout.edges)
      for (auto &array : result.edge)
        array = fields[f++].data();
    result.domain_form = layout.domains;
    for (unsigned int k = 0, n = n_domain_components(layout.domains, dim);
         k < n;
         ++k)
      result.domain[n == dim ? k * (dim + 1) : k] = fields[f++].data();
    if (layout.initial_frame)
      for (auto &array : result.deformation)
        array = fields[f++].data();
    result.place = result.position;
    if (layout.initial_frame)
      for (auto &array : result.place)
        array = fields[f++].data();
    result.volumetric = layout.volumetric < 0 ?
                          result.pressure :
                          result.history[layout.volumetric];
    result.cell       = cell.data();
    return result;
  }



  template <int dim>
  PointView<dim>
  MaterialPoints<dim>::view() const
  {
    return const_cast<MaterialPoints<dim> &>(*this).view();
  }



  template <int dim>
  std::size_t
  MaterialPoints<dim>::n_global() const
  {
    return dealii::Utilities::MPI::sum<unsigned long>(size(),
                                                      grid.communicator);
  }



  template <int dim>
  dealii::Point<dim>
  MaterialPoints<dim>::reference_position(const std::size_t p) const
  {
    Assert(layout.has_reference(), dealii::ExcInternalError());
    dealii::Point<dim> result;
    for (int d = 0; d < dim; ++d)
      result[d] = fields[fields.size() - dim + d][p];
    return result;
  }



  template <int dim>
  std::vector<std::string>
  MaterialPoints<dim>::field_names() const
  {
    std::vector<std::string> names;
    const auto               components = [&](const std::string &name,
                                const std::string &letters) {
      for (const char letter : letters)
        names.push_back(name + " " + letter);
    };
    const auto numbered = [&](const std::string &name, const unsigned int n) {
      for (unsigned int i = 0; i < n; ++i)
        names.push_back(name + " " + std::to_string(i));
    };
    const std::string axes = dim == 2 ? "xy" : "xyz";
    components("position", axes);
    components("velocity", axes);
    names.push_back("mass");
    names.push_back("pressure");
    numbered("deviator", layout.deviator ? n_deviator<dim> : 0);
    numbered("history", layout.n_history);
    numbered("affine", layout.affine ? dim * dim : 0);
    if (layout.acceleration)
      components("acceleration", axes);
    if (layout.crossings)
      names.push_back("crossings");
    if (layout.reach)
      names.push_back("reach");
    numbered("stretch", layout.stretch ? dim * (dim + 1) / 2 : 0);
    if (layout.edges)
      for (int d = 0; d < dim; ++d)
        names.push_back("edge " + std::string(1, "xyz"[d]));
    numbered("domain", n_domain_components(layout.domains, dim));
    numbered("deformation gradient", layout.initial_frame ? dim * dim : 0);
    if (layout.has_reference())
      components("reference position", axes);
    return names;
  }



  template <int dim>
  void
  MaterialPoints<dim>::clear()
  {
    resize(0);
    ++n_reorderings;
  }



  template <int dim>
  void
  MaterialPoints<dim>::append(
    const std::vector<std::uint32_t>       &new_cells,
    const std::vector<std::uint64_t>       &new_ids,
    const std::vector<std::vector<double>> &new_fields,
    const std::vector<char>                &new_size_classes)
  {
    const std::size_t before = size();
    resize(before + new_cells.size());
    std::copy(new_cells.begin(), new_cells.end(), cell.begin() + before);
    std::copy(new_ids.begin(), new_ids.end(), ids.begin() + before);
    for (std::size_t f = 0; f < fields.size(); ++f)
      std::copy(new_fields[f].begin(),
                new_fields[f].end(),
                fields[f].begin() + before);
    std::copy(new_size_classes.begin(),
              new_size_classes.end(),
              size_classes.begin() + (layout.size_class ? before : 0));
    ++n_reorderings;
  }



  template <int dim>
  std::vector<std::uint32_t>
  MaterialPoints<dim>::occupied_cells() const
  {
    // One bit per cell: sorting cell numbers would take as long as reordering
    // the points.
    constexpr unsigned int     n_bits = 64;
    std::vector<std::uint64_t> holds_points(grid.n_cells() / n_bits + 1);
    for (std::size_t p = 0; p < cell.size(); ++p)
      if (p == 0 || cell[p] != cell[p - 1])
        holds_points[cell[p] / n_bits] |= std::uint64_t(1) << cell[p] % n_bits;
    std::vector<std::uint32_t> cells;
    for (std::size_t word = 0; word < holds_points.size(); ++word)
      for (std::uint64_t bits = holds_points[word]; bits != 0; bits &= bits - 1)
        cells.push_back(word * n_bits + __builtin_ctzll(bits));
    return cells;
  }



  template <int dim>
  std::vector<std::uint32_t>
  MaterialPoints<dim>::sort_by_cell()
  {
    ++n_reorderings;
    std::vector<std::uint32_t> cells = occupied_cells();

    // Only entries of occupied cells are initialised: empty cells cost nothing.
    const std::unique_ptr<std::uint32_t[]> offset(
      new std::uint32_t[grid.n_cells()]);
    for (const std::uint32_t c : cells)
      offset[c] = 0;
    for (const std::uint32_t c : cell)
      ++offset[c];
    std::uint32_t begin = 0;
    for (const std::uint32_t c : cells)
      begin += std::exchange(offset[c], begin);

    std::vector<std::uint32_t> target(size());
    for (std::size_t p = 0; p < size(); ++p)
      target[p] = offset[cell[p]]++;

    const auto reorder = [&target](auto &array, auto &scratch) {
      for (std::size_t p = 0; p < target.size(); ++p)
        scratch[target[p]] = array[p];
      array.swap(scratch);
    };
    {
      std::vector<double> scratch(size() + padding);
      for (auto &field : fields)
        reorder(field, scratch);
    }
    {
      std::vector<std::uint64_t> scratch(size());
      reorder(ids, scratch);
    }
    if (layout.size_class)
      {
        std::vector<char> scratch(size());
        reorder(size_classes, scratch);
      }
    std::vector<std::uint32_t> scratch(size());
    reorder(cell, scratch);
    return cells;
  }



  template <int dim>
  std::vector<LostPoint<dim>>
  MaterialPoints<dim>::remove_lost()
  {
    ++n_reorderings;
    std::vector<LostPoint<dim>> result;
    std::size_t                 kept = 0;
    const auto                  box =
      std::make_pair(grid.description.lower, grid.description.upper);
    const PointView<dim> points = view();
    for (std::size_t p = 0; p < size(); ++p)
      {
        if (cell[p] == invalid_cell)
          {
            LostPoint<dim> lost;
            lost.id   = id(p);
            lost.mass = points.mass[p];
            for (int d = 0; d < dim; ++d)
              {
                lost.position[d] = points.position[d][p];
                lost.momentum[d] = points.mass[p] * points.velocity[d][p];
                lost.left_the_box |= lost.position[d] < box.first[d] ||
                                     lost.position[d] > box.second[d];
              }
            result.push_back(lost);
            continue;
          }
        move(p, kept++);
      }
    resize(kept);
    return result;
  }



  template <int dim>
  void
  MaterialPoints<dim>::move(const std::size_t from, const std::size_t to)
  {
    if (from == to)
      return;
    for (auto &field : fields)
      field[to] = field[from];
    cell[to] = cell[from];
    ids[to]  = ids[from];
    if (layout.size_class)
      size_classes[to] = size_classes[from];
  }



  template <int dim>
  void
  MaterialPoints<dim>::write_record(const std::size_t p, double *record) const
  {
    for (const auto &field : fields)
      *record++ = field[p];
    *record++ = ids[p]; // exact in a double below 2^53
    if (layout.size_class)
      *record = size_classes[p];
  }



  template <int dim>
  void
  MaterialPoints<dim>::read_record(const double *record, const std::size_t p)
  {
    for (auto &field : fields)
      field[p] = *record++;
    ids[p] = *record++;
    if (layout.size_class)
      size_classes[p] = char(*record);
  }



  template <int dim>
  void
  MaterialPoints<dim>::hand_over()
  {
    if (dealii::Utilities::MPI::n_mpi_processes(grid.communicator) == 1)
      return;

    ++n_reorderings;
    // After each record follows the receiver's number of the cell, so that the
    // receiver need not search.
    const std::size_t                           stride = record_size() + 1;
    std::map<unsigned int, std::vector<double>> leaving;
    std::size_t                                 kept = 0;
    for (std::size_t p = 0; p < size(); ++p)
      if (cell[p] >= grid.n_owned_cells())
        {
          const auto &there   = grid.ghost_cell(cell[p]);
          auto       &records = leaving[there.owner];
          records.resize(records.size() + stride);
          write_record(p, records.data() + records.size() - stride);
          records.back() = there.number;
        }
      else
        move(p, kept++);

    const auto  arriving = exchange_records(leaving, grid.communicator);
    std::size_t n        = kept;
    for (const auto &[rank, records] : arriving)
      n += records.size() / stride;
    resize(n);
    for (const auto &[rank, records] : arriving)
      for (auto record = records.begin(); record != records.end();
           record += stride, ++kept)
        {
          read_record(&*record, kept);
          cell[kept] = record[record_size()];
        }
  }



  template <int dim>
  void
  MaterialPoints<dim>::prepare_mesh_change()
  {
    // Points must be in owned cells before these change.
    hand_over();
    sort_by_cell();
    carrier = std::make_unique<dealii::Particles::ParticleHandler<dim>>(
      grid.triangulation, grid.mapping, record_size());
    carrier->reserve(size());
    std::vector<double>  record(record_size());
    const PointView<dim> points = view();
    for (const auto &owner : grid.triangulation.active_cell_iterators())
      if (owner->is_locally_owned())
        {
          const auto [begin, end] =
            std::equal_range(cell.begin(), cell.end(), grid.cell_number(owner));
          for (std::size_t p = begin - cell.begin();
               p < std::size_t(end - cell.begin());
               ++p)
            {
              write_record(p, record.data());
              dealii::Point<dim> place;
              for (int d = 0; d < dim; ++d)
                place[d] = points.place[d][p];
              carrier->insert_particle(
                place,
                grid.mapping.transform_real_to_unit_cell(owner, place),
                p,
                owner,
                dealii::ArrayView<const double>(record));
            }
        }
    carrier->update_cached_numbers();
    // The carrier holds copies; the arrays are freed to make room for them.
    for (auto &field : fields)
      std::vector<double>().swap(field);
    resize(0);
    carrier->prepare_for_coarsening_and_refinement();
  }



  template <int dim>
  void
  MaterialPoints<dim>::finish_mesh_change()
  {
    carrier->unpack_after_coarsening_and_refinement();
    resize(carrier->n_locally_owned_particles());
    std::size_t p = 0;
    for (const auto &particle : *carrier)
      {
        read_record(particle.get_properties().data(), p);
        cell[p] = grid.cell_number(particle.get_surrounding_cell());
        ++p;
      }
    carrier.reset();
    ++n_reorderings;
  }



  template <int dim>
  void
  MaterialPoints<dim>::find_cells()
  {
    const PointView<dim> points = view();
    for (std::size_t p = 0; p < size(); ++p)
      {
        std::array<double, dim> x;
        for (int d = 0; d < dim; ++d)
          x[d] = points.place[d][p];
        cell[p] = grid.bins.cell_at(x);
      }
    ++n_reorderings;
  }



  template <int dim>
  void
  MaterialPoints<dim>::resize(const std::size_t n)
  {
    // Reserve exactly: vectors would double their capacity.
    reserve(n);
    for (auto &field : fields)
      {
        field.resize(n + padding);
        // The padding is read and multiplied by zero, so it must be finite.
        std::fill(field.end() - padding, field.end(), 0.);
      }
    cell.resize(n);
    ids.resize(n);
    if (layout.size_class)
      size_classes.resize(n);
  }



  template class MaterialPoints<2>;
  template class MaterialPoints<3>;
} // namespace limber
