// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_simulation_run_state_h
#define limber_simulation_run_state_h

#include <limber/adaptation/adaptation.h>
#include <limber/output/checks.h>
#include <limber/output/observables.h>
#include <limber/output/writer.h>
#include <limber/time/integrator.h>

#include <map>
#include <string>
#include <vector>

namespace limber
{
  /** The state of a run at the end of a step, besides its points. */
  template <int dim>
  struct RunState
  {
    unsigned long                       step      = 0;
    double                              time      = 0; // s
    double                              step_size = 0; // of the last step, s
    Ledger<dim>                         ledger;        // over all ranks
    IntegratorState<dim>                integrator;
    BalanceState<dim>                   balance;
    ObservablesState<dim>               observables;
    std::vector<CheckedValue>           checks;
    WriterState                         pictures;
    AdaptationState                     adaptation;
    double                              next_pictures     = 0; // s
    std::uint64_t                       statistics_length = 0; // bytes
    std::map<std::string, unsigned int> warnings;
  };

  /** As bytes, for the array `run` of a checkpoint. */
  template <int dim>
  std::vector<char>
  to_bytes(const RunState<dim> &state);

  /** Throws std::runtime_error where the bytes are not such a state. */
  template <int dim>
  RunState<dim>
  to_run_state(const std::vector<char> &bytes);

  /** Why a state cannot belong to the run whose initial state is @p start: "has
   * values in 'run' that are not finite"; empty: it can. */
  template <int dim>
  std::string
  fault_of(const RunState<dim> &state, const RunState<dim> &start);
} // namespace limber

#endif
