// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_trial_tangent_h
#define limber_stress_trial_tangent_h

#include <limber/materials/flow_rates.h>
#include <limber/stress/trial_strain.h>
#include <limber/stress/trial_stress.h>

#include <vector>

namespace limber
{
  /**
   * The algorithmic tangent of a cell (Simo and Hughes, Computational
   * Inelasticity, 7.1 and 9.2): material part, geometric part, and curvature of
   * the volumetric energy. If plastic flow couples pressure and shear, the
   * deviator depends on the mean volume, and the pressure of the cell on the
   * strains of its points.
   */
  template <class Basis, class Law>
  class TrialTangent
  {
    static constexpr int  dim     = Basis::dim;
    static constexpr int  n_nodes = Basis::n_nodes;
    static constexpr int  n_dofs  = dim * n_nodes;
    static constexpr bool finite  = Law::finite_strain;
    static constexpr bool flows   = Law::is_plastic;
    using Motion                  = TrialMotion<Basis, Law>;
    using Trial                   = CellTrial<Basis, Law>;
    using Rates                   = FlowRates<dim>;
    // [d, e][k, l]: derivative of the Kirchhoff stress (d, e), work conjugate
    // to gradients, by the displacement gradient (k, l)
    using Moduli = decltype(Rates::deviator);

  public:
    explicit TrialTangent(const TrialStrain<Basis, Law> &strain)
      : law(strain.law)
      , strain(strain)
    {}

    void
    add(Trial &trial, CellResponse &response) const
    {
      if constexpr (has_bending_modes<Basis>)
        if (strain.assumes)
          return add_assumed(trial, response);
      add_own(trial, response);
    }

  private:
    void
    add_assumed(Trial &trial, CellResponse &response) const
    {
      std::vector<Moduli>                               moduli;
      std::vector<typename Trial::Assumed::VolumeRates> volume_rates;
      for (std::size_t p = 0; p < trial.motions.size(); ++p)
        {
          const Rates rates = rates_of(trial.motions[p]);
          moduli.push_back(finite ? moduli_at_volume(trial.motions[p], rates) :
                                    moduli_of(trial.motions[p], rates));
          auto &of_volume = volume_rates.emplace_back();
          if constexpr (finite)
            {
              const double c      = trial.growth_per_volume(p);
              of_volume.curvature = c * c * rates.curvature;
              if constexpr (flows)
                for (int d = 0; d < dim; ++d)
                  for (int e = 0; e < dim; ++e)
                    {
                      of_volume.by_strain[d][e] = c * rates.slope[d][e];
                      of_volume.of_stress[d][e] = c * rates.by_growth[d][e];
                    }
            }
        }
      trial.assumed.add_tangent(
        trial.assumed_stress(),
        [&](const std::size_t p, int d, int e, int f, int g) {
          return moduli[p][d * dim + e][f * dim + g];
        },
        volume_rates,
        response.tangent.data());
    }

    void
    add_own(const Trial &trial, CellResponse &response) const
    {
      // derivatives of mean growth and, times the volume, of the slope
      std::vector<double>       &mean_growth = response.volume_row;
      std::array<double, n_dofs> slope_of_cell{};
      std::array<double, n_dofs> by_growth{}; // of the force
      double                     curvature_of_cell = trial.curvature;
      for (const Motion &motion : trial.motions)
        {
          const Rates rates = rates_of(motion);
          add_point(motion, rates, response);
          const double weight = motion.share * (finite ? motion.growth : 1.);
          for (int i = 0; i < n_nodes; ++i)
            for (int d = 0; d < dim; ++d)
              {
                const int k = i * dim + d;
                mean_growth[k] += weight * motion.gradient[i][d];
                if constexpr (flows)
                  for (int e = 0; e < dim; ++e)
                    {
                      slope_of_cell[k] += motion.volume * rates.slope[d][e] *
                                          motion.gradient[i][e];
                      by_growth[k] += motion.volume * rates.by_growth[d][e] *
                                      motion.gradient[i][e];
                    }
              }
          if constexpr (flows)
            curvature_of_cell += motion.volume * rates.curvature;
        }
      if (!strain.mean_volume)
        return;
      response.volume_stiffness = curvature_of_cell;
      if constexpr (flows)
        for (int k = 0; k < n_dofs; ++k)
          for (int l = 0; l < n_dofs; ++l)
            response.tangent[k * n_dofs + l] +=
              mean_growth[k] * slope_of_cell[l] + by_growth[k] * mean_growth[l];
    }

