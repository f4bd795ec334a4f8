// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/problem/nearest_facet.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  using dealii::Point;
  using dealii::Tensor;



  namespace
  {
    Point<3>
    nearest_on_segment(const Point<3> &place,
                       const Point<3> &a,
                       const Point<3> &b)
    {
      const Tensor<1, 3> run    = b - a;
      const double       square = run.norm_square();
      const double       share  = square > 0 ? (place - a) * run / square : 0;
      return a + std::clamp(share, 0., 1.) * run;
    }



    /**
     * The nearest place of a triangle: the foot of the perpendicular, or a
     * place on one of its edges.
     */
    Point<3>
    nearest_on_triangle(const Point<3> &place, const NearestFacet::Facet &facet)
    {
      const Tensor<1, 3> u = facet[1] - facet[0], v = facet[2] - facet[0],
                         w = place - facet[0];
      const double uu = u * u, uv = u * v, vv = v * v;
      const double determinant = uu * vv - uv * uv;
      if (determinant > 0)
        {
          const double b = (vv * (w * u) - uv * (w * v)) / determinant;
          const double c = (uu * (w * v) - uv * (w * u)) / determinant;
          if (b >= 0 && c >= 0 && b + c <= 1)
            return facet[0] + b * u + c * v;
        }
      Point<3> result;
      double   least = 1e300;
      for (unsigned int i = 0; i < 3; ++i)
        {
          const Point<3> one =
            nearest_on_segment(place, facet[i], facet[(i + 1) % 3]);
          if (const double here = one.distance_square(place); here < least)
            {
              least  = here;
              result = one;
            }
        }
      return result;
    }
  } // namespace



  NearestFacet::NearestFacet(const std::vector<Facet> &facets,
                             const Corners<3>         &box)
    : facets(facets)
    , box(box)
  {
    // About as many bins on the surface of the box as there are facets, nearly
    // cubes, as shells of flat bins are too narrow to exclude much
    const Tensor<1, 3> extent = box.second - box.first;
    const double area   = 2 * (extent[0] * extent[1] + extent[1] * extent[2] +
                             extent[2] * extent[0]);
    const double wanted = std::sqrt(area / facets.size());
    for (unsigned int d = 0; d < 3; ++d)
      {
        n[d]    = extent[d] > 0 && wanted > 0 ?
                    static_cast<int>(std::clamp(extent[d] / wanted, 1., 128.)) :
                    1;
        edge[d] = extent[d] > 0 ? extent[d] / n[d] : 1;
      }
    begins.assign(std::size_t(n[0]) * n[1] * n[2] + 1, 0);
    for (const Facet &facet : facets)
      for_each_bin(facet, [&](const std::size_t bin) { ++begins[bin + 1]; });
    for (std::size_t bin = 0; bin + 1 < begins.size(); ++bin)
      begins[bin + 1] += begins[bin];
    in_bins.resize(begins.back());
    std::vector<std::size_t> next(begins.begin(), begins.end() - 1);
    for (std::size_t f = 0; f < facets.size(); ++f)
      for_each_bin(facets[f],
                   [&](const std::size_t bin) { in_bins[next[bin]++] = f; });
  }



  int
  NearestFacet::bin_of(const unsigned int direction, const double x) const
  {
    return static_cast<int>(std::clamp(
      (x - box.first[direction]) / edge[direction], 0., n[direction] - 1.));
  }



  std::size_t
  NearestFacet::number_of_bin(const std::array<int, 3> &at) const
  {
    return (std::size_t(at[2]) * n[1] + at[1]) * n[0] + at[0];
  }



  double
  NearestFacet::distance_square_of_bin(const Point<3>           &place,
                                       const std::array<int, 3> &at) const
  {
    double result = 0;
    for (unsigned int d = 0; d < 3; ++d)
      {
        const double lower = box.first[d] + at[d] * edge[d];
        const double beyond =
          std::max({lower - place[d], place[d] - lower - edge[d], 0.});
        result += beyond * beyond;
      }
    return result;
  }



  // Bins that the bounding box of the facet meets.
  template <class Work>
  void
  NearestFacet::for_each_bin(const Facet &facet, const Work &work) const
  {
    std::array<int, 3> first, last;
    for (unsigned int d = 0; d < 3; ++d)
      {
        first[d] = bin_of(d, std::min({facet[0][d], facet[1][d], facet[2][d]}));
        last[d]  = bin_of(d, std::max({facet[0][d], facet[1][d], facet[2][d]}));
      }
    for (int k = first[2]; k <= last[2]; ++k)
      for (int j = first[1]; j <= last[1]; ++j)
        for (int i = first[0]; i <= last[0]; ++i)
          work(number_of_bin({{i, j, k}}));
  }



  // Bins at a distance, in bins, in the maximum norm.
  template <class Work>
  void
  NearestFacet::for_each_in_shell(const std::array<int, 3> &centre,
                                  const int                 distance,
                                  const Work               &work) const
  {
    std::array<int, 3> first, last;
    for (unsigned int d = 0; d < 3; ++d)
      {
        first[d] = std::max(centre[d] - distance, 0);
        last[d]  = std::min(centre[d] + distance, n[d] - 1);
      }
    for (int k = first[2]; k <= last[2]; ++k)
      for (int j = first[1]; j <= last[1]; ++j)
        {
          const bool in_shell = std::abs(k - centre[2]) == distance ||
                                std::abs(j - centre[1]) == distance;
          for (int i = first[0]; i <= last[0]; ++i)
            if (in_shell || std::abs(i - centre[0]) == distance)
              work({{i, j, k}});
        }
  }



  // Search in growing shells of bins. Facets in bins beyond a shell are at
  // least its width away from the point of the box nearest to the place.
  NearestFacet::Found
  NearestFacet::operator()(const Point<3> &place) const
  {
    std::array<int, 3> centre;
    double             outside = 0; // squared distance from the box
    for (unsigned int d = 0; d < 3; ++d)
      {
        centre[d] = bin_of(d, place[d]);
        const double beyond =
          place[d] - std::clamp(place[d], box.first[d], box.second[d]);
        outside += beyond * beyond;
      }
    const double least_edge = std::min({edge[0], edge[1], edge[2]});
    const int    last       = std::max({n[0], n[1], n[2]});
    double       least      = 1e300;
    std::size_t  nearest    = 0;
    Found        result;
    for (int shell = 0; shell <= last; ++shell)
      {
        const double width = std::max(0, shell - 1) * least_edge;
        if (least < outside + width * width)
          break;
        for_each_in_shell(centre, shell, [&](const std::array<int, 3> &at) {
          if (distance_square_of_bin(place, at) > least)
            return;
          const std::size_t bin = number_of_bin(at);
          for (std::size_t i = begins[bin]; i < begins[bin + 1]; ++i)
            {
              const Point<3> one =
                nearest_on_triangle(place, facets[in_bins[i]]);
              if (const double here = one.distance_square(place); here < least)
                {
                  least        = here;
                  nearest      = in_bins[i];
                  result.place = one;
                }
            }
        });
      }
    const Facet &facet = facets[nearest];
    result.normal = cross_product_3d(facet[1] - facet[0], facet[2] - facet[0]);
    if (const double length = result.normal.norm(); length > 0)
      result.normal /= length;
    return result;
  }
} // namespace limber
