// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_law_sweep_h
#define limber_stress_law_sweep_h

#include <limber/stress/averaged_law.h>
#include <limber/stress/strain_sweep.h>

namespace limber
{
  /**
   * StressUpdate for one basis, law and treatment, all known at compile time:
   * the fastest, for kernels with few nodes.
   */
  template <class Basis, class Law, Treatment kind>
  class LawSweep final : public AveragedLaw<Basis::dim, Law>
  {
    static constexpr int dim = Basis::dim;
    using Base               = AveragedLaw<dim, Law>;

  public:
    using Base::Base;

    StressSummary
    update(const PointView<dim> &points,
           const GridView<dim>  &grid,
           const CellSums<dim>  *sums,
           const StressSweep    &what) const override
    {
      const Strain      strain{*this, !this->law.has_constant_wave_speed()};
      PackFindings<dim> found;
      const double      displacement =
        StrainSweep<Basis, kind, Law::uses_spin, Strain>::run(
          points, grid, sums, what, this->strain_treatment, strain, found)
          .displacement;
      StressSummary result = this->summary(found, strain.measure_waves);
      result.displacement  = displacement;
      return result;
    }

  private:
    struct Strain
    {
      template <class Lanes>
      __attribute__((always_inline)) PointPack<dim>
      operator()(const PointView<dim>                       &points,
                 const Lanes                                &lanes,
                 const MotionIncrement<dim, PointPack<dim>> &motion,
                 const HistoryChange                        &change,
                 PackFindings<dim>                          &found) const
      {
        return owner.strain(
          points, lanes, motion, change, measure_waves, found);
      }

      const LawSweep &owner;
      const bool      measure_waves;
    };
  };
} // namespace limber

#endif
