// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef tests_support_triangles_h
#define tests_support_triangles_h

#include <deal.II/base/point.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

/** @file Surfaces of triangles, and the STL files that hold them. */
namespace limber
{
  using TestFacet  = std::array<dealii::Point<3>, 3>;
  using TestFacets = std::vector<TestFacet>;



  /** A sphere: an icosahedron whose facets are divided by four, so often. */
  inline TestFacets
  icosphere(const unsigned int      divisions,
            const double            radius = 1,
            const dealii::Point<3> &centre = {})
  {
    const double     g = (1 + std::sqrt(5.)) / 2;
    dealii::Point<3> v[12];
    for (unsigned int i = 0; i < 4; ++i)
      for (unsigned int d = 0; d < 3; ++d)
        {
          v[4 * d + i][(d + 1) % 3] = i & 1 ? 1 : -1;
          v[4 * d + i][(d + 2) % 3] = i & 2 ? g : -g;
        }
    // The facets of the hull: three vertices at the distance of an edge, 2.
    TestFacets facets;
    for (unsigned int a = 0; a < 12; ++a)
      for (unsigned int b = a + 1; b < 12; ++b)
        for (unsigned int c = b + 1; c < 12; ++c)
          if (v[a].distance(v[b]) < 2.1 && v[b].distance(v[c]) < 2.1 &&
              v[c].distance(v[a]) < 2.1)
            {
              const bool outwards =
                dealii::cross_product_3d(v[b] - v[a], v[c] - v[a]) * v[a] > 0;
              facets.push_back(
                {{v[a], v[outwards ? b : c], v[outwards ? c : b]}});
            }
    const auto on_sphere = [](const dealii::Point<3> &place) {
      return dealii::Point<3>(place / place.norm());
    };
    for (TestFacet &facet : facets)
      for (auto &corner : facet)
        corner = on_sphere(corner);
    for (unsigned int division = 0; division < divisions; ++division)
      {
        TestFacets finer;
        for (const auto &[a, b, c] : facets)
          {
            const auto ab = on_sphere(a + (b - a) / 2 + dealii::Tensor<1, 3>()),
                       bc = on_sphere(b + (c - b) / 2 + dealii::Tensor<1, 3>()),
                       ca = on_sphere(c + (a - c) / 2 + dealii::Tensor<1, 3>());
            for (const TestFacet &part : {TestFacet{{a, ab, ca}},
                                          TestFacet{{b, bc, ab}},
                                          TestFacet{{c, ca, bc}},
                                          TestFacet{{ab, bc, ca}}})
              finer.push_back(part);
          }
        facets = finer;
      }
    for (TestFacet &facet : facets)
      for (auto &corner : facet)
        corner = centre + radius * corner;
    return facets;
  }



  /** The cube from @p lower on, with this edge. */
  inline TestFacets
  cube_of_facets(const dealii::Point<3> &lower = {}, const double edge = 1)
  {
    const unsigned int quads[6][4] = {{0, 4, 6, 2},
                                      {1, 3, 7, 5},
                                      {0, 1, 5, 4},
                                      {2, 6, 7, 3},
                                      {0, 2, 3, 1},
                                      {4, 5, 7, 6}};
    const auto         corner      = [&](const unsigned int i) {
      return lower + edge * dealii::Point<3>(i & 1, i >> 1 & 1, i >> 2 & 1);
    };
    TestFacets facets;
    for (const auto &[a, b, c, d] : quads)
      {
        facets.push_back({{corner(a), corner(b), corner(c)}});
        facets.push_back({{corner(a), corner(c), corner(d)}});
      }
    return facets;
  }



  /** The other way around. */
  inline TestFacets
  reversed(TestFacets facets)
  {
    for (TestFacet &facet : facets)
      std::swap(facet[1], facet[2]);
    return facets;
  }



  inline TestFacets
  joined(TestFacets facets, const TestFacets &others)
  {
    facets.insert(facets.end(), others.begin(), others.end());
    return facets;
  }



  inline std::string
  ascii_stl(const TestFacets &facets)
  {
    std::ostringstream text;
    text.precision(17);
    text << "solid test\n";
    for (const TestFacet &facet : facets)
      {
        text << "  facet normal 0 0 0\n    outer loop\n";
        for (const auto &corner : facet)
          text << "      vertex " << corner[0] << ' ' << corner[1] << ' '
               << corner[2] << '\n';
        text << "    endloop\n  endfacet\n";
      }
    text << "endsolid test\n";
    return text.str();
  }



  inline std::string
  binary_stl(const TestFacets &facets)
  {
    std::string bytes(84 + 50 * facets.size(), '\0');
    // Some programs begin the header of a binary file so.
    std::memcpy(&bytes[0], "solid", 5);
    const std::uint32_t n = facets.size();
    std::memcpy(&bytes[80], &n, 4);
    for (std::size_t f = 0; f < facets.size(); ++f)
      for (unsigned int i = 0; i < 9; ++i)
        {
          const float value = facets[f][i / 3][i % 3];
          std::memcpy(&bytes[84 + 50 * f + 12 + 4 * i], &value, 4);
        }
    return bytes;
  }



  /** By Gauss's theorem. */
  inline double
  volume_within(const TestFacets &facets)
  {
    double sum = 0;
    for (const auto &[a, b, c] : facets)
      sum += dealii::cross_product_3d(b, c) * a / 6;
    return sum;
  }
} // namespace limber

#endif
