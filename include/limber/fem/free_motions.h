// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_fem_free_motions_h
#define limber_fem_free_motions_h

#include <deal.II/base/point.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace limber
{
  /** Rigid motions: translations, then rotations (about z in the plane). */
  template <int dim>
  inline constexpr unsigned int n_rigid_motions = dim == 2 ? 3 : 6;

  /** A component of a rigid motion about @p centre at @p place; rotations with
   * unit angular velocity. */
  template <int dim>
  double
  rigid_motion(unsigned int              motion,
               unsigned int              component,
               const dealii::Point<dim> &place,
               const dealii::Point<dim> &centre);

  /** A rigid body mode that no support restrains. */
  template <int dim>
  struct FreeMotion
  {
    std::string        motion;       // "the translation along x"
    dealii::Point<dim> lower, upper; // bounding box of the moving part, m
  };

  /**
   * Search for a mechanism: a rigid motion of rigid parts that held components
   * leave free. Parts may share places: those that share a single one in the
   * plane, or a row of them in space, are hinged. @p held: held components by
   * place. @p parts: numbers of the places of each part. With more than 200
   * parts nothing is searched and nothing returned.
   */
  template <int dim>
  std::optional<FreeMotion<dim>>
  free_rigid_motion(const std::vector<dealii::Point<dim>>         &places,
                    const std::vector<std::array<bool, dim>>      &held,
                    const std::vector<std::vector<std::uint32_t>> &parts);
} // namespace limber

#endif
