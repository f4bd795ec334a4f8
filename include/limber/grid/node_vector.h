// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_node_vector_h
#define limber_grid_node_vector_h

#include <deal.II/base/tensor.h>

namespace limber
{
  /** The vector in dim slots of a nodal record. */
  template <int dim>
  inline dealii::Tensor<1, dim>
  vector_in(const double *const slots)
  {
    dealii::Tensor<1, dim> result;
    for (int d = 0; d < dim; ++d)
      result[d] = slots[d];
    return result;
  }



  /** Write a vector to dim slots of a nodal record. */
  template <int dim>
  inline void
  store_vector(const dealii::Tensor<1, dim> &vector, double *const slots)
  {
    for (int d = 0; d < dim; ++d)
      slots[d] = vector[d];
  }
} // namespace limber

#endif
