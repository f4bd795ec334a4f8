// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_convected_pack_h
#define limber_interpolation_convected_pack_h

#include <limber/interpolation/box_functions.h>
#include <limber/interpolation/convected_fields.h>
#include <limber/interpolation/corner_functions.h>

namespace limber
{
  /** A vector field of the grid on the domains of a pack (domain_shape.h). */
  template <int dim>
  struct FieldOnPack
  {
    using Number = PointPack<dim>;
    using Vector = std::array<Number, dim>;

    /** Derivative of component d along axis e, with given R^-1. */
    Number
    slope(const SmallMatrix<dim, Number> &inverse,
          const int                       d,
          const int                       e) const
    {
      Number result = change[0][d] * inverse[0][e];
#pragma GCC unroll 3
      for (int k = 1; k < dim; ++k)
        result += change[k][d] * inverse[k][e];
      return result;
    }

    Vector                       value;      // u
    std::array<Vector, dim>      change;     // u,k
    std::array<Vector, 1 << dim> at_corners; // hexahedra and CPDI, not boxes
  };



  /**
   * The domains of the points of a pack (domain_shape.h) and the functions of
   * the nodes on them. Where cells are uniform, at least locally, and no domain
   * is longer than a cell, all lie in one block of cells, and the functions of
   * its nodes are computed with points as lanes, by the same formula whichever
   * cells the corners are in. Other packs are done point by point.
   */
  template <int dim>
  class ConvectedPack
  {
  public:
    using Number                   = PointPack<dim>;
    using Vector                   = std::array<Number, dim>;
    using Matrix                   = SmallMatrix<dim, Number>;
    static constexpr int n_points  = pack_width<Number>;
    static constexpr int n_corners = 1 << dim;

    /** For points that are in @p cell. */
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
      Vector xi;
      for (int d = 0; d < dim; ++d)
        xi[d] = (lanes.load(points.position[d]) - grid.cells[cell].origin[d]) *
                inverse_edge[d];
      fits = points.has_boxes() ? set_boxes(xi, lanes) :
             rarely(points.domain_form == DomainForm::hexahedron) ?
                                  set_hexahedra(xi, lanes) :
                                  set_edges(xi, lanes);
    }

    const PointView<dim> &points;
    const GridView<dim>  &grid;
    const std::uint32_t   cell;

    // 1/m; of all cells or, on an adaptive grid, of the cell of the pack
    const std::array<double, dim> &inverse_edge;

    /** R^-1, 1/m, of the restricted R. */
    __attribute__((always_inline)) Matrix
    inverse() const
    {
      if (rarely(!fits))
        return inverse_one_by_one();
      if (points.has_boxes())
        {
          Matrix result;
#pragma GCC unroll 3
          for (int k = 0; k < dim; ++k)
#pragma GCC unroll 3
            for (int d = 0; d < dim; ++d)
              result[k][d] = k == d ? inverse_edge[d] / edges[d][d] : Number{};
          return result;
        }
      const auto   cof = cofactor<dim>(edges);
      const Number one = 1. / determinant<dim>(edges);
      Matrix       result;
#pragma GCC unroll 3
      for (int k = 0; k < dim; ++k)
#pragma GCC unroll 3
        for (int d = 0; d < dim; ++d)
          result[k][d] = cof[d][k] * (one * inverse_edge[d]);
      return result;
    }

    /** Prepare take() and give(), which use means alone. */
    void
    find_means()
    {
      if (rarely(!fits))
        return;
      points.has_boxes() ? on_boxes.find_means(block) :
                           at_corners.find_means(block);
    }

    /** G2P of n slots of the nodal records from @p slot on: mean u. */
    template <int n_slots>
    std::array<Number, n_slots>
    take(const unsigned int slot) const
    {
      if (rarely(!fits))
        return take_one_by_one<n_slots>(slot);
      return functions().template take<n_slots>(block, grid.nodes, slot);
    }

    /** P2G: add N_i times @p given, by slots of the window, to the nodes. */
    template <class Window>
    void
    give(const std::array<Number, Window::width> &given) const
    {
      if (rarely(!fits))
        return give_one_by_one<Window>(given, nullptr);
      functions().template give<Window>(block, grid.nodes, given);
    }

    /** G2P of the vector field from @p slot on: u and u,k. */
    void
    take_field(const unsigned int slot, FieldOnPack<dim> &field) const
    {
      if (rarely(!fits))
        return take_field_one_by_one(slot, field);
      if (points.has_boxes())
        return on_boxes.take_with_changes(
          block, grid.nodes, slot, field.value, field.change);
      at_corners.take_at_corners(block, grid.nodes, slot, field.at_corners);
      at_corners.combine(field.at_corners, field.value, field.change);
    }

    /**
     * P2G: add N_i times @p given and, to the forces, the changes of N_i times
     * @p along.
     */
    template <class Window>
    void
    give_with_changes(const std::array<Number, Window::width> &given,
                      const std::array<Vector, dim>           &along) const
    {
      if (rarely(!fits))
        return give_one_by_one<Window>(given, &along);
      points.has_boxes() ? on_boxes.template give_with_changes<Window>(
                             block, grid.nodes, given, along) :
                           at_corners.template give_with_changes<Window>(
                             block, grid.nodes, given, along);
    }

