// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_free_motions_h
#define limber_time_free_motions_h

#include <deal.II/base/point.h>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace limber
{
  /** Rigid motions: translations, then rotations (about z in the plane). */
  template <int dim>
  inline constexpr unsigned int n_rigid_motions = dim == 2 ? 3 : 6;

  /** Component @p component of one of them about @p centre at @p place. */
  template <int dim>
  double
  rigid_motion(unsigned int              motion,
               unsigned int              component,
               const dealii::Point<dim> &place,
               const dealii::Point<dim> &centre);

  /**
   * A rigid motion that held components leave free: "the translation along x".
   * Empty if there is none. @p held: of each place its held components; a
   * motion of the whole of @p places is looked at.
   */
  template <int dim>
  std::string
  free_rigid_motion(const std::vector<dealii::Point<dim>>    &places,
                    const std::vector<std::array<bool, dim>> &held);
} // namespace limber

#endif
