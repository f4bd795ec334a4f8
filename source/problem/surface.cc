// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/problem/surface.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace limber
{
  using dealii::Point;

  namespace
  {
    /**
     * Where the segment from a place inside to one outside crosses the surface,
     * by bisection; the same to the last bit for all who share the segment.
     */
    template <int dim>
    Point<dim>
    crossing(const Region<dim> &region,
             const Point<dim>  &inside,
             const Point<dim>  &outside)
    {
      double in = 0, out = 1;
      for (unsigned int n = 0; n < 50; ++n)
        {
          const double middle = 0.5 * (in + out);
          (region(inside + middle * (outside - inside)) ? in : out) = middle;
        }
      return inside + in * (outside - inside);
    }



    template <int dim>
    void
    add_polygon(const std::vector<Point<dim>> &corners,
                std::vector<Facet<dim>>       &facets)
    {
      if constexpr (dim == 2)
        facets.push_back({{corners[0], corners[1]}});
      else
        for (unsigned int i = 2; i < corners.size(); ++i)
          facets.push_back({{corners[0], corners[i - 1], corners[i]}});
    }



    /**
     * A cell of the sampling lattice; corners are counted in deal.II's order.
     */
    template <int dim>
    struct Part
    {
      static constexpr unsigned int n_corners = 1 << dim;

      std::array<Point<dim>, n_corners> corner;
      std::array<bool, n_corners>       is_inside;
    };



    /**
     * A face of a part, or the part itself in two dimensions: its corners,
     * counterclockwise as seen from within the part.
     */
    using Square = std::array<unsigned int, 4>;

    template <int dim>
    std::vector<Square>
    squares()
    {
      if constexpr (dim == 2)
        return {{{0, 1, 3, 2}}};
      else
        {
          std::vector<Square> result;
          for (unsigned int d = 0; d < dim; ++d)
            {
              const unsigned int e = 1 << (d + 1) % dim, f = 1 << (d + 2) % dim;
              const unsigned int up = 1 << d;
              result.push_back({{0, e, e + f, f}});
              result.push_back({{up, up + f, up + e + f, up + e}});
            }
          return result;
        }
    }



    /** Two corners of a part, one inside and one outside. */
    using Edge = std::pair<unsigned int, unsigned int>;



    /**
     * Marching squares: the surface leaves a square over edges that go,
     * counterclockwise, from inside to outside and comes back over those that
     * go the other way. Call @p work with both, for each line in which it
     * crosses the square.
     */
    template <int dim, class Work>
    void
    for_each_line(const Region<dim> &region,
                  const Part<dim>   &part,
                  const Square      &square,
                  const Work        &work)
    {
      const auto inside = [&](const unsigned int i) {
        return part.is_inside[square[i % 4]];
      };
      // Ambiguous case: where two opposite corners are inside, the centre tells
      // whether they are joined.
      const bool is_ambiguous = inside(0) == inside(2) &&
                                inside(1) == inside(3) &&
                                inside(0) != inside(1);
      const bool is_joined =
        !is_ambiguous ||
        region(part.corner[square[0]] +
               0.5 * (part.corner[square[2]] - part.corner[square[0]]));
      for (unsigned int i = 0; i < 4; ++i)
        if (inside(i) && !inside(i + 1))
          {
            unsigned int j = i;
            do
              j += is_joined ? 1 : 3;
            while (inside(j) || !inside(j + 1));
            work(Edge(square[i], square[(i + 1) % 4]),
                 Edge(square[(j + 1) % 4], square[j % 4]));
          }
    }



    /**
     * Tangent of the surface where it crosses an edge of a part, into the part;
     * nothing where it is not the same surface a bit further.
     */
    std::optional<dealii::Tensor<1, 2>>
    tangent(const Region<2> &region,
            const Part<2>   &part,
            const Edge      &edge,
            const Point<2>  &place)
    {
      constexpr double   share  = 1e-3; // of the part
      const unsigned int across = 3 - (edge.first ^ edge.second);
      const auto         shift =
        share * (part.corner[edge.first ^ across] - part.corner[edge.first]);
      const Point<2> inside  = part.corner[edge.first] + shift,
                     outside = part.corner[edge.second] + shift;
      if (!region(inside) || region(outside))
        return std::nullopt;
      return crossing<2>(region, inside, outside) - place;
    }



    /**
     * A sharp corner of the surface between two edges of a part, of which the
     * first corner is inside: the intersection of the tangents, if the surface
     * goes there.
     */
    std::optional<Point<2>>
    sharp_corner(const Region<2> &region,
                 const Part<2>   &part,
                 const Edge      &from,
                 const Edge      &to,
                 const Point<2>  &start,
                 const Point<2>  &end)
    {
      constexpr double least_sine = 0.3, tolerance = 0.02;
      const auto       a = tangent(region, part, from, start),
                 b       = tangent(region, part, to, end);
      if (!a || !b)
        return std::nullopt;
      const auto cross = [](const auto &u, const auto &v) {
        return u[0] * v[1] - u[1] * v[0];
      };
      const double sine = cross(*a, *b);
      if (std::abs(sine) < least_sine * a->norm() * b->norm())
        return std::nullopt;
      Point<2> corner = start + cross(end - start, *b) / sine * *a;
      // Tangents of a curved surface may meet slightly outside of the part.
      const double size = (part.corner[3] - part.corner[0]).norm();
      for (int d = 0; d < 2; ++d)
        {
          const double within =
            std::clamp(corner[d], part.corner[0][d], part.corner[3][d]);
          if (std::abs(corner[d] - within) > 0.05 * size)
            return std::nullopt;
          corner[d] = within;
        }

      // A rounded corner does not reach the intersection of its tangents.
      dealii::Tensor<1, 2> beyond    = corner - (start + 0.5 * (end - start));
      const bool           is_convex = cross(end - start, beyond) < 0;
      const double way = std::min(0.1, tolerance * size / beyond.norm());
      if (region(corner - way * beyond) != is_convex ||
          region(corner + way * beyond) == is_convex)
        return std::nullopt;
      return corner;
    }



    /** The facets in one part of the lattice. */
    template <int dim>
    void
    add_facets(const Region<dim>       &region,
               const Part<dim>         &part,
               std::vector<Facet<dim>> &facets)
    {
      static const std::vector<Square> all_squares = squares<dim>();
      const auto                       place       = [&](const Edge &edge) {
        return crossing<dim>(region,
                             part.corner[edge.first],
                             part.corner[edge.second]);
      };

      // In three dimensions (marching cubes) the lines on the faces join to
      // closed polygons.
      std::vector<std::pair<Edge, Edge>> lines;
      for (const Square &square : all_squares)
        for_each_line<dim>(region,
                           part,
                           square,
                           [&](const Edge &from, const Edge &to) {
                             lines.emplace_back(from, to);
                           });
      while (!lines.empty())
        {
          auto [start, end] = lines.back();
          lines.pop_back();
          std::vector<Point<dim>> polygon = {place(start)};
          if constexpr (dim == 2)
            {
              polygon.push_back(place(end));
              if (const auto corner = sharp_corner(
                    region, part, start, end, polygon[0], polygon[1]))
                {
                  facets.push_back({{polygon[0], *corner}});
                  polygon[0] = *corner;
                }
            }
          else
            while (end != start)
              {
                polygon.push_back(place(end));
                const auto next = std::find_if(lines.begin(),
                                               lines.end(),
                                               [&end = end](const auto &line) {
                                                 return line.first == end;
                                               });
                end             = next->second;
                lines.erase(next);
              }
          add_polygon<dim>(polygon, facets);
        }
    }
  } // namespace



  template <int dim>
  std::vector<Facet<dim>>
  surface(const Shape<dim>              &shape,
          const Corners<dim>            &box,
          const std::array<double, dim> &spacing)
  {
    // The nodes of the lattice cover the common box and one layer more, so that
    // the outermost are outside.
    Corners<dim>                         common = shape.bounding_box();
    std::array<std::vector<double>, dim> lines;
    std::size_t                          n_nodes = 1;
    for (unsigned int d = 0; d < dim; ++d)
      {
        common.first[d]     = std::max(common.first[d], box.first[d]);
        common.second[d]    = std::min(common.second[d], box.second[d]);
        const double length = common.second[d] - common.first[d];
        if (length <= 0)
          return {};
        // Decimal fractions may differ by round-off.
        const int n = std::max(1., std::ceil(length / spacing[d] - 1e-6));
        for (int i = -1; i <= n + 1; ++i)
          lines[d].push_back(i == n ? common.second[d] :
                                      common.first[d] + i * length / n);
        n_nodes *= lines[d].size();
      }

    const Region<dim> region = [&](const Point<dim> &place) {
      for (unsigned int d = 0; d < dim; ++d)
        if (place[d] < common.first[d] || place[d] > common.second[d])
          return false;
      return shape.contains(place);
    };
    const auto node = [&](std::size_t i) {
      Point<dim> place;
      for (unsigned int d = 0; d < dim; ++d)
        {
          place[d] = lines[d][i % lines[d].size()];
          i /= lines[d].size();
        }
      return place;
    };

    std::vector<bool> is_inside(n_nodes);
    for (std::size_t i = 0; i < n_nodes; ++i)
      is_inside[i] = region(node(i));

    std::vector<Facet<dim>> facets;
    for (std::size_t i = 0; i < n_nodes; ++i)
      {
        std::array<std::size_t, Part<dim>::n_corners> corner;
        corner.fill(i);
        bool        is_last = false;
        std::size_t rest = i, stride = 1;
        for (unsigned int d = 0; d < dim; ++d)
          {
            is_last |= rest % lines[d].size() == lines[d].size() - 1;
            for (unsigned int c = 0; c < corner.size(); ++c)
              corner[c] += (c >> d & 1) * stride;
            rest /= lines[d].size();
            stride *= lines[d].size();
          }
        if (is_last || std::all_of(corner.begin(), corner.end(), [&](auto c) {
              return is_inside[c] == is_inside[i];
            }))
          continue;
        Part<dim> part;
        for (unsigned int c = 0; c < corner.size(); ++c)
          {
            part.corner[c]    = node(corner[c]);
            part.is_inside[c] = is_inside[corner[c]];
          }
        add_facets<dim>(region, part, facets);
      }
    return facets;
  }



  template <int dim>
  std::vector<Facet<dim>>
  part_in(const Region<dim> &region, const std::vector<Facet<dim>> &facets)
  {
    std::vector<Facet<dim>> result;
    for (const Facet<dim> &facet : facets)
      {
        std::array<bool, dim> inside;
        for (unsigned int i = 0; i < dim; ++i)
          inside[i] = region(facet[i]);
        std::vector<Point<dim>> polygon;
        for (unsigned int i = 0; i < dim; ++i)
          {
            const unsigned int j = (i + 1) % dim;
            if (inside[i])
              polygon.push_back(facet[i]);
            // A segment has one edge, a triangle three.
            if (inside[i] != inside[j] && (dim == 3 || i == 0))
              polygon.push_back(inside[i] ?
                                  crossing(region, facet[i], facet[j]) :
                                  crossing(region, facet[j], facet[i]));
          }
        if (!polygon.empty())
          add_polygon<dim>(polygon, result);
      }
    return result;
  }



  template std::vector<Facet<2>>
  surface<2>(const Shape<2> &,
             const Corners<2> &,
             const std::array<double, 2> &);
  template std::vector<Facet<3>>
  surface<3>(const Shape<3> &,
             const Corners<3> &,
             const std::array<double, 3> &);
  template std::vector<Facet<2>>
  part_in<2>(const Region<2> &, const std::vector<Facet<2>> &);
  template std::vector<Facet<3>>
  part_in<3>(const Region<3> &, const std::vector<Facet<3>> &);
} // namespace limber
