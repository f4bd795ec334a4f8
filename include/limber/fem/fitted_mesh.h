// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_fem_fitted_mesh_h
#define limber_fem_fitted_mesh_h

#include <deal.II/base/geometry_info.h>

#include <deal.II/distributed/tria.h>

#include <limber/problem/problem.h>

#include <memory>

/** @file Body-fitted meshes for the initial configuration. */
namespace limber
{
  template <int dim>
  using Mesh = dealii::parallel::distributed::Triangulation<dim>;

  /** In deal.II's order. */
  template <int dim>
  using BlockCorners = std::array<dealii::Point<dim>,
                                  dealii::GeometryInfo<dim>::vertices_per_cell>;

  /**
   * A quadrilateral or hexahedron in equal parts of its natural coordinates.
   * Boundary identifiers are the numbers of the faces in deal.II's order.
   */
  template <int dim>
  std::unique_ptr<Mesh<dim>>
  make_block_mesh(const BlockCorners<dim>             &corners,
                  const std::array<unsigned int, dim> &elements,
                  MPI_Comm                             communicator);

  /**
   * The mesh that the scene asks for. Throws InputError where the body is not
   * a box and there is no mesh file, FileError where that cannot be read.
   */
  template <int dim>
  std::unique_ptr<Mesh<dim>>
  make_fitted_mesh(const Problem<dim> &problem, MPI_Comm communicator);
} // namespace limber

#endif
