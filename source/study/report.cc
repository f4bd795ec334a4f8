// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/run_info.h>
#include <limber/base/text.h>
#include <limber/output/files.h>
#include <limber/output/json.h>
#include <limber/study/plot_scripts.h>
#include <limber/study/report.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

namespace limber
{
  namespace
  {
    bool
    has_error(const StudyRow &row, const std::size_t measure)
    {
      return measure < row.measured.size() &&
             std::isfinite(row.measured[measure].error);
    }



    /** Labels of the choices that say which problem a row belongs to. */
    std::string
    problem_of(const StudyReport &report, const StudyRow &row)
    {
      std::string result;
      for (std::size_t v = 0; v < report.study.variations.size(); ++v)
        {
          const Variation &variation = report.study.variations[v];
          if (variation.is_problem)
            result += variation.name + " " +
                      variation.choices[row.variant.choices[v]].label + ", ";
        }
      return result;
    }



    /** All problems, in the order of the rows. */
    std::vector<std::string>
    problems_of(const StudyReport &report)
    {
      std::vector<std::string> result;
      for (const StudyRow &row : report.rows)
        {
          const std::string problem = problem_of(report, row);
          if (std::find(result.begin(), result.end(), problem) == result.end())
            result.push_back(problem);
        }
      return result;
    }



    double
    cost_of(const StudyReport &report, const StudyRow &row)
    {
      const auto found = row.costs.find(report.study.cost);
      return found == row.costs.end() ? std::nan("") : found->second;
    }



    /** Quoted where a separator or a quotation mark is within. */
    std::string
    csv_field(const std::string &text)
    {
      if (text.find_first_of(",\"\n") == std::string::npos)
        return text;
      std::string result = "\"";
      for (const char c : text)
        result += c == '"' ? std::string("\"\"") : std::string(1, c);
      return result + '"';
    }



    std::string
    csv_number(const double value)
    {
      return std::isfinite(value) ? to_text(value) : "nan";
    }



    std::vector<std::string>
    labels_of(const StudyReport &report, const StudyRow &row)
    {
      const StudyFile         &study  = report.study;
      std::vector<std::string> labels = {
        study.methods[row.variant.method].choice.label};
      for (std::size_t v = 0; v < study.variations.size(); ++v)
        labels.push_back(
          study.variations[v].choices[row.variant.choices[v]].label);
      return labels;
    }



    bool
    has_closed_forms(const StudyReport &report)
    {
      return std::any_of(report.study.methods.begin(),
                         report.study.methods.end(),
                         [](const StudyMethod &method) {
                           return !method.closed_form.empty();
                         });
    }



    std::string
    csv_text(const StudyReport &report)
    {
      const StudyFile         &study  = report.study;
      std::vector<std::string> header = {"method"};
      for (const Variation &variation : study.variations)
        header.push_back(variation.name);
      header.insert(header.end(), {"outcome", "exit code"});
      for (const Measure &measure : study.measures)
        for (const char *const what : {" value", " error", " Pareto"})
          header.push_back(measure.name + what);
      header.insert(header.end(), {"closed form", "beyond"});
      for (const Cost cost :
           {Cost::cpu_seconds, Cost::wall_seconds, Cost::memory, Cost::steps})
        header.push_back(name_of(cost));

      std::vector<std::vector<bool>> fronts;
      for (std::size_t m = 0; m < study.measures.size(); ++m)
        fronts.push_back(pareto_front(report, m));

      std::string text;
      for (std::size_t i = 0; i < header.size(); ++i)
        text += (i > 0 ? "," : "") + csv_field(header[i]);
      text += '\n';
      for (std::size_t r = 0; r < report.rows.size(); ++r)
        {
          const StudyRow &row = report.rows[r];
          for (const std::string &label : labels_of(report, row))
            text += csv_field(label) + ",";
          text += row.outcome + "," + std::to_string(row.exit_code);
          for (std::size_t m = 0; m < study.measures.size(); ++m)
            {
              const Measured none{std::nan(""), std::nan("")};
              const Measured found =
                m < row.measured.size() ? row.measured[m] : none;
              text += "," + csv_number(found.value) + "," +
                      csv_number(found.error) + "," +
                      (fronts[m][r] ? "1" : "0");
            }
          text += "," + csv_number(expected(report, row)) + "," + row.beyond;
          for (const Cost cost : {Cost::cpu_seconds,
                                  Cost::wall_seconds,
                                  Cost::memory,
                                  Cost::steps})
            {
              const auto it = row.costs.find(cost);
              text += "," + csv_number(it == row.costs.end() ? std::nan("") :
                                                               it->second);
            }
          text += '\n';
        }
      return text;
    }



