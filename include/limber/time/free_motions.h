// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_free_motions_h
#define limber_time_free_motions_h

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

  /** Component @p component of one of them about @p centre at @p place. */
  template <int dim>
  double
  rigid_motion(unsigned int              motion,
               unsigned int              component,
               const dealii::Point<dim> &place,
               const dealii::Point<dim> &centre);

  /** A rigid motion that nothing holds. */
  template <int dim>
  struct FreeMotion
  {
    std::string        motion;       // "the translation along x"
    dealii::Point<dim> lower, upper; // of the places that have it, m
  };

  /**
   * A rigid motion that held components leave to rigid parts, which may share
   * places: parts that share one alone in the plane, or a row of them in space,
   * are hinged. @p held: of each place its held components. @p parts: of each
   * the numbers of its places. More than 200 parts are not looked at.
   */
  template <int dim>
  std::optional<FreeMotion<dim>>
  free_rigid_motion(const std::vector<dealii::Point<dim>>         &places,
                    const std::vector<std::array<bool, dim>>      &held,
                    const std::vector<std::vector<std::uint32_t>> &parts);
} // namespace limber

#endif
