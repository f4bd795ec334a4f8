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
   * A piece of a loaded face or surface. It hangs on the material point next
   * to it and deforms with the velocity gradient there; plain, for
   * checkpoints.
   */
  template <int dim>
  struct FacePiece
  {
    std::uint64_t      carrier = 0; // id of the point
    dealii::Point<dim> reference;   // X of its centre at the start, m
    double             area = 0;    // at the start, m^(dim-1)

    // As they are now, m: from the carrier to the centre, and the edges that
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
   * The pieces that bear a load at the start, without carriers; the arm is
   * from the origin. They are about as large as the spacing of the points,
   * whatever the placement of these is. Faces of boxes and blocks are cut along
   * the lattice of the body (Body::lattice) and filled exactly, surfaces of
   * other shapes are those of surface(). All pieces are on all ranks.
   *
   * What of a whole surface lies in a side of the grid is held there and bears
   * nothing.
   */
  template <int dim>
  std::vector<FacePiece<dim>>
  pieces_at_start(const FaceLoad<dim>        &load,
                  const Body<dim>            &body,
                  const GridDescription<dim> &grid);
} // namespace limber

#endif
