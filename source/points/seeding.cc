// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/quadrature_lib.h>

#include <limber/points/part_inside.h>
#include <limber/points/seeding.h>
#include <limber/problem/point_list.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>

namespace limber
{
  namespace
  {
    /** A position in the unit cell and its share of the volume (weight). */
    template <int dim>
    struct Site
    {
      dealii::Point<dim> place;
      double             weight;
    };



    template <int dim>
    std::vector<Site<dim>>
    sites(const std::array<unsigned int, dim> &per_edge, const bool gauss)
    {
      std::array<dealii::Quadrature<1>, dim> lines;
      for (int d = 0; d < dim; ++d)
        {
          const unsigned int n = per_edge[d];
          if (gauss)
            lines[d] = dealii::QGauss<1>(n);
          else
            {
              std::vector<dealii::Point<1>> places(n);
              for (unsigned int i = 0; i < n; ++i)
                places[i][0] = (i + 0.5) / n;
              lines[d] =
                dealii::Quadrature<1>(places, std::vector<double>(n, 1. / n));
            }
        }

      std::vector<Site<dim>> result;
      const unsigned int     n_z = dim == 3 ? lines[dim - 1].size() : 1;
      for (unsigned int k = 0; k < n_z; ++k)
        for (unsigned int j = 0; j < lines[1].size(); ++j)
          for (unsigned int i = 0; i < lines[0].size(); ++i)
            {
              const unsigned int index[] = {i, j, k};
              Site<dim>          site{{}, 1.};
              for (int d = 0; d < dim; ++d)
                {
                  site.place[d] = lines[d].point(index[d])[0];
                  site.weight *= lines[d].weight(index[d]);
                }
              result.push_back(site);
            }
      return result;
    }



    /** Move a site by up to a quarter of the spacing in each direction. */
    template <int dim>
    void
    jitter(Site<dim> &site, const Body<dim> &body, std::mt19937 &random)
    {
      for (int d = 0; d < dim; ++d)
        {
          // in [-1/4, 1/4), the same on every machine
          const double shift = random() / 8589934592. - 0.25;
          site.place[d] += shift / body.points_per_cell_edge[d];
        }
    }



    /** Volume, centroid and second moments of the union of several parts. */
    template <int dim>
    PartInside<dim>
    sum_of(const std::vector<PartInside<dim>> &parts)
    {
      PartInside<dim>        result;
      dealii::Tensor<1, dim> moment;
      for (const PartInside<dim> &part : parts)
        {
          result.volume += part.volume;
          moment += part.volume * part.centroid;
        }
      if (result.volume == 0)
        return result;
      result.centroid = dealii::Point<dim>(moment / result.volume);
      for (const PartInside<dim> &part : parts)
        {
          const dealii::Tensor<1, dim> arm = part.centroid - result.centroid;
          result.spread += part.volume / result.volume *
                           (part.spread + symmetrize(outer_product(arm, arm)));
        }
      return result;
    }



    /**
     * Add the part of this box inside the shape. At a re-entrant corner its
     * centroid may be outside, in an obstacle for instance: then the box is
     * bisected along each axis until the centroids of its parts are inside.
     */
    template <int dim>
    void
    add_parts_inside(const Shape<dim>             &shape,
                     const Corners<dim>           &box,
                     std::vector<PartInside<dim>> &parts,
                     const unsigned int            divisions = 0)
    {
      constexpr unsigned int most_divisions = 3; // then close to the surface
      const PartInside<dim>  inside         = inside_of(shape, box);
      if (inside.volume == 0)
        return;
      if (divisions == most_divisions || shape.contains(inside.centroid))
        return parts.push_back(inside);
      const auto middle = box.first + 0.5 * (box.second - box.first);
      for (unsigned int half = 0; half < 1u << dim; ++half)
        {
          Corners<dim> part = box;
          for (unsigned int d = 0; d < dim; ++d)
            (half >> d & 1 ? part.first : part.second)[d] = middle[d];
          add_parts_inside(shape, part, parts, divisions + 1);
        }
    }



