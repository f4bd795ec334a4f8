// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/surface_closure.h>

#include <cmath>

namespace limber
{
  using dealii::Tensor;

  template <int dim>
  typename SurfaceClosure<dim>::Axial
  SurfaceClosure<dim>::moment(const Tensor<1, dim> &arm,
                              const Tensor<1, dim> &of)
  {
    Axial result;
    if constexpr (dim == 2)
      result[0] = arm[0] * of[1] - arm[1] * of[0];
    else
      result = dealii::cross_product_3d(arm, of);
    return result;
  }



  template <int dim>
  Tensor<1, dim>
  SurfaceClosure<dim>::turned(const Axial &by, const Tensor<1, dim> &arm)
  {
    Tensor<1, dim> result;
    if constexpr (dim == 2)
      {
        result[0] = -by[0] * arm[1];
        result[1] = by[0] * arm[0];
      }
    else
      result = dealii::cross_product_3d(by, arm);
    return result;
  }



  template <int dim>
  void
  SurfaceClosure<dim>::add(const dealii::Point<dim> &place,
                           const Tensor<1, dim>     &of_piece)
  {
    const Tensor<1, dim> arm  = place - origin;
    const double         size = of_piece.norm();
    area += size;
    first += size * arm;
    second += size * outer_product(arm, arm);
    sum += of_piece;
    sum_moment += moment(arm, of_piece);
  }



  template <int dim>
  void
  SurfaceClosure<dim>::finish(const MPI_Comm communicator)
  {
    const auto over_ranks = [&](const auto &value) {
      return dealii::Utilities::MPI::sum(value, communicator);
    };
    area       = over_ranks(area);
    first      = over_ranks(first);
    second     = over_ranks(second);
    sum        = over_ranks(sum);
    sum_moment = over_ranks(sum_moment);
    if (!(area > 0))
      return;
    alpha  = sum / area;
    centre = first / area;

    // sum |a| (|r|^2 1 - r (x) r) about the centre
    const Tensor<2, dim> spread = second - area * outer_product(centre, centre);
    Tensor<2, n_axes>    inertia;
    for (unsigned int i = 0; i < n_axes; ++i)
      {
        inertia[i][i] += trace(spread);
        if (dim == 3)
          for (unsigned int j = 0; j < n_axes; ++j)
            inertia[i][j] -= spread[i][j];
      }
    beta = invert(inertia) * (sum_moment - moment(centre, sum));
  }



  template <int dim>
  Tensor<1, dim>
  SurfaceClosure<dim>::change(const dealii::Point<dim> &place,
                              const Tensor<1, dim>     &of_piece) const
  {
    return -of_piece.norm() * (alpha + turned(beta, (place - origin) - centre));
  }



  template <int dim>
  double
  SurfaceClosure<dim>::opening() const
  {
    return area > 0 ?
             alpha.norm() +
               beta.norm() * std::sqrt(std::abs(trace(second) / area -
                                                centre.norm_square())) :
             0;
  }



  template class SurfaceClosure<2>;
  template class SurfaceClosure<3>;
} // namespace limber
