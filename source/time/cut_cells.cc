// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/quadrature_lib.h>

#include <limber/interpolation/linear.h>
#include <limber/time/cut_cells.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  namespace
  {
    // Pieces of surface in a cell are one where their normals are within some 6
    // degrees.
    constexpr double least_cosine = 0.995;

    // Parts of a cell along an edge, and what of a part is nothing
    template <int dim>
    constexpr unsigned int n_parts = dim == 2 ? 4 : 2;
    constexpr double       nothing = 1e-3;

    /** The corners of the simplices of the unit cube: along each of the ways
     * from its first corner to its last. Seen across a face they meet. */
    template <int dim>
    std::vector<std::array<unsigned int, dim + 1>>
    simplices_of_cube()
    {
      std::array<unsigned int, dim> order;
      for (unsigned int d = 0; d < dim; ++d)
        order[d] = d;
      std::vector<std::array<unsigned int, dim + 1>> result;
      do
        {
          std::array<unsigned int, dim + 1> corners{};
          for (unsigned int d = 0; d < dim; ++d)
            corners[d + 1] = corners[d] | 1u << order[d];
          result.push_back(corners);
        }
      while (std::next_permutation(order.begin(), order.end()));
      return result;
    }



    template <int dim>
    double
    monomial(const unsigned int k, const dealii::Point<dim> &xi)
    {
      double result = 1;
      for (unsigned int d = 0; d < dim; ++d)
        if (k >> d & 1)
          result *= xi[d];
      return result;
    }



    template <int dim>
    double
    function_of_corner(const unsigned int a, const dealii::Point<dim> &xi)
    {
      double result = 1;
      for (unsigned int d = 0; d < dim; ++d)
        result *= a >> d & 1 ? xi[d] : 1 - xi[d];
      return result;
    }



    double
    factorial(const int n)
    {
      return n < 2 ? 1 : n * factorial(n - 1);
    }
  } // namespace



  template <int dim>
  bool
  CutCells<dim>::may_be(const RunParts<dim> &parts)
  {
    return !parts.problem.obstacles.empty() &&
           parts.problem.grid.kernel == KernelKind::linear &&
           std::any_of(parts.bodies.begin(),
                       parts.bodies.end(),
                       [](const auto &body) {
                         return body->description.is_liquid &&
                                body->stress->treatment().kind ==
                                  Treatment::cell;
                       });
  }



  template <int dim>
  CutCells<dim>::CutCells(const RunParts<dim> &parts)
    : parts(parts)
    , knowing(n_nodal_fields(parts.problem), false)
    , moves(std::any_of(parts.problem.obstacles.begin(),
                        parts.problem.obstacles.end(),
                        [](const auto &obstacle) { return obstacle.moves(); }))
  {
    for (const auto &body : parts.bodies)
      if (body->description.is_liquid)
        knowing[body->description.nodal_field] = true;
    for (const auto &body : parts.bodies)
      if (body->description.is_liquid &&
          body->stress->treatment().kind != Treatment::cell)
        knowing[body->description.nodal_field] = false;
    reinit(0);
  }



  template <int dim>
  void
  CutCells<dim>::reinit(const double time)
  {
    distance.clear();
    at_cut.reinit(parts.grid.vertices.n());
    at_covered.reinit(parts.grid.vertices.n());
    former.clear();
    Places places;
    for (const Obstacle<dim> &obstacle : parts.problem.obstacles)
      places.emplace_back(obstacle, time);
    find_cells(places);
  }



  template <int dim>
  void
  CutCells<dim>::find(const double time)
  {
    std::fill(wet.begin(), wet.end(), 0);
    if (!moves)
      return;
    Places places;
    for (const Obstacle<dim> &obstacle : parts.problem.obstacles)
      places.emplace_back(obstacle, time);
    find_cells(places);
  }



  // Of what is furthest out, as obstacles are rigid.
  template <int dim>
  double
  CutCells<dim>::way_since_found(const Places &places) const
  {
    double result = 0;
    for (std::size_t o = 0; o < former.size(); ++o)
      for (unsigned int corner = 0; corner < n_nodes; ++corner)
        {
          dealii::Point<dim> x;
          for (unsigned int d = 0; d < dim; ++d)
            x[d] = corner >> d & 1 ? parts.problem.grid.upper[d] :
                                     parts.problem.grid.lower[d];
          result =
            std::max(result,
                     places[o].place_of(former[o].start_of(x)).distance(x));
        }
    return result;
  }



  template <int dim>
  void
  CutCells<dim>::find_cells(const Places &places)
  {
    const std::uint32_t n = parts.grid.n_cells();
    if (former.empty())
      distance.assign(n, 0);
    else if (const double way = way_since_found(places); way > 0)
      for (double &of_cell : distance)
        of_cell -= of_cell > 0 ? std::min(2 * way, of_cell) :
                                 std::max(-2 * way, of_cell);
    former = places;
    cells.clear();
    kinds.assign(n, open);
    for (std::uint32_t cell = 0; cell < n; ++cell)
      look_at(cell, places);
    for (Cell &cell : cells)
      find_surfaces(cell, places);
    wet.assign(cells.size() * knowing.size(), 0);

    const NodeTable<dim> &table = parts.grid.vertices;
    std::fill_n(at_cut.data(), table.n(), 0.);
    for (const Cell &cell : cells)
      if (cell.number < parts.grid.n_owned_cells() && cell.is_cut())
        for (const std::uint32_t offset : parts.grid.geometry[cell.number].node)
          at_cut[offset / NodeLayout<dim>::stride] = 1;
    std::fill_n(at_covered.data(), table.n(), 0.);
    for (std::uint32_t cell = 0; cell < parts.grid.n_owned_cells(); ++cell)
      if (is_covered(cell))
        for (unsigned int a = 0; a < n_nodes; ++a)
          at_covered[parts.grid.geometry[cell].node[a] /
                     NodeLayout<dim>::stride] += 1u << a;
    const ExchangePlan all(table.shared);
    for (LazyArray<double> *const of_nodes : {&at_cut, &at_covered})
      {
        exchange.start(all, of_nodes->data(), 0, 1);
        exchange.finish(of_nodes->data());
      }
  }



  // Where the middle is further off than the corners are from it, nothing runs
  // across; twice as far, as the distance from a formula is of first order.
  template <int dim>
  void
  CutCells<dim>::look_at(const std::uint32_t number, const Places &places)
  {
    const CellGeometry<dim> &geometry = parts.grid.geometry[number];
    const auto               place_at = [&](const dealii::Point<dim> &xi) {
      dealii::Point<dim> x;
      for (unsigned int d = 0; d < dim; ++d)
        x[d] = geometry.origin[d] + xi[d] / geometry.inverse_edge[d];
      return x;
    };
    const auto least = [&](const dealii::Point<dim> &x) {
      double result = 1e300;
      for (const ObstaclePlace<dim> &place : places)
        result = std::min(result, place.distance(x).value);
      return result;
    };
    double diagonal = 0; // m
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double edge = 1 / geometry.inverse_edge[d];
        diagonal += edge * edge;
      }
    diagonal        = std::sqrt(diagonal);
    double &of_cell = distance[number];
    if (std::abs(of_cell) <= diagonal)
      {
        dealii::Point<dim> middle;
        for (unsigned int d = 0; d < dim; ++d)
          middle[d] = 0.5;
        of_cell = least(place_at(middle));
      }
    if (std::abs(of_cell) > diagonal)
      {
        kinds[number] = of_cell < 0 ? covered : open;
        return;
      }

    Cell cell;
    cell.number = number;
    cell.open   = 0;
    for_each_open_simplex(number, places, [&](const Simplex &simplex) {
      add_volume(simplex, cell);
    });
    if (cell.open < least_open)
      {
        kinds[number] = cell.open > 0 ? closed : covered;
        return;
      }
    for (double &mean : cell.monomials)
      mean /= cell.open;
    if (cell.open > 1 - 1e-12)
      cell.open = 1;
    kinds[number] = first_cut + static_cast<std::uint32_t>(cells.size());
    cells.push_back(std::move(cell));
  }



  // Where the obstacles begin, and in faces behind which there is only a rest.
  template <int dim>
  void
  CutCells<dim>::find_surfaces(Cell &cell, const Places &places) const
  {
    const auto is_shut = [&](const unsigned int direction,
                             const unsigned int end) {
      const std::uint32_t next = neighbour(cell.number, direction, end);
      return next != invalid_cell && is_closed(next);
    };
    std::array<std::array<bool, 2>, dim> shut;
    for (unsigned int d = 0; d < dim; ++d)
      for (const unsigned int end : {0, 1})
        shut[d][end] = is_shut(d, end);
    const auto is_bound = [&](const Simplex     &simplex,
                              const unsigned int opposite) {
      bool                                 in_obstacle = true;
      std::array<std::array<bool, 2>, dim> in_face;
      for (auto &ends : in_face)
        ends.fill(true);
      for (unsigned int k = 0; k <= dim; ++k)
        if (k != opposite)
          {
            in_obstacle = in_obstacle && simplex.distance[k] == 0;
            for (unsigned int d = 0; d < dim; ++d)
              for (const unsigned int end : {0, 1})
                in_face[d][end] =
                  in_face[d][end] && simplex.corners[k][d] == end;
          }
      bool result = in_obstacle;
      for (unsigned int d = 0; d < dim; ++d)
        for (const unsigned int end : {0, 1})
          result = result || (in_face[d][end] && shut[d][end]);
      return result;
    };
    for_each_open_simplex(cell.number, places, [&](const Simplex &simplex) {
      for (unsigned int k = 0; k <= dim; ++k)
        if (is_bound(simplex, k))
          add_surface(simplex, k, places, cell);
    });
    for (Surface &surface : cell.surfaces)
      {
        for (double &mean : surface.functions)
          mean /= surface.area;
        surface.place /= surface.area;
        surface.normal /= surface.normal.norm();
      }
  }



  template <int dim>
  std::uint32_t
  CutCells<dim>::neighbour(const std::uint32_t cell,
                           const unsigned int  direction,
                           const unsigned int  end) const
  {
    const CellGeometry<dim> &geometry = parts.grid.geometry[cell];
    std::array<double, dim>  x;
    for (unsigned int d = 0; d < dim; ++d)
      x[d] = geometry.origin[d] + (d != direction ? 0.5 :
                                   end == 0       ? -0.25 :
                                                    1.25) /
                                    geometry.inverse_edge[d];
    return parts.grid.bins.cell_at(x);
  }



  // Of all parts of the cell: those that are open, work(simplex).
  template <int dim>
  template <class Work>
  void
  CutCells<dim>::for_each_open_simplex(const std::uint32_t number,
                                       const Places       &places,
                                       const Work         &work) const
  {
    const CellGeometry<dim> &geometry = parts.grid.geometry[number];
    constexpr unsigned int   n        = n_parts<dim>;
    double                   smallest = 1e300;
    for (unsigned int d = 0; d < dim; ++d)
      smallest = std::min(smallest, 1 / (n * geometry.inverse_edge[d]));

    static const auto simplices = simplices_of_cube<dim>();
    for (unsigned int part = 0; part < (dim == 2 ? n * n : n * n * n); ++part)
      {
        std::array<dealii::Point<dim>, n_nodes> corners;
        std::array<double, n_nodes>             distances;
        for (unsigned int a = 0; a < n_nodes; ++a)
          {
            dealii::Point<dim> x;
            for (unsigned int d = 0, rest = part; d < dim; ++d, rest /= n)
              {
                corners[a][d] = double(rest % n + (a >> d & 1)) / n;
                x[d] =
                  geometry.origin[d] + corners[a][d] / geometry.inverse_edge[d];
              }
            double &least = distances[a] = 1e300;
            for (const ObstaclePlace<dim> &place : places)
              least = std::min(least, place.distance(x).value);
            if (std::abs(least) < nothing * smallest)
              least = 0;
          }
        for (const auto &one : simplices)
          {
            Simplex simplex;
            for (unsigned int k = 0; k <= dim; ++k)
              {
                simplex.corners[k]  = corners[one[k]];
                simplex.distance[k] = distances[one[k]];
              }
            divide(simplex, work);
          }
      }
  }



  // In two where an edge runs from one side to the other, until none does.
  template <int dim>
  template <class Work>
  void
  CutCells<dim>::divide(const Simplex &simplex, const Work &work) const
  {
    for (unsigned int i = 0; i <= dim; ++i)
      for (unsigned int j = 0; j <= dim; ++j)
        if (simplex.distance[i] < 0 && simplex.distance[j] > 0)
          {
            const double share =
              simplex.distance[i] / (simplex.distance[i] - simplex.distance[j]);
            const dealii::Point<dim> between =
              simplex.corners[i] +
              share * (simplex.corners[j] - simplex.corners[i]);
            for (const unsigned int replaced : {i, j})
              {
                Simplex part            = simplex;
                part.corners[replaced]  = between;
                part.distance[replaced] = 0;
                divide(part, work);
              }
            return;
          }
    if (std::any_of(simplex.distance.begin(),
                    simplex.distance.end(),
                    [](const double x) { return x > 0; }))
      work(simplex);
  }



  template <int dim>
  void
  CutCells<dim>::add_volume(const Simplex &simplex, Cell &cell) const
  {
    dealii::Tensor<2, dim> edges;
    for (unsigned int k = 0; k < dim; ++k)
      edges[k] = simplex.corners[k + 1] - simplex.corners[0];
    const double volume = std::abs(determinant(edges)) / factorial(dim);
    cell.open += volume;
    // of the second degree, as are the means that anybody needs
    static const dealii::QGaussSimplex<dim> rule(2);
    for (unsigned int q = 0; q < rule.size(); ++q)
      {
        dealii::Point<dim> xi = simplex.corners[0];
        for (unsigned int k = 0; k < dim; ++k)
          xi += rule.point(q)[k] * edges[k];
        for (unsigned int k = 0; k < n_nodes; ++k)
          cell.monomials[k] +=
            rule.weight(q) * factorial(dim) * volume * monomial<dim>(k, xi);
      }
  }



  // The facet opposite to a corner that is open.
  template <int dim>
  void
  CutCells<dim>::add_surface(const Simplex     &simplex,
                             const unsigned int opposite,
                             const Places      &places,
                             Cell              &cell) const
  {
    const CellGeometry<dim> &geometry = parts.grid.geometry[cell.number];
    std::array<dealii::Point<dim>, dim> facet; // natural coordinates
    for (unsigned int k = 0, n = 0; k <= dim; ++k)
      if (k != opposite)
        facet[n++] = simplex.corners[k];
    const auto in_metres = [&](const Vector &xi) {
      Vector result;
      for (unsigned int d = 0; d < dim; ++d)
        result[d] = xi[d] / geometry.inverse_edge[d];
      return result;
    };
    const Vector along = in_metres(facet[1] - facet[0]);
    Vector       normal; // times the area
    if constexpr (dim == 2)
      normal = dealii::cross_product_2d(along);
    else
      normal =
        0.5 * dealii::cross_product_3d(along, in_metres(facet[2] - facet[0]));
    if (normal * in_metres(simplex.corners[opposite] - facet[0]) < 0)
      normal = -normal;
    const double area = normal.norm();
    if (!(area > 0))
      return;

    // of the third degree, as are the functions
    static const dealii::QGaussSimplex<dim - 1> rule(dim);
    std::array<double, n_nodes>                 functions{};
    dealii::Point<dim>                          middle; // times the area
    for (unsigned int q = 0; q < rule.size(); ++q)
      {
        dealii::Point<dim> xi = facet[0];
        for (unsigned int k = 1; k < dim; ++k)
          xi += rule.point(q)[k - 1] * (facet[k] - facet[0]);
        const double weight = rule.weight(q) * factorial(dim - 1) * area;
        for (unsigned int a = 0; a < n_nodes; ++a)
          functions[a] += weight * function_of_corner<dim>(a, xi);
        for (unsigned int d = 0; d < dim; ++d)
          middle[d] +=
            weight * (geometry.origin[d] + xi[d] / geometry.inverse_edge[d]);
      }
    unsigned int obstacle = 0;
    for (unsigned int o = 1; o < places.size(); ++o)
      {
        const dealii::Point<dim> x = middle / area;
        if (std::abs(places[o].distance(x).value) <
            std::abs(places[obstacle].distance(x).value))
          obstacle = o;
      }
    const auto same = [&](const Surface &surface) {
      return surface.obstacle == obstacle &&
             surface.normal * normal >
               least_cosine * surface.normal.norm() * area;
    };
    auto surface =
      std::find_if(cell.surfaces.begin(), cell.surfaces.end(), same);
    if (surface == cell.surfaces.end())
      {
        cell.surfaces.emplace_back();
        surface           = cell.surfaces.end() - 1;
        surface->obstacle = obstacle;
      }
    surface->normal += normal;
    surface->area += area;
    surface->place += middle;
    for (unsigned int a = 0; a < n_nodes; ++a)
      surface->functions[a] += functions[a];
  }



  template class CutCells<2>;
  template class CutCells<3>;
} // namespace limber
