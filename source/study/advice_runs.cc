// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/study/advice_runs.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

namespace limber
{
  namespace
  {
    namespace fs = std::filesystem;

    /** A folder for one run, gone when this goes. */
    struct ScratchFolder
    {
      ScratchFolder()
        : path((fs::temp_directory_path() /
                ("limber-advise-" + std::to_string(getpid())))
                 .string())
      {
        fs::remove_all(path);
        fs::create_directories(path);
      }

      ~ScratchFolder()
      {
        std::error_code ignored;
        fs::remove_all(path, ignored);
      }

      const std::string path;
    };



    /** Column of an observable: a second one of the name of a total. */
    const std::vector<double> *
    column(const Table &table, const std::string &name)
    {
      auto found = table.find(name + " 2");
      if (found == table.end())
        found = table.find(name);
      return found == table.end() ? nullptr : &found->second;
    }



    /** Linear interpolation between rows; exact at a row up to round-off. */
    double
    at_time(const std::vector<double> &times,
            const std::vector<double> &values,
            const double               time)
    {
      const auto next = std::lower_bound(times.begin(), times.end(), time);
      if (next == times.begin())
        return values.front();
      if (next == times.end())
        return values.back();
      const std::size_t i = next - times.begin();
      const double share  = (time - times[i - 1]) / (times[i] - times[i - 1]);
      // NaN in the row before must not spoil a value that is known.
      return share == 1 ? values[i] :
                          (1 - share) * values[i - 1] + share * values[i];
    }



    /** L2 norm of the difference over that of the change from the start. */
    double
    relative_change(const std::vector<double> &times,
                    const std::vector<double> &values,
                    const std::vector<double> &other_times,
                    const std::vector<double> &other,
                    const double               until,
                    const double               scale)
    {
      double difference = 0, size = 0, weights = 0;
      for (std::size_t i = 1; i < times.size() && times[i] <= until; ++i)
        {
          const double weight = times[i] - times[i - 1];
          const double gap = at_time(other_times, other, times[i]) - values[i];
          const double own = values[i] - values[0];
          if (!std::isfinite(own))
            continue;
          if (!std::isfinite(gap))
            return std::numeric_limits<double>::infinity();
          difference += weight * gap * gap;
          size += weight * own * own;
          weights += weight;
        }
      if (scale > 0)
        size = weights * scale * scale;
      return difference == 0 ? 0 : std::sqrt(difference / size);
    }



    void
    note(const double change, const std::string &quantity, Effect &effect)
    {
      // NaN counts as the largest
      if (std::isnan(effect.change) || change <= effect.change)
        return;
      effect.change   = change;
      effect.quantity = quantity;
    }



    template <int dim>
    void
    compare_checks(const Problem<dim> &problem,
                   const Trial        &scene,
                   const Trial        &changed,
                   Effect             &effect)
    {
      for (const Check &check : problem.checks)
        {
          const auto is_it = [&](const RecordedCheck &other) {
            return other.name == check.name;
          };
          const auto own =
            std::find_if(scene.checks.begin(), scene.checks.end(), is_it);
          const auto other =
            std::find_if(changed.checks.begin(), changed.checks.end(), is_it);
          if (own == scene.checks.end() || other == changed.checks.end())
            continue;
          const auto passes = [&](const double value) {
            return std::abs(value - check.reference) <= check.tolerance;
          };
          if (passes(own->value) && !passes(other->value))
            effect.missed_check = check.name;
          if (check.reference != 0 && std::isfinite(own->value))
            note(std::abs(other->value - own->value) /
                   std::abs(check.reference),
                 "check " + in_quotes(check.name),
                 effect);
        }
    }



    void
    compare_energies(const Trial &scene, const Trial &changed, Effect &effect)
    {
      const auto &kinetic = scene.table.at("kinetic energy");
      const auto &strain  = scene.table.at("strain energy");
      double      scale   = 0;
      for (std::size_t i = 0; i < kinetic.size(); ++i)
        scale = std::max(scale, kinetic[i] + std::abs(strain[i]));
      for (const char *const name : {"kinetic energy", "strain energy"})
        note(relative_change(scene.table.at("time"),
                             scene.table.at(name),
                             changed.table.at("time"),
                             changed.table.at(name),
                             effect.until,
                             scale),
             name,
             effect);
    }



    /** Energies are compared with their largest value, as they may be constant;
     * other quantities with their change. */
    double
    scale_of(const std::string &unit, const std::vector<double> &values)
    {
      double largest = 0;
      if (unit == "J")
        for (const double value : values)
          largest = std::max(largest, std::abs(value));
      return largest;
    }



    double
    largest_of(const std::vector<double> &values, const double origin)
    {
      double result = 0;
      for (const double value : values)
        if (std::isfinite(value))
          result = std::max(result, std::abs(value - origin));
      return result;
    }



