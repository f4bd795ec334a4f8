// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/problem/surface.h>
#include <limber/time/face_pieces.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  using dealii::Point;
  using dealii::Tensor;

  namespace
  {
    // Pieces per spacing of the points if the load varies along the face: with
    // n of them the moment of a linear load over a spacing is too small by
    // 1 / n^2 (midpoint rule).
    constexpr unsigned int pieces_where_it_varies = 3;



    /** Pieces of one face of a box or block, on the lattice of the body. */
    template <int dim>
    std::vector<FacePiece<dim>>
    pieces_of_face(const BlockShape<dim>               &block,
                   const std::array<unsigned int, dim> &lattice,
                   const unsigned int                   face)
    {
      const unsigned int normal = face / 2;
      const bool         upper  = face % 2 == 1;

      std::size_t n = 1;
      for (unsigned int d = 0; d < dim; ++d)
        if (d != normal)
          n *= lattice[d];
      std::vector<FacePiece<dim>> pieces(n);
      for (std::size_t i = 0; i < n; ++i)
        {
          Point<dim>  xi;
          std::size_t rest = i;
          xi[normal]       = upper ? 1 : 0;
          for (unsigned int d = 0; d < dim; ++d)
            if (d != normal)
              {
                xi[d] = (rest % lattice[d] + 0.5) / lattice[d];
                rest /= lattice[d];
              }

          FacePiece<dim> &piece = pieces[i];
          piece.reference       = block.place(xi);
          piece.arm             = piece.reference;
          const auto   slopes   = block.jacobian(xi);
          unsigned int e        = 0;
          for (unsigned int d = 0; d < dim; ++d)
            if (d != normal)
              {
                for (unsigned int c = 0; c < dim; ++c)
                  piece.edges[e][c] = slopes[c][d] / lattice[d];
                ++e;
              }
          Tensor<1, dim> outward;
          for (unsigned int c = 0; c < dim; ++c)
            outward[c] = upper ? slopes[c][normal] : -slopes[c][normal];
          if (piece.area_vector() * outward < 0)
            piece.edges[0] *= -1;
          piece.area = piece.area_vector().norm();
        }
      return pieces;
    }



    template <int dim>
    FacePiece<dim>
    piece_of(const Facet<dim> &facet)
    {
      FacePiece<dim> piece;
      for (const Point<dim> &corner : facet)
        piece.reference += corner / dim;
      piece.arm = piece.reference;
      // A triangle is half of the parallelogram that its edges span.
      for (unsigned int e = 0; e < dim - 1; ++e)
        piece.edges[e] =
          (facet[e + 1] - facet[0]) * (dim == 2 ? 1 : std::sqrt(0.5));
      piece.area = piece.area_vector().norm();
      return piece;
    }



    /** Add a piece of a box or block as a segment, or as two triangles. */
    template <int dim>
    void
    add_facets(const FacePiece<dim> &piece, std::vector<Facet<dim>> &facets)
    {
      const auto &edges = piece.edges;
      if constexpr (dim == 2)
        facets.push_back({{piece.reference - 0.5 * edges[0],
                           piece.reference + 0.5 * edges[0]}});
      else
        {
          const Point<dim> corner =
            piece.reference - 0.5 * (edges[0] + edges[1]);
          const Point<dim> opposite = corner + edges[0] + edges[1];
          facets.push_back({{corner, corner + edges[0], opposite}});
          facets.push_back({{corner, opposite, corner + edges[1]}});
        }
    }
  } // namespace



  template <int dim>
  Tensor<1, dim>
  FacePiece<dim>::area_vector() const
  {
    if constexpr (dim == 2)
      return dealii::cross_product_2d(edges[0]);
    else
      return dealii::cross_product_3d(edges[0], edges[1]);
  }



  template <int dim>
  std::vector<FacePiece<dim>>
  pieces_at_start(const FaceLoad<dim>        &load,
                  const Body<dim>            &body,
                  const GridDescription<dim> &grid)
  {
    const unsigned int parts =
      load.formula.is_uniform() ? 1 : pieces_where_it_varies;
    std::array<double, dim> spacing;
    auto                    lattice = body.lattice;
    for (unsigned int d = 0; d < dim; ++d)
      {
        spacing[d] =
          grid.finest_edge(d) / (body.points_per_cell_edge[d] * parts);
        lattice[d] *= parts;
      }
    std::vector<FacePiece<dim>> pieces;
    std::vector<Facet<dim>>     facets;

    if (const auto *block =
          dynamic_cast<const BlockShape<dim> *>(body.shape.get()))
      for (unsigned int face = 0; face < 2 * dim; ++face)
        {
          if (load.face && *load.face != face)
            continue;
          const auto of_face = pieces_of_face<dim>(*block, lattice, face);
          pieces.insert(pieces.end(), of_face.begin(), of_face.end());
        }
    else
      facets = surface<dim>(*body.shape, {grid.lower, grid.upper}, spacing);

    if (!load.where.empty())
      {
        for (const FacePiece<dim> &piece : pieces)
          add_facets<dim>(piece, facets);
        pieces.clear();
        facets = part_in<dim>(
          [&](const Point<dim> &place) { return load.acts_at(place); }, facets);
      }
    for (const Facet<dim> &facet : facets)
      pieces.push_back(piece_of<dim>(facet));

    // Facets degenerate where the surface passes through nodes of the lattice
    // on which it was triangulated.
    const double least_area =
      1e-12 *
      std::pow(*std::min_element(spacing.begin(), spacing.end()), dim - 1);
    pieces.erase(std::remove_if(pieces.begin(),
                                pieces.end(),
                                [&](const FacePiece<dim> &piece) {
                                  return piece.area < least_area ||
                                         (!load.face &&
                                          !grid.has_inside(piece.reference));
                                }),
                 pieces.end());
    return pieces;
  }



#define INSTANTIATE(dim)                                     \
  template struct FacePiece<dim>;                            \
  template std::vector<FacePiece<dim>> pieces_at_start<dim>( \
    const FaceLoad<dim> &, const Body<dim> &, const GridDescription<dim> &);

  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace limber