    /**
     * The symmetric map of the cube [-1/2, 1/2]^dim to a parallelepiped with
     * these second moments, see PartInside; for those of a box it is the box.
     */
    template <int dim>
    dealii::Tensor<2, dim>
    box_of_spread(const dealii::SymmetricTensor<2, dim> &spread)
    {
      dealii::Tensor<2, dim> result;
      // Jacobi rotations, which leave a diagonal matrix as it is
      for (const auto &[square, axis] :
           eigenvectors(spread,
                        dealii::SymmetricTensorEigenvectorMethod::jacobi))
        result +=
          std::sqrt(12 * std::max(0., square)) * outer_product(axis, axis);
      return result;
    }



    /**
     * Gauss-Legendre points for the part of a cell inside, of whatever shape:
     * those of a parallelepiped with the same centroid and second moments, so
     * that a body in bending has the right energy. If some are outside of the
     * cell, two along each edge, which are closer to the centroid; if some of
     * these are outside, all are moved towards it. @p work gets each position
     * and its volume.
     */
    template <int dim, class Work>
    void
    for_each_gauss_place(const PartInside<dim>               &inside,
                         const std::array<unsigned int, dim> &per_edge,
                         const Corners<dim>                  &cell,
                         const Work                          &work)
    {
      const dealii::Tensor<2, dim> box = box_of_spread(inside.spread);

      // The largest factor, up to 1, of their distances from the centroid with
      // which all are within the cell.
      const auto largest_share = [&](const std::vector<Site<dim>> &sites) {
        double share = 1;
        for (const Site<dim> &site : sites)
          {
            dealii::Tensor<1, dim> arm = site.place;
            for (int d = 0; d < dim; ++d)
              arm[d] -= 0.5;
            arm = box * arm;
            for (int d = 0; d < dim; ++d)
              {
                const double room = arm[d] > 0 ?
                                      cell.second[d] - inside.centroid[d] :
                                      inside.centroid[d] - cell.first[d];
                if (std::abs(arm[d]) * share > room)
                  share = room / std::abs(arm[d]);
              }
          }
        return share;
      };

      auto   places = sites<dim>(per_edge, true);
      double share  = largest_share(places);
      if (share < 1)
        {
          std::array<unsigned int, dim> two;
          for (int d = 0; d < dim; ++d)
            two[d] = std::min(2u, per_edge[d]);
          places = sites<dim>(two, true);
          share  = largest_share(places);
        }
      for (const Site<dim> &site : places)
        {
          dealii::Tensor<1, dim> arm = site.place;
          for (int d = 0; d < dim; ++d)
            arm[d] -= 0.5;
          work(inside.centroid + share * (box * arm),
               site.weight * inside.volume);
        }
    }



    /**
     * Move a point off the faces of its cell. A point on a face gives nothing
     * to the nodes beyond, which may then have neither mass nor velocity, but
     * strain it, and its stress would be lost there. With any tiny weight
     * momentum over mass is right.
     */
    template <int dim>
    dealii::Point<dim>
    off_the_edges(const dealii::Point<dim>  &place,
                  const BackgroundGrid<dim> &grid,
                  const std::uint32_t        cell)
    {
      constexpr double         least    = 1e-9; // in edges
      const CellGeometry<dim> &geometry = grid.geometry[cell];
      dealii::Point<dim>       result   = place;
      for (int d = 0; d < dim; ++d)
        {
          const double xi =
            (place[d] - geometry.origin[d]) * geometry.inverse_edge[d];
          if (xi < least || xi > 1 - least)
            result[d] = geometry.origin[d] + (xi < 0.5 ? least : 1 - least) /
                                               geometry.inverse_edge[d];
        }
      return result;
    }



