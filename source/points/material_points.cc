// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/points/material_points.h>

#include <algorithm>
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
             layout.n_history + (layout.affine ? dim * dim : 0);
    }



    /**
     * Points that never leave this rank need not be carried: of these the
     * handler knows no more than where they were at the start, if asked for.
     */
    template <int dim>
    unsigned int
    count_properties(const PointLayout &layout, const MPI_Comm communicator)
    {
      const bool carried =
        dealii::Utilities::MPI::n_mpi_processes(communicator) > 1;
      return (layout.reference ? dim : 0) +
             (carried ? count_fields<dim>(layout) - dim : 0);
    }
  } // namespace



  template <int dim>
  MaterialPoints<dim>::MaterialPoints(const BackgroundGrid<dim> &grid,
                                      const PointLayout         &layout)
    : handler(grid.triangulation,
              grid.mapping,
              count_properties<dim>(layout, grid.communicator))
    , grid(grid)
    , layout(layout)
    , n_fields(count_fields<dim>(layout))
    , n_properties(count_properties<dim>(layout, grid.communicator))
    , first_carried(layout.reference ? dim : 0)
    , fields(n_fields)
  {
    resize(0);
  }



  template <int dim>
  void
  MaterialPoints<dim>::add(
    const typename dealii::Triangulation<dim>::active_cell_iterator &cell,
    const dealii::Point<dim>                                        &place,
    const double                                                     mass)
  {
    std::vector<double> properties(n_properties, 0.);
    if (layout.reference)
      for (int d = 0; d < dim; ++d)
        properties[d] = place[d];
    seeded_masses.push_back(mass);
    handler.insert_particle(place,
                            grid.mapping.transform_real_to_unit_cell(cell,
                                                                     place),
                            handler.n_locally_owned_particles(),
                            cell,
                            dealii::ArrayView<const double>(properties));
  }



  template <int dim>
  void
  MaterialPoints<dim>::finish_adding()
  {
    // Numbers are unique over all ranks: this rank's follow its predecessors'.
    const unsigned long own    = handler.n_locally_owned_particles();
    unsigned long       before = 0;
    const int           ierr   = MPI_Exscan(
      &own, &before, 1, MPI_UNSIGNED_LONG, MPI_SUM, grid.communicator);
    AssertThrowMPI(ierr);
    if (dealii::Utilities::MPI::this_mpi_process(grid.communicator) == 0)
      before = 0;
    dealii::types::particle_index number = before;
    for (auto &particle : handler)
      particle.set_id(number++);
    handler.update_cached_numbers();

    gather();
    // Slots of the handler's pool are taken in the order of insertion.
    for (std::size_t p = 0; p < size(); ++p)
      fields[2 * dim][p] = seeded_masses[handle[p]];
    std::vector<double>().swap(seeded_masses);
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
  dealii::types::particle_index
  MaterialPoints<dim>::id(const std::size_t p) const
  {
    return handler.get_property_pool().get_id(handle[p]);
  }



  template <int dim>
  dealii::Point<dim>
  MaterialPoints<dim>::reference_position(const std::size_t p) const
  {
    const auto properties =
      handler.get_property_pool().get_properties(handle[p]);
    dealii::Point<dim> result;
    for (int d = 0; d < dim; ++d)
      result[d] = properties[d];
    return result;
  }



  template <int dim>
  void
  MaterialPoints<dim>::collect_cells(std::vector<std::uint32_t> &cells) const
  {
    const std::size_t before = cells.size();
    for (std::size_t p = 0; p < cell.size(); ++p)
      if (p == 0 || cell[p] != cell[p - 1])
        cells.push_back(cell[p]);
    std::sort(cells.begin() + before, cells.end());
    cells.erase(std::unique(cells.begin() + before, cells.end()), cells.end());
  }



  template <int dim>
  void
  MaterialPoints<dim>::sort_by_cell()
  {
    ++n_reorderings;
    std::vector<std::uint32_t> cells;
    collect_cells(cells);

    // Only the entries of occupied cells are touched: an empty box is free.
    offset.resize(grid.n_cells());
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

    std::vector<double> sorted(size() + padding);
    for (auto &field : fields)
      {
        for (std::size_t p = 0; p < target.size(); ++p)
          sorted[target[p]] = field[p];
        field.swap(sorted);
      }
    for (auto *const numbers : {&cell, &handle})
      {
        std::vector<std::uint32_t> reordered(size());
        for (std::size_t p = 0; p < target.size(); ++p)
          reordered[target[p]] = (*numbers)[p];
        numbers->swap(reordered);
      }
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
            lost_handles.push_back(handle[p]);
            continue;
          }
        if (kept != p)
          {
            for (auto &field : fields)
              field[kept] = field[p];
            cell[kept]   = cell[p];
            handle[kept] = handle[p];
          }
        ++kept;
      }
    resize(kept);
    return result;
  }



  template <int dim>
  void
  MaterialPoints<dim>::write_back()
  {
    auto &pool = handler.get_property_pool();
    for (std::size_t p = 0; p < size(); ++p)
      {
        dealii::Point<dim> place;
        for (int d = 0; d < dim; ++d)
          place[d] = fields[d][p];
        pool.set_location(handle[p], place);
        const auto properties = pool.get_properties(handle[p]);
        for (unsigned int k = first_carried; k < n_properties; ++k)
          properties[k] = fields[dim + k - first_carried][p];
      }

    if (lost_handles.empty())
      return;
    std::sort(lost_handles.begin(), lost_handles.end());
    std::vector<
      typename dealii::Particles::ParticleHandler<dim>::particle_iterator>
      lost;
    for (auto particle = handler.begin(); particle != handler.end(); ++particle)
      if (std::binary_search(lost_handles.begin(),
                             lost_handles.end(),
                             particle->get_local_index()))
        lost.push_back(particle);
    handler.remove_particles(lost);
    lost_handles.clear();
  }



  template <int dim>
  void
  MaterialPoints<dim>::gather()
  {
    ++n_reorderings;
    resize(handler.n_locally_owned_particles());
    auto       &pool = handler.get_property_pool();
    std::size_t p    = 0;
    for (const auto &particle : handler)
      {
        handle[p]         = particle.get_local_index();
        cell[p]           = grid.cell_number(particle.get_surrounding_cell());
        const auto &place = particle.get_location();
        for (int d = 0; d < dim; ++d)
          fields[d][p] = place[d];
        const auto properties = pool.get_properties(handle[p]);
        for (unsigned int k = first_carried; k < n_properties; ++k)
          fields[dim + k - first_carried][p] = properties[k];
        ++p;
      }
  }



  template <int dim>
  void
  MaterialPoints<dim>::hand_over()
  {
    write_back();
    // The sort holds all points twice; the arrays make room for it.
    for (auto &field : fields)
      std::vector<double>().swap(field);
    resize(0);
    handler.sort_particles_into_subdomains_and_cells();
  }



  template <int dim>
  void
  MaterialPoints<dim>::synchronise()
  {
    if (!is_carried())
      return sort_by_cell();
    hand_over();
    gather();
  }



  template <int dim>
  bool
  MaterialPoints<dim>::is_carried() const
  {
    return n_properties > first_carried;
  }



  template <int dim>
  void
  MaterialPoints<dim>::prepare_mesh_change()
  {
    AssertThrow(is_carried(), dealii::ExcInternalError());
    // Points must be in their cells before these are split or moved.
    hand_over();
    handler.prepare_for_coarsening_and_refinement();
  }



  template <int dim>
  void
  MaterialPoints<dim>::finish_mesh_change()
  {
    handler.unpack_after_coarsening_and_refinement();
    // Unpacking leaves memory in disorder; the sort mends it.
    handler.sort_particles_into_subdomains_and_cells();
    gather();
  }



  template <int dim>
  void
  MaterialPoints<dim>::resize(const std::size_t n)
  {
    for (auto &field : fields)
      {
        field.resize(n + padding);
        // What lies beyond the points is read, multiplied by zero, and so has
        // to be finite.
        std::fill(field.end() - padding, field.end(), 0.);
      }
    cell.resize(n);
    handle.resize(n);
  }



  template <int dim>
  std::size_t
  MaterialPoints<dim>::memory_consumption() const
  {
    return fields.size() * (size() + padding) * sizeof(double) +
           2 * size() * sizeof(std::uint32_t);
  }



  template class MaterialPoints<2>;
  template class MaterialPoints<3>;
} // namespace limber
