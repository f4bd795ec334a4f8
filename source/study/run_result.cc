// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/study/run_result.h>

#include <boost/property_tree/json_parser.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

namespace limber
{
  namespace
  {
    using Tree = boost::property_tree::ptree;

    constexpr double nothing = std::numeric_limits<double>::quiet_NaN();



    double
    number_or_nan(const std::string &text)
    {
      return to_number(text).value_or(nothing);
    }



    std::string
    member(const Tree &tree, const std::string &name)
    {
      const auto found = tree.find(name);
      return found == tree.not_found() ? "" : found->second.data();
    }



    /** Of a JSON file; @p remedy is the last sentence where it fails. */
    Tree
    read_tree(const std::string &path, const std::string &remedy)
    {
      Tree tree;
      try
        {
          boost::property_tree::read_json(path, tree);
        }
      catch (const boost::property_tree::json_parser_error &error)
        {
          throw FileError("The file " + in_quotes(path) +
                          " cannot be read: " + error.message() +
                          ". Usually what writes it was ended before. " +
                          remedy);
        }
      return tree;
    }



    template <typename Map>
    std::vector<std::string>
    names_of(const Map &map)
    {
      std::vector<std::string> names;
      for (const auto &[name, value] : map)
        names.push_back(name);
      return names;
    }



    /** Range of rows within the times of the measure. */
    std::pair<std::size_t, std::size_t>
    rows_of(const Measure &measure, const Table &table)
    {
      // times that are to be met are met up to round-off
      constexpr double exactly = 1e-9;
      const auto      &time    = table.at("time");
      return {std::lower_bound(time.begin(),
                               time.end(),
                               measure.from_time * (1 - exactly)) -
                time.begin(),
              std::upper_bound(time.begin(),
                               time.end(),
                               measure.until_time * (1 + exactly)) -
                time.begin()};
    }



    /** The sum of the columns in the rows that count. */
    std::vector<double>
    sum_columns(const Measure &measure, const Table &table)
    {
      const auto [first, last] = rows_of(measure, table);
      std::vector<double> sum(first < last ? last - first : 0);
      for (const std::string &name : measure.of)
        {
          const auto found = table.find(name);
          if (found == table.end())
            refuse_name(measure, name, "column", names_of(table));
          for (std::size_t i = 0; i < sum.size(); ++i)
            sum[i] += found->second[first + i];
        }
      return sum;
    }



    double
    reduce(const Measure &measure, const Table &table)
    {
      const auto values = sum_columns(measure, table);
      if (values.empty())
        return nothing;
      // NaN must not be hidden by a comparison
      for (const double value : values)
        if (std::isnan(value) && measure.reduction != Reduction::last)
          return nothing;
      const auto   extremes = std::minmax_element(values.begin(), values.end());
      const double first = values.front(), last = values.back();
      switch (measure.reduction)
        {
          case Reduction::last:
            return last;
          case Reduction::largest:
            return *extremes.second;
          case Reduction::smallest:
            return *extremes.first;
          case Reduction::largest_magnitude:
            return std::max(std::abs(*extremes.first),
                            std::abs(*extremes.second));
          case Reduction::last_over_first:
            return last / first;
          case Reduction::largest_over_first:
            return *extremes.second / first;
          case Reduction::amplitude_per_step:
            {
              const auto [begin, end] = rows_of(measure, table);
              const auto  &step       = table.at("step");
              const double steps      = step[end - 1] - step[begin];
              return std::pow(last / first, 0.5 / steps);
            }
        }
      return nothing;
    }



    Measured
    worst_check(const Measure &measure, const RecordedSummary &summary)
    {
      Measured worst{nothing, -1};
      for (const std::string &name : measure.of)
        {
          std::vector<std::string> known;
          const RecordedCheck     *found = nullptr;
          for (const RecordedCheck &check : summary.checks)
            {
              known.push_back(check.name);
              if (check.name == name)
                found = &check;
            }
          if (found == nullptr)
            refuse_name(measure, name, "check", known);
          if (found->reference == 0)
            throw InputError("The check " + in_quotes(name) + " of 'Measure " +
                             measure.name +
                             "' has the reference 0, so its relative error is "
                             "not defined. Take the column of its observable, "
                             "with 'Reference = 0' and a 'Scale'.");
          const double error = std::abs(found->value - found->reference) /
                               std::abs(found->reference);
          if (!(error <= worst.error))
            worst = {found->value, error};
          if (std::isnan(error))
            break;
        }
      // the worst of several checks may be another one in each run, so it has
      // no value
      return measure.of.size() == 1 ? worst :
                                      Measured{worst.error, worst.error};
    }
  } // namespace



