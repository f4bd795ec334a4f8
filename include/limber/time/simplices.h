// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_simplices_h
#define limber_time_simplices_h

#include <algorithm>
#include <array>
#include <vector>

namespace limber
{
  /**
   * Kuhn's (Freudenthal's) triangulation of the unit cube: the corners of dim!
   * simplices, one for each path along edges from the first corner to the last.
   * Those of neighbouring cubes match across faces.
   */
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
} // namespace limber

#endif
