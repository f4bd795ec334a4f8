// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_face_pieces_h
#define limber_time_face_pieces_h

#include <limber/problem/problem.h>

#include <boost/serialization/array.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace limber
{
  /**
   * A surface segment of a loaded face or surface. It is attached to the
   * material point next to it (its carrier) and deforms with the velocity
   * gradient there; plain, for checkpoints.
   */
  template <int dim>
  struct FacePiece
  {
    std::uint64_t      carrier = 0; // id of the point
    dealii::Point<dim> reference;   // X of its centre at the start, m
    double             area = 0;    // at the start, m^(dim-1)

    // Present vectors, m: from the carrier to the centre, and the edges that
    // span the piece, or a parallelogram of its area, ordered so that their
    // cross product points outward.
    dealii::Tensor<1, dim>                      arm;
    std::array<dealii::Tensor<1, dim>, dim - 1> edges;

    /** The present area times the present outer normal (Nanson), m^(dim-1). */
    dealii::Tensor<1, dim>
    area_vector() const;

    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int)
    {
      archive &carrier &reference &area &arm &edges;
    }
  };



  /**
   * The pieces under a load at the start, without carriers; the arm is from the
   * origin. They are about as large as the spacing of the points, for any
   * placement of these. Faces of boxes and blocks are divided along the lattice
   * of the body (Body::lattice) and covered exactly; other shapes are
   * triangulated by surface(). All pieces are on all ranks.
   *
   * Parts of a whole surface that lie in a side of the grid are held there and
   * not loaded.
   */
  template <int dim>
  std::vector<FacePiece<dim>>
  pieces_at_start(const FaceLoad<dim>        &load,
                  const Body<dim>            &body,
                  const GridDescription<dim> &grid);
} // namespace limber

#endif
