// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/fe/fe_values.h>

#include <limber/fem/solid_model.h>

#include <algorithm>
#include <memory>

/** @file Loads on the finite elements of a reference. */
namespace limber
{
  // Traction per initial area; a pressure follows the deformed face (Nanson's
  // formula).
  template <int dim>
  dealii::Tensor<1, dim>
  SolidModel<dim>::face_traction(const FaceLoad<dim>             &load,
                                 const dealii::FEFaceValues<dim> &faces,
                                 const unsigned int               q,
                                 const std::vector<double>       &u,
                                 const double                     time) const
  {
    dealii::Point<dim> place = faces.quadrature_point(q);
    if (!load.is_pressure)
      return load.formula.vector(place, time);
    if (!element->finite_strain)
      return -load.formula.value(place, time) * faces.normal_vector(q);
    dealii::Tensor<2, dim> F = dealii::unit_symmetric_tensor<dim>();
    for (unsigned int i = 0; i < u.size(); ++i)
      {
        const unsigned int c = fe.system_to_component_index(i).first;
        F[c] += u[i] * faces.shape_grad(i, q);
        place[c] += u[i] * faces.shape_value(i, q);
      }
    // present area times normal: J F^-T N dA
    return -load.formula.value(place, time) * determinant(F) *
           (faces.normal_vector(q) * invert(F));
  }



  namespace
  {
    /**
     * Quadrature over a part of a face, given by a fine one of equal weights
     * and whether its points are in that part: of each of the pieces of the
     * face the centroid of those points, so that linear functions are
     * integrated as by the fine one. Gauss points would miss up to a half of
     * the face.
     */
    template <int d>
    dealii::Quadrature<d>
    over_part(const dealii::Quadrature<d> &fine,
              const std::vector<bool>     &is_in_part)
    {
      constexpr unsigned int        n_pieces = 8; // in each direction
      std::vector<dealii::Point<d>> centroids(
        dealii::Utilities::pow(n_pieces, d));
      std::vector<double> weights(centroids.size());
      for (unsigned int q = 0; q < fine.size(); ++q)
        if (is_in_part[q])
          {
            unsigned int piece = 0;
            for (int c = 0; c < d; ++c)
              piece = piece * n_pieces +
                      static_cast<unsigned int>(fine.point(q)[c] * n_pieces);
            centroids[piece] += fine.weight(q) * fine.point(q);
            weights[piece] += fine.weight(q);
          }
      std::vector<dealii::Point<d>> places;
      std::vector<double>           of_places;
      for (std::size_t piece = 0; piece < weights.size(); ++piece)
        if (weights[piece] > 0)
          {
            places.push_back(centroids[piece] / weights[piece]);
            of_places.push_back(weights[piece]);
          }
      return {places, of_places};
    }
  } // namespace



  template <int dim>
  void
  SolidModel<dim>::find_loaded_faces()
  {
    const dealii::QGauss<dim - 1>    whole(degree + 1);
    const dealii::QIterated<dim - 1> fine(dealii::QMidpoint<1>(),
                                          dim == 2 ? 1024 : 128);
    dealii::FEFaceValues<dim>        on_face(fe,
                                      fine,
                                      dealii::update_quadrature_points);
    std::vector<bool>                is_loaded(fine.size());
    for (unsigned int l = 0; l < problem.loads.faces.size(); ++l)
      for (const auto &cell : dof_handler.active_cell_iterators())
        for (const unsigned int f : cell->face_indices())
          {
            const FaceLoad<dim> &load = problem.loads.faces[l];
            const auto           face = cell->face(f);
            if (!cell->is_locally_owned() || !face->at_boundary() ||
                !(load.face ? face->boundary_id() == *load.face :
                              problem.grid.has_inside(face->center())))
              continue;
            if (load.where.empty())
              {
                loaded_faces.push_back({cell, f, l, whole});
                continue;
              }
            on_face.reinit(cell, f);
            for (unsigned int q = 0; q < fine.size(); ++q)
              is_loaded[q] = load.acts_at(on_face.quadrature_point(q));
            const auto n = std::count(is_loaded.begin(), is_loaded.end(), true);
            if (n == long(fine.size()))
              loaded_faces.push_back({cell, f, l, whole});
            else if (n > 0)
              loaded_faces.push_back({cell, f, l, over_part(fine, is_loaded)});
          }
  }



