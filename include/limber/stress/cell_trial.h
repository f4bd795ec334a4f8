// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_cell_trial_h
#define limber_stress_cell_trial_h

#include <limber/interpolation/basis.h>
#include <limber/materials/frame.h>
#include <limber/materials/further_deformation.h>
#include <limber/stress/assumed_trial.h>

#include <array>
#include <vector>

namespace limber
{
  /** How a point is strained in a trial, and how it resists. */
  template <class Basis, class Law>
  struct TrialMotion
  {
    static constexpr int  dim    = Basis::dim;
    static constexpr bool finite = Law::finite_strain;
    using State                  = typename Law::template State<dim, double>;

    // of the functions where forces act, 1/m
    std::array<std::array<double, dim>, Basis::n_nodes> gradient;
    // From where the functions are: of the step, or F in the initial frame; as
    // it is assumed where it is
    SquareMatrix<dim> F;
    // What the state is deformed by: F, or in the initial frame, where the law
    // flows, that of the step
    SquareMatrix<dim> f;
    double            growth;       // of the volume by f, the point's own
    double            volume;       // at the start, m^dim
    double            share;        // of its growth in the mean of the cell
    double            former_ratio; // volume ratio that the growth belongs to
    State             state;
    State             start;            // where the law flows, before the step
    double            acting       = 1; // growth that the state has followed
    double            plastic_work = 0; // per volume at the start, Pa
    // In the tangent: rows of the deviator, and derivative of the energy by
    // the growth that acts, per volume at the start, Pa
    SquareMatrix<dim> stress;
    double            slope;

    /** Kirchhoff, that of the points of the cell, as it acts at this one, Pa.
     */
    double
    mean_stress() const
    {
      return slope * (finite ? growth : 1.);
    }

    /** First Piola and Kirchhoff's, Pa. */
    SquareMatrix<dim>
    piola() const
    {
      SquareMatrix<dim> result = stress;
      const double      mean   = mean_stress();
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



  /** Stands for AssumedTrial where the functions have no bending modes. */
  struct NoAssumedTrial
  {};



  /** Of the points of a cell. */
  template <class Basis, class Law>
  struct CellTrial
  {
    static constexpr int dim = Basis::dim;

    std::array<std::array<double, dim>, Basis::n_nodes> u; // of nodes, m
    std::vector<TrialMotion<Basis, Law>>                motions;
    using Assumed = std::conditional_t<has_bending_modes<Basis>,
                                       AssumedTrial<dim, Law::finite_strain>,
                                       NoAssumedTrial>;
    Assumed assumed;
    Assumed assumed_before; // in the initial frame, where the law flows
    double  volume = 0;     // of all at the start, m^dim
    double  slope = 0, curvature = 0; // of the energy, by mean growth, J

    /** First Piola and Kirchhoff's, Pa, of all points. */
    std::vector<SquareMatrix<dim>>
    piola() const
    {
      std::vector<SquareMatrix<dim>> result;
      result.reserve(motions.size());
      for (const auto &motion : motions)
        result.push_back(motion.piola());
      return result;
    }
  };
} // namespace limber

#endif