    /** Whether moved_corners() is available: hexahedra, all in a block. */
    bool
    has_corners() const
    {
      return points.domain_form == DomainForm::hexahedron && fits;
    }

    /**
     * Corners of the hexahedra relative to their points (m), after moving for
     * @p step (s) with the velocity @p field there.
     */
    std::array<Vector, n_corners>
    moved_corners(const FieldOnPack<dim> &field, const double step) const
    {
      std::array<Vector, n_corners> result;
      for (int c = 0; c < n_corners; ++c)
        for (int d = 0; d < dim; ++d)
          result[c][d] =
            offsets[c][d] / inverse_edge[d] + step * field.at_corners[c][d];
      return result;
    }

  private:
    const MeanFunctions<dim> &
    functions() const
    {
      if (points.has_boxes())
        return on_boxes;
      return at_corners;
    }

    /** CPDI domains; false if one does not fit into a block. */
    template <class Lanes>
    __attribute__((always_inline)) bool
    set_edges(const Vector &xi, const Lanes &lanes)
    {
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
              edges[d][k] =
                lanes.load(points.domain[d * dim + k]) * inverse_edge[d];
              half[d] += magnitude(edges[d][k]);
            }
          fitted &= half[d] <= 0.5;
          box *= half[d];
        }
      if (rarely(!all(fitted & (determinant<dim>(edges) > box))) ||
          !block.find(grid, cell, xi, half))
        return false;
      at_corners.set(block, xi, edges);
      return true;
    }

    /** CPDI2 domains; not inlined, being less frequent. */
    template <class Lanes>
    __attribute__((noinline)) bool
    set_hexahedra(const Vector &xi, const Lanes &lanes)
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
      if (rarely(!all(fitted)) || !block.find(grid, cell, xi, half))
        return false;
      edges   = shape.edges;
      offsets = shape.offsets;
      at_corners.set(block, xi, shape);
      return true;
    }

    /** Boxes along the axes. */
    template <class Lanes>
    __attribute__((always_inline)) bool
    set_boxes(const Vector &xi, const Lanes &lanes)
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
          half[d] = smaller(half[d], broadcast<Number>(largest_half_box));
#pragma GCC unroll 3
          for (int k = 0; k < dim; ++k)
            edges[d][k] = k == d ? half[d] : Number{};
        }
      if (!block.find(grid, cell, xi, half))
        return false;
      on_boxes.set(block, xi, half);
      return true;
    }

    // Point by point: rare, and out of line.

    ConvectedDomain<dim>
    domain_of(const int p) const
    {
      return ConvectedDomain<dim>(points, grid, cell, first + p);
    }

    __attribute__((noinline, cold)) Matrix
    inverse_one_by_one() const
    {
      Matrix result;
      for (int p = 0; p < n_points; ++p)
        {
          const auto one =
            DomainShape<dim>(points, grid, cell, first + (p < n ? p : 0))
              .inverse();
          for (int k = 0; k < dim; ++k)
            for (int d = 0; d < dim; ++d)
              result[k][d][p] = one[k][d];
        }
      return result;
    }

    template <int n_slots>
    __attribute__((noinline, cold)) std::array<Number, n_slots>
    take_one_by_one(const unsigned int slot) const
    {
      std::array<Number, n_slots> result;
      set_zero(result);
      for (int p = 0; p < n; ++p)
        domain_of(p).for_nodes(
          grid, [&](const auto &piece, const int i, const double *const node) {
            for (int s = 0; s < n_slots; ++s)
              result[s][p] += piece.weight[i] * node[slot + s];
          });
      return result;
    }

    __attribute__((noinline, cold)) void
    take_field_one_by_one(const unsigned int slot,
                          FieldOnPack<dim>  &field) const
    {
      set_zero(field.value);
      set_zero(field.change);
      for (int p = 0; p < n; ++p)
        domain_of(p).for_nodes(
          grid, [&](const auto &piece, const int i, const double *const node) {
            for (int d = 0; d < dim; ++d)
              {
                field.value[d][p] += piece.weight[i] * node[slot + d];
                for (int k = 0; k < dim; ++k)
                  field.change[k][d][p] += piece.along[k][i] * node[slot + d];
              }
          });
    }

    template <class Window>
    __attribute__((noinline, cold)) void
    give_one_by_one(const std::array<Number, Window::width> &given,
                    const std::array<Vector, dim> *const     along) const
    {
      using Layout = NodeLayout<dim>;
      for (int p = 0; p < n; ++p)
        domain_of(p).for_nodes(
          grid, [&](const auto &piece, const int i, double *const node) {
            for (unsigned int s = 0; s < Window::width; ++s)
              node[Window::start + s] += piece.weight[i] * given[s][p];
            for (int k = 0; along != nullptr && k < dim; ++k)
              for (int d = 0; d < dim; ++d)
                node[Layout::force + d] +=
                  piece.along[k][i] * (*along)[k][d][p];
          });
    }

    const std::size_t first;
    const int         n;
    bool              fits; // whether every domain is in one block

    Matrix               edges; // restricted R, in cells, where they fit
    BlockNodes<dim>      block;
    BoxFunctions<dim>    on_boxes;         // GIMP, or ...
    CornerFunctions<dim> at_corners;       // ... CPDI, CPDI2
    std::array<Vector, n_corners> offsets; // of corners of hexahedra, in cells
  };
} // namespace limber

#endif
