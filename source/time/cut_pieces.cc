// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/cut_cells.h>

#include <algorithm>

/**
 * @file Final quantities of a cut cell, from the integrals over its open part
 * and its surfaces: means, hydrostatic load, groups of facets.
 */

namespace limber
{
  namespace
  {
    // A facet joins a piece if its normal is within some 37 degrees of the mean
    // normal of those already in it.
    constexpr double least_cosine_of_piece = 0.8;
  } // namespace



  // Divide moments by the open fraction, and make the hydrostatic load that of
  // the pressure relative to its mean p_c: subtract (g . x_c) int grad N_i dV.
  template <int dim>
  void
  CutCells<dim>::finish_volume(Cell &cell) const
  {
    const CellGeometry<dim> &geometry = parts.grid.geometry[cell.number];
    double                   volume   = cell.open; // m^dim
    for (double &mean : cell.monomials)
      mean /= cell.open;
    double depth = 0;
    for (unsigned int d = 0; d < dim; ++d)
      {
        volume /= geometry.inverse_edge[d];
        depth += parts.problem.loads.gravity[d] * cell.monomials[1u << d] /
                 geometry.inverse_edge[d];
      }
    for (unsigned int d = 0; d < dim; ++d)
      {
        // means of grad N_i, a product of linear functions, expanded in
        // monomials
        auto means = cell.monomials;
        for (unsigned int k = 0; k < n_nodes; ++k)
          if (k >> d & 1)
            means[k] = 0;
        for (unsigned int e = 0; e < dim; ++e)
          for (unsigned int k = 0; e != d && k < n_nodes; ++k)
            if (!(k >> e & 1))
              means[k] -= means[k | 1u << e];
        for (unsigned int a = 0; a < n_nodes; ++a)
          cell.hydrostatic[a][d] -= depth * volume * geometry.inverse_edge[d] *
                                    (a >> d & 1 ? 1 : -1) *
                                    means[a & ~(1u << d)];
      }
    if (cell.open > 1 - 1e-12)
      cell.open = 1;
  }



  // Group the facets of a curved surface into pieces. Each piece has one
  // implicit pressure, as the few nodes of a cell could hardly tell those of
  // its facets apart, and one set of moments of the flow through it
  // (SmoothSurfaces).
  template <int dim>
  void
  CutCells<dim>::find_pieces(Cell &cell) const
  {
    struct Piece
    {
      Vector             normal; // times the area, as the place
      dealii::Point<dim> place;
      double             area = 0;
      unsigned int       obstacle;
    };
    std::vector<Piece> pieces;
    for (Surface &surface : cell.surfaces)
      {
        const auto is_alike = [&](const Piece &piece) {
          return piece.obstacle == surface.obstacle &&
                 piece.normal * surface.normal >
                   least_cosine_of_piece * piece.normal.norm();
        };
        auto piece = std::find_if(pieces.begin(), pieces.end(), is_alike);
        if (piece == pieces.end())
          {
            piece           = pieces.insert(pieces.end(), Piece());
            piece->obstacle = surface.obstacle;
          }
        surface.piece = piece - pieces.begin();
        piece->normal += surface.area * surface.normal;
        piece->place += surface.area * surface.place;
        piece->area += surface.area;
      }
    if (!is_implicit) // each facet has a pressure of its own
      return;
    for (Surface &surface : cell.surfaces)
      surface.beyond =
        parts.problem.loads.gravity *
        (surface.place - dealii::Point<dim>(pieces[surface.piece].place /
                                            pieces[surface.piece].area));
  }



  template void
  CutCells<2>::finish_volume(Cell &) const;
  template void
  CutCells<2>::find_pieces(Cell &) const;
  template void
  CutCells<3>::finish_volume(Cell &) const;
  template void
  CutCells<3>::find_pieces(Cell &) const;
} // namespace limber