    /** Whether it is constant up to round-off, relative to all quantities of
     * the same unit: then it has no change to compare with. */
    template <int dim>
    bool
    stays(const Problem<dim>        &problem,
          const Trial               &scene,
          const std::string         &unit,
          const std::vector<double> &values)
    {
      constexpr double round_off = 1e-9;
      double           largest   = 0;
      for (const Observable<dim> &observable : problem.observables)
        if (const auto *const any = column(scene.table, observable.name);
            any != nullptr && observable.unit == unit)
          largest = std::max(largest, largest_of(*any, 0));
      return largest_of(values, values.front()) <= round_off * largest;
    }



    template <int dim>
    void
    compare_observables(const Problem<dim> &problem,
                        const Trial        &scene,
                        const Trial        &changed,
                        Effect             &effect)
    {
      const auto &times = scene.table.at("time");
      const auto &other = changed.table.at("time");
      for (const Observable<dim> &observable : problem.observables)
        {
          const auto *const own  = column(scene.table, observable.name);
          const auto *const with = column(changed.table, observable.name);
          if (own == nullptr || with == nullptr ||
              stays(problem, scene, observable.unit, *own))
            continue;
          const std::string name = in_quotes(observable.name);
          if (observable.kind->looks_at != ObservedPart::column)
            note(relative_change(times,
                                 *own,
                                 other,
                                 *with,
                                 effect.until,
                                 scale_of(observable.unit, *own)),
                 name,
                 effect);
          else if (const double last = at_time(times, *own, effect.until);
                   std::isfinite(last))
            note(std::abs(at_time(other, *with, effect.until) / last - 1),
                 name,
                 effect);
        }
    }
  } // namespace



  Trial
  try_scene(const std::string              &scene,
            const std::vector<std::string> &settings,
            const double                    seconds)
  {
    const ScratchFolder      scratch;
    const std::string        folder  = scratch.path + "/run";
    std::vector<std::string> command = {this_program(), scene};
    for (const std::string &setting : settings)
      command.insert(command.end(), {"--set", setting});
    command.insert(command.end(),
                   {"--output-directory",
                    folder,
                    "--set",
                    "Output/Time interval=0",
                    "--set",
                    "Output/Point arrays=false",
                    "--set",
                    "Output/Replace=false"});
    const ChildEnd end = run_child(command, scratch.path + "/log", seconds);

    Trial trial;
    trial.outcome = outcome_of(end, folder);
    if (!fs::exists(folder + "/summary.json"))
      return trial;
    const RecordedSummary summary = read_summary(folder);
    trial.table                   = read_statistics(folder);
    trial.checks                  = summary.checks;
    trial.until                   = trial.table.at("time").back();
    const auto cpu                = summary.numbers.find("cpu_seconds");
    trial.cpu = cpu == summary.numbers.end() ? end.seconds : cpu->second;
    return trial;
  }



  template <int dim>
  Effect
  compare_trials(const Problem<dim> &problem,
                 const Trial        &scene,
                 const Trial        &changed)
  {
    Effect effect;
    effect.until = std::min(scene.until, changed.until);
    effect.is_whole =
      scene.outcome == "finished" && changed.outcome == "finished";
    if (scene.table.empty() || changed.table.empty() || effect.until <= 0)
      return effect;
    effect.factor = (scene.cpu / scene.until) / (changed.cpu / changed.until);
    compare_observables(problem, scene, changed, effect);
    if (problem.observables.empty())
      compare_energies(scene, changed, effect);
    if (effect.is_whole)
      compare_checks(problem, scene, changed, effect);
    return effect;
  }



  double
  longest_way(const Table &table, const double edge)
  {
    const auto &time  = table.at("time");
    const auto &speed = table.at("largest velocity");
    double      way   = 0;
    for (std::size_t i = 1; i < time.size(); ++i)
      way += (time[i] - time[i - 1]) * std::max(speed[i - 1], speed[i]);
    return way / edge;
  }



  JudgedAdvice
  judge_advice(const Advice &advice,
               const Trial  &changed,
               const Effect &effect,
               const double  error,
               const double  way)
  {
    // below this a saving is lost in what a machine does besides
    constexpr double least_factor = 1.03;
    const bool       ran =
      changed.outcome == "finished" || changed.outcome == "time limit";
    if (!ran)
      return {Judgement::refused, "the run with it ends: " + changed.outcome};
    if (effect.until <= 0)
      return {Judgement::refused,
              "its first steps take longer than '--seconds'"};
    if (!effect.missed_check.empty())
      return {Judgement::refused,
              "check " + in_quotes(effect.missed_check) + " is missed with it"};
    if (effect.factor < least_factor && advice.memory == 0)
      return {Judgement::refused, "no time is saved"};
    if (!(effect.change <= error))
      return {Judgement::trade, "it changes more than was asked for"};
    if (way > advice.longest_way)
      return {Judgement::trade,
              "points may pass " + brief(way) +
                " cells, where fewer of them creep more"};
    if (!effect.is_whole && !advice.is_exact)
      return {Judgement::trade,
              "what comes later was not computed; give '--seconds' more"};
    return {Judgement::advised, "runs with and without it"};
  }



  template Effect
  compare_trials(const Problem<2> &, const Trial &, const Trial &);
  template Effect
  compare_trials(const Problem<3> &, const Trial &, const Trial &);
} // namespace limber
