// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/basis_functions.h>
#include <limber/materials/law_list.h>
#include <limber/points/locate.h>
#include <limber/stress/trial_strain.h>
#include <limber/stress/trial_stress.h>
#include <limber/stress/trial_tangent.h>

#include <cmath>
#include <stdexcept>

namespace limber
{
  namespace
  {
    template <class Basis, class Law>
    class LawTrialStress final : public TrialStress<Basis::dim>
    {
      static constexpr int  dim     = Basis::dim;
      static constexpr int  n_nodes = Basis::n_nodes;
      static constexpr bool finite  = Law::finite_strain;
      static constexpr bool flows   = Law::is_plastic;
      using Matrix                  = SquareMatrix<dim>;
      using Motion                  = TrialMotion<Basis, Law>;
      using Trial                   = CellTrial<Basis, Law>;
      using Strain                  = TrialStrain<Basis, Law>;
      using Work                    = typename TrialStress<dim>::Work;

    public:
      LawTrialStress(const Law             &law,
                     const StrainTreatment &treatment,
                     const Frame            frame)
        : strain(law, treatment, frame)
        , tangent(strain)
      {}

      bool
      respond(const PointView<dim> &points,
              const GridView<dim>  &grid,
              const double *const   displacement,
              const double *const   former,
              const bool            with_tangent,
              const Work           &work) const override
      {
        bool         admissible = true;
        CellResponse response(dim * n_nodes);
        Trial        trial, trial_before;
        for_each_batch(points, [&](const CellBatch &batch) {
          if (!admissible)
            return;
          admissible = strain(points, grid, displacement, batch, trial);
          if (!admissible)
            return;
          response.clear();
          resist(trial, response);
          if (with_tangent)
            {
              // extrapolation is for hyperelastic laws only: yielding is not
              // linear
              if constexpr (finite && !flows)
                if (former != nullptr &&
                    strain(points, grid, former, batch, trial_before))
                  extrapolate(trial_before, trial);
              tangent.add(trial, response);
            }
          work(batch.cell, response);
        });
        return admissible;
      }

      AcceptedMotion
      accept(const PointView<dim> &points,
             const GridView<dim>  &grid,
             const double *const   displacement) const override
      {
        AcceptedMotion result;
        Trial          trial;
        for_each_batch(points, [&](const CellBatch &batch) {
          if (!strain(points, grid, displacement, batch, trial))
            throw std::logic_error("no response to this displacement");
          for (std::size_t p = batch.begin; p < batch.end; ++p)
            {
              const Motion &motion = trial.motions[p - batch.begin];
              keep(motion, points, p);
              if (strain.initial)
                keep_deformation(own_deformation(trial, p - batch.begin),
                                 points,
                                 p);
              result.plastic_work += motion.volume * motion.plastic_work;
            }
          result.longest_way =
            std::max(result.longest_way, move(points, grid, trial.u, batch));
        });
        return result;
      }

      bool
      has_finite_strain() const override
      {
        return finite;
      }

      const StrainTreatment &
      treatment() const override
      {
        return strain.treatment;
      }

      double
      density() const override
      {
        return strain.law.density;
      }

      double
      young_modulus() const override
      {
        const double K = strain.law.bulk_modulus, G = strain.law.shear_modulus;
        return 9 * K * G / (3 * K + G);
      }

      double
      bulk_over_shear() const override
      {
        return strain.mean_volume ?
                 strain.law.bulk_modulus / strain.law.shear_modulus :
                 0;
      }

      // Pressure-dependent strength: non-associated flow gives an unsymmetric
      // tangent.
      bool
      has_symmetric_tangent() const override
      {
        return !flows || std::is_same_v<Law, J2>;
      }

