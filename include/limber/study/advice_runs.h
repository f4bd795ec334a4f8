// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_study_advice_runs_h
#define limber_study_advice_runs_h

#include <limber/problem/problem.h>
#include <limber/study/advice.h>
#include <limber/study/run_result.h>

#include <string>
#include <vector>

/** @file Judges an advice by runs with and without it. */
namespace limber
{
  /** One run of a scene, cut off after some time where it is long. */
  struct Trial
  {
    std::string                outcome;   // "finished", or what went wrong
    double                     until = 0; // s of motion that were computed
    double                     cpu   = 0; // CPU seconds for them
    Table                      table;     // its statistics
    std::vector<RecordedCheck> checks;
  };

  /** In a process of its own, @p seconds of wall time at most. */
  Trial
  try_scene(const std::string              &scene,
            const std::vector<std::string> &settings,
            const double                    seconds);

  /** Differences of a run from that of the scene as it is. */
  struct Effect
  {
    double      factor = 1;       // CPU time of the scene over that of the run
    double      until  = 0;       // s of motion that both have computed
    double      change = 0;       // largest of all quantities, relative
    std::string quantity;         // which
    std::string missed_check;     // that the scene as it is passes
    bool        is_whole = false; // both ran to the end
  };

  /**
   * Observables over time, in the L2 norm relative to that of their own change
   * from the start, energies to the largest value; frequencies at the end;
   * checked values relative to their references. Where a scene has no
   * observable, kinetic and strain energy relative to the largest sum of both.
   */
  template <int dim>
  Effect
  compare_trials(const Problem<dim> &problem,
                 const Trial        &scene,
                 const Trial        &changed);

  /** Upper bound of the number of cells that a point has crossed: the largest
   * velocity, integrated over time, over @p edge of a cell. */
  double
  longest_way(const Table &table, const double edge);

  /** Verdict on an advice. */
  enum class Judgement
  {
    advised, // saves time or memory, changes less than the error asked for
    trade,   // changes more, or what it changes is not known to the end
    refused  // fails, misses a check, or saves nothing
  };

  /** A verdict with its reason. */
  struct JudgedAdvice
  {
    Judgement   judgement = Judgement::refused;
    std::string ground;
  };

  /** @p way: longest_way() of the scene as it is. */
  JudgedAdvice
  judge_advice(const Advice &advice,
               const Trial  &changed,
               const Effect &effect,
               const double  error,
               const double  way);
} // namespace limber

#endif
