// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/stress/averaged_law.h>
#include <limber/stress/pack_sweep.h>

namespace limber
{
  namespace
  {
    /**
     * A StressUpdate whose law is called from the sweep of a kernel, by pack.
     */
    template <int dim, class Law>
    class LawOnPacks final : public AveragedLaw<dim, Law>,
                             private PackStrain<dim>
    {
      using Motion = typename PackStrain<dim>::Motion;

    public:
      LawOnPacks(const Law             &law,
                 const StrainTreatment &treatment,
                 const PackSweep<dim>  &sweep)
        : AveragedLaw<dim, Law>(law, treatment)
        , sweep(sweep)
        , measure_waves(!law.has_constant_wave_speed())
      {}

      StressSummary
      update(const PointView<dim> &points,
             const GridView<dim>  &grid,
             const CellSums<dim>  *sums,
             const StressSweep    &what) const override
      {
        PackFindings<dim>   found;
        const StressSummary moved = sweep.strain(
          points, grid, sums, what, this->strain_treatment, *this, found);
        StressSummary result = this->summary(found, measure_waves);
        result.displacement  = moved.displacement;
        result.speed_squared = moved.speed_squared;
        result.removed       = moved.removed;
        return result;
      }

      bool
      takes_velocity() const override
      {
        return sweep.takes_velocity;
      }

    private:
      PointPack<dim>
      strain_pack(const PointView<dim>        &points,
                  const BatchLanes<dim, true> &lanes,
                  const Motion                &motion,
                  const HistoryChange         &change,
                  PackFindings<dim>           &found) const override
      {
        return this->strain(
          points, lanes, motion, change, measure_waves, found);
      }

      PointPack<dim>
      strain_pack(const PointView<dim>         &points,
                  const BatchLanes<dim, false> &lanes,
                  const Motion                 &motion,
                  const HistoryChange          &change,
                  PackFindings<dim>            &found) const override
      {
        return this->strain(
          points, lanes, motion, change, measure_waves, found);
      }

      const PackSweep<dim> sweep;
      const bool           measure_waves;
    };
  } // namespace



  template <int dim>
  std::unique_ptr<const StressUpdate<dim>>
  make_pack_sweep(const AnyLaw          &any,
                  const StrainTreatment &treatment,
                  const PackSweep<dim>  &sweep)
  {
    return std::visit(
      [&](const auto &law) -> std::unique_ptr<const StressUpdate<dim>> {
        using Law = std::decay_t<decltype(law)>;
        return std::make_unique<LawOnPacks<dim, Law>>(law, treatment, sweep);
      },
      any);
  }



  template std::unique_ptr<const StressUpdate<2>>
  make_pack_sweep(const AnyLaw &,
                  const StrainTreatment &,
                  const PackSweep<2> &);
  template std::unique_ptr<const StressUpdate<3>>
  make_pack_sweep(const AnyLaw &,
                  const StrainTreatment &,
                  const PackSweep<3> &);
} // namespace limber
