// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_sum_momentum_h
#define limber_transfer_sum_momentum_h

#include <limber/interpolation/linear.h>
#include <limber/points/cell_batch.h>

namespace limber
{
  /**
   * Add m N_i and m N_i (v + C (x_i - x)) of the points of a batch, one lane
   * per node of their cell; C only if @p affine. Products of weights keep
   * small nodal masses exact.
   */
  template <int dim, bool affine>
  __attribute__((always_inline)) inline void
  sum_momentum(const PointView<dim>              &points,
               const CellBatch                   &batch,
               const CellGeometry<dim>           &cell,
               typename Linear<dim>::Nodes       &mass,
               typename Linear<dim>::Nodes *const momentum)
  {
    using Kernel = Linear<dim>;
    using Nodes  = typename Kernel::Nodes;

    for (std::size_t p = batch.begin; p < batch.end; ++p)
      {
        std::array<Nodes, dim> w;
        for (int d = 0; d < dim; ++d)
          w[d] = Kernel::weights(d,
                                 (points.position[d][p] - cell.origin[d]) *
                                   cell.inverse_edge[d]);
        Nodes mass_weight = w[0] * w[1];
        if constexpr (dim == 3)
          mass_weight *= w[2];
        mass_weight *= points.mass[p];
        mass += mass_weight;
        for (int d = 0; d < dim; ++d)
          {
            Nodes velocity = broadcast<Nodes>(points.velocity[d][p]);
            if constexpr (affine)
              // x_i - x: one weight of the other end, signed
              for (int e = 0; e < dim; ++e)
                velocity += points.affine[d * dim + e][p] /
                            cell.inverse_edge[e] *
                            (Kernel::sign(e) * Kernel::across(w[e], e));
            momentum[d] += mass_weight * velocity;
          }
      }
  }
} // namespace limber

#endif
