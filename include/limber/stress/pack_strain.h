// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_pack_strain_h
#define limber_stress_pack_strain_h

#include <limber/interpolation/batch_lanes.h>
#include <limber/materials/law.h>
#include <limber/stress/stress_update.h>

namespace limber
{
  /** What becomes of the volumetric variable of points before they strain. */
  struct HistoryChange
  {
    bool   any   = false;
    double share = 0; // of the way to the mean
    double mean  = 0; // of the cell
    double shift = 0; // added besides
  };



  /** What a sweep finds while it strains points, by lanes; J, m^2/s^2. */
  template <int dim>
  struct PackFindings
  {
    PointPack<dim> waves{}, viscous{}, removed{}, plastic{};
  };



  /**
   * What a law does to the points of a pack whose motion is known
   * (LawOnPoints::strain). Sweeps of kernels that see many nodes, which take
   * long to compile, call it once per pack and are there once, not for every
   * law.
   */
  template <int dim>
  class PackStrain
  {
  public:
    using Motion = MotionIncrement<dim, PointPack<dim>>;

    virtual PointPack<dim>
    strain_pack(const PointView<dim>        &points,
                const BatchLanes<dim, true> &lanes,
                const Motion                &motion,
                const HistoryChange         &change,
                PackFindings<dim>           &found) const = 0;

    virtual PointPack<dim>
    strain_pack(const PointView<dim>         &points,
                const BatchLanes<dim, false> &lanes,
                const Motion                 &motion,
                const HistoryChange          &change,
                PackFindings<dim>            &found) const = 0;

  protected:
    ~PackStrain() = default;
  };
} // namespace limber

#endif
