// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_nearest_facet_h
#define limber_problem_nearest_facet_h

#include <limber/problem/shape.h>

#include <array>
#include <cstdint>
#include <vector>

namespace limber
{
  /**
   * Nearest of many triangles. They are kept in the bins of a lattice; bins are
   * searched in growing shells around the place until no other can be nearer.
   */
  class NearestFacet
  {
  public:
    using Facet = std::array<dealii::Point<3>, 3>;

    NearestFacet(const std::vector<Facet> &facets, const Corners<3> &box);

    struct Found
    {
      dealii::Point<3>     place;  // on the triangle
      dealii::Tensor<1, 3> normal; // of the triangle, of length 1
    };

    Found
    operator()(const dealii::Point<3> &place) const;

  private:
    int
    bin_of(unsigned int direction, double x) const;

    std::size_t
    number_of_bin(const std::array<int, 3> &at) const;

    /** From a place, in square metres; zero within the bin. */
    double
    distance_square_of_bin(const dealii::Point<3>   &place,
                           const std::array<int, 3> &at) const;

    template <class Work>
    void
    for_each_bin(const Facet &facet, const Work &work) const;

    template <class Work>
    void
    for_each_in_shell(const std::array<int, 3> &centre,
                      int                       distance,
                      const Work               &work) const;

    std::vector<Facet>         facets;
    Corners<3>                 box;
    std::array<int, 3>         n;
    std::array<double, 3>      edge;
    std::vector<std::size_t>   begins; // of the facets of a bin
    std::vector<std::uint32_t> in_bins;
  };
} // namespace limber

#endif
