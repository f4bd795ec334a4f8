// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_averaged_law_h
#define limber_stress_averaged_law_h

#include <limber/stress/law_on_points.h>

#include <stdexcept>

namespace limber
{
  /**
   * A law on points whose strain (and possibly history) is averaged over cells.
   */
  template <int dim, class Law>
  class AveragedLaw : public LawOnPoints<dim, Law>
  {
    using Base         = LawOnPoints<dim, Law>;
    using DeviatorSums = limber::DeviatorSums<dim>;

  public:
    AveragedLaw(const Law &law, const StrainTreatment &treatment)
      : Base(law)
      , strain_treatment(treatment)
    {}

    void
    sum_deviators(const PointView<dim> &points,
                  const CellSums<dim>  &sums) const override
    {
      if constexpr (Law::keeps_deviator)
        for (std::size_t p = 0; p < points.size; ++p)
          {
            const auto e =
              law.template deviatoric_strain<dim>(state_of(points, p));
            double *const record = sums.open(points.cell[p]);
            record[DeviatorSums::mass] += points.mass[p];
            for (unsigned int k = 0; k < e.size(); ++k)
              record[DeviatorSums::strain + k] += points.mass[p] * e[k];
          }
      else
        throw std::logic_error("no deviatoric history");
    }

    double
    relax_deviators(const PointView<dim> &points,
                    const double *const   sums,
                    const double          share) const override
    {
      const Treatment kind = strain_treatment.kind;
      if (!averages_shear_in_cells(kind))
        throw std::logic_error("no deviatoric history that is averaged");
      double removed = 0;
      if constexpr (Law::keeps_deviator)
        for (std::size_t p = 0; p < points.size; ++p)
          {
            auto                state = state_of(points, p);
            auto                e = law.template deviatoric_strain<dim>(state);
            const double *const record =
              sums + points.cell[p] * DeviatorSums::stride;
            const double inverse_mass = 1 / record[DeviatorSums::mass];
            for (unsigned int k = kind == Treatment::cell_full ? 0 : 2;
                 k < e.size();
                 ++k)
              e[k] += share *
                      (record[DeviatorSums::strain + k] * inverse_mass - e[k]);
            const double before = law.template deviatoric_energy<dim>(state);
            law.template set_deviatoric_strain<dim>(state, e);
            removed += points.mass[p] * inverse_density *
                       (before - law.template deviatoric_energy<dim>(state));
            store_state(points,
                        state,
                        [&](const double value, double *const a) {
                          a[p] = value;
                        });
          }
      else
        throw std::logic_error("no deviatoric history");
      return removed;
    }

    const StrainTreatment &
    treatment() const override
    {
      return strain_treatment;
    }

  protected:
    using Base::inverse_density;
    using Base::law;
    using Base::state_of;
    using Base::store_state;

    const StrainTreatment strain_treatment;
  };
} // namespace limber

#endif
