// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/output/files.h>
#include <limber/output/json.h>
#include <limber/output/run_folder.h>
#include <limber/output/statistics.h>
#include <limber/problem/read_problem.h>
#include <limber/study/compare.h>
#include <limber/study/field_source.h>
#include <limber/study/run_result.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <limits>
#include <sstream>

namespace limber
{
  namespace
  {
    // Times closer than this share of the last one are the same.
    constexpr double same_times = 1e-7;



    /** L2 and maximum norm of the difference of one quantity over points and
     * times. */
    struct Difference
    {
      double squared = 0, squared_scale = 0; // weighed by mass
      double largest = 0, largest_scale = 0;
      bool   known = false;

      void
      add(const double weight, const double difference, const double value)
      {
        if (!std::isfinite(difference))
          return;
        known = true;
        squared += weight * difference * difference;
        squared_scale += weight * value * value;
        largest       = std::max(largest, difference);
        largest_scale = std::max(largest_scale, value);
      }

      Difference &
      operator+=(const Difference &other)
      {
        squared += other.squared;
        squared_scale += other.squared_scale;
        largest       = std::max(largest, other.largest);
        largest_scale = std::max(largest_scale, other.largest_scale);
        known |= other.known;
        return *this;
      }

      /** NaN where nothing is known or the reference is zero. */
      double
      relative() const
      {
        return known && squared_scale > 0 ? std::sqrt(squared / squared_scale) :
                                            not_known;
      }

      double
      relative_maximum() const
      {
        return known && largest_scale > 0 ? largest / largest_scale : not_known;
      }
    };



    const std::vector<std::string> quantities = {"displacement",
                                                 "velocity",
                                                 "pressure",
                                                 "stress"};

    using Differences = std::array<Difference, 4>; // in this order



    double
    product(const std::array<double, 6> &a, const std::array<double, 6> &b)
    {
      double result = 0;
      for (unsigned int k = 0; k < 6; ++k)
        result += (k < 3 ? 1 : 2) * a[k] * b[k];
      return result;
    }



    template <int dim>
    Differences
    differences(const PointArrays<dim> &own,
                const PointArrays<dim> &other,
                std::size_t            &n_missed)
    {
      Differences result;
      for (std::size_t p = 0; p < own.size(); ++p)
        {
          const double weight = own.mass.empty() ? 1 : own.mass[p];
          const auto   du     = own.displacement[p] - other.displacement[p];
          const auto   dv     = own.velocity[p] - other.velocity[p];
          std::array<double, 6> ds;
          for (unsigned int k = 0; k < 6; ++k)
            ds[k] = own.stress[p][k] - other.stress[p][k];
          result[0].add(weight, du.norm(), other.displacement[p].norm());
          result[1].add(weight, dv.norm(), other.velocity[p].norm());
          result[2].add(weight,
                        std::abs(own.pressure[p] - other.pressure[p]),
                        std::abs(other.pressure[p]));
          result[3].add(weight,
                        std::sqrt(product(ds, ds)),
                        std::sqrt(product(other.stress[p], other.stress[p])));
          n_missed += !std::isfinite(du.norm()) && !std::isfinite(dv.norm()) &&
                      !std::isfinite(other.pressure[p]);
        }
      return result;
    }



    /** Linear interpolation between rows; NaN outside. */
    double
    interpolate(const std::vector<double> &times,
                const std::vector<double> &values,
                const double               time)
    {
      const auto after = std::lower_bound(times.begin(), times.end(), time);
      if (after == times.end())
        return not_known;
      const std::size_t k = after - times.begin();
      if (*after == time)
        return values[k];
      if (k == 0)
        return not_known;
      const double share = (time - times[k - 1]) / (times[k] - times[k - 1]);
      return values[k - 1] + share * (values[k] - values[k - 1]);
    }



