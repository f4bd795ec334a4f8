// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/output/statistics.h>
#include <limber/problem/read_problem.h>
#include <limber/problem/size_estimate.h>
#include <limber/study/run_result.h>
#include <limber/study/variants.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <set>
#include <sstream>

namespace limber
{
  namespace
  {
    /** A name for a folder: letters, digits and '.', all else becomes '_'. */
    std::string
    as_folder(const std::string &name)
    {
      std::string result;
      for (const char c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-')
          result += c;
        else if (!result.empty() && result.back() != '_')
          result += '_';
      return result;
    }



    void
    append(std::vector<std::string> &to, const std::vector<std::string> &from)
    {
      to.insert(to.end(), from.begin(), from.end());
    }



    /**
     * Next combination of the choices, like an odometer; false after the last.
     */
    bool
    next(std::vector<std::size_t>     &choices,
         const std::vector<Variation> &variations)
    {
      for (std::size_t v = choices.size(); v-- > 0;)
        {
          if (++choices[v] < variations[v].choices.size())
            return true;
          choices[v] = 0;
        }
      return false;
    }



    Variant
    make_variant(const StudyFile                &study,
                 const std::size_t               method,
                 const std::vector<std::size_t> &choices)
    {
      Variant       variant{method, choices, "", "", study.settings, ""};
      const Choice &line = study.methods[method].choice;
      variant.name       = line.label;
      variant.runner     = study.methods[method].runner;
      append(variant.settings, line.settings);
      for (std::size_t v = 0; v < choices.size(); ++v)
        {
          const Choice &choice = study.variations[v].choices[choices[v]];
          variant.name += ", " + choice.label;
          append(variant.settings, choice.settings);
        }
      return variant;
    }



    /**
     * Refuses measures of columns and checks that runs of the scene will not
     * have. References write columns of their own.
     */
    template <int dim>
    void
    check_measures(const std::vector<Measure> &measures,
                   const Problem<dim>         &problem,
                   const Runner                runner)
    {
      std::vector<std::string> columns, checks;
      for (const Column &column : statistics_columns(problem))
        columns.push_back(column.name);
      for (const Check &check : problem.checks)
        checks.push_back(check.name);
      const auto require = [](const Measure                  &measure,
                              const std::string              &what,
                              const std::vector<std::string> &known) {
        for (const std::string &name : measure.of)
          if (std::find(known.begin(), known.end(), name) == known.end())
            refuse_name(measure, name, what, known);
      };
      for (const Measure &measure : measures)
        if (measure.source == MeasureSource::check)
          require(measure, "check", checks);
        else if (measure.source == MeasureSource::column &&
                 runner == Runner::points)
          require(measure, "column", columns);
    }



    template <int dim>
    void
    check_problem(const SceneFile            &scene,
                  const Runner                runner,
                  const std::vector<Measure> &measures)
    {
      const auto problem = read_problem<dim>(scene);
      check_size(problem,
                 runner == Runner::reference ? Task::reference : Task::run,
                 this_machine());
      check_measures(measures, problem, runner);
    }



    /** Checks what the run would check first; returns the entries it uses. */
    std::string
    check_scene(const StudyFile            &study,
                const Variant              &variant,
                const std::vector<Measure> &measures)
    {
      try
        {
          const SceneFile scene(study.scene, variant.settings);
          if (scene.dimension() == 2)
            check_problem<2>(scene, variant.runner, measures);
          else
            check_problem<3>(scene, variant.runner, measures);
          std::ostringstream text;
          print_parameters(text, PrintStyle::prm, &scene);
          return text.str();
        }
      catch (const InputError &error)
        {
          throw InputError("The variant " + in_quotes(variant.name) + " of " +
                           study.path + " is refused. " + error.what());
        }
    }
  } // namespace



  namespace
  {
    constexpr double most_variants = 1e4;



    /** Each is read, and is a folder. */
    void
    check_number(const StudyFile &study)
    {
      double n = study.methods.size();
      for (const Variation &variation : study.variations)
        n *= variation.choices.size();
      if (n > most_variants)
        throw InputError("The study " + in_quotes(study.path) + " has " +
                         brief(n) + " variants, at most " +
                         brief(most_variants) +
                         " are run. Usually two variations should go "
                         "together. Name one of them in the entry 'With' of "
                         "the other, or take values out.");
    }
  } // namespace



  std::vector<Variant>
  expand(const StudyFile &study)
  {
    check_number(study);
    std::vector<Variant>  variants;
    std::set<std::string> folders;
    for (std::size_t method = 0; method < study.methods.size(); ++method)
      {
        std::vector<std::size_t> choices(study.variations.size(), 0);
        do
          {
            Variant     variant = make_variant(study, method, choices);
            std::string folder  = as_folder(variant.name);
            while (!folders.insert(folder).second)
              folder += "_";
            variant.folder     = study.directory + "/runs/" + folder;
            variant.parameters = check_scene(study, variant, study.measures);
            variants.push_back(variant);
          }
        while (next(choices, study.variations));
      }
    return variants;
  }



  std::optional<Variant>
  standard_of(const StudyFile &study)
  {
    if (!is_compared(study) || study.comparison.with == Standard::exact)
      return std::nullopt;
    for (const Variation &variation : study.variations)
      if (variation.is_problem)
        throw InputError(
          "In the study " + in_quotes(study.path) + " the variation " +
          in_quotes(variation.name) +
          " makes other problems ('Another problem = true'), but errors are "
          "measured against the one solution of 'Comparison'. Usually a "
          "variation was added to a study of one problem. Set "
          "'Comparison/With = exact', measure by a 'check', or write a study "
          "for each value.");
    Variant variant{
      0, {}, "comparison", study.directory + "/comparison", study.settings, ""};
    append(variant.settings, study.comparison.settings);
    if (study.comparison.with == Standard::reference)
      variant.runner = Runner::reference;
    variant.parameters = check_scene(study, variant, {});
    return variant;
  }



  double
  abscissa(const StudyFile &study, const Variant &variant)
  {
    for (std::size_t v = 0; v < study.variations.size(); ++v)
      if (study.variations[v].name == study.horizontal_axis)
        return *to_number(
          study.variations[v].choices[variant.choices[v]].label);
    return std::numeric_limits<double>::quiet_NaN();
  }
} // namespace limber
