// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/pressure_surfaces.h>

#include <algorithm>

namespace limber
{
  template <int dim>
  PressureSurfaces<dim>::PressureSurfaces(const RunParts<dim> &parts,
                                          CutCells<dim> *const cut_cells)
    : parts(parts)
    , cut_cells(cut_cells)
  {}



  template <int dim>
  void
  PressureSurfaces<dim>::reinit(const CornersOfNodes<dim> &corners)
  {
    pieces.clear();
    n_own = most_in_cell = 0;
    if (cut_cells == nullptr)
      return;
    shared_cells.emplace(parts.grid.shared_cells);
    shared_cells->add(corners.far_exchange());
    n_known = parts.grid.n_cells() + corners.n_far_cells();
    first_of.reinit(n_known);
  }



  template <int dim>
  void
  PressureSurfaces<dim>::clear()
  {
    for (const Piece &piece : pieces)
      first_of[piece.cell] = 0;
    pieces.clear();
    n_own = 0;
  }



  // Only surfaces that the contact impulses act on, see ObstacleContact.
  template <int dim>
  void
  PressureSurfaces<dim>::add(const Cell &cell)
  {
    const std::size_t first = pieces.size();
    for (unsigned int s = 0; s < cell.surfaces.size(); ++s)
      {
        const auto &surface = cell.surfaces[s];
        if (!cut_cells->meets_cut(cell, surface))
          continue;
        const auto has_same = [&](const Piece &piece) {
          return piece.place == surface.piece;
        };
        auto piece =
          std::find_if(pieces.begin() + first, pieces.end(), has_same);
        if (piece == pieces.end())
          {
            piece        = pieces.insert(pieces.end(), Piece());
            piece->cell  = cell.number;
            piece->place = surface.piece;
          }
        for (unsigned int a = 0; a < n_nodes; ++a)
          for (int d = 0; d < dim; ++d)
            piece->entries[a * dim + d] +=
              surface.area * surface.functions[a] * surface.normal[d];
      }
    if (pieces.size() > first)
      first_of[cell.number] = 1 + first;
  }



  template <int dim>
  void
  PressureSurfaces<dim>::number(const std::uint32_t first_row)
  {
    if (cut_cells == nullptr)
      return;
    unsigned int most = 0;
    for (std::uint32_t k = 0; k < n_own; ++k)
      {
        pieces[k].row = first_row + k;
        most = std::max<unsigned int>(most, k + 2 - first_of[pieces[k].cell]);
      }
    most_in_cell = dealii::Utilities::MPI::max(most, parts.grid.communicator);
    if (most_in_cell > 0 && !shared_cells->neighbours.empty())
      learn_of_neighbours();
  }



  // Only the owner of a cell knows which of the cells around it are closed, and
  // so all of its surfaces: it sends their rows to the other ranks.
  template <int dim>
  void
  PressureSurfaces<dim>::learn_of_neighbours()
  {
    constexpr unsigned int n_entries = n_nodes * dim;
    const unsigned int     n_numbers = most_in_cell * (1 + n_entries);
    told.reinit(n_known * n_numbers);
    between_ranks.emplace(n_numbers);
    for (std::uint32_t k = 0; k < n_own; ++k)
      {
        const Piece  &piece   = pieces[k];
        double *const of_cell = told_in(piece.cell);
        of_cell[place_of(k)]  = piece.row + 1.;
        std::copy(piece.entries.begin(),
                  piece.entries.end(),
                  of_cell + most_in_cell + place_of(k) * n_entries);
      }
    between_ranks->start(*shared_cells, told.data(), 0, n_numbers);
    between_ranks->finish(told.data());

    for (const std::uint32_t cell : shared_cells->received)
      for (unsigned int k = 0; cell >= parts.grid.n_owned_cells() &&
                               k < most_in_cell && told_in(cell)[k] > 0;
           ++k)
        {
          if (k == 0)
            first_of[cell] = 1 + pieces.size();
          Piece piece;
          piece.cell = cell;
          piece.row  = told_in(cell)[k] - 1;
          std::copy_n(told_in(cell) + most_in_cell + k * n_entries,
                      n_entries,
                      piece.entries.begin());
          pieces.push_back(piece);
        }
  }



  template <int dim>
  double *
  PressureSurfaces<dim>::told_in(const std::uint32_t cell)
  {
    return told.data() + std::size_t(cell) * (told.size() / n_known);
  }



  // Index of a piece among those of its cell.
  template <int dim>
  unsigned int
  PressureSurfaces<dim>::place_of(const std::size_t piece) const
  {
    return piece + 1 - first_of[pieces[piece].cell];
  }



  // Copy values of pieces from the owners of cells to all ranks that hold them.
  template <int dim>
  template <class Get, class Set>
  void
  PressureSurfaces<dim>::exchange(const Get &get, const Set &set)
  {
    if (most_in_cell == 0 || shared_cells->neighbours.empty())
      return;
    for (const Piece &piece : pieces)
      told_in(piece.cell)[place_of(&piece - pieces.data())] = 0;
    for (std::size_t k = 0; k < n_own; ++k)
      told_in(pieces[k].cell)[place_of(k)] = get(pieces[k]);
    between_ranks->start(*shared_cells, told.data(), 0, most_in_cell);
    between_ranks->finish(told.data());
    for (std::size_t k = n_own; k < pieces.size(); ++k)
      set(pieces[k], told_in(pieces[k].cell)[place_of(k)]);
  }



  template <int dim>
  void
  PressureSurfaces<dim>::dry()
  {
    for (Piece &piece : pieces)
      {
        piece.is_wet  = false;
        piece.leaving = 0;
      }
  }



  template <int dim>
  void
  PressureSurfaces<dim>::wet(const std::uint32_t cell,
                             const unsigned int  surface,
                             const double        least)
  {
    Piece &piece = pieces[piece_of(cell, surface)];
    piece.is_wet = true;
    piece.leaving += area_of(cell, surface) * least;
  }



  template <int dim>
  std::uint32_t
  PressureSurfaces<dim>::piece_of(const std::uint32_t cell,
                                  const unsigned int  surface) const
  {
    std::uint32_t      result = none;
    const unsigned int place  = cut_cells->cell(cell)->surfaces[surface].piece;
    for_each_in(cell, [&](const std::uint32_t k) {
      if (pieces[k].place == place)
        result = k;
    });
    return result;
  }



  template <int dim>
  void
  PressureSurfaces<dim>::finish_wetting()
  {
    exchange([](const Piece &piece) { return piece.is_wet ? 1. : 0.; },
             [](Piece &piece, const double value) {
               piece.is_wet = value > 0;
             });
  }



  template <int dim>
  void
  PressureSurfaces<dim>::share(double Piece::*const member)
  {
    exchange([&](const Piece &piece) { return piece.*member; },
             [&](Piece &piece, const double value) { piece.*member = value; });
  }



  template class PressureSurfaces<2>;
  template class PressureSurfaces<3>;
} // namespace limber
