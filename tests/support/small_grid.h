// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_tests_support_small_grid_h
#define limber_tests_support_small_grid_h

#include <limber/interpolation/basis.h>
#include <limber/materials/kernel.h>
#include <limber/points/point_view.h>
#include <limber/transfer/grid_to_points.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

/**
 * @file A structured grid and points made by hand, without deal.II: what the
 * sweeps are tested on. The direct formulas of the shape functions stand here
 * as well, written as in a textbook, to be compared with the sweeps.
 */
namespace limber
{
  namespace testing_support
  {
    template <int dim>
    using Vector = std::array<double, dim>;

    template <int dim>
    using Matrix = std::array<std::array<double, dim>, dim>;



    /** Random numbers that are the same in every run. */
    class Random
    {
    public:
      explicit Random(const unsigned int seed = 1)
        : engine(seed)
      {}

      double
      operator()(const double lower = -1, const double upper = 1)
      {
        return lower + (upper - lower) * (engine() * 0x1p-32);
      }

      /** One of 0, ..., n - 1. */
      std::size_t
      below(const std::size_t n)
      {
        return std::size_t(engine()) * n >> 32;
      }

      template <int dim>
      Vector<dim>
      vector()
      {
        Vector<dim> result;
        for (double &x : result)
          x = (*this)();
        return result;
      }

      template <int dim>
      Matrix<dim>
      matrix(const double size = 1)
      {
        Matrix<dim> result;
        for (auto &row : result)
          for (double &x : row)
            x = size * (*this)();
        return result;
      }

      /** Used where an order is shuffled. */
      std::mt19937 engine;
    };



    template <int dim, KernelKind kernel>
    using BasisOf = std::conditional_t<
      kernel == KernelKind::quadratic,
      Quadratic<dim>,
      std::conditional_t<kernel == KernelKind::cubic, Cubic<dim>, Linear<dim>>>;



    /** Edges that differ in every direction show what is scaled by which. */
    template <int dim, KernelKind kernel = KernelKind::linear>
    class SmallGrid
    {
    public:
      using Basis = BasisOf<dim, kernel>;
      // Of splines, 0 of linear functions
      static constexpr int degree = kernel == KernelKind::quadratic ? 2 :
                                    kernel == KernelKind::cubic     ? 3 :
                                                                      0;
      using Spline                = SplineCell<dim, degree == 0 ? 2 : degree>;
      // of the cell with all that does not vanish in it
      static constexpr int n_in_cell = Basis::n_nodes;

      explicit SmallGrid(const std::int64_t n_per_edge = 5)
      {
        const Vector<3> lowers{{-0.3, 0.2, 1.1}}, edges{{0.5, 0.25, 0.4}};
        n_cells = n_nodes = n_vertices = 1;
        for (int d = 0; d < dim; ++d)
          {
            lower[d]             = lowers[d];
            edge[d]              = edges[d];
            bins.lower[d]        = lower[d];
            bins.inverse_edge[d] = 1 / edge[d];
            bins.n[d]            = n_per_edge;
            n_cells *= n_per_edge;
            n_vertices *= n_per_edge + 1;
            n_nodes *= n_per_edge + (degree == 2 ? 2 : 1);
          }
        for (std::size_t c = 0; c < n_cells; ++c)
          {
            CellGeometry<dim>             cell;
            std::array<std::int64_t, dim> at;
            for (int d = 0, rest = c; d < dim; ++d, rest /= n_per_edge)
              {
                at[d]                = rest % n_per_edge;
                cell.origin[d]       = lower[d] + edge[d] * at[d];
                cell.inverse_edge[d] = 1 / edge[d];
              }
            for (int i = 0; i < 1 << dim; ++i)
              {
                std::int64_t node = 0;
                for (int d = dim - 1; d >= 0; --d)
                  node = node * (n_per_edge + 1) + at[d] + (i >> d & 1);
                cell.node[i] = node * NodeLayout<dim>::stride;
              }
            cells.push_back(cell);
            bin_table.push_back(c);
            if constexpr (degree > 0)
              {
                Spline spline;
                for (int i = 0; i < n_in_cell; ++i)
                  {
                    std::int64_t node = 0;
                    for (int d = dim - 1; d >= 0; --d)
                      if (const auto k = at[d] + Basis::power(i, d);
                          degree == 2)
                        node = node * (n_per_edge + 2) + k;
                      else // none beyond the sides
                        node = node * (n_per_edge + 1) +
                               std::clamp<std::int64_t>(k - 1, 0, n_per_edge);
                    spline.node[i] = node * NodeLayout<dim>::stride;
                  }
                for (int d = 0; d < dim; ++d)
                  {
                    constexpr double inside  = inner_factor();
                    constexpr double at_side = degree == 2 ? 1 : 0;
                    spline.lower[d]          = at[d] == 0 ? at_side : inside;
                    spline.upper[d] =
                      at[d] == n_per_edge - 1 ? at_side : inside;
                  }
                splines.push_back(spline);
              }
          }
        bins.table        = bin_table.data();
        bins.one_per_cell = true;
        bin_nodes         = nodes_of_bins(bins, cells);
        bins.nodes        = bin_nodes.data();
        nodes.resize(n_nodes * NodeLayout<dim>::stride);
        occupied.resize(n_cells);
        means.resize(n_vertices * NodalMeanLayout::stride);
        sums.resize(n_cells * n_in_cell);
        next_sums.resize(sums.size());
        turn_of_sums.resize(n_cells, turn);
      }