    // Derivatives of the stress of a point; those of the deviator by growth and
    // of the slope by strain vanish for an elastic law.
    Rates
    rates_of(const Motion &motion) const
    {
      if constexpr (flows)
        return flow_rates<dim>(law, motion.start, motion.f, motion.acting);
      else
        {
          Rates result;
          for (int k = 0; k < dim; ++k)
            for (int l = 0; l <= k; ++l)
              {
                SquareMatrix<dim> e{};
                e[k][l] += 0.5;
                e[l][k] += 0.5;
                const auto rate =
                  law.template deviatoric_tangent<dim>(motion.state, e);
                for (int c = 0; c < dim * dim; ++c)
                  result.deviator[c][k * dim + l] =
                    result.deviator[c][l * dim + k] = rate[c / dim][c % dim];
              }
          result.curvature = strain.curvature(motion, motion.growth);
          return result;
        }
    }

    /** The derivative of the deviator alone, with the volume ratio fixed. */
    Moduli
    moduli_at_volume(const Motion &motion, const Rates &rates) const
    {
      Moduli      a = rates.deviator;
      const auto &s = motion.stress;
      for (int d = 0; d < dim; ++d)
        for (int e = 0; e < dim; ++e)
          for (int k = 0; k < dim; ++k)
            a[k * dim + d][k * dim + e] += s[d][e];
      return a;
    }

    Moduli
    moduli_of(const Motion &motion, const Rates &rates) const
    {
      Moduli a = finite ? moduli_at_volume(motion, rates) : rates.deviator;
      const double mean   = motion.mean_stress();
      const double growth = finite ? motion.growth : 1.;
      const double volumetric =
        strain.mean_volume ? 0 : rates.curvature * growth * growth;
      for (int d = 0; d < dim; ++d)
        for (int e = 0; e < dim; ++e)
          {
            a[d * dim + d][e * dim + e] += volumetric;
            if constexpr (finite)
              {
                a[d * dim + d][e * dim + e] += mean;
                a[d * dim + e][e * dim + d] -= mean;
              }
            if constexpr (flows)
              if (!strain.mean_volume)
                for (int k = 0; k < dim; ++k)
                  {
                    a[k * dim + k][d * dim + e] += growth * rates.slope[d][e];
                    a[d * dim + e][k * dim + k] +=
                      growth * rates.by_growth[d][e];
                  }
          }
      return a;
    }

    void
    add_point(const Motion &motion,
              const Rates  &rates,
              CellResponse &response) const
    {
      constexpr int n = dim * dim;
      const Moduli  a = moduli_of(motion, rates);
      const auto   &g = motion.gradient;
      for (int i = 0; i < n_nodes; ++i)
        for (int d = 0; d < dim; ++d)
          {
            std::array<double, n> row{};
            for (int e = 0; e < dim; ++e)
              for (int c = 0; c < n; ++c)
                row[c] += motion.volume * g[i][e] * a[d * dim + e][c];
            double *const out =
              &response.tangent[std::size_t(i * dim + d) * n_dofs];
            for (int j = 0; j < n_nodes; ++j)
              for (int k = 0; k < dim; ++k)
                for (int l = 0; l < dim; ++l)
                  out[j * dim + k] += row[k * dim + l] * g[j][l];
          }
    }

    const FurtherDeformation<Law> &law;
    const TrialStrain<Basis, Law> &strain;
  };
} // namespace limber

#endif