    /** The formulas of the methods as lines to be drawn. */
    json::Value
    closed_forms(const StudyReport &report)
    {
      const StudyFile &study = report.study;
      json::Members    lines;
      double           lower = 1e300, upper = -1e300;
      for (const StudyRow &row : report.rows)
        {
          const double x = abscissa(study, row.variant);
          lower          = std::min(lower, x);
          upper          = std::max(upper, x);
        }
      constexpr unsigned int n    = 200;
      const bool             logs = lower > 0 && (study.logarithmic == "both" ||
                                      study.logarithmic == "horizontal");
      for (const StudyMethod &method : study.methods)
        {
          if (method.closed_form.empty() || !(lower < upper))
            continue;
          std::vector<json::Value> xs, ys;
          for (unsigned int i = 0; i <= n; ++i)
            {
              const double share = double(i) / n;
              const double x = logs ? lower * std::pow(upper / lower, share) :
                                      lower + share * (upper - lower);
              xs.push_back(json::number(x));
              ys.push_back(json::number(method.closed_form.value({x, 0}, 0)));
            }
          lines.emplace_back(method.choice.label,
                             json::object({{"x", json::array(xs)},
                                           {"y", json::array(ys)}}));
        }
      return json::object(lines);
    }



    json::Value
    words_of(const std::vector<std::string> &words)
    {
      std::vector<json::Value> result;
      for (const std::string &word : words)
        result.push_back(json::string(word));
      return json::array(result);
    }



    std::string
    json_text_of(const StudyReport &report)
    {
      const StudyFile         &study = report.study;
      std::vector<json::Value> measures, variations, levels;
      for (const Measure &measure : study.measures)
        measures.push_back(json::string(measure.name));
      for (const Variation &variation : study.variations)
        variations.push_back(json::string(variation.name));
      for (const double level : study.error_levels)
        levels.push_back(json::number(level));
      const std::string axis = study.horizontal_axis.empty() ?
                                 name_of(study.cost) :
                                 study.horizontal_axis;
      return json::object(
               {{"title", json::string(study.title)},
                {"caption", json::string(report.caption)},
                {"measures", json::array(measures)},
                {"drawn methods", words_of(study.drawn_methods)},
                {"drawn measures", words_of(study.drawn_measures)},
                {"variations", json::array(variations)},
                {"horizontal", json::string(axis)},
                {"horizontal label",
                 json::string(study.horizontal_label.empty() ?
                                axis :
                                study.horizontal_label)},
                {"vertical label", json::string(study.vertical_label)},
                {"against cost", json::boolean(study.horizontal_axis.empty())},
                {"logarithmic", json::string(study.logarithmic)},
                {"error levels", json::array(levels)},
                {"closed forms", closed_forms(report)}})
               .text +
             "\n";
    }



    /** The error of a comparison is its value, as is that of several checks. */
    bool
    has_value_and_error(const Measure &measure)
    {
      return measure.has_error() &&
             measure.source != MeasureSource::comparison &&
             (measure.source != MeasureSource::check || measure.of.size() <= 1);
    }



