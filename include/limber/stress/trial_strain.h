// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_trial_strain_h
#define limber_stress_trial_strain_h

#include <limber/interpolation/basis_functions.h>
#include <limber/points/cell_batch.h>
#include <limber/stress/cell_trial.h>
#include <limber/stress/strain_treatment.h>

#include <algorithm>

namespace limber
{
  /**
   * Strains the points of a cell by trial displacements of its nodes and
   * computes their states, without changing the points (TrialStress). The
   * growth of the volume is the mean of the cell with Treatment::cell, else
   * that of the point.
   */
  template <class Basis, class Law>
  class TrialStrain
  {
    static constexpr int  dim     = Basis::dim;
    static constexpr int  n_nodes = Basis::n_nodes;
    static constexpr bool finite  = Law::finite_strain;
    static constexpr bool flows   = Law::is_plastic;
    using Matrix                  = SquareMatrix<dim>;
    using Motion                  = TrialMotion<Basis, Law>;
    using Trial                   = CellTrial<Basis, Law>;

  public:
    TrialStrain(const Law             &law,
                const StrainTreatment &treatment,
                const Frame            frame)
      : law(law)
      , mean_volume(treatment.kind == Treatment::cell)
      , assumes(treatment.kind == Treatment::assumed_strain)
      , initial(frame == Frame::initial)
      , treatment(treatment)
    {}

    /** Kinematics and states; false if a point is inverted. */
    bool
    operator()(const PointView<dim> &points,
               const GridView<dim>  &grid,
               const double *const   displacement,
               const CellBatch      &batch,
               Trial                &trial) const
    {
      const auto &nodes = Basis::nodes_of(grid, batch.cell).node;
      for (int i = 0; i < n_nodes; ++i)
        std::copy_n(displacement +
                      std::size_t(nodes[i]) / NodeLayout<dim>::stride * dim,
                    dim,
                    trial.u[i].begin());

      trial.functions.clear();
      for (std::size_t p = batch.begin; p < batch.end; ++p)
        trial.functions.push_back(functions_at(points, grid, batch.cell, p));

      trial.motions.resize(batch.end - batch.begin);
      trial.volume       = 0;
      double mean_growth = 0, volume_before = 0;
      for (std::size_t p = batch.begin; p < batch.end; ++p)
        {
          Motion &motion = trial.motions[p - batch.begin];
          if (!deform(
                points, p, trial.functions[p - batch.begin], trial.u, motion))
            return false;
          trial.volume += motion.volume;
          volume_before += motion.share;
        }
      for (Motion &motion : trial.motions)
        {
          motion.share /= volume_before;
          mean_growth += motion.share * motion.growth;
        }
      if constexpr (has_bending_modes<Basis>)
        if (assumes && !assume(points, batch, trial))
          return false;

      trial.slope = trial.curvature = 0;
      for (std::size_t p = batch.begin; p < batch.end; ++p)
        {
          Motion      &motion = trial.motions[p - batch.begin];
          const double growth = mean_volume ? mean_growth : motion.growth;
          set_state(points, p, growth, motion);
          motion.slope  = slope(motion, growth);
          motion.stress = rows_of<dim>(motion.state.deviator);
          if (mean_volume)
            {
              trial.slope += motion.volume * motion.slope;
              trial.curvature += motion.volume * curvature(motion, growth);
            }
        }
      if (mean_volume)
        for (Motion &motion : trial.motions)
          motion.slope = trial.slope * motion.share / motion.volume;
      return true;
    }

    /**
     * Derivative of the volumetric energy by the growth that acts, per initial
     * volume, Pa: J p = - J dU/dJ.
     */
    static double
    slope(const Motion &motion, const double growth)
    {
      return finite ? -motion.state.pressure / growth : -motion.state.pressure;
    }

    /** Its derivative, Pa; zero for a plastic law, see FlowRates. */
    double
    curvature(const Motion &motion, const double growth) const
    {
      if constexpr (flows)
        return 0;
      else
        {
          const double J = motion.former_ratio;
          return finite ? J * J * law.volumetric_stiffness(J * growth) :
                          law.volumetric_stiffness(1.);
        }
    }

    /**
     * The functions of the nodes of its cell, where the forces of a point act.
     */
    static BasisFunctions<Basis>
    functions_at(const PointView<dim> &points,
                 const GridView<dim>  &grid,
                 const std::uint32_t   cell,
                 const std::size_t     p)
    {
      return {natural_place(points, grid.cells[cell], p), grid, cell};
    }

    const FurtherDeformation<Law> law;
    const bool                    mean_volume, assumes, initial;
    const StrainTreatment         treatment;

