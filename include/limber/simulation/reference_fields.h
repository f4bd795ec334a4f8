// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_simulation_reference_fields_h
#define limber_simulation_reference_fields_h

#include <limber/fem/reference_solver.h>
#include <limber/fem/solid_samples.h>

#include <string>

/** @file The fields of a reference on disk: nodes/nodes_00012.h5. */
namespace limber
{
  /**
   * Write the arrays of all nodes (output/point_arrays.h). Stress and pressure
   * are means over the elements that meet at a node. Collective; throws
   * FileError.
   */
  template <int dim>
  void
  write_reference_fields(const std::string      &folder,
                         const unsigned int      number,
                         const SolidModel<dim>  &model,
                         const SolidMotion<dim> &motion);

  /**
   * Displacement and velocity of the nodes of @p model, whose mesh has to be
   * that of the reference. Throws FileError where it is not. Every rank reads.
   * Returns pressure and stress of the nodes of this rank, in the order of
   * SolidModel::for_each_owned_node().
   */
  template <int dim>
  std::vector<NodalStress>
  read_reference_fields(const std::string     &path,
                        const SolidModel<dim> &model,
                        NodalVector           &displacement,
                        NodalVector           &velocity);
} // namespace limber

#endif