      GridView<dim>
      view()
      {
        GridView<dim> result;
        result.cells = cells.data();
        result.nodes = nodes.data();
        result.bins  = bins;
        if constexpr (degree == 2)
          result.quadratics = splines.data();
        if constexpr (degree == 3)
          result.cubics = splines.data();
        result.occupied = occupied.data();
        result.entered  = &entered;
        result.left     = &left;
        return result;
      }

      CellSums<dim>
      cell_sums()
      {
        CellSums<dim> result;
        result.now     = sums.data();
        result.next    = next_sums.data();
        result.turn_of = turn_of_sums.data();
        result.turn    = turn + 1;
        result.stride  = n_in_cell;
        return result;
      }

      /** The records of a projection on nodes; sum(records) adds to them. */
      template <class Sum>
      const double *
      nodal_means(const Sum &sum)
      {
        std::fill(means.begin(), means.end(), 0.);
        sum(means.data());
        for (std::size_t n = 0; n < n_vertices; ++n)
          {
            double *const record = &means[n * NodalMeanLayout::stride];
            if (record[NodalMeanLayout::mass] > 0)
              record[NodalMeanLayout::value] /= record[NodalMeanLayout::mass];
          }
        return means.data();
      }

      /** Make the sums of the present places those of these points. */
      void
      gather(const PointView<dim> &points)
      {
        std::fill(turn_of_sums.begin(), turn_of_sums.end(), turn);
        // what no point comes to overwrite
        std::fill(next_sums.begin(), next_sums.end(), 0.);
        gather_cell_sums<dim>(points, view(), cell_sums());
        sums = next_sums;
        // what points have to overwrite
        std::fill(next_sums.begin(), next_sums.end(), 1e30);
        std::fill(turn_of_sums.begin(), turn_of_sums.end(), turn);
      }

      Vector<dim>
      place(const std::size_t node) const
      {
        Vector<dim> result;
        std::size_t rest = node;
        for (int d = 0; d < dim; ++d)
          {
            const std::int64_t n     = bins.n[d] + (degree == 2 ? 2 : 1);
            const std::int64_t index = rest % n;
            rest /= n;
            double at = index;
            if (degree == 2) // in the sides and at the centres of cells
              at = index == 0 ? 0 : (index == n - 1 ? bins.n[d] : index - 0.5);
            result[d] = lower[d] + edge[d] * at;
          }
        return result;
      }

      /** The offsets of the nodes of a cell. */
      const auto &
      nodes_of(const std::uint32_t cell) const
      {
        if constexpr (degree > 0)
          return splines[cell];
        else
          return cells[cell];
      }

      /** Of the first and the last spline of a cell away from sides. */
      static constexpr double
      inner_factor()
      {
        return degree == 2 ? 1. / 2 : 1. / 6;
      }