    /** Observables of both tables over the time that both cover. */
    template <int dim>
    std::vector<std::pair<std::string, Difference>>
    observable_differences(const Problem<dim> &problem,
                           const std::string  &run,
                           const std::string  &other)
    {
      const Table own = read_statistics(run), theirs = read_statistics(other);
      std::vector<std::pair<std::string, Difference>> result;
      if (own.count("time") == 0 || theirs.count("time") == 0)
        return result;
      const auto &times = own.at("time");
      for (const Observable<dim> &observable : problem.observables)
        {
          if (own.count(observable.name) == 0 ||
              theirs.count(observable.name) == 0)
            continue;
          Difference  difference;
          const auto &values = own.at(observable.name);
          for (std::size_t k = 0; k < times.size(); ++k)
            {
              const double value = interpolate(theirs.at("time"),
                                               theirs.at(observable.name),
                                               times[k]);
              // weighed by the time that a row stands for
              const double before = k == 0 ? times[k] : times[k - 1];
              const double after =
                k + 1 == times.size() ? times[k] : times[k + 1];
              difference.add((after - before) / 2,
                             std::abs(values[k] - value),
                             std::abs(value));
            }
          result.emplace_back(observable.name, difference);
        }
      return result;
    }



    bool
    has_arrays(const std::string &folder, const std::string &series)
    {
      return !find_point_arrays(folder, series).empty();
    }



    template <int dim>
    std::unique_ptr<FieldSource<dim>>
    make_source(const std::string &other, const Problem<dim> &problem)
    {
      if (other == "exact")
        return make_exact_source(problem);
      if (has_arrays(other, "nodes"))
        return make_reference_source<dim>(other);
      if (has_arrays(other, "points"))
        return make_run_source<dim>(other);
      throw InputError("The folder " + in_quotes(other) +
                       " on the command line holds neither the nodes of a "
                       "reference nor the arrays of points. Usually the run "
                       "did not write them. Set 'Output/Point arrays = true' "
                       "and 'Output/Time interval', or compute it with "
                       "'limber reference'.");
    }



    json::Value
    to_json(const Difference &difference)
    {
      return json::object(
        {{"relative_l2", json::number(difference.relative())},
         {"relative_maximum", json::number(difference.relative_maximum())}});
    }



    /** Where there is nothing to compare with, there is no number. */
    std::string
    number_or_dash(const double number)
    {
      return std::isfinite(number) ? brief(number) : "-";
    }



    template <int dim>
    int
    compare(const SceneFile   &scene,
            const std::string &run,
            const std::string &other,
            Console           &console)
    {
      const Problem<dim> problem = read_problem<dim>(scene);
      const std::string  series = has_arrays(run, "nodes") ? "nodes" : "points";
      const auto         files  = find_point_arrays(run, series);
      if (files.empty())
        throw InputError("The run in " + in_quotes(run) +
                         " has no arrays of its points to be compared. "
                         "Usually they were not asked for. Run it anew with "
                         "'Output/Point arrays = true' and an 'Output/Time "
                         "interval'.");
      const auto   own_source = series == "nodes" ?
                                  make_reference_source<dim>(run) :
                                  make_run_source<dim>(run);
      const auto   source     = make_source(other, problem);
      const auto   times      = source->times();
      const double tolerance  = same_times * files.back().first;

      std::vector<Column> columns = {{"time", "s"}};
      for (const std::string &quantity : quantities)
        {
          columns.push_back({quantity + ", relative L2", ""});
          columns.push_back({quantity + ", relative maximum", ""});
        }
      const FolderLock lock = lock_for_comparison(run);
      Statistics       table(run + "/comparison", columns);

      Differences  all;
      std::size_t  n_missed = 0;
      unsigned int n_times  = 0;
      for (const auto &file : files)
        {
          const double time       = file.first;
          double       other_time = time;
          if (!times.empty())
            other_time = *std::min_element(times.begin(),
                                           times.end(),
                                           [&](const double a, const double b) {
                                             return std::abs(a - time) <
                                                    std::abs(b - time);
                                           });
          if (std::abs(other_time - time) > tolerance)
            continue;
          const auto        own = own_source->at_own_places(time);
          const Differences found =
            differences<dim>(own,
                             source->evaluate(other_time, own.place),
                             n_missed);
          std::vector<double> row = {time};
          for (unsigned int q = 0; q < found.size(); ++q)
            {
              row.push_back(found[q].relative());
              row.push_back(found[q].relative_maximum());
              all[q] += found[q];
            }
          table.add(row);
          ++n_times;
        }
      table.close();
      if (n_times == 0)
        throw InputError("No time at which " + in_quotes(run) +
                         " was written is one of " + source->description() +
                         ". Usually the two have different intervals. Set the "
                         "same 'Output/Time interval' in both.");

      const auto observed =
        other == "exact" ? std::vector<std::pair<std::string, Difference>>() :
                           observable_differences(problem, run, other);

      json::Members      fields, observables;
      std::ostringstream text;
      text << std::setprecision(4) << run << " against "
           << source->description() << ", " << n_times << " times\n"
           << "                       relative L2  relative maximum\n";
      const auto line = [&](const std::string &name, const Difference &d) {
        text << "  " << std::left << std::setw(20) << name << std::right
             << std::setw(12) << number_or_dash(d.relative()) << std::setw(18)
             << number_or_dash(d.relative_maximum()) << '\n';
      };
      for (unsigned int q = 0; q < all.size(); ++q)
        {
          line(quantities[q], all[q]);
          fields.emplace_back(quantities[q], to_json(all[q]));
        }
      for (const auto &[name, difference] : observed)
        {
          line(name, difference);
          observables.emplace_back(name, to_json(difference));
        }
      if (n_missed > 0)
        text << "  " << n_missed << " values lie outside and are left out\n";
      text << "results in " << run << "/comparison";
      write_whole_file(run + "/comparison.json",
                       json::object(
                         {{"run", json::string(run)},
                          {"other", json::string(other)},
                          {"times", json::integer(n_times)},
                          {"left_out", json::integer(n_missed)},
                          {"fields", json::object(fields)},
                          {"observables", json::object(observables)}})
                           .text +
                         "\n");
      console.say(text.str());
      return int(ExitCode::success);
    }
  } // namespace



