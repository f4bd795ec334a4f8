// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/fe/mapping_q1.h>

#include <deal.II/numerics/rtree.h>

#include <limber/fem/solid_samples.h>

namespace limber
{
  namespace
  {
    /** Whether a place lies in a cell, and where in it. */
    template <int dim>
    bool
    find_in_cell(
      const dealii::Mapping<dim>                                   &mapping,
      const typename dealii::DoFHandler<dim>::active_cell_iterator &cell,
      const dealii::Point<dim>                                     &place,
      dealii::Point<dim>                                           &unit)
    {
      constexpr double tolerance = 1e-8; // of round-off between cells
      try
        {
          unit = mapping.transform_real_to_unit_cell(cell, place);
        }
      catch (const typename dealii::Mapping<dim>::ExcTransformationFailed &)
        {
          return false;
        }
      if (!dealii::GeometryInfo<dim>::is_inside_unit_cell(unit, tolerance))
        return false;
      unit = dealii::GeometryInfo<dim>::project_to_unit_cell(unit);
      return true;
    }



    /** Samples at places in one cell, given in reference coordinates. */
    template <int dim>
    void
    fill_samples(
      const SolidModel<dim>                                        &model,
      const typename dealii::DoFHandler<dim>::active_cell_iterator &cell,
      const std::vector<dealii::Point<dim>>                        &unit_places,
      const NodalVector             &displacement,
      const NodalVector             &velocity,
      std::vector<PlaceSample<dim>> &samples)
    {
      dealii::FEValues<dim> values(model.shape_values(model.quadrature));
      dealii::FEValues<dim> places(
        model.shape_values(dealii::Quadrature<dim>(unit_places)));
      values.reinit(cell);
      places.reinit(cell);
      const auto u      = model.values_of(cell, displacement);
      const auto v      = model.values_of(cell, velocity);
      const auto states = model.states(cell, values, places, displacement);
      samples.assign(unit_places.size(), PlaceSample<dim>());
      for (unsigned int q = 0; q < unit_places.size(); ++q)
        {
          samples[q].inside   = true;
          samples[q].material = states[q];
          for (unsigned int i = 0; i < u.size(); ++i)
            {
              const unsigned int c =
                model.fe.system_to_component_index(i).first;
              samples[q].displacement[c] += places.shape_value(i, q) * u[i];
              samples[q].velocity[c] += places.shape_value(i, q) * v[i];
            }
        }
    }
  } // namespace



