// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/dofs/dof_tools.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>

#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparsity_tools.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <limber/base/exceptions.h>
#include <limber/fem/solid_model.h>

#include <algorithm>
#include <limits>
#include <map>

namespace limber
{
  namespace
  {
    const dealii::UpdateFlags update_flags =
      dealii::update_values | dealii::update_gradients |
      dealii::update_quadrature_points | dealii::update_JxW_values;

    unsigned int
    degree_of(const ReferenceElement kind)
    {
      return kind == ReferenceElement::q1 ||
                 kind == ReferenceElement::q1_p0_p0 ?
               1 :
               2;
    }
  } // namespace



  template <int dim>
  SolidModel<dim>::SolidModel(const Problem<dim> &problem,
                              MPI_Comm            communicator)
    : SolidModel(problem, make_fitted_mesh(problem, communicator))
  {}



  template <int dim>
  SolidModel<dim>::SolidModel(const Problem<dim>        &problem,
                              std::unique_ptr<Mesh<dim>> given_mesh)
    : problem(problem)
    , communicator(given_mesh->get_communicator())
    , mesh(std::move(given_mesh))
    , degree(degree_of(problem.reference.element))
    , element(
        make_solid_element(problem.bodies.front(), problem.reference.element))
    , fe(dealii::FE_Q<dim>(degree), dim)
    , quadrature(degree + 1)
    , dof_handler(*mesh)
  {
    check_scene();
    number();
    held_nodes = std::make_unique<const HeldNodes<dim>>(problem, dof_handler);
    assemble_masses();
    begin_memory();
    find_loaded_faces();
  }



  template <int dim>
  SolidModel<dim>::~SolidModel() = default;



  template <int dim>
  void
  SolidModel<dim>::check_scene() const
  {
    if (problem.bodies.size() > 1)
      throw InputError("The scene has " +
                       std::to_string(problem.bodies.size()) +
                       " bodies in its entry 'Bodies'; the finite element "
                       "reference knows one, and no contact. Make a scene for "
                       "each body, or compare with a finer run.");
    if (!problem.obstacles.empty())
      throw InputError("The scene has obstacles ('Obstacles'), which the "
                       "finite element reference does not know. Make a scene "
                       "without them, or compare with a finer run.");
    if (problem.bodies.front().initial_stress)
      throw InputError("The body '" + problem.bodies.front().name +
                       "' has an 'Initial stress', which the finite element "
                       "reference does not know. Leave it empty and let the "
                       "load settle, or compare with a finer run.");
    if (element->n_memory() > 0 &&
        problem.reference.method == ReferenceMethod::explicit_steps)
      throw InputError("The material of body '" + problem.bodies.front().name +
                       "' flows, which the explicit finite element reference "
                       "does not know. Set 'Reference/Method = implicit' or "
                       "'quasi-static'.");
    if (problem.method.damping_rate > 0 &&
        problem.reference.method != ReferenceMethod::quasi_static)
      throw InputError("The scene damps all motion ('Method/Damping rate'), "
                       "which the finite element reference does in "
                       "equilibrium only. Usually the state of rest is wanted. "
                       "Set 'Reference/Method = quasi-static', or 'Damping "
                       "rate = 0'.");
  }



