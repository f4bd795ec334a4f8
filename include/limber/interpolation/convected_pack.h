// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_convected_pack_h
#define limber_interpolation_convected_pack_h

#include <limber/interpolation/batch_lanes.h>
#include <limber/interpolation/convected_fields.h>

namespace limber
{
  /**
   * The domains of the points of a pack (convected.h) and the functions of the
   * nodes on them. Where all cells are alike a domain no longer than one lies
   * in a block of 2^dim cells: the functions of its 3^dim nodes are computed
   * with the points as lanes, for the same formula whichever cells the corners
   * are in. A pack with other domains is done point by point.
   */
  template <int dim>
  class ConvectedPack
  {
  public:
    using Number                   = PointPack<dim>;
    static constexpr int n_points  = pack_width<Number>;
    static constexpr int n_nodes   = dim == 2 ? 9 : 27;
    static constexpr int n_corners = 1 << dim;

    /** A record of nodal slots for each point; those beyond mean nothing. */
    template <class Window>
    using Records = std::array<typename Window::Lanes, n_points>;

    /** Of points that are in @p cell. */
    template <class Lanes>
    __attribute__((always_inline)) ConvectedPack(const PointView<dim> &points,
                                                 const GridView<dim>  &grid,
                                                 const std::uint32_t   cell,
                                                 const Lanes          &lanes)
      : points(points)
      , grid(grid)
      , cell(cell)
      , first(lanes.first)
      , n(lanes.n)
    {
      Vector at; // from the lower corner of the bins, in cells
      for (int d = 0; d < dim; ++d)
        at[d] = (lanes.load(points.position[d]) - grid.bins.lower[d]) *
                grid.bins.inverse_edge[d];
      fits = grid.bins.one_per_cell &&
             (points.has_boxes() ? set_boxes(at, lanes) :
              rarely(points.domain_form == DomainForm::hexahedron) ?
                                   set_hexahedra(at, lanes) :
                                   set_edges(at, lanes));
      if (rarely(!fits))
        invert_one_by_one();
    }

    const PointView<dim> &points;
    const GridView<dim>  &grid;
    const std::uint32_t   cell;

    SmallMatrix<dim, Number> inverse; // R^-1, 1/m, of R as it counts

    /** u and u,k (convected.h) of fields in the slots of the window. */
    template <class Window>
    __attribute__((always_inline)) void
    take(Records<Window> &mean, std::array<Records<Window>, dim> &along) const
    {
      using Record = typename Window::Lanes;
      if (rarely(!fits))
        return take_one_by_one<Window>(mean, along);
      for (int p = 0; p < n; ++p)
        {
          Record                  u{};
          std::array<Record, dim> change;
          set_zero(change);
          for_nodes(
            p,
            [&](const int i, const std::uint32_t record)
              __attribute__((always_inline)) {
                const auto value =
                  load<Record>(grid.nodes + record + Window::start);
                u += functions.mean[i][p] * value;
#pragma GCC unroll 3
                for (int k = 0; k < dim; ++k)
                  change[k] += functions.along[k][i][p] * value;
              });
          mean[p] = u;
          for (int k = 0; k < dim; ++k)
            along[k][p] = change[k];
        }
    }

    /** Add N_i @p alike and the changes of N_i times @p along to the nodes. */
    template <class Window, bool has_alike, bool has_along>
    __attribute__((always_inline)) void
    give(const Records<Window>                  &alike,
         const std::array<Records<Window>, dim> &along) const
    {
      using Record = typename Window::Lanes;
      if (rarely(!fits))
        return give_one_by_one<Window, has_along>(alike, along);
      for (int p = 0; p < n; ++p)
        for_nodes(
          p,
          [&](const int i, const std::uint32_t record)
            __attribute__((always_inline)) {
              double *const slots = grid.nodes + record + Window::start;
              Record        sum   = load<Record>(slots);
              if constexpr (has_alike)
                sum += functions.mean[i][p] * alike[p];
              if constexpr (has_along)
#pragma GCC unroll 3
                for (int k = 0; k < dim; ++k)
                  sum += functions.along[k][i][p] * along[k][p];
              store(sum, slots);
            });
    }

