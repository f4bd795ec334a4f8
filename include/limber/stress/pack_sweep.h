// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_pack_sweep_h
#define limber_stress_pack_sweep_h

#include <limber/materials/law_list.h>
#include <limber/stress/pack_strain.h>

#include <memory>

/**
 * @file Sweeps that call the law once per pack, compiled independently of it.
 */
namespace limber
{
  /**
   * A sweep of a kernel that strains and moves the points of a body, for any
   * law.
   */
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
    // Whether it does G2P as well (StressUpdate::takes_velocity()).
    bool takes_velocity = false;
  };



  /** A StressUpdate from any law and such a sweep. */
  template <int dim>
  std::unique_ptr<const StressUpdate<dim>>
  make_pack_sweep(const AnyLaw          &law,
                  const StrainTreatment &treatment,
                  const PackSweep<dim>  &sweep);
} // namespace limber

#endif