  template <int dim>
  void
  SolidModel<dim>::number()
  {
    dof_handler.distribute_dofs(fe);
    relevant = dealii::DoFTools::extract_locally_relevant_dofs(dof_handler);
    none.reinit(relevant);
    none.close();

    smallest_edge      = std::numeric_limits<double>::infinity();
    const auto &points = fe.base_element(0).get_unit_support_points();
    const dealii::Quadrature<dim> places(points);
    dealii::FEValues<dim> values(fe, places, dealii::update_quadrature_points);
    const unsigned int    n_nodes = points.size();
    std::map<dealii::types::global_dof_index,
             std::pair<dealii::Point<dim>, NodeDofs>>
                                                 found;
    std::vector<dealii::types::global_dof_index> dofs(fe.dofs_per_cell);
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          smallest_edge =
            std::min(smallest_edge, cell->minimum_vertex_distance());
          values.reinit(cell);
          cell->get_dof_indices(dofs);
          for (unsigned int n = 0; n < n_nodes; ++n)
            {
              NodeDofs of_node;
              for (unsigned int d = 0; d < dim; ++d)
                of_node[d] = dofs[fe.component_to_system_index(d, n)];
              if (dof_handler.locally_owned_dofs().is_element(of_node[0]))
                found[of_node[0]] = {values.quadrature_point(n), of_node};
            }
        }
    smallest_edge = dealii::Utilities::MPI::min(smallest_edge, communicator);
    for (const auto &[dof, node] : found)
      nodes.push_back(node);
  }



  template <int dim>
  NodalVector
  SolidModel<dim>::make_vector() const
  {
    return NodalVector(dof_handler.locally_owned_dofs(),
                       relevant,
                       communicator);
  }



  template <int dim>
  void
  SolidModel<dim>::reinit(Matrix &matrix) const
  {
    dealii::DynamicSparsityPattern pattern(relevant);
    dealii::DoFTools::make_sparsity_pattern(dof_handler, pattern, none, true);
    dealii::SparsityTools::distribute_sparsity_pattern(
      pattern, dof_handler.locally_owned_dofs(), communicator, relevant);
    matrix.reinit(dof_handler.locally_owned_dofs(),
                  dof_handler.locally_owned_dofs(),
                  pattern,
                  communicator);
  }



  template <int dim>
  void
  SolidModel<dim>::assemble_masses()
  {
    masses = std::make_unique<Matrix>();
    reinit(*masses);
    lumped = make_vector();
    weight = make_vector();

    const unsigned int         n = fe.dofs_per_cell;
    dealii::FEValues<dim>      values(shape_values(quadrature));
    dealii::FullMatrix<double> matrix(n, n);
    dealii::Vector<double>     rows(n), forces(n);
    std::vector<dealii::types::global_dof_index> dofs(n);
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          values.reinit(cell);
          matrix = 0;
          rows   = 0;
          for (const unsigned int q : values.quadrature_point_indices())
            for (unsigned int i = 0; i < n; ++i)
              {
                const double part =
                  element->density * values.JxW(q) * values.shape_value(i, q);
                const unsigned int c = fe.system_to_component_index(i).first;
                rows[i] += part;
                for (unsigned int j = 0; j < n; ++j)
                  if (fe.system_to_component_index(j).first == c)
                    matrix(i, j) += part * values.shape_value(j, q);
              }
          for (unsigned int i = 0; i < n; ++i)
            forces[i] =
              rows[i] *
              problem.loads.gravity[fe.system_to_component_index(i).first];
          cell->get_dof_indices(dofs);
          none.distribute_local_to_global(matrix, dofs, *masses);
          none.distribute_local_to_global(rows, dofs, lumped);
          none.distribute_local_to_global(forces, dofs, weight);
        }
    masses->compress(dealii::VectorOperation::add);
    lumped.compress(dealii::VectorOperation::add);
    weight.compress(dealii::VectorOperation::add);
  }



  template <int dim>
  std::size_t
  SolidModel<dim>::memory_of(
    const typename dealii::DoFHandler<dim>::active_cell_iterator &cell) const
  {
    return std::size_t(cell->active_cell_index()) * quadrature.size() *
           element->n_memory();
  }



  template <int dim>
  void
  SolidModel<dim>::begin_memory()
  {
    memory.resize(std::size_t(mesh->n_active_cells()) * quadrature.size() *
                  element->n_memory());
    if (memory.empty())
      return;
    dealii::FEValues<dim> values(shape_values(quadrature));
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          values.reinit(cell);
          element->begin(values, memory.data() + memory_of(cell));
        }
  }



  template <int dim>
  double
  SolidModel<dim>::accept(const NodalVector &displacement)
  {
    if (element->n_memory() == 0)
      return 0;
    double                work = 0;
    dealii::FEValues<dim> values(shape_values(quadrature));
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          values.reinit(cell);
          work += element->accept(values,
                                  values_of(cell, displacement),
                                  memory.data() + memory_of(cell));
        }
    return dealii::Utilities::MPI::sum(work, communicator);
  }



  template <int dim>
  std::vector<MaterialState>
  SolidModel<dim>::states(
    const typename dealii::DoFHandler<dim>::active_cell_iterator &cell,
    const dealii::FEValues<dim>                                  &values,
    const dealii::FEValues<dim>                                  &places,
    const NodalVector &displacement) const
  {
    return element->states(values,
                           places,
                           values_of(cell, displacement),
                           memory.data() + memory_of(cell));
  }



  template <int dim>
  NodalVector
  SolidModel<dim>::initial_velocity() const
  {
    NodalVector         result  = make_vector();
    const Formula<dim> &formula = problem.bodies.front().initial_velocity;
    if (!formula.empty())
      for (const auto &[place, dofs] : nodes)
        {
          const auto velocity = formula.vector(place, 0);
          for (unsigned int d = 0; d < dim; ++d)
            result[dofs[d]] = velocity[d];
        }
    held().prescribe_velocity(0, result);
    result.update_ghost_values();
    return result;
  }



  template <int dim>
  dealii::FEValues<dim>
  SolidModel<dim>::shape_values(const dealii::Quadrature<dim> &places) const
  {
    return dealii::FEValues<dim>(fe, places, update_flags);
  }



  template <int dim>
  std::vector<double>
  SolidModel<dim>::values_of(
    const typename dealii::DoFHandler<dim>::active_cell_iterator &cell,
    const NodalVector                                            &vector) const
  {
    std::vector<dealii::types::global_dof_index> dofs(fe.dofs_per_cell);
    cell->get_dof_indices(dofs);
    std::vector<double> result(dofs.size());
    for (unsigned int i = 0; i < dofs.size(); ++i)
      result[i] = vector(dofs[i]);
    return result;
  }



  template <int dim>
  bool
  SolidModel<dim>::internal_forces(const NodalVector &displacement,
                                   NodalVector       &forces) const
  {
    forces = 0;
    dealii::FEValues<dim>  values(shape_values(quadrature));
    dealii::Vector<double> on_cell(fe.dofs_per_cell);
    std::vector<dealii::types::global_dof_index> dofs(fe.dofs_per_cell);
    bool                                         good = true;
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          values.reinit(cell);
          good = good && element->compute(values,
                                          values_of(cell, displacement),
                                          on_cell,
                                          nullptr,
                                          nullptr,
                                          memory.data() + memory_of(cell));
          if (!good)
            break;
          cell->get_dof_indices(dofs);
          none.distribute_local_to_global(on_cell, dofs, forces);
        }
    forces.compress(dealii::VectorOperation::add);
    return dealii::Utilities::MPI::min(int(good), communicator) != 0;
  }



  template <int dim>
  bool
  SolidModel<dim>::assemble(const NodalVector &displacement,
                            const double       mass_factor,
                            Matrix            &matrix,
                            const NodalVector *former) const
  {
    matrix                       = 0;
    const unsigned int         n = fe.dofs_per_cell;
    dealii::FEValues<dim>      values(shape_values(quadrature));
    dealii::Vector<double>     on_cell(n);
    dealii::FullMatrix<double> tangent(n, n);
    std::vector<double>        former_values;
    std::vector<dealii::types::global_dof_index> dofs(n);
    bool                                         good = true;
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          values.reinit(cell);
          if (former != nullptr)
            former_values = values_of(cell, *former);
          good = good &&
                 element->compute(values,
                                  values_of(cell, displacement),
                                  on_cell,
                                  &tangent,
                                  former != nullptr ? &former_values : nullptr,
                                  memory.data() + memory_of(cell));
          if (!good)
            break;
          if (mass_factor != 0)
            for (const unsigned int q : values.quadrature_point_indices())
              for (unsigned int i = 0; i < n; ++i)
                for (unsigned int j = 0; j < n; ++j)
                  if (fe.system_to_component_index(i).first ==
                      fe.system_to_component_index(j).first)
                    tangent(i, j) += mass_factor * element->density *
                                     values.JxW(q) * values.shape_value(i, q) *
                                     values.shape_value(j, q);
          cell->get_dof_indices(dofs);
          held().constraints().distribute_local_to_global(tangent,
                                                          dofs,
                                                          matrix);
        }
    matrix.compress(dealii::VectorOperation::add);
    return dealii::Utilities::MPI::min(int(good), communicator) != 0;
  }



  template <int dim>
  std::vector<double>
  SolidModel<dim>::rigid_motions() const
  {
    constexpr unsigned int n_motions = dim == 2 ? 3 : 6;
    const auto            &owned     = dof_handler.locally_owned_dofs();
    const std::size_t      n         = owned.n_elements();
    std::vector<double>    result(n_motions * n);
    const auto             set =
      [&](const unsigned int motion, const auto dof, const double value) {
        result[motion * n + owned.index_within_set(dof)] = value;
      };
    for (const auto &[place, dofs] : nodes)
      {
        for (unsigned int d = 0; d < dim; ++d)
          set(d, dofs[d], 1);
        for (unsigned int r = 0; r < n_motions - dim; ++r)
          {
            // about the axis r in space, about z in the plane
            const unsigned int a = dim == 2 ? 0 : (r + 1) % 3;
            const unsigned int b = dim == 2 ? 1 : (r + 2) % 3;
            set(dim + r, dofs[a], -place[b]);
            set(dim + r, dofs[b], place[a]);
          }
      }
    return result;
  }



  template class SolidModel<2>;
  template class SolidModel<3>;
} // namespace limber