    std::string
    markdown_text(const StudyReport &report, const std::string &findings)
    {
      const StudyFile   &study = report.study;
      std::ostringstream text;
      text << "# " << study.title << "\n\n";
      std::string header = "| method |", rule = "| --- |";
      for (const Variation &variation : study.variations)
        {
          header += " " + variation.name + " |";
          rule += " --: |";
        }
      for (const Measure &measure : study.measures)
        {
          header += " " + measure.name + " |";
          rule += " --: |";
          if (has_value_and_error(measure))
            {
              header += " error |";
              rule += " --: |";
            }
        }
      if (has_closed_forms(report))
        {
          header += " closed form |";
          rule += " --: |";
        }
      const bool has_beyond =
        std::any_of(report.rows.begin(),
                    report.rows.end(),
                    [](const StudyRow &row) { return !row.beyond.empty(); });
      if (has_beyond)
        {
          header += " beyond |";
          rule += " --- |";
        }
      text << header << " " << name_of(study.cost) << " |\n"
           << rule << " --: |\n";

      for (const StudyRow &row : report.rows)
        {
          text << "|";
          for (const std::string &label : labels_of(report, row))
            text << " " << label << " |";
          for (std::size_t m = 0; m < study.measures.size(); ++m)
            {
              const Measure &measure = study.measures[m];
              text << " "
                   << (m < row.measured.size() ? brief(row.measured[m].value) :
                                                 row.outcome)
                   << " |";
              if (has_value_and_error(measure))
                text << " "
                     << (m < row.measured.size() ?
                           brief(row.measured[m].error) :
                           "")
                     << " |";
            }
          if (has_closed_forms(report))
            {
              const double value = expected(report, row);
              text << " " << (std::isfinite(value) ? brief(value) : "") << " |";
            }
          if (has_beyond)
            text << " " << row.beyond << " |";
          const double cost = cost_of(report, row);
          text << " " << (std::isfinite(cost) ? brief(cost) : "") << " |\n";
        }
      if (!findings.empty())
        {
          text << "\n";
          std::istringstream lines(findings);
          for (std::string line; std::getline(lines, line);)
            text << (line.compare(0, 2, "  ") == 0 ? "  - " + line.substr(2) :
                                                     "- " + line)
                 << "\n";
        }
      text << "\n" << report.caption << "\n";
      return text.str();
    }



    std::string
    processor()
    {
      std::ifstream file("/proc/cpuinfo");
      for (std::string line; std::getline(file, line);)
        if (line.compare(0, 10, "model name") == 0)
          return trimmed(line.substr(line.find(':') + 1));
      return "unknown processor";
    }



    /** Rows of a problem that have an error; method -1: of all methods. */
    std::vector<std::size_t>
    candidates(const StudyReport &report,
               const std::string &problem,
               const std::size_t  measure,
               const int          method)
    {
      std::vector<std::size_t> result;
      for (std::size_t r = 0; r < report.rows.size(); ++r)
        if (has_error(report.rows[r], measure) &&
            problem_of(report, report.rows[r]) == problem &&
            (method < 0 ||
             report.rows[r].variant.method == std::size_t(method)))
          result.push_back(r);
      return result;
    }



    /** The cheapest of them with an error not above a level; -1: none. */
    int
    cheapest(const StudyReport &report,
             const std::string &problem,
             const std::size_t  measure,
             const double       level,
             const int          method)
    {
      int best = -1;
      for (const std::size_t r : candidates(report, problem, measure, method))
        {
          const StudyRow &row = report.rows[r];
          if (row.measured[measure].error <= level &&
              (best < 0 ||
               cost_of(report, row) < cost_of(report, report.rows[best])))
            best = int(r);
        }
      return best;
    }



    /** In words. */
    std::string
    smallest_error(const StudyReport &report,
                   const std::string &problem,
                   const std::size_t  measure,
                   const int          method)
    {
      double result = std::numeric_limits<double>::infinity();
      for (const std::size_t r : candidates(report, problem, measure, method))
        result = std::min(result, report.rows[r].measured[measure].error);
      std::ostringstream text;
      text.precision(3);
      text << "the smallest error is " << result;
      return std::isfinite(result) ? text.str() : "none has finished";
    }



    bool
    is_drawn(const StudyFile &study, const Measure &measure)
    {
      const auto &drawn = study.drawn_measures;
      return drawn.empty() ||
             std::find(drawn.begin(), drawn.end(), measure.name) != drawn.end();
    }



