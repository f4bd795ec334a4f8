// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_simulation_checkpoint_points_h
#define limber_simulation_checkpoint_points_h

#include <limber/output/array_file.h>
#include <limber/state/material_body.h>

#include <string>
#include <vector>

/**
 * @file The points of a body in a checkpoint: one array per quantity, as
 * "body 0/velocity x", and the place of each point's cell in the lattice of
 * the scene, so that every rank finds its own whatever the partition is.
 */
namespace limber
{
  /** The arrays of a body, those without physics first. */
  template <int dim>
  std::vector<std::string>
  point_array_names(unsigned int body, const MaterialPoints<dim> &points);

  /** Collective; what fails is thrown when the file is closed. */
  template <int dim>
  void
  write_points(GatheredFile              &file,
               const BackgroundGrid<dim> &grid,
               unsigned int               body,
               const MaterialPoints<dim> &points);

  /**
   * Replace the points of a body by those of the file in cells of this rank.
   * Returns how many the file has, for all ranks. Throws DamagedFile where
   * they cannot be those of a body that had @p n_at_start points: lengths that
   * differ, cells that are not there or do not hold their points, values that
   * are not finite, points without mass.
   */
  template <int dim>
  std::size_t
  read_points(const ArrayFile           &file,
              const BackgroundGrid<dim> &grid,
              unsigned int               body,
              std::size_t                n_at_start,
              MaterialPoints<dim>       &points);
} // namespace limber

#endif