      std::size_t
      node_number(const std::uint32_t cell, const int i) const
      {
        return nodes_of(cell).node[i] / NodeLayout<dim>::stride;
      }

      /** N_i at a place, of node i of a cell. */
      double
      shape(const std::uint32_t cell, const int i, const Vector<dim> &x) const
      {
        double result = 1;
        for (int d = 0; d < dim; ++d)
          result *= factor(cell, i, x, d);
        return result;
      }

      /** grad N_i at a place. */
      Vector<dim>
      gradient(const std::uint32_t cell,
               const int           i,
               const Vector<dim>  &x) const
      {
        Vector<dim> result;
        for (int d = 0; d < dim; ++d)
          {
            result[d] = factor(cell, i, x, d, true);
            for (int e = 0; e < dim; ++e)
              if (e != d)
                result[d] *= factor(cell, i, x, e);
          }
        return result;
      }

      void
      clear()
      {
        std::fill(nodes.begin(), nodes.end(), 0.);
      }

      std::size_t                    n_cells, n_nodes, n_vertices;
      Vector<dim>                    lower, edge;
      std::vector<CellGeometry<dim>> cells;
      std::vector<Spline>            splines;
      std::vector<double>            nodes, means, sums, next_sums;
      std::vector<std::uint32_t>     turn_of_sums;
      std::uint32_t                  turn = 1; // of the present sums
      std::vector<std::uint32_t>     bin_table, bin_nodes, entered;
      std::vector<std::uint8_t>      occupied;
      BinView<dim>                   bins;
      bool                           left = false;

    private:
      double
      factor(const std::uint32_t cell,
             const int           i,
             const Vector<dim>  &x,
             const int           d,
             const bool          derivative = false) const
      {
        if constexpr (degree > 0)
          {
            const int at =
              std::lround((cells[cell].origin[d] - lower[d]) / edge[d]);
            const int  k     = at + Basis::power(i, d);
            const auto plain = [&](const int number) {
              return spline(number, degree, x[d], d, derivative);
            };
            if constexpr (degree == 2)
              return plain(k);
            // That of the node beyond a side acts on the two next to it, which
            // give it the value of linear extrapolation.
            const int last = bins.n[d] + 2;
            if (k == 0 || k == last)
              return 0;
            return plain(k) +
                   (k == 1 ? 2 * plain(0) :
                    k == 2 ? -plain(0) :
                             0) +
                   (k == last - 1 ? 2 * plain(last) :
                    k == last - 2 ? -plain(last) :
                                    0);
          }
        else
          {
            const double xi = (x[d] - cells[cell].origin[d]) / edge[d];
            if (derivative)
              return ((i >> d & 1) ? 1 : -1) / edge[d];
            return (i >> d & 1) ? xi : 1 - xi;
          }
      }

      /**
       * B-splines by the recursion of Cox and de Boor on the faces of the
       * cells. Of quadratic ones the first and the last are threefold knots; of
       * cubic ones the grid goes on.
       */
      double
      spline(const int    i,
             const int    order,
             const double x,
             const int    d,
             const bool   derivative) const
      {
        const auto knot = [&](const std::int64_t k) {
          return lower[d] +
                 edge[d] * (degree == 2 ?
                              std::clamp<std::int64_t>(k - 2, 0, bins.n[d]) :
                              k - 3);
        };
        if (order == 0)
          return knot(i) <= x && x < knot(i + 1) ? 1 : 0;
        double     result = 0;
        const auto add =
          [&](const int first, const double numerator, const double sign) {
            const double width = knot(first + order) - knot(first);
            if (width > 0)
              result += (derivative ? sign * order : numerator) / width *
                        spline(first, order - 1, x, d, false);
          };
        add(i, x - knot(i), 1);
        add(i + 1, knot(i + 1 + order) - x, -1);
        return result;
      }
    };



    /** Arrays of points with the room behind them that the sweeps demand. */
    template <int dim>
    class SmallPoints
    {
    public:
      static constexpr std::size_t room = 1 << dim;

