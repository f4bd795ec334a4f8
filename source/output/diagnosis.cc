// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/text.h>
#include <limber/output/diagnosis.h>
#include <limber/problem/filter_bound.h>

#include <algorithm>
#include <string>

/** @file From symptoms to the numerical failure mode and its remedy. */
namespace limber
{
  namespace
  {
    std::string
    percent_of(const double share)
    {
      return brief(100 * share) + " %";
    }



    /**
     * Small-cut instability. USL needs C < sqrt(2 xi) where a cell at the
     * surface of a body is filled to xi; in full cells it is stable to 0.7.
     * Points that cross cells pass through every xi, so the present one need
     * not have started it. It is an instability of sound, which semi-implicit
     * steps do not resolve. With FMPM(k) the limit is C < sqrt(2 xi / k).
     * Smooth kernels are exempt: in such a cell their functions are as small as
     * the forces.
     */
    template <int dim>
    Diagnosis
    find_cut_cell(const Symptoms     &symptoms,
                  const BodySymptoms &body,
                  const Problem<dim> &problem)
    {
      const Method &method         = problem.method;
      const double  courant_number = symptoms.courant_number;
      if (method.order != StressUpdateOrder::usl || courant_number > 0.7 ||
          method.integration == TimeIntegration::semi_implicit)
        return {};
      const bool filters = filters_velocity(method.transfer);
      if (filters && problem.grid.kernel != KernelKind::linear)
        return {};
      const unsigned int order =
        method.transfer == Transfer::fmpm ? method.transfer_order : 1;
      return {"small cut cell",
              std::string("with ") +
                (filters ? "a transfer that filters the velocity" :
                           "the stress update 'usl'") +
                ", Courant number " + brief(courant_number) +
                " fails in cells filled to less than " +
                brief(0.5 * order * courant_number * courant_number) +
                " edges (body '" + body.body +
                "' now: " + brief(2 * body.filling) + "). Set " +
                (!filters ?
                   "'Method/Stress update = auto'." :
                 problem.grid.against_splines.empty() ?
                   "'Method/Kernel = quadratic', or 'Transfer = flip'" +
                     entries_of_filter(method) + "." :
                   "'Method/Transfer = flip'" + entries_of_filter(method) +
                     ".")};
    }



    /**
     * The affine part of a point's motion has next to no inertia near an edge
     * of its cell, and is not bounded with AFLIP (doc/theory/transfers.md).
     * What else is seen then, a checkerboard or an inverted point, follows from
     * it.
     */
    template <int dim>
    Diagnosis
    find_affine_velocity(const Problem<dim> &problem)
    {
      if (problem.method.transfer != Transfer::aflip ||
          problem.grid.kernel != KernelKind::linear)
        return {};
      return {"affine velocity",
              "with linear functions the transfer 'aflip' is unstable where "
              "points come near the edges of cells. Set " +
                std::string(problem.grid.against_splines.empty() ?
                              "'Method/Kernel = quadratic', or " :
                              "") +
                "'Method/Transfer = flip'."};
    }



    /** In liquids that are stirred the volume ratios of points drift apart
     * while the means of cells stay right. */
    template <int dim>
    std::string
    remedy_for_crushed(const BodySymptoms &of_body, const Problem<dim> &problem)
    {
      for (const Body<dim> &body : problem.bodies)
        if (body.name == of_body.body && body.is_liquid &&
            averages_volume_in_cells(body.treatment) &&
            body.history == HistoryTreatment::keep)
          return "Set 'Body " + body.name + "/History = replace'.";
      return "Refine 'Grid/Cells' or load more slowly.";
    }



    template <int dim>
    Diagnosis
    diagnose_unstable(const Symptoms &symptoms, const Problem<dim> &problem)
    {
      if (const auto found = find_affine_velocity(problem); !found.mode.empty())
        return found;
      for (const BodySymptoms &body : symptoms.bodies)
        {
          const auto found = find_cut_cell(symptoms, body, problem);
          if (!found.mode.empty())
            return found;
        }
      // Only if the step is prescribed; one from the Courant number is within
      // this bound.
      if (const double bound = courant_number_of_filter(problem);
          symptoms.courant_number > bound * (1 + 1e-6))
        return {"Courant number",
                "the last step had Courant number " +
                  brief(symptoms.courant_number) + ", and the transfer holds " +
                  brief(bound) +
                  ". Set 'Method/Time step = 0', or 'Transfer = flip'" +
                  entries_of_filter(problem.method) + "."};
      // MUSL and USF are stable to 1.3 and more in full cells, with and without
      // locking treatment.
      if (symptoms.courant_number > 1)
        return {"Courant number",
                "the last step had Courant number " +
                  brief(symptoms.courant_number) +
                  ", beyond what the stress update holds. Set 'Method/Courant "
                  "number = 0.4' and 'Method/Time step = 0'."};
      for (const BodySymptoms &body : symptoms.bodies)
        {
          constexpr double crushed = 0.1; // of the initial volume
          if (body.smallest_volume < crushed)
            return {"inverted point",
                    "a point of body '" + body.body + "' has " +
                      brief(body.smallest_volume) + " of its volume left. " +
                      remedy_for_crushed(body, problem)};
        }
      return {};
    }