  private:
    using Vector = std::array<Number, dim>;
    using Matrix = SmallMatrix<dim, Number>;

    /** The place of node i of a block along d: 0, 1, 2. */
    static constexpr int
    digit(const int i, const int d)
    {
      return i / (d == 0 ? 1 : d == 1 ? 3 : 9) % 3;
    }

    /** The cell of the block that has node i, and which of its nodes that is.
     */
    static constexpr int
    cell_with_node(const int i)
    {
      int result = 0;
      for (int d = 0; d < dim; ++d)
        result |= (digit(i, d) == 2) << d;
      return result;
    }

    static constexpr int
    node_in_cell(const int i)
    {
      int result = 0;
      for (int d = 0; d < dim; ++d)
        result |= (digit(i, d) != 0) << d;
      return result;
    }

    /** Call work(i, record) for the nodes of the block of point p. */
    template <class Work>
    __attribute__((always_inline)) void
    for_nodes(const int p, const Work &work) const
    {
#pragma GCC unroll 9
      for (int row = 0; row < n_nodes / 3; ++row)
        {
          // nothing reaches the third row
          if (digit(3 * row, 1) == 2 && end[1][p] <= 1)
            continue;
          if (dim == 3 && digit(3 * row, dim - 1) == 2 && end[dim - 1][p] <= 1)
            continue;
#pragma GCC unroll 3
          for (int i = 3 * row; i < 3 * row + 3; ++i)
            work(i, (*blocks[p][cell_with_node(i)])[node_in_cell(i)]);
        }
    }

    /** Convected domains; false if one is none for a block. */
    template <class Lanes>
    __attribute__((always_inline)) bool
    set_edges(Vector &at, const Lanes &lanes)
    {
      Matrix edges, in_cells;
      Vector half;
      Number box    = broadcast<Number>(flattest_domain);
      auto   fitted = box > 0.;
#pragma GCC unroll 3
      for (int d = 0; d < dim; ++d)
        {
          half[d] = Number{};
#pragma GCC unroll 3
          for (int k = 0; k < dim; ++k)
            {
              edges[d][k]    = lanes.load(points.domain[d * dim + k]);
              in_cells[d][k] = edges[d][k] * grid.bins.inverse_edge[d];
              half[d] += magnitude(in_cells[d][k]);
            }
          fitted &= half[d] <= 0.5;
          box *= half[d];
        }
      if (rarely(!all(fitted & (determinant<dim>(in_cells) > box))) ||
          !find_blocks(at, half))
        return false;
      invert(edges);
      set_functions(at, in_cells);
      return true;
    }

    /** Hexahedra; out of the way of the others. */
    template <class Lanes>
    __attribute__((noinline)) bool
    set_hexahedra(Vector at, const Lanes &lanes)
    {
      Hexahedron<dim, Number> shape; // in cells
      for (int d = 0; d < dim; ++d)
        {
          const double inverse_edge = grid.bins.inverse_edge[d];
          for (int k = 0; k < dim; ++k)
            shape.edges[d][k] =
              lanes.load(points.domain[d * dim + k]) * inverse_edge;
          for (int t = 0; t < shape.n_twists; ++t)
            shape.twists[t][d] =
              lanes.load(points.domain[dim * (dim + t) + d]) * inverse_edge;
        }
      shape.integrate();
      Vector half;
      Number box    = broadcast<Number>(flattest_domain);
      auto   fitted = box > 0.;
      for (int d = 0; d < dim; ++d)
        {
          half[d] = Number{};
          for (const auto &offset : shape.offsets)
            half[d] = larger(half[d], magnitude(offset[d]));
          fitted &= half[d] <= 0.5;
          box *= half[d];
        }
      fitted &= shape.smallest > box;
      fitted &= determinant<dim>(shape.edges) > box;
      if (rarely(!all(fitted)) || !find_blocks(at, half))
        return false;
      auto edges = shape.edges;
      for (int d = 0; d < dim; ++d)
        for (int k = 0; k < dim; ++k)
          edges[d][k] /= grid.bins.inverse_edge[d];
      invert(edges);
      for_functions([&](const int c,
                        const int d) { return at[d] + shape.offsets[c][d]; },
                    [&](const int i, const Number(&values)[n_corners]) {
                      Number mean{};
                      for (int c = 0; c < n_corners; ++c)
                        mean += (n_corners * shape.shares[c]) * values[c];
                      store(mean, functions.mean[i]);
                      for (int k = 0; k < dim; ++k)
                        {
                          Number along{};
                          for (int c = 0; c < n_corners; ++c)
                            along +=
                              (n_corners * shape.along[k][c]) * values[c];
                          store(along, functions.along[k][i]);
                        }
                    });
      return true;
    }

