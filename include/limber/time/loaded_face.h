// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_loaded_face_h
#define limber_time_loaded_face_h

#include <limber/interpolation/support.h>
#include <limber/state/material_body.h>
#include <limber/time/face_pieces.h>

#include <vector>

namespace limber
{
  /**
   * A loaded face or surface of a body (traction or pressure boundary): its
   * pieces, each on the rank of its carrier, the point that it is attached to.
   * A piece whose carrier leaves the grid is lost with it.
   */
  template <int dim>
  class LoadedFace
  {
  public:
    /**
     * Throws InputError where there is nothing to load or no point is near;
     * collective.
     */
    LoadedFace(const FaceLoad<dim>       &load,
               const MaterialBody<dim>   &body,
               const BackgroundGrid<dim> &grid);

    /** A piece of this rank and the index of its carrier in the arrays. */
    struct Here
    {
      std::size_t     point;
      FacePiece<dim> *piece;
    };

    /** The pieces of this rank, with the present indices of their carriers. */
    const std::vector<Here> &
    here();

    /** Send pieces after carriers that have changed ranks; collective. */
    void
    exchange();

    /** The pieces of all ranks; collective. */
    std::vector<FacePiece<dim>>
    all_pieces() const;

    /** The same, with the places of their centres instead of the arms from
     * their carriers. */
    std::vector<FacePiece<dim>>
    detached_pieces() const;

    /** Choose carriers anew among the points that there are now; collective. */
    void
    attach(std::vector<FacePiece<dim>> detached);

    /** Restore the pieces from a checkpoint, @p all of them on all ranks. */
    void
    restore(const std::vector<FacePiece<dim>> &all);

    /** Whether this is a pressure on a closed surface of which no piece has
     * been lost: see SurfaceClosure. Collective. */
    bool
    is_closed() const;

    /** The centre of its pieces at the start, m. */
    const dealii::Point<dim> &
    centre_at_start() const
    {
      return centre;
    }

    const FaceLoad<dim>     &load;
    const MaterialBody<dim> &body;

  private:
    std::vector<unsigned int>
    find_carriers(std::vector<FacePiece<dim>> &all) const;
    void
    add_place(std::size_t p, double factor, dealii::Tensor<1, dim> &to) const;
    void
    adopt(const std::vector<FacePiece<dim>> &candidates);

    const BackgroundGrid<dim>  &grid;
    std::vector<FacePiece<dim>> pieces;
    std::vector<Here>           present;
    dealii::Point<dim>          centre;
    // Number of pieces of a surface that is closed at the start, else 0
    std::size_t   n_of_closed = 0;
    unsigned long order       = 0; // of points, when `present` was made
  };



  /**
   * The functions of the nodes around the carrier @p p of a piece, with the
   * shares of a force on the piece as values. In the initial frame these are
   * the functions at the place where the piece was at the start, if that is in
   * the cell of its carrier; else the functions at the carrier and their
   * gradients times the arm.
   */
  template <int dim>
  Support<dim>
  support_of_piece(const GridView<dim>  &grid,
                   const PointView<dim> &points,
                   const std::size_t     p,
                   const FacePiece<dim> &piece);
} // namespace limber

#endif