    template <int dim>
    unsigned int
    points_per_edge(const Body<dim> &body)
    {
      return *std::max_element(body.points_per_cell_edge.begin(),
                               body.points_per_cell_edge.end());
    }



    /**
     * Damps the pressure pattern, or else the hourglass motion that causes it.
     */
    template <int dim>
    std::string
    remedy_for_checkerboard(const Body<dim> &body)
    {
      if (averages_volume_in_cells(body.treatment) &&
          body.checkerboard_control == 0)
        return "Checkerboard control = 0.5";
      return "Hourglass control = " +
             brief(std::max(0.2, 2 * body.hourglass_control));
    }



    /** By the kernel, as 'auto' may have chosen no treatment. */
    std::string
    remedy_for_locking(const KernelKind kernel)
    {
      return kernel == KernelKind::linear ? "cell" : "node";
    }



    template <int dim>
    Diagnosis
    diagnose_wrong(const Symptoms &symptoms, const Problem<dim> &problem)
    {
      for (std::size_t b = 0; b < symptoms.bodies.size(); ++b)
        {
          const BodySymptoms &body  = symptoms.bodies[b];
          const std::string   start = "Body " + body.body + "/";
          const bool averaged = problem.bodies[b].treatment != Treatment::none;
          if (!averaged && body.pressure_scatter > 1)
            return {"locking",
                    "in cells of body '" + body.body +
                      "' the pressure scatters by " +
                      brief(body.pressure_scatter) + " times its mean. Set '" +
                      start + "Locking treatment = " +
                      remedy_for_locking(problem.grid.kernel) + "'."};
          if (averaged && body.checkerboard > 1)
            return {"checkerboard",
                    "neighbouring cells of body '" + body.body +
                      "' differ in pressure by " + brief(body.checkerboard) +
                      " times its size. Set '" + start +
                      remedy_for_checkerboard(problem.bodies[b]) + "'."};
          if (body.isolated_cells > 0.05)
            return {"lost contact",
                    percent_of(body.isolated_cells) +
                      " of the cells of body '" + body.body +
                      "' touch no other one. Set '" + start +
                      "Points per cell edge = " +
                      std::to_string(2 * points_per_edge(problem.bodies[b])) +
                      "', more than the largest stretch."};
        }
      return {};
    }
  } // namespace



  namespace
  {
    /**
     * Hourglass modes cause it in liquids, which hourglass control damps; in
     * solids PIC damping does (blend time). APIC velocities contain no motion
     * that the grid does not see, but gain energy where points cross cells
     * (doc/theory/transfers.md).
     */
    template <int dim>
    std::string
    remedy_for_unseen_motion(const Problem<dim> &problem)
    {
      for (const Body<dim> &body : problem.bodies)
        if (body.is_liquid && body.treatment != Treatment::none &&
            body.hourglass_control == 0 && !is_spline(problem.grid.kernel))
          return "Body " + body.name + "/Hourglass control = 0.2'.";
      constexpr double share = 0.05; // twenty periods in the run
      return "Method/Blend time = " + brief(share * problem.end_time) +
             "' or the shortest time of interest.";
    }
  } // namespace



  template <int dim>
  Diagnosis
  diagnose(const Symptoms     &symptoms,
           const Problem<dim> &problem,
           const bool          unstable)
  {
    // There Newton's method has reported what is not in equilibrium.
    if (is_solved_by_newton(problem.method.integration))
      return {};
    if (unstable)
      {
        Diagnosis found = diagnose_unstable(symptoms, problem);
        if (!found.mode.empty())
          {
            found.is_unstable = true;
            return found;
          }
      }
    const Diagnosis found = diagnose_wrong(symptoms, problem);
    if (!found.mode.empty())
      return found;
    constexpr double much = 0.3; // of the kinetic energy
    if (symptoms.unseen_energy > much &&
        (problem.method.transfer == Transfer::flip ||
         problem.method.transfer == Transfer::aflip))
      return {"null space",
              percent_of(symptoms.unseen_energy) +
                " of the kinetic energy is unseen by the nodes. Set '" +
                remedy_for_unseen_motion(problem)};
    return {};
  }



  template Diagnosis
  diagnose<2>(const Symptoms &, const Problem<2> &, bool);
  template Diagnosis
  diagnose<3>(const Symptoms &, const Problem<3> &, bool);
} // namespace limber