    /** Boxes along the axes. */
    template <class Lanes>
    __attribute__((always_inline)) bool
    set_boxes(Vector &at, const Lanes &lanes)
    {
      Vector half;
#pragma GCC unroll 3
      for (int d = 0; d < dim; ++d)
        {
          const double inverse_edge = grid.bins.inverse_edge[d];
          half[d]                   = larger(half_box<dim>(
                             points,
                             d,
                             [&](const double *const array) __attribute__((
                               always_inline)) { return lanes.load(array); }) *
                             inverse_edge,
                           broadcast<Number>(smallest_half_box));
          half[d]                   = half[d] < largest_half_box ?
                                        half[d] :
                                        broadcast<Number>(largest_half_box);
#pragma GCC unroll 3
          for (int k = 0; k < dim; ++k)
            inverse[k][d] = k == d ? inverse_edge / half[d] : Number{};
        }
      if (!find_blocks(at, half))
        return false;
      set_functions_of_boxes(at, half);
      return true;
    }

    /**
     * Find the blocks of domains that reach @p half a cell and less from their
     * points, and let @p at count from their corners; false if there is none.
     */
    __attribute__((always_inline)) bool
    find_blocks(Vector &at, const Vector &half)
    {
      const BinView<dim> &bins  = grid.bins;
      Number              index = Number{};
#pragma GCC unroll 3
      for (int d = dim - 1; d >= 0; --d)
        {
          if (bins.n[d] < 2)
            return false;
          const double last  = static_cast<double>(bins.n[d] - 2);
          const Number lower = at[d] - half[d];
          const Number inner = lower > 0. ? lower : Number{};
          const Number block =
            rounded_down(inner < last ? inner : broadcast<Number>(last));
          at[d] -= block;
          store(at[d] + half[d], end[d]);
          index = index * static_cast<double>(bins.n[d]) + block;
        }

      const auto bin = to_integers(index);
      for (int p = 0; p < n; ++p)
#pragma GCC unroll 8
        for (int c = 0; c < n_corners; ++c)
          {
            std::int64_t offset = c & 1;
            if (c & 2)
              offset += bins.n[0];
            if (c & 4)
              offset += bins.n[0] * bins.n[1];
            const std::uint32_t there = bins.table[bin[p] + offset];
            if (rarely(there == invalid_cell))
              return false;
            blocks[p][c] = &grid.cells[there].node;
          }
      return true;
    }

    __attribute__((always_inline)) void
    invert(const Matrix &edges)
    {
      const auto   cof = cofactor<dim>(edges);
      const Number one = 1. / determinant<dim>(edges);
#pragma GCC unroll 3
      for (int k = 0; k < dim; ++k)
#pragma GCC unroll 3
        for (int d = 0; d < dim; ++d)
          inverse[k][d] = cof[d][k] * one;
    }

    __attribute__((always_inline)) void
    set_functions(const Vector &at, const Matrix &in_cells)
    {
      for_functions(
        [&](const int c, const int d) __attribute__((always_inline)) {
          Number x = at[d];
#pragma GCC unroll 3
          for (int k = 0; k < dim; ++k)
            x += DomainShape<dim>::sign(c, k) * in_cells[d][k];
          return x;
        },
        [&](const int i, Number(&values)[n_corners])
          __attribute__((always_inline)) { set_function(i, values); });
    }

