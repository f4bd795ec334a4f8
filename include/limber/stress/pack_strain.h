// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_pack_strain_h
#define limber_stress_pack_strain_h

#include <limber/interpolation/batch_lanes.h>
#include <limber/materials/law.h>
#include <limber/stress/stress_update.h>

namespace limber
{
  /** Change of the volumetric variable of points before they are strained. */
  struct HistoryChange
  {
    bool   any   = false;
    double share = 0; // relaxation towards the mean
    double mean  = 0; // of the cell
    double shift = 0; // added to it
  };



  /** Results of a sweep, by lanes: wave speed squared, m^2/s^2; energies, J. */
  template <int dim>
  struct PackFindings
  {
    PointPack<dim> waves{}, viscous{}, removed{}, plastic{};
  };



  /**
   * Virtual interface to LawOnPoints::strain: a law applied to a pack of points
   * with known motion. Sweeps of kernels with many nodes, which take long to
   * compile, call it once per pack and are compiled once for all laws.
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