  template <int dim>
  PlaceSample<dim>
  sample_at(const SolidModel<dim>    &model,
            const dealii::Point<dim> &place,
            const NodalVector        &displacement,
            const NodalVector        &velocity)
  {
    constexpr unsigned int n_stress = 9;
    // count, displacement, velocity, volume ratio, pressure, stress, variables
    std::vector<double> sums(1 + 2 * dim + 2 + n_stress + max_variables);
    const dealii::MappingQ1<dim>  mapping;
    std::vector<PlaceSample<dim>> here;
    for (const auto &cell : model.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned() &&
          cell->bounding_box().point_inside(place, 1e-6))
        {
          dealii::Point<dim> unit;
          if (!find_in_cell<dim>(mapping, cell, place, unit))
            continue;
          fill_samples(model, cell, {unit}, displacement, velocity, here);
          const PlaceSample<dim> &found = here.front();
          sums[0] += 1;
          for (unsigned int d = 0; d < dim; ++d)
            {
              sums[1 + d] += found.displacement[d];
              sums[1 + dim + d] += found.velocity[d];
            }
          sums[1 + 2 * dim] += found.material.volume_ratio;
          sums[2 + 2 * dim] += found.material.pressure;
          for (unsigned int k = 0; k < n_stress; ++k)
            sums[3 + 2 * dim + k] += found.material.stress[k / 3][k % 3];
          for (unsigned int k = 0; k < max_variables; ++k)
            sums[3 + 2 * dim + n_stress + k] += found.material.variables[k];
        }
    dealii::Utilities::MPI::sum(sums, model.communicator, sums);

    PlaceSample<dim> result;
    result.inside = sums[0] > 0;
    if (!result.inside)
      return result;
    for (unsigned int d = 0; d < dim; ++d)
      {
        result.displacement[d] = sums[1 + d] / sums[0];
        result.velocity[d]     = sums[1 + dim + d] / sums[0];
      }
    result.material.volume_ratio = sums[1 + 2 * dim] / sums[0];
    result.material.pressure     = sums[2 + 2 * dim] / sums[0];
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j <= i; ++j)
        result.material.stress[i][j] = sums[3 + 2 * dim + 3 * i + j] / sums[0];
    for (unsigned int k = 0; k < max_variables; ++k)
      result.material.variables[k] = sums[3 + 2 * dim + n_stress + k] / sums[0];
    return result;
  }



  namespace
  {
    /** Calls function with each cell that contains some of the places, their
     * reference coordinates and numbers; every place with one cell. */
    template <int dim, class Function>
    void
    for_each_cell_with(const SolidModel<dim>                 &model,
                       const std::vector<dealii::Point<dim>> &places,
                       const Function                        &function)
    {
      // R-tree of the places: the bounding box of each cell finds those in it.
      std::vector<std::pair<dealii::Point<dim>, std::size_t>> entries;
      for (std::size_t p = 0; p < places.size(); ++p)
        entries.emplace_back(places[p], p);
      const auto tree = dealii::pack_rtree(entries);

      const dealii::MappingQ1<dim>    mapping;
      std::vector<bool>               found(places.size(), false);
      std::vector<dealii::Point<dim>> unit_places;
      std::vector<std::size_t>        indices;
      for (const auto &cell : model.dof_handler.active_cell_iterators())
        {
          unit_places.clear();
          indices.clear();
          dealii::BoundingBox<dim> box = cell->bounding_box();
          box.extend(1e-6 * model.smallest_edge);
          for (auto it = tree.qbegin(boost::geometry::index::intersects(box));
               it != tree.qend();
               ++it)
            {
              dealii::Point<dim> unit;
              if (!found[it->second] &&
                  find_in_cell<dim>(mapping, cell, it->first, unit))
                {
                  found[it->second] = true;
                  unit_places.push_back(unit);
                  indices.push_back(it->second);
                }
            }
          if (!indices.empty())
            function(cell, unit_places, indices);
        }
    }
  } // namespace



  template <int dim>
  std::vector<PlaceSample<dim>>
  sample_at(const SolidModel<dim>                 &model,
            const std::vector<dealii::Point<dim>> &places,
            const NodalVector                     &displacement,
            const NodalVector                     &velocity)
  {
    std::vector<PlaceSample<dim>> result(places.size()), here;
    for_each_cell_with(
      model,
      places,
      [&](const auto &cell, const auto &unit_places, const auto &indices) {
        fill_samples(model, cell, unit_places, displacement, velocity, here);
        for (std::size_t k = 0; k < indices.size(); ++k)
          result[indices[k]] = here[k];
      });
    return result;
  }



  template <int dim>
  std::vector<QuadratureSample<dim>>
  quadrature_samples(const SolidModel<dim> &model,
                     const NodalVector     &displacement,
                     const NodalVector     &velocity)
  {
    std::vector<QuadratureSample<dim>> result;
    std::vector<PlaceSample<dim>>      here;
    dealii::FEValues<dim> values(model.shape_values(model.quadrature));
    for (const auto &cell : model.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          values.reinit(cell);
          fill_samples(model,
                       cell,
                       model.quadrature.get_points(),
                       displacement,
                       velocity,
                       here);
          for (const unsigned int q : values.quadrature_point_indices())
            result.push_back(
              {values.quadrature_point(q), values.JxW(q), here[q]});
        }
    return result;
  }



  template <int dim>
  std::vector<NodalStress>
  interpolate_at(const SolidModel<dim>                 &model,
                 const std::vector<dealii::Point<dim>> &places,
                 const std::vector<NodalStress>        &nodal)
  {
    std::vector<std::size_t> node_of(model.dof_handler.n_dofs());
    std::size_t              n_nodes = 0;
    model.for_each_owned_node([&](const auto &, const auto &dofs) {
      for (const auto dof : dofs)
        node_of[dof] = n_nodes;
      ++n_nodes;
    });
    std::vector<NodalStress>                     result(places.size());
    const auto                                  &fe = model.fe.base_element(0);
    std::vector<dealii::types::global_dof_index> dofs(model.fe.dofs_per_cell);
    for_each_cell_with(
      model,
      places,
      [&](const auto &cell, const auto &unit_places, const auto &indices) {
        cell->get_dof_indices(dofs);
        for (std::size_t k = 0; k < indices.size(); ++k)
          for (unsigned int i = 0; i < fe.dofs_per_cell; ++i)
            {
              const NodalStress &node =
                nodal[node_of[dofs[model.fe.component_to_system_index(0, i)]]];
              for (unsigned int c = 0; c < node.size(); ++c)
                result[indices[k]][c] +=
                  fe.shape_value(i, unit_places[k]) * node[c];
            }
      });
    return result;
  }



  template <int dim>
  std::vector<MaterialState>
  nodal_states(const SolidModel<dim> &model, const NodalVector &displacement)
  {
    // count, volume ratio, pressure, six of stress: dim of them in a vector
    constexpr unsigned int n_values = 9, n_vectors = (n_values + dim - 1) / dim;
    std::vector<NodalVector>      sums(n_vectors, model.make_vector());
    const dealii::Quadrature<dim> support(
      model.fe.base_element(0).get_unit_support_points());
    dealii::FEValues<dim> values(model.shape_values(model.quadrature));
    dealii::FEValues<dim> places(model.shape_values(support));
    std::vector<dealii::types::global_dof_index> dofs(model.fe.dofs_per_cell);
    for (const auto &cell : model.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          values.reinit(cell);
          places.reinit(cell);
          const auto states = model.states(cell, values, places, displacement);
          cell->get_dof_indices(dofs);
          for (unsigned int n = 0; n < states.size(); ++n)
            {
              const auto                        &state = states[n];
              const std::array<double, n_values> all   = {{1,
                                                           state.volume_ratio,
                                                           state.pressure,
                                                           state.stress[0][0],
                                                           state.stress[1][1],
                                                           state.stress[2][2],
                                                           state.stress[0][1],
                                                           state.stress[1][2],
                                                           state.stress[2][0]}};
              for (unsigned int k = 0; k < n_values; ++k)
                sums[k / dim](
                  dofs[model.fe.component_to_system_index(k % dim, n)]) +=
                  all[k];
            }
        }
    for (NodalVector &sum : sums)
      sum.compress(dealii::VectorOperation::add);

    std::vector<MaterialState> result;
    model.for_each_owned_node([&](const auto &, const auto &of_node) {
      const auto value = [&](const unsigned int k) {
        return sums[k / dim][of_node[k % dim]] / sums[0][of_node[0]];
      };
      MaterialState state;
      state.volume_ratio = value(1);
      state.pressure     = value(2);
      for (unsigned int d = 0; d < 3; ++d)
        {
          state.stress[d][d]           = value(3 + d);
          state.stress[d][(d + 1) % 3] = value(6 + d);
        }
      result.push_back(state);
    });
    return result;
  }



  template PlaceSample<2>
  sample_at(const SolidModel<2> &,
            const dealii::Point<2> &,
            const NodalVector &,
            const NodalVector &);
  template std::vector<PlaceSample<2>>
  sample_at(const SolidModel<2> &,
            const std::vector<dealii::Point<2>> &,
            const NodalVector &,
            const NodalVector &);
  template std::vector<QuadratureSample<2>>
  quadrature_samples(const SolidModel<2> &,
                     const NodalVector &,
                     const NodalVector &);
  template std::vector<MaterialState>
  nodal_states(const SolidModel<2> &, const NodalVector &);
  template std::vector<NodalStress>
  interpolate_at(const SolidModel<2> &,
                 const std::vector<dealii::Point<2>> &,
                 const std::vector<NodalStress> &);
  template std::vector<NodalStress>
  interpolate_at(const SolidModel<3> &,
                 const std::vector<dealii::Point<3>> &,
                 const std::vector<NodalStress> &);
  template PlaceSample<3>
  sample_at(const SolidModel<3> &,
            const dealii::Point<3> &,
            const NodalVector &,
            const NodalVector &);
  template std::vector<PlaceSample<3>>
  sample_at(const SolidModel<3> &,
            const std::vector<dealii::Point<3>> &,
            const NodalVector &,
            const NodalVector &);
  template std::vector<QuadratureSample<3>>
  quadrature_samples(const SolidModel<3> &,
                     const NodalVector &,
                     const NodalVector &);
  template std::vector<MaterialState>
  nodal_states(const SolidModel<3> &, const NodalVector &);
} // namespace limber