    /**
     * The functions of the nodes of a block at a corner are products of
     * 1 - x, 1 - |x - 1| and x - 1, or zero, for each direction; a corner
     * beyond a side counts in it. Corner c is at @p place(c, d) along d, and
     * @p work(i, values) takes the functions of node i at all corners, over
     * their number.
     */
    template <class Place, class Work>
    __attribute__((always_inline)) void
    for_functions(const Place &place, const Work &work)
    {
      constexpr double share = 1. / n_corners;
      Number           factors[n_corners][dim][3];
#pragma GCC unroll 8
      for (int c = 0; c < n_corners; ++c)
#pragma GCC unroll 3
        for (int d = 0; d < dim; ++d)
          {
            const Number x     = place(c, d);
            const Number lower = clamped(1. - x), upper = clamped(x - 1.);
            const double whole = d == 0 ? share : 1.;
            factors[c][d][0]   = whole * lower;
            factors[c][d][1]   = whole * (1. - lower - upper);
            factors[c][d][2]   = whole * upper;
          }
#pragma GCC unroll 9
      for (int row = 0; row < n_nodes / 3; ++row)
        {
          Number others[n_corners];
#pragma GCC unroll 8
          for (int c = 0; c < n_corners; ++c)
            {
              others[c] = factors[c][1][row % 3];
              if constexpr (dim == 3)
                others[c] *= factors[c][2][row / 3];
            }
#pragma GCC unroll 3
          for (int i = 0; i < 3; ++i)
            {
              Number values[n_corners];
#pragma GCC unroll 8
              for (int c = 0; c < n_corners; ++c)
                values[c] = factors[c][0][i] * others[c];
              work(3 * row + i, values);
            }
        }
      // Else GCC takes every weight out of a register by shuffles, where a
      // load spreads it over the lanes for nothing.
      __asm__("" : "+m"(functions));
    }

    /**
     * Products of the means of 1 - x, 1 - |x - 1| and x - 1, or zero, over the
     * box along each direction, and of half their change from one end to the
     * other. Beyond a side of the grid the first and the last go on.
     */
    __attribute__((always_inline)) void
    set_functions_of_boxes(const Vector &at, const Vector &half)
    {
      Number mean[dim][3], change[dim][3];
#pragma GCC unroll 3
      for (int d = 0; d < dim; ++d)
        {
          const Number lower = at[d] - half[d], upper = at[d] + half[d];
          const Number share = 0.5 / half[d];
          const Number below = larger(1. - lower, Number{}),
                       rest  = larger(1. - upper, Number{}),
                       above = larger(upper - 1., Number{}),
                       start = larger(lower - 1., Number{});
          change[d][0]       = 0.5 * (rest - below);
          change[d][2]       = 0.5 * (above - start);
          change[d][1]       = -(change[d][0] + change[d][2]);
          mean[d][0]         = (below + rest) * (share * -change[d][0]);
          mean[d][2]         = (above + start) * (share * change[d][2]);
          mean[d][1]         = larger(1. - mean[d][0] - mean[d][2], Number{});
        }
#pragma GCC unroll 27
      for (int i = 0; i < n_nodes; ++i)
        {
          Number all = mean[0][digit(i, 0)];
#pragma GCC unroll 3
          for (int d = 1; d < dim; ++d)
            all *= mean[d][digit(i, d)];
          store(all, functions.mean[i]);
#pragma GCC unroll 3
          for (int k = 0; k < dim; ++k)
            {
              Number along = change[k][digit(i, k)];
#pragma GCC unroll 3
              for (int d = 0; d < dim; ++d)
                if (d != k)
                  along *= mean[d][digit(i, d)];
              store(along, functions.along[k][i]);
            }
        }
      __asm__("" : "+m"(functions)); // as in set_functions()
    }

    static Number
    clamped(const Number &x)
    {
      const Number positive = x > 0. ? x : Number{};
      return positive < 1. ? positive : broadcast<Number>(1.);
    }

