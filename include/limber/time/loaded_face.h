// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_loaded_face_h
#define limber_time_loaded_face_h

#include <limber/state/material_body.h>

#include <boost/serialization/array.hpp>

#include <array>
#include <vector>

namespace limber
{
  /**
   * A piece of a loaded face. It hangs on the material point next to it and
   * deforms with the velocity gradient there; plain, for checkpoints.
   */
  template <int dim>
  struct FacePiece
  {
    std::uint64_t      carrier = 0; // id of the point
    dealii::Point<dim> reference;   // X of its centre at the start, m
    double             area = 0;    // at the start, m^(dim-1)

    // As they are now, m: from the carrier to the centre, and the edges that
    // span the piece, ordered so that their cross product points outward.
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
   * One face of a box or block body under a load: its pieces, each on the
   * rank that has its carrier. The pieces follow from the lattice of the body
   * (Body::lattice), whatever the placement of the points is, and fill the
   * face exactly. A piece whose carrier leaves the grid is lost with it.
   */
  template <int dim>
  class LoadedFace
  {
  public:
    /** Throws InputError where no point is near; collective. */
    LoadedFace(const FaceLoad<dim>       &load,
               const MaterialBody<dim>   &body,
               const BackgroundGrid<dim> &grid);

    /** A piece of this rank and where its carrier stands in the arrays. */
    struct Here
    {
      std::size_t     point;
      FacePiece<dim> *piece;
    };

    /** The pieces whose carriers are here. */
    const std::vector<Here> &
    here();

    /** After points have changed ranks: follow them; collective. */
    void
    exchange();

    /** Of all ranks; collective. */
    std::vector<FacePiece<dim>>
    all_pieces() const;

    /** Take over those of a checkpoint, known to all ranks. */
    void
    restore(const std::vector<FacePiece<dim>> &all);

    const FaceLoad<dim>     &load;
    const MaterialBody<dim> &body;

  private:
    void
    find_carriers(std::vector<FacePiece<dim>> &all) const;
    void
    adopt(const std::vector<FacePiece<dim>> &candidates);

    const BackgroundGrid<dim>  &grid;
    std::vector<FacePiece<dim>> pieces;
    std::vector<Here>           present;
    unsigned long               order = 0; // of points, when `present` was made
  };
} // namespace limber

#endif
