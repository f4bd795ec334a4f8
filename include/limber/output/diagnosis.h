// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_diagnosis_h
#define limber_output_diagnosis_h

#include <limber/state/material_body.h>

#include <string>
#include <vector>

namespace limber
{
  /** Indicators for one body that tell failure modes apart. */
  struct BodySymptoms
  {
    std::string body;
    double      smallest_volume = 1; // smallest J of the points
    // Half the filling of the smallest cut cell: smallest mean distance of the
    // points of a cell from the side on which they enter it, in edges, where
    // the cell beyond the opposite side is empty
    double filling = 1;
    // Rms of the pressures of points about the mean of their cell, over the
    // rms of these means; before any averaging
    double pressure_scatter = 0;
    // Rms difference between the pressure of a cell and the mean of its two
    // neighbours along an axis, over the rms of the pressures: 0 for a linear
    // field, 2 for a checkerboard
    double checkerboard = 0;
    // Share of occupied cells that share no node with another occupied one
    double isolated_cells = 0;
  };

  /** Indicators for a run at one moment. */
  struct Symptoms
  {
    double courant_number = 0;                // of the last step
    double unseen_energy  = 0;                // null-space share of the kinetic
                                              // energy, which the nodes do not
                                              // see
    unsigned long             not_finite = 0; // points
    std::vector<BodySymptoms> bodies;
  };

  /** The failure mode that a run has most likely run into. */
  struct Diagnosis
  {
    std::string mode; // "small cut cell", ...; empty: nothing stands out
    std::string text; // the numbers that show it and the entry to change
    bool        is_unstable = false; // stops runs and ejects points
  };

  /** Smallest edge of the cells that hold points, m: the one that limits
   * explicit steps. Collective. */
  template <int dim>
  double
  smallest_edge_with_points(const State<dim> &state);

  /**
   * Evaluates the points; @p signal_speed: wave speed plus speed of the points,
   * m/s. Costs as much as some steps. Collective; only rank 0 gets an answer.
   */
  template <int dim>
  Symptoms
  find_symptoms(const State<dim> &state, const double signal_speed);

  /** The likeliest failure mode; @p unstable: the run was stopped, else it
   * finished but missed a check. Thresholds stand beside the code. */
  template <int dim>
  Diagnosis
  diagnose(const Symptoms     &symptoms,
           const Problem<dim> &problem,
           const bool          unstable);
} // namespace limber

#endif
