// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_region_sums_h
#define limber_output_region_sums_h

#include <deal.II/base/mpi.h>

#include <limber/problem/observable.h>

#include <array>

namespace limber
{
  /** Sums over the material that is in a region of space, as at a gauge. */
  template <int dim>
  class RegionSums
  {
  public:
    /** A part of the material: mass, kg, velocity, m/s, and, if the stress is
     * asked for, present volume, m^dim, Cauchy pressure and stress, Pa. */
    void
    add(const double                         mass,
        const dealii::Tensor<1, dim>        &velocity,
        const double                         volume   = 0,
        const double                         pressure = 0,
        const dealii::SymmetricTensor<2, 3> &stress   = {})
    {
      sums[0] += mass;
      sums[1] += volume;
      sums[2] += volume * pressure;
      for (unsigned int d = 0; d < dim; ++d)
        sums[3 + d] += mass * velocity[d];
      for (unsigned int k = 0; k < 6; ++k)
        sums[3 + dim + k] += volume * stress.access_raw_entry(k);
    }

    /** Collective. */
    void
    sum_over_ranks(const MPI_Comm communicator)
    {
      MPI_Allreduce(MPI_IN_PLACE,
                    sums.data(),
                    sums.size(),
                    MPI_DOUBLE,
                    MPI_SUM,
                    communicator);
    }

    /** Mass, and means over it or over the volume. Where there is no material
     * there is no stress, and the velocity is unknown. */
    Seen<dim>
    seen() const
    {
      Seen<dim> result;
      result.mass            = sums[0];
      const double of_volume = sums[1] > 0 ? 1 / sums[1] : 0;
      result.pressure        = of_volume * sums[2];
      for (unsigned int k = 0; k < 6; ++k)
        result.stress.access_raw_entry(k) = of_volume * sums[3 + dim + k];
      for (unsigned int d = 0; d < dim; ++d)
        result.velocity[d] = sums[0] > 0 ? sums[3 + d] / sums[0] : not_known;
      return result;
    }

  private:
    std::array<double, 9 + dim> sums{};
  };
} // namespace limber

#endif