  namespace
  {
    const std::string compare_usage = R"(limber compare RUN OTHER

Errors of displacement, velocity, pressure and stress of a run, over its body
and all common times, and of its observables. RUN is the folder of a run with
'Output/Point arrays = true', or of a reference; OTHER is the folder of a
reference, of another run with point arrays, or the word 'exact' for the
formulas of section 'Exact solution'.

Results: comparison (a table over time) and comparison.json in RUN. A quantity
that OTHER does not have, or that is zero there, is shown as '-'.

Exit codes: 0 done, 1 wrong input, 3 file error.
)";
  } // namespace



  int
  run_compare(const std::vector<std::string> &words, Console &console)
  {
    if (std::find(words.begin(), words.end(), "--help") != words.end() ||
        std::find(words.begin(), words.end(), "-h") != words.end())
      {
        console.show(compare_usage);
        return int(ExitCode::success);
      }
    for (const std::string &word : words)
      if (word.compare(0, 1, "-") == 0)
        throw InputError("The option " + in_quotes(word) +
                         " on the command line is not known: 'compare' takes "
                         "two words and none. See 'limber compare --help'.");
    if (words.size() != 2)
      throw InputError(
        "The word 'compare' on the command line is followed by " +
        std::to_string(words.size()) +
        " words instead of two. Write 'limber compare RUN "
        "OTHER': a run folder, and the folder of a reference, "
        "of another run, or the word 'exact'.");
    if (dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1)
      throw InputError("'limber compare' works on one rank and was started on "
                       "several. Leave out 'mpirun'.");
    if (!std::filesystem::exists(words[0] + "/parameters.prm"))
      throw InputError("The folder " + in_quotes(words[0]) +
                       " on the command line holds no run: there is no "
                       "parameters.prm in it. Usually the path is misspelt. "
                       "Name the 'Output/Directory' of a run.");
    const SceneFile scene(words[0] + "/parameters.prm");
    if (const std::string other = words[1] + "/parameters.prm";
        std::filesystem::exists(other) &&
        SceneFile(other).dimension() != scene.dimension())
      throw InputError("One of the folders " + in_quotes(words[0]) + " and " +
                       in_quotes(words[1]) +
                       " on the command line is of a scene in the plane, the "
                       "other of one in space. Usually one is of another "
                       "scene. Name two of the same.");
    return scene.dimension() == 2 ?
             compare<2>(scene, words[0], words[1], console) :
             compare<3>(scene, words[0], words[1], console);
  }
} // namespace limber
