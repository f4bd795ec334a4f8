// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_batch_lanes_h
#define limber_interpolation_batch_lanes_h

#include <limber/base/expected.h>
#include <limber/base/small_matrix.h>
#include <limber/grid/record_window.h>
#include <limber/interpolation/linear.h>
#include <limber/materials/law.h>
#include <limber/points/cell_batch.h>
#include <limber/points/locate.h>

namespace limber
{
  /**
   * A pack of points: as wide as a cell has nodes, but no wider than a
   * register, as GCC compares packs of two registers lane by lane.
   */
  template <int dim>
  using PointPack = Pack<(dim == 2 ? 4 : widest_pack)>;



  /**
   * Some points of a batch as lanes of a pack. The last pack of a batch may not
   * be @p full: idle lanes then repeat the first point on loading, so that they
   * cannot produce exceptions of their own, and are not overwritten on storing.
   */
  template <int dim, bool full>
  class BatchLanes
  {
  public:
    using Number = PointPack<dim>;

    /** The @p n points from @p first on. */
    BatchLanes(const std::size_t first, const int n)
      : first(first)
      , n(n)
      , active(first_lanes<Number>(n))
    {}

    Number
    load(const double *const array) const
    {
      const Number values = limber::load<Number>(array + first);
      if constexpr (full)
        return values;
      else
        return active ? values : broadcast<Number>(array[first]);
    }

    void
    store(const Number &values, double *const array) const
    {
      if constexpr (full)
        limber::store(values, array + first);
      else
        limber::store(active ? values : limber::load<Number>(array + first),
                      array + first);
    }

    /** Values in active lanes, zero in idle ones. */
    Number
    only_active(const Number &values) const
    {
      if constexpr (full)
        return values;
      else
        return active ? values : Number{};
    }

    /** Natural coordinates of the points in their cell. */
    std::array<Number, dim>
    natural(const PointView<dim> &points, const CellGeometry<dim> &cell) const
    {
      std::array<Number, dim> xi;
      for (int d = 0; d < dim; ++d)
        xi[d] = (load(points.place[d]) - cell.origin[d]) * cell.inverse_edge[d];
      return xi;
    }

    static constexpr int width = pack_width<Number>;

    const std::size_t first; // point in the first lane
    const int         n;     // number of active lanes

  private:
    const decltype(first_lanes<Number>(0)) active;
  };



  namespace internal
  {
    /** Out of line, to keep the loop over full packs small. */
    template <class Work, class Lanes>
    __attribute__((noinline)) void
    do_apart(const Work &work, const Lanes &lanes)
    {
      work(lanes);
    }
  } // namespace internal



  /**
   * Call @p work for the points of a batch, pack by pack. @p work should be
   * always inlined: a call would cost as much as a point.
   */
  template <int dim, class Work>
  __attribute__((always_inline)) inline void
  for_each_pack(const CellBatch &batch, const Work &work)
  {
    constexpr std::size_t width = pack_width<PointPack<dim>>;
    std::size_t           p     = batch.begin;
    if (usually(p + width <= batch.end))
      do
        {
          work(BatchLanes<dim, true>(p, width));
          p += width;
        }
      while (rarely(p + width <= batch.end));
    if (rarely(p < batch.end))
      internal::do_apart(
        work, BatchLanes<dim, false>(p, static_cast<int>(batch.end - p)));
  }



  /** The Kirchhoff deviator of a pack of points of a solid, Pa. */
  template <int dim, class Lanes>
  __attribute__((always_inline)) inline SmallMatrix<dim, PointPack<dim>>
  stress_deviator(const PointView<dim> &points, const Lanes &lanes)
  {
    Deviator<dim, PointPack<dim>> s;
#pragma GCC unroll 8
    for (unsigned int k = 0; k < s.size(); ++k)
      s[k] = lanes.load(points.deviator[k]);
    return rows_of<dim>(s);
  }



  /** Where the points of a pack have moved to. */
  template <int dim>
  struct MovedPack
  {
    std::array<PointPack<dim>, dim> xi; // natural coordinates in the old cell
    PointPack<dim>                  displacement; // max. shift over edge
    bool                            inside;       // all are still in the cell
  };