    /** Sums over the corners, with signs along one edge after the other. */
    __attribute__((always_inline)) void
    set_function(const int i, Number (&values)[n_corners])
    {
#pragma GCC unroll 3
      for (int k = 0; k < dim; ++k)
        {
          const int n_pairs = n_corners >> (k + 1);
          Number    change{};
#pragma GCC unroll 4
          for (int c = 0; c < n_pairs; ++c)
            {
              const Number first = values[2 * c], second = values[2 * c + 1];
              change    = c == 0 ? second - first : change + (second - first);
              values[c] = first + second;
            }
          store(change, functions.along[k][i]);
        }
      store(values[0], functions.mean[i]);
    }

    // One by one: seldom, and out of the way.

    ConvectedDomain<dim>
    domain_of(const int p) const
    {
      return ConvectedDomain<dim>(points, grid, cell, first + p);
    }

    __attribute__((noinline, cold)) void
    invert_one_by_one()
    {
      for (int p = 0; p < n_points; ++p)
        {
          const auto one =
            DomainShape<dim>(points, grid, cell, first + (p < n ? p : 0))
              .inverse();
          for (int k = 0; k < dim; ++k)
            for (int d = 0; d < dim; ++d)
              inverse[k][d][p] = one[k][d];
        }
    }

    template <class Window>
    __attribute__((noinline, cold)) void
    take_one_by_one(Records<Window>                  &mean,
                    std::array<Records<Window>, dim> &along) const
    {
      for (int p = 0; p < n; ++p)
        {
          const FieldsOnDomain<dim, Window> fields(domain_of(p), grid);
          mean[p] = fields.mean;
          for (int k = 0; k < dim; ++k)
            along[k][p] = fields.along[k];
        }
    }

    template <class Window, bool has_along>
    __attribute__((noinline, cold)) void
    give_one_by_one(const Records<Window>                  &alike,
                    const std::array<Records<Window>, dim> &along) const
    {
      for (int p = 0; p < n; ++p)
        {
          std::array<typename Window::Lanes, dim> own;
          for (int k = 0; k < dim; ++k)
            own[k] = along[k][p];
          give_to_nodes<Window>(grid,
                                domain_of(p),
                                alike[p],
                                has_along ? own.data() : nullptr);
        }
    }

    const std::size_t first;
    const int         n;
    bool              fits; // every domain, in a block

    // Of each point the records of the nodes of the cells of its block, and
    // where in it the domain ends, in cells
    const std::array<std::uint32_t, n_corners> *blocks[n_points][n_corners];
    alignas(64) double end[dim][n_points];

    // 2^-d sum_c N_i(x_c) and 2^-d sum_c s_ck N_i(x_c), points as lanes
    struct alignas(64) Functions
    {
      double mean[n_nodes][n_points];
      double along[dim][n_nodes][n_points];
    };
    Functions functions;
  };



  /** Fields of the grid on the domains of a pack, in the slots of a window. */
  template <int dim, class Window>
  class FieldsOnPack
  {
    using Pack   = ConvectedPack<dim>;
    using Number = typename Pack::Number;

  public:
    __attribute__((always_inline)) FieldsOnPack(const Pack &domains)
    {
      typename Pack::template Records<Window>                  of_mean;
      std::array<typename Pack::template Records<Window>, dim> of_change;
      set_zero(of_mean);
      for (auto &records : of_change)
        set_zero(records);
      domains.template take<Window>(of_mean, of_change);
      mean = slots_of<Number>(of_mean);
      for (int k = 0; k < dim; ++k)
        change[k] = slots_of<Number>(of_change[k]);
    }

    /** u of the field in that slot. */
    const Number &
    value(const unsigned int slot) const
    {
      return mean[Window::lane_of(slot)];
    }

    /** Derivative along axis e of the field in that slot, with R^-1. */
    Number
    slope(const SmallMatrix<dim, Number> &inverse,
          const unsigned int              slot,
          const int                       e) const
    {
      Number result = change[0][Window::lane_of(slot)] * inverse[0][e];
#pragma GCC unroll 3
      for (int k = 1; k < dim; ++k)
        result += change[k][Window::lane_of(slot)] * inverse[k][e];
      return result;
    }

  private:
    using Slots = std::array<Number, Window::width>;
    Slots                  mean;
    std::array<Slots, dim> change;
  };
} // namespace limber

#endif
