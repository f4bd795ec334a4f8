// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../support/plain_dealii.h"

#include <limber/base/timing.h>

#include <cstdio>

/**
 * @file What it brings not to write the steps the way the deal.II tutorials
 * would: an elastic block, explicit steps with the stress updated last, FLIP,
 * no locking treatment. Both ways must give the same points.
 */
using namespace limber;
using namespace limber::testing_support;

namespace
{
  template <int dim>
  bool
  compare(const unsigned int n_cells, const unsigned int n_steps)
  {
    Comparison<dim>   both(n_cells);
    const std::size_t n = both.bodies[0]->points.size();

    double start = cpu_time();
    for (unsigned int k = 0; k < n_steps; ++k)
      both.advance_limber();
    const double limber = (cpu_time() - start) / n / n_steps * 1e9;

    start = cpu_time();
    for (unsigned int k = 0; k < n_steps; ++k)
      both.advance_plain();
    const double plain = (cpu_time() - start) / n / n_steps * 1e9;

    const double difference = both.difference();
    std::printf("%dd  %7zu points, %3u steps   plain %7.1f   limber %6.1f   "
                "ratio %5.1f   difference %.1e\n",
                dim,
                n,
                n_steps,
                plain,
                limber,
                plain / limber,
                difference);
    return difference < 1e-11;
  }
} // namespace



int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  std::printf("CPU time per point and step, ns\n");
  const bool agree_2d = compare<2>(100, 50);
  const bool agree_3d = compare<3>(24, 20);
  if (!agree_2d || !agree_3d)
    std::printf("The two ways do not agree.\n");
  return agree_2d && agree_3d ? 0 : 1;
}
