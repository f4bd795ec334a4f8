// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_cell_trial_h
#define limber_stress_cell_trial_h

#include <limber/interpolation/basis.h>
#include <limber/interpolation/basis_functions.h>
#include <limber/materials/frame.h>
#include <limber/materials/further_deformation.h>
#include <limber/stress/assumed_tangent.h>

#include <array>
#include <vector>

namespace limber
{
  /** Kinematics and state of a point in a trial. */
  template <class Basis, class Law>
  struct TrialMotion
  {
    static constexpr int  dim    = Basis::dim;
    static constexpr bool finite = Law::finite_strain;
    using State                  = typename Law::template State<dim, double>;

    // gradients in the configuration where forces act, 1/m
    std::array<std::array<double, dim>, Basis::n_nodes> gradient;
    // Relative to the configuration of the functions: of the step, or F in the
    // initial frame; the assumed one with assumed strain
    SquareMatrix<dim> F;
    // The deformation applied to the state: F, or in the initial frame with a
    // plastic law that of the step
    SquareMatrix<dim> f;
    double            growth;       // of the volume by f, of the point alone
    double            volume;       // at the start, m^dim
    double            share;        // weight in the mean growth of the cell
    double            former_ratio; // volume ratio to which growth is relative
    State             state;
    State             start;            // plastic laws: state before the step
    double            acting       = 1; // growth that was applied to the state
    double            plastic_work = 0; // per volume at the start, Pa
    // For the tangent: the deviator, and the derivative of the energy by the
    // growth that acts, per initial volume, Pa
    SquareMatrix<dim> stress;
    double            slope;

    /**
     * Kirchhoff mean stress that acts on this point, averaged in the cell, Pa.
     */
    double
    mean_stress() const
    {
      return slope * (finite ? growth : 1.);
    }

    /** First Piola-Kirchhoff stress of the deviator and this Kirchhoff mean
     * stress, Pa. */
    SquareMatrix<dim>
    piola(const double mean) const
    {
      SquareMatrix<dim> result = stress;
      for (int d = 0; d < dim; ++d)
        result[d][d] += mean;
      if constexpr (finite)
        {
          const double ratio = determinant<dim>(F);
          result = times<dim>(result, cofactor<dim>(F)); // det(F) F^-T
          for (auto &row : result)
            for (double &entry : row)
              entry /= ratio;
        }
      return result;
    }
  };



  /** Replaces AssumedTangent for bases without bending modes. */
  struct NoAssumedTrial
  {};



  /** Kinematics and states of all points of a cell in a trial. */
  template <class Basis, class Law>
  struct CellTrial
  {
    static constexpr int dim = Basis::dim;

    std::array<std::array<double, dim>, Basis::n_nodes> u; // of nodes, m
    std::vector<BasisFunctions<Basis>>   functions;        // at the points
    std::vector<TrialMotion<Basis, Law>> motions;
    using Assumed = std::conditional_t<has_bending_modes<Basis>,
                                       AssumedTangent<dim, Law::finite_strain>,
                                       NoAssumedTrial>;
    Assumed assumed;
    Assumed assumed_before;           // before the step; plastic, initial frame
    double  volume = 0;               // of all at the start, m^dim
    double  slope = 0, curvature = 0; // derivatives of energy by mean growth, J

    /** Stress of all points with assumed strain. */
    auto
    assumed_stress() const
    {
      std::vector<typename Assumed::Stress> result;
      result.reserve(motions.size());
      for (std::size_t k = 0; k < motions.size(); ++k)
        if constexpr (Law::finite_strain)
          result.push_back(
            {motions[k].piola(0), motions[k].slope * growth_per_volume(k)});
        else
          result.push_back({motions[k].piola(motions[k].mean_stress()), 0});
      return result;
    }

    /** Derivative of the growth of a point by its assumed volume ratio. */
    double
    growth_per_volume(const std::size_t k) const
    {
      return motions[k].growth / assumed.volume_ratio(k);
    }
  };
} // namespace limber

#endif
