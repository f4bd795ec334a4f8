// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/mpi.h>

#include <limber/output/outermost.h>
#include <limber/problem/observable.h>

#include <algorithm>
#include <array>

namespace limber
{
  // By histograms, each of the one bin of the last in which the coordinate is.
  double
  outermost(PlacesOfMass places, const double share, MPI_Comm communicator)
  {
    constexpr unsigned int n_bins = 256, n_rounds = 5; // 256^-5 = 1e-12

    // largest coordinate, largest negative one
    std::array<double, 2> ends;
    ends.fill(-std::numeric_limits<double>::infinity());
    double mass = 0;
    for (const auto &[x, m] : places)
      {
        ends[0] = std::max(ends[0], x);
        ends[1] = std::max(ends[1], -x);
        mass += m;
      }
    MPI_Allreduce(
      MPI_IN_PLACE, ends.data(), 2, MPI_DOUBLE, MPI_MAX, communicator);
    mass = dealii::Utilities::MPI::sum(mass, communicator);
    if (!(mass > 0))
      return not_known;
    double upper = ends[0], lower = -ends[1];
    double beyond = share * mass; // may lie beyond
    if (share == 0)
      return upper;

    for (unsigned int round = 0; round < n_rounds; ++round)
      {
        const double width  = (upper - lower) / n_bins;
        const auto   bin_of = [&](const double x) {
          return static_cast<unsigned int>(
            std::clamp((upper - x) / width, 0., n_bins - 1.));
        };
        if (!(width > 0))
          break;
        std::array<double, n_bins> in_bin{}; // from the upper end
        for (const auto &[x, m] : places)
          in_bin[bin_of(x)] += m;
        MPI_Allreduce(MPI_IN_PLACE,
                      in_bin.data(),
                      n_bins,
                      MPI_DOUBLE,
                      MPI_SUM,
                      communicator);
        unsigned int bin = 0;
        for (; bin < n_bins - 1 && in_bin[bin] <= beyond; ++bin)
          beyond -= in_bin[bin];
        places.erase(std::remove_if(places.begin(),
                                    places.end(),
                                    [&](const auto &place) {
                                      return bin_of(place.first) != bin;
                                    }),
                     places.end());
        upper -= bin * width;
        lower = upper - width;
      }
    return 0.5 * (lower + upper);
  }
} // namespace limber
