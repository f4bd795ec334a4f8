// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/transfer/checkerboard.h>

#include <algorithm>

namespace limber
{
  namespace
  {
    constexpr unsigned int number = 0, inverse_mass = 1, patterns = 2;



    /** Call work(slot, sign) for every pattern, with its sign at corner a. */
    template <int dim, class Work>
    void
    for_each_pattern(const int a, const Work &work)
    {
      unsigned int slot = patterns;
      for (int k = 3; k < 1 << dim; ++k)
        if (k & (k - 1))
          work(slot++, __builtin_parity(k & a) ? -1. : 1.);
    }
  } // namespace



  template <int dim>
  void
  gather_checkerboards(const std::vector<std::uint32_t> &cells,
                       const GridView<dim>              &grid,
                       const CellSums<dim>              &sums)
  {
    for (const std::uint32_t cell : cells)
      {
        const double mass = sums.present_mass(cell);
        if (!(mass > 0))
          continue;
        const double mean =
          sums.now[cell * sums.stride + sums.volumetric()] / mass;
        for (int a = 0; a < 1 << dim; ++a)
          {
            double *const node = grid.nodes + grid.cells[cell].node[a];
            node[number] += 1;
            node[inverse_mass] += 1 / mass;
            for_each_pattern<dim>(a,
                                  [&](const unsigned int slot,
                                      const double       sign) {
                                    node[slot] += sign * mean;
                                  });
          }
      }
  }



  template <int dim>
  void
  find_checkerboard_shifts(const std::vector<std::uint32_t> &cells,
                           const GridView<dim>              &grid,
                           const CellSums<dim>              &sums,
                           const double                      way,
                           double *const                     shift)
  {
    constexpr double all = 1 << dim;
    for (const std::uint32_t cell : cells)
      {
        const double mass = sums.present_mass(cell);
        shift[cell]       = 0;
        if (!(mass > 0))
          continue;
        const auto  &inverse_edge = grid.cells[cell].inverse_edge;
        const double share =
          std::min(way * *std::max_element(inverse_edge.begin(),
                                           inverse_edge.end()),
                   1 / all);
        for (int a = 0; a < 1 << dim; ++a)
          {
            const double *const node = grid.nodes + grid.cells[cell].node[a];
            // At a free surface patterns do cause a force.
            if (node[number] != all)
              continue;
            double sum = 0;
            for_each_pattern<dim>(a,
                                  [&](const unsigned int slot,
                                      const double       sign) {
                                    sum += sign * node[slot];
                                  });
            shift[cell] -= share / all * sum / (node[inverse_mass] * mass);
          }
      }
  }



  template void
  gather_checkerboards(const std::vector<std::uint32_t> &,
                       const GridView<2> &,
                       const CellSums<2> &);
  template void
  gather_checkerboards(const std::vector<std::uint32_t> &,
                       const GridView<3> &,
                       const CellSums<3> &);
  template void
  find_checkerboard_shifts(const std::vector<std::uint32_t> &,
                           const GridView<2> &,
                           const CellSums<2> &,
                           double,
                           double *);
  template void
  find_checkerboard_shifts(const std::vector<std::uint32_t> &,
                           const GridView<3> &,
                           const CellSums<3> &,
                           double,
                           double *);
} // namespace limber