    private:
      // Changes of the growths of all points from one trial to another, linear
      // in the displacement; nothing without assumed strain.
      std::vector<double>
      assumed_growths(Trial &before, const Trial &trial) const
      {
        std::vector<double> result;
        if constexpr (has_bending_modes<Basis>)
          if (strain.assumes)
            {
              std::vector<Matrix> change;
              for (std::size_t k = 0; k < trial.motions.size(); ++k)
                {
                  change.push_back(trial.assumed.points[k].F);
                  for (int d = 0; d < dim; ++d)
                    for (int e = 0; e < dim; ++e)
                      change[k][d][e] -= before.assumed.points[k].F[d][e];
                }
              result = before.assumed.change_of_volume_ratios(change);
              for (std::size_t k = 0; k < result.size(); ++k)
                result[k] *= before.growth_per_volume(k);
            }
        return result;
      }

      // Replace the stress by that of the previous iterate plus its
      // linearisation in the displacement since, which is linear in the
      // material frame.
      void
      extrapolate(Trial &before, Trial &trial) const
      {
        static_assert(!flows);
        double                    slope_of_cell = before.slope, mean_growth = 0;
        const std::vector<double> growths = assumed_growths(before, trial);
        for (std::size_t k = 0; k < trial.motions.size(); ++k)
          {
            const Motion &from  = before.motions[k];
            Motion       &to    = trial.motions[k];
            const Matrix  way   = times_inverse<dim>(to.f, from.f);
            double        trace = -dim;
            Matrix        grown;
            for (int d = 0; d < dim; ++d)
              {
                trace += way[d][d];
                for (int e = 0; e < dim; ++e)
                  grown[d][e] = 0.5 * (way[d][e] + way[e][d]) - (d == e);
              }
            Matrix       stress = rows_of<dim>(from.state.deviator);
            const Matrix rate =
              strain.law.template deviatoric_tangent<dim>(from.state, grown);
            for (int d = 0; d < dim; ++d)
              for (int e = 0; e < dim; ++e)
                stress[d][e] += rate[d][e];
            for (int d = 0; d < dim; ++d)
              for (int e = 0; e < dim; ++e)
                {
                  double entry = 0;
                  for (int c = 0; c < dim; ++c)
                    for (int b = 0; b < dim; ++b)
                      entry += way[d][c] * stress[c][b] * way[e][b];
                  to.stress[d][e] = entry;
                }
            if (strain.mean_volume)
              mean_growth += from.volume / before.volume * from.growth * trace;
            else
              to.slope = strain.slope(from, from.growth) +
                         strain.curvature(from, from.growth) *
                           (strain.assumes ? growths[k] : from.growth * trace);
          }
        if (strain.mean_volume)
          {
            slope_of_cell += before.curvature * mean_growth;
            for (Motion &to : trial.motions)
              to.slope = slope_of_cell / trial.volume;
          }
      }

      // Energy and its first derivative, the force. With averaged volumes it
      // follows from the mean growth, whose derivative is the mean of growth *
      // gradient.
      void
      resist(Trial &trial, CellResponse &response) const
      {
        for (const Motion &motion : trial.motions)
          response.energy +=
            motion.volume *
            (strain.law.template strain_energy<dim>(motion.state) +
             motion.plastic_work);
        if constexpr (has_bending_modes<Basis>)
          if (strain.assumes)
            {
              trial.assumed.add_force(trial.assumed_stress(),
                                      response.force.data());
              return;
            }
        for (const Motion &motion : trial.motions)
          {
            const Matrix &s    = motion.stress;
            const double  mean = motion.mean_stress();
            for (int i = 0; i < n_nodes; ++i)
              for (int d = 0; d < dim; ++d)
                {
                  double force = mean * motion.gradient[i][d];
                  for (int e = 0; e < dim; ++e)
                    force += s[d][e] * motion.gradient[i][e];
                  response.force[i * dim + d] += motion.volume * force;
                }
          }
      }

      /** F of the point from the nodes, not the assumed one. */
      const Matrix &
      own_deformation(const Trial &trial, const std::size_t k) const
      {
        if constexpr (has_bending_modes<Basis>)
          if (strain.assumes)
            return trial.assumed.points[k].F;
        return trial.motions[k].F;
      }

