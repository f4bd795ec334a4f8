// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_sum_momentum_h
#define limber_transfer_sum_momentum_h

#include <limber/base/expected.h>
#include <limber/interpolation/linear.h>
#include <limber/points/cell_batch.h>

#include <algorithm>

namespace limber
{
  /**
   * P2G of mass and momentum: add m N_i and m N_i (v + C (x_i - x)) for the
   * points of a batch, one lane per node of their cell; C only if @p affine. As
   * products of weights without cancellation, tiny nodal masses are accurate.
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

    constexpr std::size_t width = 1 << dim;
    std::size_t           begin = batch.begin;
    do
      {
        // natural coordinates of a pack; points beyond the batch are not used
        alignas(64) double xi[dim][width];
#pragma GCC unroll 8
        for (int d = 0; d < dim; ++d)
          store((load<Nodes>(points.place[d] + begin) - cell.origin[d]) *
                  cell.inverse_edge[d],
                xi[d]);
        const std::size_t end = std::min(begin + width, batch.end);
        read_from_memory<dim>(xi);
        for (std::size_t p = begin; p < end; ++p)
          {
            std::array<Nodes, dim> w;
#pragma GCC unroll 8
            for (int d = 0; d < dim; ++d)
              w[d] = Kernel::weights(d, xi[d][p - begin]);
            Nodes mass_weight = w[0] * w[1];
            if constexpr (dim == 3)
              mass_weight *= w[2];
            mass_weight *= points.mass[p];
            mass += mass_weight;
            for (int d = 0; d < dim; ++d)
              {
                Nodes velocity = broadcast<Nodes>(points.velocity[d][p]);
                if constexpr (affine)
                  // x_i - x: plus or minus the weight of the opposite end
                  for (int e = 0; e < dim; ++e)
                    velocity += points.affine[d * dim + e][p] /
                                cell.inverse_edge[e] *
                                (Kernel::sign(e) * Kernel::across(w[e], e));
                momentum[d] += mass_weight * velocity;
              }
          }
        begin += width;
      }
    while (rarely(begin < batch.end));
  }
} // namespace limber

#endif