    /**
     * Call @p work with the cell, the place, the volume in m^dim and the half
     * edges in m (columns) of every point of the body, in the order of cells.
     */
    template <int dim, class Work>
    void
    for_each_site(const Body<dim>           &body,
                  const BackgroundGrid<dim> &grid,
                  const Work                &work)
    {
      const auto regular = sites<dim>(body.points_per_cell_edge, false);
      const auto box     = body.shape->bounding_box();
      const auto touches = [&](const auto &cell) {
        for (int d = 0; d < dim; ++d)
          if (cell->vertex(0)[d] > box.second[d] ||
              cell->vertex((1 << dim) - 1)[d] < box.first[d])
            return false;
        return true;
      };

      for (const auto &cell : grid.triangulation.active_cell_iterators())
        {
          if (!cell->is_locally_owned() || !touches(cell))
            continue;
          const dealii::Point<dim> lower = cell->vertex(0);
          const auto               edge  = cell->vertex((1 << dim) - 1) - lower;
          double                   volume = 1;
          unsigned long            seed   = 5489;
          for (int d = 0; d < dim; ++d)
            {
              volume *= edge[d];
              seed =
                seed * 1000003 +
                std::lround((lower[d] - grid.description.lower[d]) / edge[d]);
            }
          // Making a generator takes longer than placing the points.
          std::optional<std::mt19937> random;
          if (body.placement == Placement::jittered)
            random.emplace(seed);

          // domain: a box of the volume of the point
          const auto give = [&](const dealii::Point<dim> &place,
                                const double              part) {
            dealii::Tensor<2, dim> half_edges;
            for (int d = 0; d < dim; ++d)
              half_edges[d][d] =
                0.5 * edge[d] / body.points_per_cell_edge[d] *
                std::pow(part / volume * regular.size(), 1. / dim);
            work(grid.cell_number(cell), place, part, half_edges);
          };

          std::vector<PartInside<dim>> parts; // of 'cut' and 'gauss'
          for (Site<dim> site : regular)
            {
              if (random)
                jitter(site, body, *random);
              dealii::Point<dim> place = lower;
              for (int d = 0; d < dim; ++d)
                place[d] += site.place[d] * edge[d];
              if (body.placement == Placement::cut ||
                  body.placement == Placement::gauss)
                {
                  Corners<dim> part(place, place);
                  for (int d = 0; d < dim; ++d)
                    {
                      const double half =
                        0.5 * edge[d] / body.points_per_cell_edge[d];
                      part.first[d] -= half;
                      part.second[d] += half;
                    }
                  add_parts_inside(*body.shape, part, parts);
                }
              else if (body.shape->contains(place))
                give(place, site.weight * volume);
            }
          if (body.placement == Placement::gauss && !parts.empty())
            for_each_gauss_place<dim>(
              sum_of(parts),
              body.points_per_cell_edge,
              Corners<dim>(lower, lower + edge),
              [&](const dealii::Point<dim> &place, const double part) {
                give(off_the_edges(place, grid, grid.cell_number(cell)), part);
              });
          else
            for (const PartInside<dim> &part : parts)
              give(part.centroid, part.volume);
        }
    }



    /** The same for placement 'fitted': a lattice in natural coordinates. */
    template <int dim, class Work>
    void
    for_each_part(const Body<dim>           &body,
                  const BackgroundGrid<dim> &grid,
                  const Work                &work)
    {
      const auto   &block = dynamic_cast<const BlockShape<dim> &>(*body.shape);
      unsigned long n     = 1;
      for (const unsigned int parts : body.lattice)
        n *= parts;
      for (unsigned long i = 0; i < n; ++i)
        {
          Corners<dim>       part;
          dealii::Point<dim> centre;
          unsigned long      rest = i;
          for (int d = 0; d < dim; ++d)
            {
              const unsigned int parts = body.lattice[d];
              part.first[d]            = double(rest % parts) / parts;
              part.second[d]           = double(rest % parts + 1) / parts;
              centre[d]                = (rest % parts + 0.5) / parts;
              rest /= parts;
            }
          const dealii::Point<dim> place = block.place(centre);
          std::array<double, dim>  x;
          for (int d = 0; d < dim; ++d)
            x[d] = place[d];
          const std::uint32_t cell = grid.bins.cell_at(x);
          if (cell >= grid.n_owned_cells())
            continue;
          dealii::Tensor<2, dim> half_edges = block.jacobian(centre);
          for (int d = 0; d < dim; ++d)
            for (int k = 0; k < dim; ++k)
              half_edges[d][k] *= 0.5 / body.lattice[k];
          work(cell,
               off_the_edges(place, grid, cell),
               block.volume(part),
               half_edges);
        }
    }



