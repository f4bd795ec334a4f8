// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_pack_strain_h
#define limber_stress_pack_strain_h

#include <limber/stress/averaged_law.h>

namespace limber
{
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



  /** The sweep of a law that calls it so: update() remains to be written. */
  template <int dim, class Law>
  class LawOnPacks : public AveragedLaw<dim, Law>, protected PackStrain<dim>
  {
    using Motion = typename PackStrain<dim>::Motion;

  public:
    LawOnPacks(const Law &law, const StrainProjection &projection)
      : AveragedLaw<dim, Law>(law, projection)
      , measure_waves(!law.has_constant_wave_speed())
    {}

  protected:
    /** What a sweep has found, with where the points have gone. */
    StressSummary
    whole_summary(const PackFindings<dim> &found,
                  const StressSummary     &moved) const
    {
      StressSummary result = this->summary(found, measure_waves);
      result.displacement  = moved.displacement;
      result.speed_squared = moved.speed_squared;
      result.removed       = moved.removed;
      return result;
    }

  private:
    PointPack<dim>
    strain_pack(const PointView<dim>        &points,
                const BatchLanes<dim, true> &lanes,
                const Motion                &motion,
                const HistoryChange         &change,
                PackFindings<dim>           &found) const override
    {
      return this->strain(points, lanes, motion, change, measure_waves, found);
    }

    PointPack<dim>
    strain_pack(const PointView<dim>         &points,
                const BatchLanes<dim, false> &lanes,
                const Motion                 &motion,
                const HistoryChange          &change,
                PackFindings<dim>            &found) const override
    {
      return this->strain(points, lanes, motion, change, measure_waves, found);
    }

    const bool measure_waves;
  };
} // namespace limber

#endif