    /** Cost of one error level in one problem, in words. */
    std::string
    findings_for(const StudyReport &report,
                 const std::string &problem,
                 const std::size_t  m,
                 const double       level)
    {
      const StudyFile   &study = report.study;
      std::ostringstream text;
      text.precision(3);
      text << study.measures[m].name << ", error " << level << ": ";
      const int best = cheapest(report, problem, m, level, -1);
      if (best < 0)
        {
          text << "reached by no variant; "
               << smallest_error(report, problem, m, -1) << "\n";
          return text.str();
        }
      const StudyRow &winner = report.rows[best];
      const double    cost   = cost_of(report, winner);
      text << "cheapest is '" << winner.variant.name << "' with "
           << winner.measured[m].error << ", " << cost << " "
           << name_of(study.cost) << "\n";
      for (std::size_t method = 0; method < study.methods.size(); ++method)
        {
          if (winner.variant.method == method)
            continue;
          text << "  " << study.methods[method].choice.label << ": ";
          const int own = cheapest(report, problem, m, level, int(method));
          if (own < 0)
            text << "not reached, "
                 << smallest_error(report, problem, m, int(method)) << "\n";
          else
            text << cost_of(report, report.rows[own]) / cost
                 << " times as much, with '" << report.rows[own].variant.name
                 << "'\n";
        }
      return text.str();
    }
  } // namespace



  double
  expected(const StudyReport &report, const StudyRow &row)
  {
    const Formula<2> &formula =
      report.study.methods[row.variant.method].closed_form;
    if (formula.empty() || report.study.horizontal_axis.empty())
      return std::nan("");
    return formula.value({abscissa(report.study, row.variant), 0}, 0);
  }



  std::vector<bool>
  pareto_front(const StudyReport &report, const std::size_t measure)
  {
    const auto       &rows = report.rows;
    std::vector<bool> front(rows.size());
    for (std::size_t a = 0; a < rows.size(); ++a)
      {
        front[a] = has_error(rows[a], measure);
        for (std::size_t b = 0; front[a] && b < rows.size(); ++b)
          if (has_error(rows[b], measure) &&
              problem_of(report, rows[a]) == problem_of(report, rows[b]))
            {
              const double error_a = rows[a].measured[measure].error;
              const double error_b = rows[b].measured[measure].error;
              const double cost_a  = cost_of(report, rows[a]);
              const double cost_b  = cost_of(report, rows[b]);
              if (error_b <= error_a && cost_b <= cost_a &&
                  (error_b < error_a || cost_b < cost_a))
                front[a] = false;
            }
      }
    return front;
  }



  std::string
  cheapest_variants(const StudyReport         &report,
                    const std::vector<double> &levels)
  {
    std::string text;
    for (const std::string &problem : problems_of(report))
      for (std::size_t m = 0; m < report.study.measures.size(); ++m)
        if (is_drawn(report.study, report.study.measures[m]))
          for (const double level : levels)
            text += problem + findings_for(report, problem, m, level);
    return text;
  }



  std::string
  caption_of(const std::string &command)
  {
    const RunInfo     info = run_info();
    const std::time_t now  = std::time(nullptr);
    char              day[16];
    std::strftime(day, sizeof(day), "%Y-%m-%d", std::localtime(&now));
    std::ostringstream text;
    text << processor() << ", " << std::thread::hardware_concurrency()
         << " cores; Limber " << info.version << " (revision " << info.revision
         << (info.debug ? ", debug build" : "") << "), deal.II " << info.deal_ii
         << "; " << day << "; `" << command << "`";
    return text.str();
  }



  void
  write_report(const StudyReport &report, const std::string &findings)
  {
    const std::string &folder = report.study.directory;
    write_whole_file(folder + "/study.csv", csv_text(report));
    write_whole_file(folder + "/study.json", json_text_of(report));
    write_whole_file(folder + "/study.md", markdown_text(report, findings));
  }



  std::string
  draw_chart(const StudyFile &study)
  {
    const std::string script = plot_script("plot_study.py");
    const std::string python = plot_python();
    const std::string log    = study.directory + "/chart.log";
    if (std::filesystem::exists(script))
      try
        {
          if (run_child({python, "-B", script, study.directory}, log, 300)
                .exit_code == 0)
            {
              std::filesystem::remove(log);
              return "chart in " + study.directory + "/study.svg and study.png";
            }
        }
      catch (const FileError &)
        {
          // there is no such Python
        }
    return "No chart was drawn: it needs Python 3 with matplotlib and numpy (" +
           log + " says what was missing). Draw it elsewhere from study.csv " +
           "and study.json with\n  " + python + " " + script + " " +
           study.directory;
  }
} // namespace limber
