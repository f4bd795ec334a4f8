// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/pressure_system.h>

#include <algorithm>

/**
 * @file Tension cutoff of liquids: P >= 0, cells without pressure may expand
 * but not be compressed, and no cell has both (complementarity), found by a
 * primal-dual active set (M. Hintermueller, K. Ito and K. Kunisch, SIAM J.
 * Optim. 13, 2002, 865-888).
 */

namespace limber
{
  template <int dim>
  bool
  PressureSystem<dim>::cuts_tension() const
  {
    return cells.surfaces.any() ||
           std::any_of(parts.bodies.begin(),
                       parts.bodies.end(),
                       [](const auto &body) {
                         return body->description.cuts_tension;
                       });
  }



  template <int dim>
  bool
  PressureSystem<dim>::cut_tension(const bool may_return)
  {
    if (is_cut.empty())
      {
        whole            = equations.values;
        whole_right_side = equations.right_side;
        is_cut.assign(equations.n, 0);
      }
    for (std::uint32_t row = 0; row < equations.n; ++row)
      if (is_cut[row])
        pressures[row] = 0;
    for (Medium &medium : cells.media)
      {
        for (std::size_t k = 0; k < medium.cells.size(); ++k)
          medium.result(medium.cells[k])[Result::pressure] =
            pressures[medium.first + k];
        cells.share(medium, Result::pressure);
      }
    auto      &surfaces      = cells.surfaces;
    const auto first_surface = cells.first_of_surfaces();
    for (std::uint32_t k = 0; k < surfaces.n_of_rank(); ++k)
      surfaces.pieces[k].pressure = pressures[first_surface + k];
    surfaces.share(&Piece::pressure);

    int any = 0;
    for (std::uint32_t row = 0; row < equations.n; ++row)
      {
        const bool changes =
          may_be_cut[row] &&
          (is_cut[row] ? may_return && row_residual(row) < 0 :
                         pressures[row] < 0);
        if (!changes)
          continue;
        is_cut[row]    = !is_cut[row];
        pressures[row] = 0;
        any            = 1;
      }
    if (dealii::Utilities::MPI::max(any, parts.grid.communicator) == 0)
      return false;
    exclude_cut();
    return true;
  }



  // Residual of the full equation of a row, times the scale of the row, m^3: by
  // how much the cell expands beyond what its pressure gives.
  template <int dim>
  double
  PressureSystem<dim>::row_residual(const std::uint32_t row) const
  {
    double result = -whole_right_side[row];
    for (unsigned int place = 0; place < equations.width; ++place)
      if (const std::size_t at = std::size_t(row) * equations.width + place;
          mates[at] != invalid_cell)
        result +=
          whole[at] *
          of_mate(
            at,
            place,
            [](const double *const result) { return result[Result::pressure]; },
            [](const Piece &piece) { return piece.pressure; });
    return result;
  }



  // Rows of the active set become P = 0, and their columns are dropped from the
  // other rows, so that the matrix stays symmetric.
  template <int dim>
  void
  PressureSystem<dim>::exclude_cut()
  {
    for (Medium &medium : cells.media)
      {
        for (std::size_t k = 0; k < medium.cells.size(); ++k)
          medium.result(medium.cells[k])[Result::scale] =
            is_cut[medium.first + k] ? 0 : 1;
        cells.share(medium, Result::scale);
      }
    auto      &surfaces      = cells.surfaces;
    const auto first_surface = cells.first_of_surfaces();
    for (std::uint32_t k = 0; k < surfaces.n_of_rank(); ++k)
      surfaces.pieces[k].scale = is_cut[first_surface + k] ? 0 : 1;
    surfaces.share(&Piece::scale);
    for (std::uint32_t row = 0; row < equations.n; ++row)
      {
        equations.right_side[row] = is_cut[row] ? 0 : whole_right_side[row];
        for (unsigned int place = 0; place < equations.width; ++place)
          {
            const std::size_t at = std::size_t(row) * equations.width + place;
            if (mates[at] == invalid_cell)
              continue;
            const bool diagonal =
              equations.columns[at] == equations.first + row;
            equations.values[at] = diagonal ? 1 :
                                   is_cut[row] ?
                                              0 :
                                              whole[at] * scale_of(at, place);
          }
      }
  }



  template bool
  PressureSystem<2>::cuts_tension() const;
  template bool
  PressureSystem<3>::cuts_tension() const;
  template bool
  PressureSystem<2>::cut_tension(bool);
  template bool
  PressureSystem<3>::cut_tension(bool);
} // namespace limber
