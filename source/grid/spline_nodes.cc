// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/spline_nodes.h>

#include <algorithm>
#include <map>

namespace limber
{
  namespace
  {
    /** 3^d: index distance of neighbouring nodes of a cell along d. */
    constexpr int
    stride(const int d)
    {
      return d == 0 ? 1 : 3 * stride(d - 1);
    }



    /** Digit (base 3) of node i of a cell, or of a place in it, along d. */
    constexpr int
    digit(const int i, const int d)
    {
      return i / stride(d) % 3;
    }



    /** Whether the cell ends at the lower (0) or upper (2) side along d. */
    template <int dim>
    bool
    ends_at(const BackgroundGrid<dim> &grid,
            const std::uint32_t        cell,
            const int                  d,
            const int                  end)
    {
      const CellGeometry<dim> &geometry = grid.geometry[cell];
      const double             edge     = 1 / geometry.inverse_edge[d];
      return end == 0 ?
               geometry.origin[d] - grid.description.lower[d] < 0.5 * edge :
               grid.description.upper[d] - geometry.origin[d] < 1.5 * edge;
    }



    /**
     * Numbers the nodes. A node is identified by a cell and its place in the
     * cell: the middle or, at sides of the grid, a face, an edge or a corner.
     * The place has digits 0, 1, 2 in base three, one per direction: lower
     * side, middle, upper side.
     */
    template <int dim>
    class Numbers
    {
    public:
      explicit Numbers(const BackgroundGrid<dim> &grid)
        : grid(grid)
        , node_of_cell(grid.n_cells())
      {
        add_cells(0, grid.n_owned_cells());
        nodes.n_owned      = n_numbers;
        nodes.inward_share = 1;
        add_cells(grid.n_owned_cells(), grid.n_cells());
        nodes.sides.assign(n_numbers, 0);
        for (const auto &[key, node] : in_sides)
          find_side(key.first, key.second, node);
        share();
      }

      std::vector<SplineCell<dim, 2>>
      cells() const
      {
        std::vector<SplineCell<dim, 2>> result(grid.n_cells());
        for (std::uint32_t cell = 0; cell < result.size(); ++cell)
          {
            SplineCell<dim, 2> &spline = result[cell];
            for (int d = 0; d < dim; ++d)
              {
                spline.lower[d] = ends_at(grid, cell, d, 0) ? 1 : 0.5;
                spline.upper[d] = ends_at(grid, cell, d, 2) ? 1 : 0.5;
              }
            for (int i = 0; i < n_places; ++i)
              {
                const std::uint32_t node = node_at(cell, i);
                spline.node[i]           = node == unknown_node ?
                                             unknown_node :
                                             node * NodeLayout<dim>::stride;
              }
          }
        return result;
      }

      NodeTable<dim> nodes;

    private:
      using Key = std::pair<std::uint32_t, int>; // cell, place

      static constexpr int n_places = stride(dim);
      static constexpr int middle   = n_places / 2;

      void
      add_cells(const std::uint32_t begin, const std::uint32_t end)
      {
        for (std::uint32_t cell = begin; cell < end; ++cell)
          node_of_cell[cell] = n_numbers++;
        for (std::uint32_t cell = begin; cell < end; ++cell)
          for (const int place : places_in_sides(cell))
            in_sides[{cell, place}] = n_numbers++;
      }

      std::vector<int>
      places_in_sides(const std::uint32_t cell) const
      {
        std::vector<int> result;
        for (int place = 0; place < n_places; ++place)
          {
            bool exists = place != middle;
            for (int d = 0; d < dim; ++d)
              if (const int end = digit(place, d); end != 1)
                exists = exists && ends_at(grid, cell, d, end);
            if (exists)
              result.push_back(place);
          }
        return result;
      }

      /**
       * Node i of a cell: that of a neighbour, or one in a side of the grid.
       */
      std::uint32_t
      node_at(const std::uint32_t cell, const int i) const
      {
        const CellGeometry<dim> &geometry = grid.geometry[cell];
        std::array<double, dim>  x; // the middle of the neighbour
        int                      place = middle;
        for (int d = 0; d < dim; ++d)
          {
            const int end  = digit(i, d);
            double    step = end - 1;
            if (end != 1 && ends_at(grid, cell, d, end))
              {
                place += (end - 1) * stride(d);
                step = 0;
              }
            x[d] = geometry.origin[d] + (0.5 + step) / geometry.inverse_edge[d];
          }
        const std::uint32_t neighbour = grid.bins.cell_at(x);
        if (neighbour == invalid_cell)
          return unknown_node;
        return place == middle ? node_of_cell[neighbour] :
                                 in_sides.at({neighbour, place});
      }

