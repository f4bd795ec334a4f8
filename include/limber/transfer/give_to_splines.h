// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_give_to_splines_h
#define limber_transfer_give_to_splines_h

#include <limber/interpolation/batch_lanes.h>
#include <limber/interpolation/spline.h>
#include <limber/transfer/give_by_directions.h>
#include <limber/transfer/give_by_planes.h>

namespace limber
{
  /**
   * Weights of all nodes of a cell at the points of a pack, stored in memory,
   * such that each can be broadcast over the lanes of a record as it is loaded.
   */
  template <class Basis, bool slopes>
  struct SplineWeights
  {
    static constexpr int dim                 = Basis::dim;
    using Number                             = PointPack<dim>;
    static constexpr int         width       = pack_width<Number>;
    static constexpr int         n           = Basis::n_nodes;
    static constexpr std::size_t n_gradients = slopes ? dim : 0;

    __attribute__((always_inline))
    SplineWeights(const CellGeometry<dim>       &cell,
                  const typename Basis::Cell    &nodes,
                  const std::array<Number, dim> &xi)
    {
      std::array<typename Basis::Factors::template Weights<Number>, dim> w;
#pragma GCC unroll 3
      for (int d = 0; d < dim; ++d)
        {
          w[d] = Basis::weights(nodes, d, xi[d]);
          if constexpr (slopes)
            for (Number &slope : w[d].slope)
              slope *= cell.inverse_edge[d];
        }
        // Products of non-negative factors without cancellation: tiny nodal
        // masses are accurate and remain positive.
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
      // Without this GCC extracts every weight from a register by shuffles,
      // while a broadcast load is free.
      __asm__("" : "+m"(value));
      if constexpr (slopes)
        __asm__("" : "+m"(gradient));
    }

    alignas(64) double value[n][width];
    alignas(64) double gradient[n_gradients > 0 ? n_gradients : 1]
                               [n_gradients > 0 ? n : 1][width];
  };



  /**
   * Sums for the records of the nodes of a cell: @p n_slots slots from @p first
   * on are lanes of one pack per node. So a point adds one product of a pack
   * and a weight to each node, and a cell adds each record at once. Sums of a
   * pack of points should be a local object, to stay in registers; those of a
   * batch live in memory, as out-of-line functions must access them
   * (for_each_pack).
   */
  template <class Basis, unsigned int first, unsigned int n_slots>
  class SplineSums
  {
  public:
    static constexpr int dim = Basis::dim;
    using Window             = RecordWindow<dim, first, n_slots>;
    // As two halves: forces are in the lower lanes and most of the work.
    using Record =
      std::conditional_t<Window::width == 8, SplitPack, typename Window::Lanes>;
    static constexpr unsigned int width = Window::width;
    static constexpr unsigned int start = Window::start;
    using ForceRecord =
      std::conditional_t<Window::width == 8, SplitPack::Half, Record>;

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

    /** Add N_i times a record for all nodes; weights of one of the points. */
    template <std::size_t n, int points, class What>
    __attribute__((always_inline)) void
    add(const double (&weights)[n][points], const int point, const What &what)
    {
#pragma GCC unroll 27
      for (std::size_t i = 0; i < n; ++i)
        sums[i] += weights[i][point] * what;
    }

    /** Add the sums of a pack, or copy them if it is the first of its batch. */
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
    add_to_nodes(const typename Basis::Cell &cell, double *const nodes) const
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
   * What the points of a pack give to all nodes apart from the factor N_i, as
   * records: m and m v, or the latter alone if the slots do not include the
   * mass.
   */
  template <class Sums, int dim, class Lanes>
  __attribute__((always_inline)) inline auto
  momentum_records(const PointView<dim> &points,
                   const Lanes          &lanes,
                   const unsigned int    momentum) // its first slot
  {
    using Number = PointPack<dim>;

    const Number                    mass = lanes.load(points.mass);
    std::array<Number, Sums::width> slots;
    set_zero(slots);
    if constexpr (Sums::start == 0)
      slots[NodeLayout<dim>::mass] = mass;
    for (int d = 0; d < dim; ++d)
      slots[Sums::lane_of(momentum + d)] =
        mass * lanes.load(points.velocity[d]);
    return records_of<typename Sums::Record>(slots);
  }



  /** m C_e, to be multiplied by N_i (x_i - x)_e (APIC). */
  template <class Sums, int dim, class Lanes>
  __attribute__((always_inline)) inline auto
  affine_records(const PointView<dim> &points,
                 const Lanes          &lanes,
                 const unsigned int    momentum,
                 const int             e)
  {
    using Number = PointPack<dim>;

    const Number                    mass = lanes.load(points.mass);
    std::array<Number, Sums::width> slots;
    set_zero(slots);
    for (int d = 0; d < dim; ++d)
      slots[Sums::lane_of(momentum + d)] =
        mass * lanes.load(points.affine[d * dim + e]);
    return records_of<typename Sums::Record>(slots);
  }



  /** Forces - V t, to be multiplied by the derivatives of N_i along e. */
  template <class Sums, int dim>
  __attribute__((always_inline)) inline auto
  force_records(const SmallMatrix<dim, PointPack<dim>> &Vt, const int e)
  {
    using Record        = typename Sums::ForceRecord;
    constexpr int width = pack_width<Record>;
    static_assert(Sums::lane_of(NodeLayout<dim>::force) + dim <= width);
    std::array<PointPack<dim>, width> slots;
    set_zero(slots);
#pragma GCC unroll 3
    for (int d = 0; d < dim; ++d)
      slots[Sums::lane_of(NodeLayout<dim>::force + d)] = -Vt[d][e];
    return records_of<Record>(slots);
  }



