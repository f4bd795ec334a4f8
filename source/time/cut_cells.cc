// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/quadrature_lib.h>

#include <limber/interpolation/basis_functions.h>
#include <limber/interpolation/linear.h>
#include <limber/time/cut_cells.h>
#include <limber/time/simplices.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  namespace
  {
    // Facets in a cell are merged into one Surface if the cosine of the angle
    // between their normals is larger. A Surface acts along its mean normal,
    // with the velocity of its centroid: of a curved one a force along it would
    // be left, and one that turns in itself would push. So in the plane the
    // facets of a straight wall alone are merged, and in three dimensions,
    // where there would be dozens in a cell, those within some 2 degrees.
    constexpr double same_plane = 1 - 1e-7, nearly_flat = 0.9995;

    // A facet counts as normal to an axis if the cosine of the angle between
    // its normal and the axis is larger.
    constexpr double across_axis = 1 - 1e-5;

    // Corners of sub-cells closer to a surface than this fraction of their
    // shortest edge are snapped onto it, which avoids sliver simplices.
    constexpr double nothing = 1e-3;

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
    BasisFunctions<Linear<dim>>
    functions_at(const dealii::Point<dim> &xi,
                 const GridView<dim>      &grid,
                 const std::uint32_t       cell)
    {
      std::array<double, dim> natural;
      for (unsigned int d = 0; d < dim; ++d)
        natural[d] = xi[d];
      return {natural, grid, cell};
    }



    template <int dim>
    dealii::Point<dim>
    place_at(const dealii::Point<dim> &xi, const CellGeometry<dim> &cell)
    {
      dealii::Point<dim> result;
      for (unsigned int d = 0; d < dim; ++d)
        result[d] = cell.origin[d] + xi[d] / cell.inverse_edge[d];
      return result;
    }



    template <int dim>
    double
    least_distance(const std::vector<ObstaclePlace<dim>> &places,
                   const dealii::Point<dim>              &x)
    {
      double result = 1e300;
      for (const ObstaclePlace<dim> &place : places)
        result = std::min(result, place.distance(x).value);
      return result;
    }



    double
    factorial(const int n)
    {
      return n < 2 ? 1 : n * factorial(n - 1);
    }
  } // namespace



  // Classify a cell and cut it. If the distance at its centre exceeds the
  // diagonal (see is_as_before()), no surface can intersect the cell.
  template <int dim>
  void
  CutCells<dim>::look_at(const std::uint32_t number, const Places &places)
  {
    const double across = diagonal(number),
                 least  = moves ? std::min(distance_at_rest[number],
                                          distance[number]) :
                                  distance_at_rest[number];
    if (std::abs(least) > across)
      {
        kinds[number] = least < 0 ? covered : open;
        return;
      }

    Cell cell;
    cell.number               = number;
    cell.open                 = 0;
    const Distances distances = distances_in(number, places);
    for_each_open_simplex(distances, [&](const Simplex &simplex) {
      add_volume(simplex, cell);
    });
    const bool layer     = is_layer(number, distances),
               by_moving = moves && distance[number] < distance_at_rest[number],
               is_left   = by_moving && cell.open < least_open_left() &&
                         !holding.empty() && !(holding[number] > 0);
    if (is_left || cell.open < (layer ? least_of_layer : least_share))
      {
        const bool has_walls =
          is_left || (by_moving && is_implicit) || cell.open >= least_share;
        kinds[number] = !(cell.open > 0) ? covered :
                        has_walls        ? closed :
                                           closed_small_cut;
        return;
      }
    finish_volume(cell);
    kinds[number] = first_cut + static_cast<std::uint32_t>(cells.size());
    cells.push_back(std::move(cell));
    distances_of_cells.push_back(distances);
  }



  // Whether most of the surface's area is normal to an axis, as on boxes.
  template <int dim>
  bool
  CutCells<dim>::is_layer(const std::uint32_t cell,
                          const Distances    &distances) const
  {
    const auto &inverse_edge = parts.grid.geometry[cell].inverse_edge;
    double      across = 0, all = 0; // m^(dim-1)
    for_each_open_simplex(distances, [&](const Simplex &simplex) {
      for (unsigned int opposite = 0; opposite <= dim; ++opposite)
        {
          std::array<dealii::Point<dim>, dim> facet; // m
          bool                                is_bound = true;
          for (unsigned int k = 0, n = 0; k <= dim; ++k)
            if (k != opposite)
              {
                is_bound = is_bound && simplex.distance[k] == 0;
                for (unsigned int d = 0; d < dim; ++d)
                  facet[n][d] = simplex.corners[k][d] / inverse_edge[d];
                ++n;
              }
          if (!is_bound)
            continue;
          Vector normal;
          if constexpr (dim == 2)
            normal = dealii::cross_product_2d(facet[1] - facet[0]);
          else
            normal = 0.5 * dealii::cross_product_3d(facet[1] - facet[0],
                                                    facet[2] - facet[0]);
          double largest = 0;
          for (unsigned int d = 0; d < dim; ++d)
            largest = std::max(largest, std::abs(normal[d]));
          all += normal.norm();
          if (largest > across_axis * normal.norm())
            across += normal.norm();
        }
    });
    return across > 0.5 * all;
  }



  // Collect the facets that bound the open part: on the zero level set of phi,
  // and in faces towards neighbours that count as closed.
  template <int dim>
  void
  CutCells<dim>::find_surfaces(Cell            &cell,
                               const Distances &distances,
                               const Places    &places) const
  {
    std::array<std::array<bool, 2>, dim>   is_shut;
    std::array<std::array<Shares, 2>, dim> at_tips;
    for (unsigned int d = 0; d < dim; ++d)
      for (const unsigned int end : {0, 1})
        {
          const std::uint32_t next = neighbour(cell.number, d, end);
          is_shut[d][end]          = next != invalid_cell && is_closed(next);
          if (is_shut[d][end] && kinds[next] == closed_small_cut)
            {
              at_tips[d][end]    = open_corners(d, end, distances);
              cell.is_beside_tip = true;
            }
          else
            at_tips[d][end].fill(0);
        }
    const auto look_at_facet = [&](const Simplex     &simplex,
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
      if (in_obstacle)
        return add_surface(simplex, opposite, nullptr, places, cell);
      for (unsigned int d = 0; d < dim; ++d)
        for (const unsigned int end : {0, 1})
          if (in_face[d][end] && is_shut[d][end])
            {
              const Shares &shares = at_tips[d][end];
              const bool    is_tip =
                std::any_of(shares.begin(),
                            shares.end(),
                            [](const double share) { return share > 0; });
              return add_surface(
                simplex, opposite, is_tip ? &shares : nullptr, places, cell);
            }
    };
    for_each_open_simplex(distances, [&](const Simplex &simplex) {
      for (unsigned int k = 0; k <= dim; ++k)
        look_at_facet(simplex, k);
    });
    for (Surface &surface : cell.surfaces)
      {
        for (double &mean : surface.functions)
          mean /= surface.area;
        for (Vector &mean : surface.moments)
          mean /= surface.area;
        surface.place /= surface.area;
        surface.normal /= surface.normal.norm();
      }
    find_pieces(cell);
    for (const Surface &surface : cell.surfaces)
      {
        Vector from_origin;
        for (unsigned int d = 0; d < dim; ++d)
          from_origin[d] =
            surface.place[d] - parts.grid.geometry[cell.number].origin[d];
        for (unsigned int a = 0; a < n_nodes; ++a)
          cell.hydrostatic[a] -=
            (from_origin * parts.problem.loads.gravity - surface.beyond) *
            surface.normals[a];
      }
  }



  // Weights of the corners of a face that are outside obstacles, proportional
  // to their distance from these, with the sum 1; all 0 if none is outside.
  template <int dim>
  typename CutCells<dim>::Shares
  CutCells<dim>::open_corners(const unsigned int direction,
                              const unsigned int end,
                              const Distances   &distances) const
  {
    Shares result;
    double sum = 0;
    for (unsigned int a = 0; a < n_nodes; ++a)
      {
        unsigned int place = 0;
        for (unsigned int d = 0, stride = n_parts; d < dim;
             ++d, stride *= n_parts + 1)
          place += (a >> d & 1) * stride;
        result[a] =
          (a >> direction & 1) == end ? std::max(0., distances[place]) : 0;
        sum += result[a];
      }
    if (sum > 0)
      for (double &share : result)
        share /= sum;
    return result;
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



  template <int dim>
  typename CutCells<dim>::Distances
  CutCells<dim>::distances_in(const std::uint32_t number,
                              const Places       &places) const
  {
    const CellGeometry<dim> &geometry = parts.grid.geometry[number];
    double                   smallest = 1e300; // edge of a part, m
    for (unsigned int d = 0; d < dim; ++d)
      smallest = std::min(smallest, 1 / (n_parts * geometry.inverse_edge[d]));
    Distances result;
    for (unsigned int corner = 0; corner < n_corners; ++corner)
      {
        dealii::Point<dim> xi;
        for (unsigned int d = 0, rest = corner; d < dim;
             ++d, rest /= n_parts + 1)
          xi[d] = double(rest % (n_parts + 1)) / n_parts;
        double &least = result[corner] =
          least_distance(places, place_at(xi, geometry));
        if (std::abs(least) < nothing * smallest)
          least = 0;
      }
    return result;
  }



  // Split all sub-cells into simplices, cut these at phi = 0 and call
  // work(simplex) for the open ones.
  template <int dim>
  template <class Work>
  void
  CutCells<dim>::for_each_open_simplex(const Distances &all,
                                       const Work      &work) const
  {
    constexpr unsigned int n         = n_parts;
    static const auto      simplices = simplices_of_cube<dim>();
    for (unsigned int part = 0; part < (dim == 2 ? n * n : n * n * n); ++part)
      {
        std::array<dealii::Point<dim>, n_nodes> corners;
        std::array<double, n_nodes>             distances;
        for (unsigned int a = 0; a < n_nodes; ++a)
          {
            unsigned int place = 0;
            for (unsigned int d = 0, rest = part, stride = 1; d < dim;
                 ++d, rest /= n, stride *= n + 1)
              {
                const unsigned int along = rest % n + (a >> d & 1);
                corners[a][d]            = double(along) / n;
                place += along * stride;
              }
            distances[a] = all[place];
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



  // Bisect recursively at the zero of phi on edges on which phi changes sign,
  // until no simplex is cut.
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
    const CellGeometry<dim> &geometry = parts.grid.geometry[cell.number];
    dealii::Tensor<2, dim>   edges;
    for (unsigned int k = 0; k < dim; ++k)
      edges[k] = simplex.corners[k + 1] - simplex.corners[0];
    const double volume = std::abs(determinant(edges)) / factorial(dim);
    cell.open += volume;
    double of_cell = 1; // m^dim
    for (unsigned int d = 0; d < dim; ++d)
      of_cell /= geometry.inverse_edge[d];
    // exact for x grad N_i; no other integrand has a higher degree
    static const dealii::QGaussSimplex<dim> rule(dim);
    for (unsigned int q = 0; q < rule.size(); ++q)
      {
        dealii::Point<dim> xi = simplex.corners[0];
        for (unsigned int k = 0; k < dim; ++k)
          xi += rule.point(q)[k] * edges[k];
        const double weight = rule.weight(q) * factorial(dim) * volume;
        for (unsigned int k = 0; k < n_nodes; ++k)
          cell.monomials[k] += weight * monomial<dim>(k, xi);
        double depth = 0; // g . x, m^2/s^2
        for (unsigned int d = 0; d < dim; ++d)
          depth +=
            parts.problem.loads.gravity[d] * xi[d] / geometry.inverse_edge[d];
        const BasisFunctions<Linear<dim>> there =
          functions_at(xi, parts.nodes.view(), cell.number);
        for (unsigned int a = 0; a < n_nodes; ++a)
          for (unsigned int d = 0; d < dim; ++d)
            cell.hydrostatic[a][d] +=
              weight * of_cell * depth * there.gradient[a][d];
      }
  }



  // Add the facet opposite to an open corner of a simplex. In a face towards a
  // tip it stands for the wall behind the tip, along which liquid may slide:
  // only the part of its normal along that of the obstacle counts.
  template <int dim>
  void
  CutCells<dim>::add_surface(const Simplex     &simplex,
                             const unsigned int opposite,
                             const Shares      *at_tip,
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
    dealii::Point<dim> centre;
    for (const auto &corner : facet)
      for (unsigned int d = 0; d < dim; ++d)
        centre[d] += corner[d] / dim;
    centre                     = place_at(centre, geometry);
    unsigned int obstacle      = 0;
    auto         from_obstacle = places[0].distance(centre);
    for (unsigned int o = 1; o < places.size(); ++o)
      if (const auto from = places[o].distance(centre);
          std::abs(from.value) < std::abs(from_obstacle.value))
        {
          obstacle      = o;
          from_obstacle = from;
        }
    Vector along_wall; // tangential part of the face's normal
    if (at_tip != nullptr)
      {
        const Vector across =
          (normal * from_obstacle.normal) * from_obstacle.normal;
        along_wall = normal - across;
        normal     = across;
      }
    const double area = normal.norm();
    if (!(area > 0))
      return;

    // exact to the third degree, that of the shape functions
    static const dealii::QGaussSimplex<dim - 1> rule(dim);
    std::array<double, n_nodes>                 functions{};
    std::array<Vector, n_nodes>                 moments{};
    dealii::Point<dim>                          middle; // times the area
    for (unsigned int q = 0; q < rule.size(); ++q)
      {
        dealii::Point<dim> xi = facet[0];
        for (unsigned int k = 1; k < dim; ++k)
          xi += rule.point(q)[k - 1] * (facet[k] - facet[0]);
        const double weight = rule.weight(q) * factorial(dim - 1) * area;
        const double depth  = in_metres(xi) * parts.problem.loads.gravity;
        const BasisFunctions<Linear<dim>> at_place =
          functions_at(xi, parts.nodes.view(), cell.number);
        for (unsigned int a = 0; a < n_nodes; ++a)
          {
            functions[a] += weight * at_place.value[a];
            moments[a] += weight * at_place.value[a] * place_at(xi, geometry);
            cell.hydrostatic[a] +=
              (weight / area * at_place.value[a] * depth) * normal;
          }
        middle += weight * place_at(xi, geometry);
      }
    if (at_tip != nullptr)
      for (unsigned int a = 0; a < n_nodes; ++a)
        cell.beside_tips[a] +=
          (functions[a] / area - (*at_tip)[a]) * along_wall;
    const double least_cosine = dim == 2 ? same_plane : nearly_flat;
    const auto   same         = [&](const Surface &surface) {
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
      {
        surface->functions[a] += functions[a];
        surface->moments[a] += moments[a];
        surface->normals[a] += functions[a] / area * normal;
      }
  }



  template class CutCells<2>;
  template class CutCells<3>;
} // namespace limber
