// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_convected_pack_h
#define limber_interpolation_convected_pack_h

#include <limber/interpolation/box_functions.h>
#include <limber/interpolation/convected_fields.h>
#include <limber/interpolation/corner_functions.h>

namespace limber
{
  /**
   * The domains of the points of a pack (convected.h) and the functions of the
   * nodes on them. Where all cells are alike, or those around, a domain no
   * longer than one lies in a block of 2^dim cells: the functions of its 3^dim
   * nodes are computed with the points as lanes, for the same formula whichever
   * cells the corners are in. A pack with other domains is done point by point.
   */
  template <int dim>
  class ConvectedPack
  {
  public:
    using Number                   = PointPack<dim>;
    static constexpr int n_points  = pack_width<Number>;
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
      , inverse_edge(grid.bins.one_per_cell ? grid.bins.inverse_edge :
                                              grid.cells[cell].inverse_edge)
      , first(lanes.first)
      , n(lanes.n)
    {
      Vector at; // from the lower corner of the bins, in cells
      for (int d = 0; d < dim; ++d)
        at[d] = (lanes.load(points.position[d]) - grid.bins.lower[d]) *
                inverse_edge[d];
      fits = points.has_boxes() ? set_boxes(at, lanes) :
             rarely(points.domain_form == DomainForm::hexahedron) ?
                                  set_hexahedra(at, lanes) :
                                  set_edges(at, lanes);
      if (rarely(!fits))
        invert_one_by_one();
    }

    const PointView<dim> &points;
    const GridView<dim>  &grid;
    const std::uint32_t   cell;

    // 1/m; of all cells, or where these have several sizes of that of the pack
    const std::array<double, dim> &inverse_edge;

    SmallMatrix<dim, Number> inverse; // R^-1, 1/m, of R as it counts

    /** u and u,k (convected.h) of fields in the slots of the window. */
    template <class Window>
    __attribute__((always_inline)) void
    take(Records<Window> &mean, std::array<Records<Window>, dim> &along) const
    {
      using Record = typename Window::Lanes;
      if (rarely(!fits))
        return take_one_by_one<Window>(mean, along);
      const auto each = [&](const auto &functions)
        __attribute__((always_inline))
      {
        for (int p = 0; p < n; ++p)
          {
            std::array<Record, dim> change;
            functions.template take<Window>(
              block, grid.nodes, p, mean[p], change);
            for (int k = 0; k < dim; ++k)
              along[k][p] = change[k];
          }
      };
      points.has_boxes() ? each(on_boxes) : each(at_corners);
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
      const auto each = [&](const auto &functions)
        __attribute__((always_inline))
      {
        for (int p = 0; p < n; ++p)
          {
            std::array<Record, dim> own;
            for (int k = 0; has_along && k < dim; ++k)
              own[k] = along[k][p];
            functions.template give<Window, has_alike, has_along>(
              block, grid.nodes, p, alike[p], own);
          }
      };
      points.has_boxes() ? each(on_boxes) : each(at_corners);
    }

    using Vector = std::array<Number, dim>;

    /** Whether velocity_at_corners() is there: hexahedra, all in blocks. */
    bool
    has_corners() const
    {
      return points.domain_form == DomainForm::hexahedron && fits;
    }

    /**
     * Where the corners of the hexahedra are, from their points (m), once they
     * have moved for the time @p step (s) with the velocity of the grid there.
     */
    std::array<Vector, n_corners>
    moved_corners(const double step) const
    {
      auto result = at_corners.at_corners(block,
                                          grid.nodes,
                                          n,
                                          NodeLayout<dim>::moving_velocity);
      for (int c = 0; c < n_corners; ++c)
        for (int d = 0; d < dim; ++d)
          result[c][d] =
            (at_corners.corner(c, d) - place[d]) / inverse_edge[d] +
            step * result[c][d];
      return result;
    }

  private:
    using Matrix = SmallMatrix<dim, Number>;

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
              in_cells[d][k] = edges[d][k] * inverse_edge[d];
              half[d] += magnitude(in_cells[d][k]);
            }
          fitted &= half[d] <= 0.5;
          box *= half[d];
        }
      if (rarely(!all(fitted & (determinant<dim>(in_cells) > box))) ||
          !block.find(grid, cell, n, at, half))
        return false;
      invert(edges);
      at_corners.set(at, in_cells);
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
          for (int k = 0; k < dim; ++k)
            shape.edges[d][k] =
              lanes.load(points.domain[d * dim + k]) * inverse_edge[d];
          for (int t = 0; t < shape.n_twists; ++t)
            shape.twists[t][d] =
              lanes.load(points.domain[dim * (dim + t) + d]) * inverse_edge[d];
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
      if (rarely(!all(fitted)) || !block.find(grid, cell, n, at, half))
        return false;
      auto edges = shape.edges;
      for (int d = 0; d < dim; ++d)
        for (int k = 0; k < dim; ++k)
          edges[d][k] /= inverse_edge[d];
      invert(edges);
      at_corners.set(at, shape);
      place = at;
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
          half[d] = larger(half_box<dim>(
                             points,
                             d,
                             [&](const double *const array) __attribute__((
                               always_inline)) { return lanes.load(array); }) *
                             inverse_edge[d],
                           broadcast<Number>(smallest_half_box));
          half[d] = half[d] < largest_half_box ?
                      half[d] :
                      broadcast<Number>(largest_half_box);
#pragma GCC unroll 3
          for (int k = 0; k < dim; ++k)
            inverse[k][d] = k == d ? inverse_edge[d] / half[d] : Number{};
        }
      if (!block.find(grid, cell, n, at, half))
        return false;
      on_boxes.set(at, half);
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

    BlockNodes<dim>      block;
    BoxFunctions<dim>    on_boxes;   // of one form of domains or ...
    CornerFunctions<dim> at_corners; // ... of the others
    Vector               place; // of hexahedra only: in the block, in cells
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