  /** Which contributions give_pack() adds. */
  template <bool give_momentum, bool give_affine, bool give_force>
  struct Given
  {
    static constexpr bool momentum = give_momentum, affine = give_affine,
                          force = give_force;
  };



  /**
   * P2G of a pack: add to the sums of a batch m N_i and m N_i (v + C (x_i -
   * x)), and with @p Vt (J) the force - V t grad N_i. For quadratic splines the
   * sums stay in registers while points are added one by one; where they would
   * not fit (cubic splines, forces in 3d) this is done plane by plane.
   */
  template <class Basis, class What, class Sums, class Lanes>
  __attribute__((always_inline)) inline void
  give_pack(const PointView<Basis::dim>                         &points,
            const CellGeometry<Basis::dim>                      &cell,
            const typename Basis::Cell                          &nodes,
            const Lanes                                         &lanes,
            const std::array<PointPack<Basis::dim>, Basis::dim> &xi,
            const unsigned int momentum, // its first slot
            const SmallMatrix<Basis::dim, PointPack<Basis::dim>> &Vt,
            const bool begins, // the sums of the batch
            Sums      &of_batch)
  {
    constexpr int dim = Basis::dim;
    using Number      = PointPack<dim>;
    // Distances of the nodes from the points along e, m
    const auto arms = [&](const int e) __attribute__((always_inline))
    {
      const auto                   places = Basis::places(nodes, e);
      std::array<Number, Basis::n> result;
      for (int i = 0; i < Basis::n; ++i)
        result[i] = (places[i] - xi[e]) / cell.inverse_edge[e];
      return result;
    };
    if constexpr (Basis::degree == 2 && dim == 2 && What::momentum &&
                  What::force && !What::affine)
      give_by_directions(points, cell, nodes, lanes, xi, Vt, begins, of_batch);
    else if constexpr (Basis::degree == 2 && !(dim == 3 && What::force) &&
                       Basis::n_nodes <= n_registers)
      {
        const SplineWeights<Basis, What::force> weights(cell, nodes, xi);
        Sums                                    sums;
        sums.clear();
        if constexpr (What::momentum)
          {
            const auto records =
              momentum_records<Sums>(points, lanes, momentum);
            for (int p = 0; p < lanes.n; ++p)
              sums.add(weights.value, p, records[p]);
          }
        if constexpr (What::affine)
          for (int e = 0; e < dim; ++e)
            {
              alignas(64) double moments[Basis::n_nodes][1 << dim];
              const auto         arm = arms(e);
              for (int i = 0; i < Basis::n_nodes; ++i)
                store(load<Number>(weights.value[i]) * arm[Basis::power(i, e)],
                      moments[i]);
              const auto added =
                affine_records<Sums>(points, lanes, momentum, e);
              for (int p = 0; p < lanes.n; ++p)
                sums.add(moments, p, added[p]);
            }
        if constexpr (What::force)
#pragma GCC unroll 3
          for (int e = 0; e < dim; ++e)
            {
              const auto records = force_records<Sums, dim>(Vt, e);
              for (int p = 0; p < lanes.n; ++p)
                sums.add(weights.gradient[e], p, records[p]);
            }
        of_batch.take(sums, begins);
      }
    else
      {
        using Factors = AxisFactors<Basis, What::force>;
        typename Factors::OfDirections values, slopes;
#pragma GCC unroll 3
        for (int d = 0; d < dim; ++d)
          {
            const auto w = Basis::weights(nodes, d, xi[d]);
            values[d]    = w.value;
            slopes[d]    = w.slope;
#pragma GCC unroll 4
            for (Number &slope : slopes[d])
              slope *= cell.inverse_edge[d];
          }
        std::array<typename Sums::Record, Factors::width> alike;
        std::array<std::array<typename Sums::ForceRecord, Factors::width>, dim>
          along;
        if constexpr (What::momentum)
          alike = momentum_records<Sums>(points, lanes, momentum);
        if constexpr (What::force)
#pragma GCC unroll 3
          for (int e = 0; e < dim; ++e)
            along[e] = force_records<Sums, dim>(Vt, e);
        add_by_planes<Basis, What::momentum, What::force>(Factors(values,
                                                                  slopes),
                                                          alike,
                                                          along,
                                                          lanes.n,
                                                          begins,
                                                          of_batch.sums);
        if constexpr (What::affine)
          {
            auto                             moments = values;
            std::array<decltype(alike), dim> turning;
            for (int e = 0; e < dim; ++e)
              {
                const auto arm = arms(e);
                for (int i = 0; i < Basis::n; ++i)
                  moments[e][i] *= arm[i];
                turning[e] = affine_records<Sums>(points, lanes, momentum, e);
              }
            add_by_planes<Basis, false, true>(AxisFactors<Basis, true>(values,
                                                                       moments),
                                              alike,
                                              turning,
                                              lanes.n,
                                              false,
                                              of_batch.sums);
          }
      }
  }
} // namespace limber

#endif