      SmallPoints(const std::size_t  n,
                  const bool         deviator,
                  const unsigned int n_history,
                  const int          volumetric,
                  const bool         affine = true)
        : size(n)
        , n_history(n_history)
        , volumetric(volumetric)
        , has_deviator(deviator)
        , has_affine(affine)
        , fields(2 * dim + 2 + n_deviator<dim> + n_history + dim * dim,
                 std::vector<double>(n + room))
        , cell(n + room, invalid_cell)
      {}

      PointView<dim>
      view()
      {
        PointView<dim> result;
        unsigned int   k    = 0;
        const auto     next = [&]() { return fields[k++].data(); };
        result.size         = size;
        for (auto &array : result.position)
          array = next();
        for (auto &array : result.velocity)
          array = next();
        result.mass     = next();
        result.pressure = next();
        if (has_deviator)
          for (auto &array : result.deviator)
            array = next();
        for (unsigned int i = 0; i < n_history; ++i)
          result.history[i] = next();
        if (has_affine)
          for (auto &array : result.affine)
            array = next();
        result.volumetric =
          volumetric < 0 ? result.pressure : result.history[volumetric];
        result.place = result.position;
        result.cell  = cell.data();
        return result;
      }

      Vector<dim>
      position(const std::size_t p) const
      {
        Vector<dim> result;
        for (int d = 0; d < dim; ++d)
          result[d] = fields[d][p];
        return result;
      }

      const std::size_t                size;
      const unsigned int               n_history;
      const int                        volumetric;
      const bool                       has_deviator, has_affine;
      std::vector<std::vector<double>> fields;
      std::vector<std::uint32_t>       cell;
    };



    /** The whole stress of a point times J, pressure and zz included. */
    template <int dim>
    Matrix<3>
    kirchhoff_stress(const PointView<dim> &points, const std::size_t p)
    {
      Matrix<3> t{};
      if (points.deviator[0] != nullptr)
        {
          t[0][0] = points.deviator[0][p];
          t[1][1] = points.deviator[1][p];
          t[2][2] = -t[0][0] - t[1][1];
          t[0][1] = t[1][0] = points.deviator[2][p];
          if constexpr (dim == 3)
            {
              t[1][2] = t[2][1] = points.deviator[3][p];
              t[2][0] = t[0][2] = points.deviator[4][p];
            }
        }
      for (int d = 0; d < 3; ++d)
        t[d][d] -= points.pressure[p];
      return t;
    }



    /**
     * Random points in random cells: some cells empty, some holding one
     * point, some more than two packs; stragglers that are stored away from
     * the other points of their cell; on request in no order at all.
     */
    template <int dim, KernelKind kernel>
    SmallPoints<dim>
    random_points(const SmallGrid<dim, kernel> &grid,
                  Random                       &random,
                  const bool                    deviator   = true,
                  const unsigned int            n_history  = 0,
                  const int                     volumetric = -1,
                  const bool                    shuffled   = false)
    {
      std::vector<std::uint32_t> owner;
      for (std::uint32_t c = 0; c < grid.n_cells; ++c)
        {
          const std::size_t kind = random.below(4);
          const std::size_t n    = kind == 0 ? 0 :
                                   kind == 1 ? 1 :
                                   kind == 2 ? (1 << dim) :
                                               random.below(5 << dim);
          owner.insert(owner.end(), n, c);
        }
      const auto swap_some = [&](const std::size_t n) {
        for (std::size_t k = 0; k < n; ++k)
          std::swap(owner[random.below(owner.size())],
                    owner[random.below(owner.size())]);
      };
      swap_some(shuffled ? 2 * owner.size() : owner.size() / 10);

      SmallPoints<dim> points(owner.size(), deviator, n_history, volumetric);
      std::copy(owner.begin(), owner.end(), points.cell.begin());
      for (std::size_t p = 0; p < points.size; ++p)
        {
          for (auto &field : points.fields)
            field[p] = random();
          for (int d = 0; d < dim; ++d)
            points.fields[d][p] =
              grid.cells[owner[p]].origin[d] + grid.edge[d] * random(0, 1);
          points.view().mass[p] = random(0.5, 2);
        }
      return points;
    }
  } // namespace testing_support
} // namespace limber

#endif
