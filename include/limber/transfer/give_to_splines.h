// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_give_to_splines_h
#define limber_transfer_give_to_splines_h

#include <limber/interpolation/batch_lanes.h>
#include <limber/interpolation/quadratic.h>

namespace limber
{
  /**
   * Weights of all nodes of a cell at the points of a pack, in memory, so that
   * each can be spread over the lanes of a record as it is loaded.
   */
  template <int dim, bool slopes>
  struct SplineWeights
  {
    using Basis                              = Quadratic<dim>;
    using Number                             = PointPack<dim>;
    static constexpr int         width       = pack_width<Number>;
    static constexpr int         n           = Basis::n_nodes;
    static constexpr std::size_t n_gradients = slopes ? dim : 0;

    __attribute__((always_inline))
    SplineWeights(const CellGeometry<dim>       &cell,
                  const SplineCell<dim>         &nodes,
                  const std::array<Number, dim> &xi)
    {
      std::array<typename Basis::template Weights<Number>, dim> w;
#pragma GCC unroll 3
      for (int d = 0; d < dim; ++d)
        {
          w[d] = Basis::weights(nodes, d, xi[d]);
          if constexpr (slopes)
            for (Number &slope : w[d].slope)
              slope *= cell.inverse_edge[d];
        }
        // Every weight is a product of factors that are exact to the last bits:
        // small masses of nodes remain positive.
#pragma GCC unroll 27
      for (int i = 0; i < n; ++i)
        {
          const Number &x      = w[0].value[Basis::power(i, 0)];
          Number        others = w[1].value[Basis::power(i, 1)];
          if constexpr (dim == 3)
            others *= w[2].value[Basis::power(i, 2)];
          store(x * others, value[i]);
          if constexpr (slopes)
            {
              store(w[0].slope[Basis::power(i, 0)] * others, gradient[0][i]);
              Number y = x * w[1].slope[Basis::power(i, 1)];
              if constexpr (dim == 3)
                {
                  const Number z = x * w[1].value[Basis::power(i, 1)];
                  store(z * w[2].slope[Basis::power(i, 2)], gradient[2][i]);
                  y *= w[2].value[Basis::power(i, 2)];
                }
              store(y, gradient[1][i]);
            }
        }
      // Else GCC takes every weight out of a register by shuffles, where a
      // load spreads it over the lanes for nothing.
      __asm__("" : "+m"(value));
      if constexpr (slopes)
        __asm__("" : "+m"(gradient));
    }

    alignas(64) double value[n][width];
    alignas(64) double gradient[n_gradients > 0 ? n_gradients : 1]
                               [n_gradients > 0 ? n : 1][width];
  };



  /**
   * Sums for the records of the nodes of a cell: @p n_slots of them from
   * @p first on are lanes of one pack for each node. What a point gives is then
   * one product of a pack and a weight for each node, and what a cell gives
   * is added to a record at once. The sums of a pack of points are best those
   * of a local object, so that they stay in registers; those of a batch, which
   * work that is called apart has to know (for_each_pack), live in memory.
   */
  template <int dim, unsigned int first, unsigned int n_slots>
  class SplineSums
  {
  public:
    using Basis                         = Quadratic<dim>;
    using Window                        = RecordWindow<dim, first, n_slots>;
    using Record                        = typename Window::Lanes;
    static constexpr unsigned int width = Window::width;
    static constexpr unsigned int start = Window::start;

    __attribute__((always_inline)) void
    clear()
    {
      set_zero(sums);
    }

    static constexpr unsigned int
    lane_of(const unsigned int slot)
    {
      return Window::lane_of(slot);
    }

    /** N_i times a record, for all nodes; weights are those of one point. */
    template <std::size_t n, int points>
    __attribute__((always_inline)) void
    add(const double (&weights)[n][points], const int point, const Record &what)
    {
#pragma GCC unroll 27
      for (std::size_t i = 0; i < n; ++i)
        sums[i] += weights[i][point] * what;
    }

    /** Add those of a pack, or be them if it is the first of its batch. */
    __attribute__((always_inline)) void
    take(const SplineSums &other, const bool first_pack)
    {
      if (first_pack)
        sums = other.sums;
      else
#pragma GCC unroll 27
        for (int i = 0; i < Basis::n_nodes; ++i)
          sums[i] += other.sums[i];
    }

    __attribute__((always_inline)) void
    add_to_nodes(const SplineCell<dim> &cell, double *const nodes) const
    {
#pragma GCC unroll 27
      for (int i = 0; i < Basis::n_nodes; ++i)
        {
          double *const record = nodes + cell.node[i] + start;
          store(load<Record>(record) + sums[i], record);
        }
    }

    std::array<Record, Basis::n_nodes> sums;
  };



  /**
   * What the points of a pack give, as records of slots, to the sums of the
   * nodes of their cell: m N_i and m N_i (v + C (x_i - x)), or the second
   * alone where slots of the mass are not among those summed up.
   */
  template <int dim, bool affine, class Lanes, class Sums>
  __attribute__((always_inline)) inline void
  give_momentum(const PointView<dim>                  &points,
                const CellGeometry<dim>               &cell,
                const SplineCell<dim>                 &nodes,
                const Lanes                           &lanes,
                const std::array<PointPack<dim>, dim> &xi,
                const double (&weights)[Quadratic<dim>::n_nodes][1 << dim],
                const unsigned int momentum, // its first slot
                Sums              &sums)
  {
    using Number            = PointPack<dim>;
    using Basis             = Quadratic<dim>;
    using Record            = typename Sums::Record;
    constexpr bool has_mass = Sums::start == 0;

    const Number                    mass = lanes.load(points.mass);
    std::array<Number, Sums::width> slots;
    set_zero(slots);
    if constexpr (has_mass)
      slots[NodeLayout<dim>::mass] = mass;
    for (int d = 0; d < dim; ++d)
      slots[Sums::lane_of(momentum + d)] =
        mass * lanes.load(points.velocity[d]);
    const auto records = records_of<Record>(slots);
    for (int p = 0; p < lanes.n; ++p)
      sums.add(weights, p, records[p]);

    if constexpr (affine)
      for (int e = 0; e < dim; ++e)
        {
          alignas(64) double moments[Basis::n_nodes][1 << dim];
          const auto         places = Basis::places(nodes, e);
          for (int i = 0; i < Basis::n_nodes; ++i)
            store(load<Number>(weights[i]) *
                    ((places[Basis::power(i, e)] - xi[e]) /
                     cell.inverse_edge[e]),
                  moments[i]);
          std::array<Number, Sums::width> of_affine;
          set_zero(of_affine);
          for (int d = 0; d < dim; ++d)
            of_affine[Sums::lane_of(momentum + d)] =
              mass * lanes.load(points.affine[d * dim + e]);
          const auto added = records_of<Record>(of_affine);
          for (int p = 0; p < lanes.n; ++p)
            sums.add(moments, p, added[p]);
        }
  }
} // namespace limber

#endif
