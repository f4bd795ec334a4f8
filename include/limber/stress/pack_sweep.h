// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_pack_sweep_h
#define limber_stress_pack_sweep_h

#include <limber/materials/law_list.h>
#include <limber/stress/pack_strain.h>

#include <memory>

/** @file Sweeps that call their law once per pack: laws and kernels apart. */
namespace limber
{
  /** How a kernel strains and moves the points of a body, whatever its law. */
  template <int dim>
  struct PackSweep
  {
    StressSummary (*strain)(const PointView<dim>  &points,
                            const GridView<dim>   &grid,
                            const CellSums<dim>   *sums,
                            const StressSweep     &what,
                            const StrainTreatment &treatment,
                            const PackStrain<dim> &law,
                            PackFindings<dim>     &found);
    // Whether it lets them take their velocities (StressUpdate).
    bool takes_velocity = false;
  };



  /** Any law with such a sweep. */
  template <int dim>
  std::unique_ptr<const StressUpdate<dim>>
  make_pack_sweep(const AnyLaw          &law,
                  const StrainTreatment &treatment,
                  const PackSweep<dim>  &sweep);
} // namespace limber

#endif