      void
      find_side(const std::uint32_t cell,
                const int           place,
                const std::uint32_t node)
      {
        const CellGeometry<dim> &geometry = grid.geometry[cell];
        dealii::Point<dim>      &x        = nodes.places[node];
        for (int d = 0; d < dim; ++d)
          {
            const int end = digit(place, d);
            x[d] =
              end == 0 ? grid.description.lower[d] :
              end == 2 ? grid.description.upper[d] :
                         geometry.origin[d] + 0.5 / geometry.inverse_edge[d];
            if (end != 1)
              nodes.sides[node] |= 1 << (2 * d + end / 2);
          }
        for (int directions = 0; directions < 1 << dim; ++directions)
          {
            int reached = place;
            for (int d = 0; d < dim; ++d)
              if (directions >> d & 1)
                reached += (1 - digit(place, d)) * stride(d);
            nodes.inward[node][directions] = reached == middle ?
                                               node_of_cell[cell] :
                                               in_sides.at({cell, reached});
          }
      }

      // Ranks that share a cell share its nodes, listed in the same order.
      void
      share()
      {
        nodes.shared.communicator = grid.shared_cells.communicator;
        for (const auto &neighbour : grid.shared_cells.neighbours)
          {
            SharedRecords::Neighbour of_nodes;
            of_nodes.rank = neighbour.rank;
            for (const std::uint32_t cell : neighbour.records)
              {
                of_nodes.records.push_back(node_of_cell[cell]);
                for (const int place : places_in_sides(cell))
                  of_nodes.records.push_back(in_sides.at({cell, place}));
              }
            nodes.shared.neighbours.push_back(std::move(of_nodes));
          }
      }

      const BackgroundGrid<dim>   &grid;
      std::vector<std::uint32_t>   node_of_cell;
      std::map<Key, std::uint32_t> in_sides;
      std::uint32_t                n_numbers = 0;
    };
  } // namespace



  template <int dim>
  QuadraticNodes<dim>
  number_quadratic_nodes(const BackgroundGrid<dim> &grid)
  {
    Numbers<dim> numbers(grid);
    auto         cells = numbers.cells();
    return {std::move(numbers.nodes), std::move(cells)};
  }



  // Nodes other than vertices of the cell are vertices of a neighbour.
  template <int dim>
  std::vector<SplineCell<dim, 3>>
  find_cubic_cells(const BackgroundGrid<dim> &grid)
  {
    std::vector<SplineCell<dim, 3>> result(grid.n_cells());
    for (std::uint32_t cell = 0; cell < result.size(); ++cell)
      {
        const CellGeometry<dim> &geometry = grid.geometry[cell];
        SplineCell<dim, 3>      &spline   = result[cell];
        for (int d = 0; d < dim; ++d)
          {
            spline.lower[d] = ends_at(grid, cell, d, 0) ? 0 : 1. / 6;
            spline.upper[d] = ends_at(grid, cell, d, 2) ? 0 : 1. / 6;
          }
        for (int i = 0; i < int(spline.node.size()); ++i)
          {
            std::array<double, dim> x; // in the middle of the neighbour
            int                     vertex = 0;
            for (int d = 0, rest = i; d < dim; ++d, rest /= 4)
              {
                const int    at    = rest % 4;
                const double steps = at == 0 && spline.lower[d] != 0 ? -0.5 :
                                     at == 3 && spline.upper[d] != 0 ? 1.5 :
                                                                       0.5;
                x[d] = geometry.origin[d] + steps / geometry.inverse_edge[d];
                vertex |= (at < 2 ? 0 : 1) << d;
              }
            const std::uint32_t neighbour = grid.bins.cell_at(x);
            spline.node[i]                = neighbour == invalid_cell ?
                                              unknown_node :
                                              grid.geometry[neighbour].node[vertex];
          }
      }
    return result;
  }



  template <int dim>
  void
  set_inward_vertices(const BackgroundGrid<dim> &grid, NodeTable<dim> &vertices)
  {
    // The mass of a node in a held side is 7/12 of that of an inner one; 1/12
    // is what mirrored material would contribute to the inward node, per
    // direction.
    vertices.inward_share = 1. / 7;
    vertices.inward.clear();
    const auto number = [](const std::uint32_t offset) {
      return offset / NodeLayout<dim>::stride;
    };
    for (std::uint32_t cell = 0; cell < grid.n_cells(); ++cell)
      for (int i = 0; i < 1 << dim; ++i)
        {
          const auto         &corners = grid.geometry[cell].node;
          const std::uint32_t node    = number(corners[i]);
          if (vertices.sides[node] == 0)
            continue;
          int across = 0; // directions in which it is in a side
          for (int d = 0; d < dim; ++d)
            if (ends_at(grid, cell, d, i >> d & 1 ? 2 : 0))
              across |= 1 << d;
          for (int directions = 0; directions < 1 << dim; ++directions)
            vertices.inward[node][directions] =
              number(corners[i ^ (directions & across)]);
        }
  }



  template QuadraticNodes<2>
  number_quadratic_nodes(const BackgroundGrid<2> &);
  template QuadraticNodes<3>
  number_quadratic_nodes(const BackgroundGrid<3> &);
  template std::vector<SplineCell<2, 3>>
  find_cubic_cells(const BackgroundGrid<2> &);
  template std::vector<SplineCell<3, 3>>
  find_cubic_cells(const BackgroundGrid<3> &);
  template void
  set_inward_vertices(const BackgroundGrid<2> &, NodeTable<2> &);
  template void
  set_inward_vertices(const BackgroundGrid<3> &, NodeTable<3> &);
} // namespace limber
