// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_surface_closure_h
#define limber_time_surface_closure_h

#include <deal.II/base/mpi.h>
#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

namespace limber
{
  /**
   * Corrects the area vectors a_i of the pieces of a closed surface so that
   * they have no sum and no moment: then a uniform pressure neither pushes a
   * body nor turns it. Pieces that follow one point each lose this, and a free
   * body would drift and spin. What is missing is spread over the pieces by
   * their area,
   *
   *   a_i <- a_i - |a_i| (alpha + beta x (x_i - c)),
   *
   * with the centre c of the surface.
   */
  template <int dim>
  class SurfaceClosure
  {
  public:
    /** Takes moments about @p origin, m, a place near by. */
    explicit SurfaceClosure(const dealii::Point<dim> &origin = {})
      : origin(origin)
    {}

    /** A piece at @p place, m, with its area vector, m^(dim-1). */
    void
    add(const dealii::Point<dim> &place, const dealii::Tensor<1, dim> &area);

    /** Find alpha and beta over all ranks, after all add(); collective. */
    void
    finish(MPI_Comm communicator);

    /** Correction of the area vector of a piece, m^(dim-1). */
    dealii::Tensor<1, dim>
    change(const dealii::Point<dim>     &place,
           const dealii::Tensor<1, dim> &area) const;

    /** Closure error: about the largest change over the area, no unit. */
    double
    opening() const;

  private:
    // Rotations: about z in the plane
    static constexpr unsigned int n_axes = dim == 2 ? 1 : 3;
    using Axial                          = dealii::Tensor<1, n_axes>;

    static Axial
    moment(const dealii::Tensor<1, dim> &arm, const dealii::Tensor<1, dim> &of);
    static dealii::Tensor<1, dim>
    turned(const Axial &by, const dealii::Tensor<1, dim> &arm);

    dealii::Point<dim>     origin;
    double                 area = 0;   // sum |a|
    dealii::Tensor<1, dim> first;      // sum |a| r
    dealii::Tensor<2, dim> second;     // sum |a| r (x) r
    dealii::Tensor<1, dim> sum;        // of a
    Axial                  sum_moment; // of r x a
    dealii::Tensor<1, dim> alpha, centre;
    Axial                  beta;
  };
} // namespace limber

#endif