  void
  refuse_name(const Measure                  &measure,
              const std::string              &name,
              const std::string              &what,
              const std::vector<std::string> &known)
  {
    const auto meant = nearest(name, known);
    throw InputError("The run has no " + what + " " + in_quotes(name) +
                     ", which 'Measure " + measure.name +
                     "/Name' asks for. Usually it is misspelt or missing in "
                     "the scene. " +
                     (meant ? "Did you mean " + in_quotes(*meant) + "?" :
                      known.empty() ?
                              "It has none at all." :
                              "Choose from: " + join(known, ", ") + "."));
  }



  RecordedSummary
  read_summary(const std::string &folder)
  {
    const Tree      tree = read_tree(folder + "/summary.json", "Run it again.");
    RecordedSummary summary;
    for (const auto &[name, value] : tree)
      if (value.empty())
        summary.numbers[name] = number_or_nan(value.data());
    summary.verdict   = member(tree, "verdict");
    summary.failure   = member(tree, "failure");
    summary.message   = member(tree, "message");
    const auto checks = tree.find("checks");
    if (checks != tree.not_found())
      for (const auto &[name, check] : checks->second)
        summary.checks.push_back({member(check, "name"),
                                  number_or_nan(member(check, "value")),
                                  number_or_nan(member(check, "reference"))});
    return summary;
  }



  Table
  read_statistics(const std::string &folder)
  {
    const std::string        path = folder + "/statistics";
    std::ifstream            file(path);
    std::vector<std::string> names; // of several equal ones the first counts
    Table                    table;
    for (std::string line; std::getline(file, line);)
      if (line[0] == '#')
        {
          std::string name = trimmed(line.substr(line.find(':') + 1));
          if (name.back() == ']')
            name = trimmed(name.substr(0, name.rfind('[')));
          names.push_back(std::count(names.begin(), names.end(), name) > 0 ?
                            name + " 2" :
                            name);
        }
      else
        {
          std::istringstream row(line);
          std::string        word;
          for (const std::string &name : names)
            {
              row >> word;
              table[name].push_back(number_or_nan(word));
            }
        }
    if (table.empty())
      throw FileError("The table " + in_quotes(path) +
                      " has no rows. Usually the run was ended before its "
                      "first step. Run it again.");
    return table;
  }



  namespace
  {
    /** The relative L2 error that `limber compare` has left in a run folder. */
    double
    read_comparison(const Measure &measure, const std::string &folder)
    {
      const Tree tree =
        read_tree(folder + "/comparison.json", "Go on with '--resume'.");
      const std::string       &name = measure.of.front();
      std::vector<std::string> known;
      for (const char *const kind : {"fields", "observables"})
        for (const auto &[compared, errors] : tree.get_child(kind))
          {
            if (compared == name)
              return number_or_nan(member(errors, "relative_l2"));
            known.push_back(compared);
          }
      refuse_name(measure, name, "field or observable", known);
    }
  } // namespace



  Measured
  take_measure(const Measure         &measure,
               const RecordedSummary &summary,
               const std::string     &folder)
  {
    if (measure.source == MeasureSource::check)
      return worst_check(measure, summary);

    if (measure.source == MeasureSource::comparison)
      {
        const double error = read_comparison(measure, folder);
        return {error, error};
      }

    Measured result;
    if (measure.source == MeasureSource::summary)
      {
        const auto found = summary.numbers.find(measure.of.front());
        if (found == summary.numbers.end())
          refuse_name(measure,
                      measure.of.front(),
                      "entry of the summary",
                      names_of(summary.numbers));
        result.value = found->second;
      }
    else
      result.value = reduce(measure, read_statistics(folder));
    result.error = measure.reference ?
                     std::abs(result.value - *measure.reference) /
                       measure.scale.value_or(std::abs(*measure.reference)) :
                     result.value / measure.scale.value_or(1);
    return result;
  }



  std::string
  outcome_of(const ChildEnd &end, const std::string &folder)
  {
    if (end.timed_out)
      return "time limit";
    if (end.killed)
      return "crashed (signal " + std::to_string(end.exit_code - 128) + ")";
    switch (ExitCode(end.exit_code))
      {
        case ExitCode::success:
        case ExitCode::check_missed:
          return "finished";
        case ExitCode::wrong_input:
          return "refused";
        case ExitCode::file_error:
          return "file error";
        default:
          break;
      }
    if (end.exit_code >= int(ExitCode::stopped_by_signal))
      return "stopped";
    if (!std::filesystem::exists(folder + "/summary.json"))
      return "failed";
    const RecordedSummary summary = read_summary(folder);
    return summary.failure.empty() ? "failed" : summary.failure;
  }
} // namespace limber