  template <int dim>
  std::vector<double>
  SolidModel<dim>::loaded_areas() const
  {
    std::vector<double> result(problem.loads.faces.size());
    for (const LoadedFace &loaded : loaded_faces)
      {
        dealii::FEFaceValues<dim> face(fe,
                                       loaded.places,
                                       dealii::update_JxW_values);
        face.reinit(loaded.cell, loaded.face);
        for (const unsigned int q : face.quadrature_point_indices())
          result[loaded.load] += face.JxW(q);
      }
    dealii::Utilities::MPI::sum(result, communicator, result);
    return result;
  }



  template <int dim>
  void
  SolidModel<dim>::loads(const NodalVector &displacement,
                         const double       time,
                         NodalVector       &forces) const
  {
    forces = 0;
    if (!has_loads())
      return;
    dealii::FEValues<dim>  values(shape_values(quadrature));
    dealii::Vector<double> on_cell(fe.dofs_per_cell);
    std::vector<dealii::types::global_dof_index> dofs(fe.dofs_per_cell);
    const auto                                   give = [&](const auto &cell) {
      cell->get_dof_indices(dofs);
      none.distribute_local_to_global(on_cell, dofs, forces);
    };
    const auto &body_force = problem.loads.body_force;
    if (body_force)
      for (const auto &cell : dof_handler.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            on_cell = 0;
            values.reinit(cell);
            const auto u = values_of(cell, displacement);
            for (const unsigned int q : values.quadrature_point_indices())
              {
                dealii::Point<dim> place = values.quadrature_point(q);
                if (!problem.loads.body_force_at_start)
                  for (unsigned int i = 0; i < u.size(); ++i)
                    place[fe.system_to_component_index(i).first] +=
                      u[i] * values.shape_value(i, q);
                const auto force = element->density * values.JxW(q) *
                                   body_force->vector(place, time);
                for (unsigned int i = 0; i < u.size(); ++i)
                  on_cell[i] += force[fe.system_to_component_index(i).first] *
                                values.shape_value(i, q);
              }
            give(cell);
          }

    std::unique_ptr<dealii::FEFaceValues<dim>> face;
    for (const LoadedFace &loaded : loaded_faces)
      {
        const FaceLoad<dim> &load = problem.loads.faces[loaded.load];
        if (face == nullptr || !(face->get_quadrature() == loaded.places))
          face = std::make_unique<dealii::FEFaceValues<dim>>(
            fe,
            loaded.places,
            dealii::update_values | dealii::update_gradients |
              dealii::update_JxW_values | dealii::update_quadrature_points |
              dealii::update_normal_vectors);
        face->reinit(loaded.cell, loaded.face);
        const auto u = values_of(loaded.cell, displacement);
        on_cell      = 0;
        for (const unsigned int q : face->quadrature_point_indices())
          {
            const auto traction = face_traction(load, *face, q, u, time);
            for (unsigned int i = 0; i < fe.dofs_per_cell; ++i)
              on_cell[i] += traction[fe.system_to_component_index(i).first] *
                            face->shape_value(i, q) * face->JxW(q);
          }
        give(loaded.cell);
      }
    forces.compress(dealii::VectorOperation::add);
  }



  template void
  SolidModel<2>::find_loaded_faces();
  template std::vector<double>
  SolidModel<2>::loaded_areas() const;
  template void
  SolidModel<2>::loads(const NodalVector &, double, NodalVector &) const;
  template void
  SolidModel<3>::find_loaded_faces();
  template std::vector<double>
  SolidModel<3>::loaded_areas() const;
  template void
  SolidModel<3>::loads(const NodalVector &, double, NodalVector &) const;
} // namespace limber