    template <int dim, class Work>
    void
    for_each_point(const Body<dim>           &body,
                   const BackgroundGrid<dim> &grid,
                   const Work                &work)
    {
      if (body.placement == Placement::fitted)
        for_each_part(body, grid, work);
      else
        for_each_site(body, grid, work);
    }
  } // namespace



  namespace
  {
    /** Points from a list, with their positions, sizes and velocities. */
    template <int dim>
    void
    add_listed_points(
      const PointListShape<dim>                               &list,
      const BackgroundGrid<dim>                               &grid,
      const std::function<double(const dealii::Point<dim> &)> &density,
      MaterialPoints<dim>                                     &points)
    {
      for (const ListedPoint<dim> &listed : list.points)
        {
          // Upper faces do not belong to cells; those of the box are moved
          // inside.
          std::array<double, dim> x;
          for (int d = 0; d < dim; ++d)
            x[d] = std::min(listed.place[d],
                            std::nextafter(grid.description.upper[d],
                                           grid.description.lower[d]));
          const std::uint32_t cell = grid.bins.cell_at(x);
          if (cell >= grid.n_owned_cells())
            continue;
          const double rho = density(listed.place);
          const double volume =
            listed.mass > 0 ? listed.mass / rho : listed.volume;
          dealii::Tensor<2, dim> half_edges;
          for (int d = 0; d < dim; ++d)
            half_edges[d][d] = 0.5 * std::pow(volume, 1. / dim);
          points.add(cell,
                     off_the_edges(listed.place, grid, cell),
                     rho * volume,
                     half_edges);
          const PointView<dim> view = points.view();
          for (int d = 0; d < dim; ++d)
            view.velocity[d][points.size() - 1] = listed.velocity[d];
        }
    }
  } // namespace



  template <int dim>
  void
  seed(const Body<dim>                                         &body,
       const BackgroundGrid<dim>                               &grid,
       const std::function<double(const dealii::Point<dim> &)> &density,
       MaterialPoints<dim>                                     &points)
  {
    if (const auto *list =
          dynamic_cast<const PointListShape<dim> *>(body.shape.get()))
      {
        points.reserve(list->points.size());
        add_listed_points(*list, grid, density, points);
        points.finish_adding();
        return;
      }
    // Counted first, so that the arrays get exactly the memory they need.
    std::size_t n = 0;
    for_each_point(body, grid, [&n](const auto &...) { ++n; });
    points.reserve(n);
    for_each_point(body,
                   grid,
                   [&](const std::uint32_t           cell,
                       const dealii::Point<dim>     &place,
                       const double                  volume,
                       const dealii::Tensor<2, dim> &half_edges) {
                     points.add(cell,
                                place,
                                density(place) * volume,
                                half_edges);
                   });
    points.finish_adding();
  }



  template void
  seed(const Body<2> &,
       const BackgroundGrid<2> &,
       const std::function<double(const dealii::Point<2> &)> &,
       MaterialPoints<2> &);
  template void
  seed(const Body<3> &,
       const BackgroundGrid<3> &,
       const std::function<double(const dealii::Point<3> &)> &,
       MaterialPoints<3> &);
} // namespace limber