  /**
   * Move the points of a pack by @p shift (m), and locate the cells of those
   * that have left @p cell.
   */
  template <int dim, class Lanes>
  __attribute__((always_inline)) inline MovedPack<dim>
  move_points(const PointView<dim>                  &points,
              const GridView<dim>                   &grid,
              const std::uint32_t                    cell,
              const Lanes                           &lanes,
              const std::array<PointPack<dim>, dim> &shift)
  {
    using Number                      = PointPack<dim>;
    const CellGeometry<dim> &geometry = grid.cells[cell];
    MovedPack<dim>           moved;
    auto                     inside = Number{} == Number{};
    for (int d = 0; d < dim; ++d)
      {
        const Number position = lanes.load(points.position[d]) + shift[d];
        lanes.store(position, points.position[d]);
        const Number xi =
          (position - geometry.origin[d]) * geometry.inverse_edge[d];
        inside &= (xi >= 0.) & (xi <= 1.);
        moved.xi[d]        = xi;
        const Number cells = magnitude(shift[d]) * geometry.inverse_edge[d];
        moved.displacement = d == 0 ? cells : larger(moved.displacement, cells);
      }
    moved.inside = all(inside);
    if (!moved.inside)
      locate(points, grid, cell, lanes.first, lanes.first + lanes.n);
    return moved;
  }



  /**
   * Monomial coefficients of @p n_components slots of the nodal records of a
   * cell, from slot @p first on; computed once per batch, for evaluation at
   * many points.
   */
  template <class Basis, unsigned int first, unsigned int n_components>
  class NodalCoefficients
  {
    static constexpr int dim = Basis::dim;
    using Window             = RecordWindow<dim, first, n_components>;
    static constexpr unsigned int width = Window::width;
    static constexpr unsigned int start = Window::start;
    // Records wider than a register are transformed in parts.
    using Part =
      std::conditional_t<width <= widest_pack, typename Window::Lanes, Pack<4>>;

  public:
    __attribute__((always_inline))
    NodalCoefficients(const GridView<dim> &grid, const std::uint32_t cell)
    {
#pragma GCC unroll 2
      for (unsigned int lane = 0; lane < width; lane += pack_width<Part>)
        transform(grid, Basis::nodes_of(grid, cell), lane);
    }

    /** Coefficients of one component, counted from slot @p first. */
    auto
    component(const unsigned int c) const
    {
      return [this, c](const int k) {
        return coefficients[k * width + c + first - start];
      };
    }

    /** A vector field, as coefficients; refers to its owner. */
    class VectorField
    {
    public:
      /** Component d is in lane first_lane + d; other lanes are undefined. */
      using Components                = Pack<dim == 2 ? 2 : 4>;
      static constexpr int first_lane = dim == 3 && first > start ? 1 : 0;

      explicit VectorField(const double *const values)
        : values(values)
      {}

      auto
      operator()(const int d) const
      {
        return [this, d](const int k) { return values[k * int(width) + d]; };
      }

      Components
      components(const int k) const
      {
        return load<Components>(values + (k * int(width) - first_lane));
      }

    private:
      // Coefficient 0 of component 0; a pointer, as which of two fields it is
      // may be known at run time only.
      const double *values;
    };

    /** The vector field whose first component is that one. */
    VectorField
    field(const unsigned int begin) const
    {
      return VectorField(&coefficients[begin + first - start]);
    }

  private:
    /** Transform the lanes of one part, from @p lane on. */
    template <class Nodes>
    __attribute__((always_inline)) void
    transform(const GridView<dim> &grid,
              const Nodes         &nodes,
              const unsigned int   lane)
    {
      const auto read = [&](const int i) __attribute__((always_inline))
      {
        return load<Part>(grid.nodes + nodes.node[i] + start + lane);
      };
      const auto keep = [&](const int k, const Part &value)
        __attribute__((always_inline))
      {
        store(value, &coefficients[k * width + lane]);
      };
      // 27 nodes at once are faster even if some registers are spilled.
      if constexpr (Basis::n_nodes > 32)
        Basis::template to_monomials_by_planes<Part>(
          nodes,
          read,
          [&](const int k) __attribute__((always_inline)) {
            return load<Part>(&coefficients[k * width + lane]);
          },
          keep);
      else
        {
          std::array<Part, Basis::n_nodes> a;
#pragma GCC unroll 27
          for (int i = 0; i < Basis::n_nodes; ++i)
            a[i] = read(i);
          Basis::to_monomials(a, nodes);
#pragma GCC unroll 27
          for (int i = 0; i < Basis::n_nodes; ++i)
            keep(i, a[i]);
        }
    }

    // Rows must not straddle cache lines: loads across two lines right after
    // the store would stall (no store forwarding).
    alignas(64) std::array<double, width * Basis::n_nodes> coefficients;
  };
} // namespace limber

#endif