  private:
    // Apply the assumed strain; false as above.
    bool
    assume(const PointView<dim> &points,
           const CellBatch      &batch,
           Trial                &trial) const
    {
      auto &assumed = trial.assumed;
      assumed.points.resize(trial.motions.size());
      for (std::size_t k = 0; k < trial.motions.size(); ++k)
        {
          const BasisFunctions<Basis> &functions = trial.functions[k];
          assumed.points[k]                      = {trial.motions[k].F,
                                                    functions.xi,
                                                    trial.motions[k].volume,
                                                    functions.gradient};
        }
      if (!assumed.finish(treatment))
        return false;
      auto &before = trial.assumed_before;
      if (follows_steps())
        {
          before.points = assumed.points;
          for (std::size_t k = 0; k < before.points.size(); ++k)
            before.points[k].F = deformation_before(points, batch.begin + k);
          if (!before.finish(treatment))
            return false;
        }
      for (std::size_t k = 0; k < trial.motions.size(); ++k)
        {
          Motion &motion = trial.motions[k];
          motion.F       = assumed.deformation(k);
          if (!set_further(follows_steps() ? before.deformation(k) : Matrix(),
                           motion))
            return false;
          motion.growth = assumed.volume_ratio(k);
          if (finite && !(motion.growth > 0))
            return false;
          if (follows_steps())
            motion.growth /= before.volume_ratio(k);
        }
      return true;
    }

    /** Whether F is relative to the initial frame, but states follow steps. */
    bool
    follows_steps() const
    {
      return flows && initial;
    }

    /** F at the start of the step. */
    static Matrix
    deformation_before(const PointView<dim> &points, const std::size_t p)
    {
      Matrix F;
      for (int d = 0; d < dim; ++d)
        for (int e = 0; e < dim; ++e)
          F[d][e] = points.deformation[d * dim + e][p];
      return F;
    }

    // Set f and its growth from F and, if states follow steps, the F before;
    // false as above.
    bool
    set_further(const Matrix &before, Motion &motion) const
    {
      motion.f      = motion.F;
      motion.growth = volume_ratio(motion.F);
      if (finite && !(motion.growth > 0))
        return false;
      if constexpr (flows)
        if (initial)
          {
            motion.f = times_inverse<dim>(motion.F, before);
            motion.growth /= determinant<dim>(before);
          }
      return true;
    }

    static double
    volume_ratio(const Matrix &f)
    {
      if constexpr (finite)
        return determinant<dim>(f);
      double result = 1;
      for (int d = 0; d < dim; ++d)
        result += f[d][d] - 1;
      return result;
    }

    bool
    deform(const PointView<dim>                               &points,
           const std::size_t                                   p,
           const BasisFunctions<Basis>                        &functions,
           const std::array<std::array<double, dim>, n_nodes> &u,
           Motion                                             &motion) const
    {
      for (int d = 0; d < dim; ++d)
        for (int e = 0; e < dim; ++e)
          {
            double &entry = motion.F[d][e];
            entry = initial ? points.deformation[d * dim + e][p] : d == e;
            for (int i = 0; i < n_nodes; ++i)
              entry += u[i][d] * functions.gradient[i][e];
          }
      motion.volume   = points.mass[p] / law.density;
      motion.share    = motion.volume;
      motion.gradient = functions.gradient;
      Matrix before{};
      if constexpr (flows)
        if (initial)
          {
            before = deformation_before(points, p);
            motion.share *= determinant<dim>(before);
          }
      if (!set_further(before, motion))
        return false;
      if constexpr (!finite)
        return true;
      const Matrix cof   = cofactor<dim>(motion.F); // det(F) F^-T
      const double ratio = determinant<dim>(motion.F);
      for (int i = 0; i < n_nodes; ++i)
        for (int d = 0; d < dim; ++d)
          {
            double &entry = motion.gradient[i][d];
            entry         = 0;
            for (int e = 0; e < dim; ++e)
              entry += cof[d][e] * functions.gradient[i][e];
            entry /= ratio;
          }
      return true;
    }

    void
    set_state(const PointView<dim> &points,
              const std::size_t     p,
              const double          growth,
              Motion               &motion) const
    {
      auto &state = motion.state;
      if constexpr (!flows)
        if (initial)
          {
            motion.former_ratio = 1;
            state = law.template at_deformation<dim>(motion.f, growth);
            return;
          }
      state.pressure = points.pressure[p];
      for (unsigned int k = 0; k < state.deviator.size(); ++k)
        state.deviator[k] = points.deviator[k][p];
      for (unsigned int k = 0; k < state.history.size(); ++k)
        state.history[k] = points.history[k][p];
      motion.former_ratio = law.template volume_ratio<dim>(state);
      if constexpr (flows)
        {
          motion.start  = state;
          motion.acting = growth;
        }
      motion.plastic_work = law.template deform<dim>(motion.f, growth, state);
    }
  };
} // namespace limber

#endif