      void
      keep(const Motion         &motion,
           const PointView<dim> &points,
           const std::size_t     p) const
      {
        points.pressure[p] = motion.state.pressure;
        for (unsigned int k = 0; k < motion.state.deviator.size(); ++k)
          points.deviator[k][p] = motion.state.deviator[k];
        for (unsigned int k = 0; k < motion.state.history.size(); ++k)
          points.history[k][p] = motion.state.history[k];
      }

      static void
      keep_deformation(const Matrix         &F,
                       const PointView<dim> &points,
                       const std::size_t     p)
      {
        for (int d = 0; d < dim; ++d)
          for (int e = 0; e < dim; ++e)
            points.deformation[d * dim + e][p] = F[d][e];
      }

      double
      move(const PointView<dim>                               &points,
           const GridView<dim>                                &grid,
           const std::array<std::array<double, dim>, n_nodes> &u,
           const CellBatch                                    &batch) const
      {
        const auto &inverse_edge = grid.cells[batch.cell].inverse_edge;
        double      longest      = 0;
        for (std::size_t p = batch.begin; p < batch.end; ++p)
          {
            const BasisFunctions<Basis> functions =
              Strain::functions_at(points, grid, batch.cell, p);
            for (int d = 0; d < dim; ++d)
              {
                double way = 0;
                for (int i = 0; i < n_nodes; ++i)
                  way += functions.value[i] * u[i][d];
                points.position[d][p] += way;
                longest = std::max(longest, std::abs(way) * inverse_edge[d]);
              }
          }
        if (!strain.initial)
          locate(points, grid, batch.cell, batch.begin, batch.end);
        return longest;
      }

      const Strain                   strain;
      const TrialTangent<Basis, Law> tangent;
    };
  } // namespace



  template <int dim>
  std::unique_ptr<const TrialStress<dim>>
  make_trial_stress(const std::string         &name,
                    const std::vector<double> &values,
                    const Treatment            kind,
                    const HourglassResponse    response,
                    const Frame                frame,
                    const KernelKind           kernel)
  {
    const bool on_splines = kernel == KernelKind::quadratic;
    if (kind != Treatment::none && kind != Treatment::cell &&
        (kind != Treatment::assumed_strain || on_splines))
      throw std::logic_error("no tangent of this treatment");
    if (on_splines ? frame != Frame::initial : kernel != KernelKind::linear)
      throw std::logic_error("no tangent with these functions");
    std::unique_ptr<const TrialStress<dim>> result;
    for_each_law([&](auto *const candidate) {
      using Law = std::remove_pointer_t<decltype(candidate)>;
      if constexpr (Law::is_elastic || Law::is_plastic)
        {
          if (result || name != Law::name)
            return;
          std::array<double, Law::parameters.size()> own;
          if (values.size() != own.size())
            throw std::logic_error("wrong number of parameters for " + name);
          std::copy(values.begin(), values.end(), own.begin());
          if (!Law::accepts(own))
            return;
          const Law             law(own);
          const StrainTreatment treatment =
            strain_treatment(law, kind, response);
          if (on_splines)
            {
              result =
                std::make_unique<LawTrialStress<Quadratic<dim>, Law>>(law,
                                                                      treatment,
                                                                      frame);
              return;
            }
          result = std::make_unique<LawTrialStress<Linear<dim>, Law>>(law,
                                                                      treatment,
                                                                      frame);
        }
    });
    if (!result)
      throw std::logic_error("no law of a solid " + name);
    return result;
  }



  template std::unique_ptr<const TrialStress<2>>
  make_trial_stress(const std::string &,
                    const std::vector<double> &,
                    Treatment,
                    HourglassResponse,
                    Frame,
                    KernelKind);
  template std::unique_ptr<const TrialStress<3>>
  make_trial_stress(const std::string &,
                    const std::vector<double> &,
                    Treatment,
                    HourglassResponse,
                    Frame,
                    KernelKind);
} // namespace limber
