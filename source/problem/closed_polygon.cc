// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/problem/closed_polygon.h>
#include <limber/problem/signed_distance.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  using dealii::Point;



  bool
  is_before_edge(const std::array<double, 2> &place,
                 const std::array<double, 2> &lower,
                 const std::array<double, 2> &upper)
  {
    // An explicit fused multiply-add, as a compiler may contract one copy of
    // this expression and not another.
    return std::fma(upper[0] - lower[0],
                    place[1] - lower[1],
                    -((place[0] - lower[0]) * (upper[1] - lower[1]))) > 0;
  }



  int
  crossing(const std::array<double, 2> &place,
           const std::array<double, 2> &a,
           const std::array<double, 2> &b)
  {
    const bool a_below = a[1] <= place[1], b_below = b[1] <= place[1];
    if (a_below == b_below)
      return 0;
    if (a_below)
      return is_before_edge(place, a, b) ? 1 : 0;
    return is_before_edge(place, b, a) ? -1 : 0;
  }



  ClosedPolygon::ClosedPolygon(const std::vector<Edge> &given)
  {
    for (const Edge &edge : given)
      edges.push_back(
        {{{{edge[0][0], edge[0][1]}}, {{edge[1][0], edge[1][1]}}}});
    box = {given.front()[0], given.front()[0]};
    for (const Edge &edge : given)
      for (unsigned int d = 0; d < 2; ++d)
        {
          box.first[d]  = std::min({box.first[d], edge[0][d], edge[1][d]});
          box.second[d] = std::max({box.second[d], edge[0][d], edge[1][d]});
        }
    fill_rows();
    enclosed = integrate_area();
  }



  std::size_t
  ClosedPolygon::row_of(const double y) const
  {
    const double row = (y - box.first[1]) / row_height;
    return std::clamp(row, 0., row_begins.size() - 2.);
  }



  void
  ClosedPolygon::fill_rows()
  {
    const auto for_each_row = [this](const auto &work) {
      for (std::size_t e = 0; e < edges.size(); ++e)
        {
          const auto [low, high] = std::minmax(edges[e][0][1], edges[e][1][1]);
          const std::size_t last = row_of(high);
          for (std::size_t row = row_of(low); row <= last; ++row)
            work(row, e);
        }
    };

    // As many rows as edges, unless long edges lie in many of them: then memory
    // limits the number.
    std::size_t  n_rows = std::clamp<std::size_t>(edges.size(), 1, 1 << 20);
    std::size_t  n      = 0;
    const double height = box.second[1] - box.first[1];
    for (;; n_rows /= 2)
      {
        row_height = height > 0 ? height / n_rows : 1;
        row_begins.assign(n_rows + 1, 0);
        n = 0;
        for (const auto &edge : edges)
          n += row_of(std::max(edge[0][1], edge[1][1])) -
               row_of(std::min(edge[0][1], edge[1][1])) + 1;
        if (n <= 8 * edges.size() || n_rows == 1)
          break;
      }

    for_each_row(
      [this](const std::size_t row, std::size_t) { ++row_begins[row + 1]; });
    for (std::size_t row = 0; row < n_rows; ++row)
      row_begins[row + 1] += row_begins[row];
    in_rows.resize(n);
    std::vector<std::size_t> next(row_begins.begin(), row_begins.end() - 1);
    for_each_row([&](const std::size_t row, const std::size_t e) {
      in_rows[next[row]++] = e;
    });
  }



  bool
  ClosedPolygon::contains(const Point<2> &point) const
  {
    for (unsigned int d = 0; d < 2; ++d)
      if (point[d] < box.first[d] || point[d] > box.second[d])
        return false;
    const Place       place{{point[0], point[1]}};
    const std::size_t row    = row_of(place[1]);
    bool              inside = false;
    for (std::size_t i = row_begins[row]; i < row_begins[row + 1]; ++i)
      inside ^=
        crossing(place, edges[in_rows[i]][0], edges[in_rows[i]][1]) != 0;
    return inside;
  }



  SignedDistance<2>
  ClosedPolygon::signed_distance(const Point<2> &place) const
  {
    return distance_from_edges(place, edges, [this](const Point<2> &other) {
      return contains(other);
    });
  }



  // Area by Green's theorem, the integral of x dy around the region; on which
  // side of an edge the region is, is tested beside the edge's midpoint.
  double
  ClosedPolygon::integrate_area() const
  {
    double result = 0;
    for (std::size_t e = 0; e < edges.size(); ++e)
      {
        const Place      &a = edges[e][0], &b = edges[e][1];
        const Place       middle{{0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])}};
        const std::size_t row          = row_of(middle[1]);
        bool              region_right = false;
        for (std::size_t i = row_begins[row]; i < row_begins[row + 1]; ++i)
          if (in_rows[i] != e)
            region_right ^=
              crossing(middle, edges[in_rows[i]][0], edges[in_rows[i]][1]) != 0;
        const double part = (middle[0] - box.first[0]) * std::abs(b[1] - a[1]);
        result += region_right ? -part : part;
      }
    return result;
  }



  namespace
  {
    /** Twice the area of the triangle, positive anticlockwise. */
    double
    orientation(const std::array<double, 2> &a,
                const std::array<double, 2> &b,
                const std::array<double, 2> &c)
    {
      return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    }



    using PlainEdge = std::array<std::array<double, 2>, 2>;

    bool
    cross(const PlainEdge &e, const PlainEdge &f)
    {
      if (e == f || (e[0] == f[1] && e[1] == f[0]))
        return true;
      const bool meet =
        e[0] == f[0] || e[0] == f[1] || e[1] == f[0] || e[1] == f[1];
      return !meet &&
             orientation(e[0], e[1], f[0]) * orientation(e[0], e[1], f[1]) <
               0 &&
             orientation(f[0], f[1], e[0]) * orientation(f[0], f[1], e[1]) < 0;
    }
  } // namespace



  std::optional<std::pair<std::size_t, std::size_t>>
  ClosedPolygon::crossed_edges() const
  {
    const auto left = [this](const std::size_t e) {
      return std::min(edges[e][0][0], edges[e][1][0]);
    };
    const auto right = [this](const std::size_t e) {
      return std::max(edges[e][0][0], edges[e][1][0]);
    };
    for (std::size_t row = 0; row + 1 < row_begins.size(); ++row)
      {
        // from left to right, so that only edges that overlap in x are compared
        std::vector<std::uint32_t> here(in_rows.begin() + row_begins[row],
                                        in_rows.begin() + row_begins[row + 1]);
        std::sort(here.begin(), here.end(), [&](const auto e, const auto f) {
          return left(e) < left(f);
        });
        for (std::size_t i = 0; i < here.size(); ++i)
          for (std::size_t k = i + 1;
               k < here.size() && left(here[k]) <= right(here[i]);
               ++k)
            if (cross(edges[here[i]], edges[here[k]]))
              return std::minmax<std::size_t>(here[i], here[k]);
      }
    return std::nullopt;
  }
} // namespace limber
