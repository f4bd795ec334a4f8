// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/words.h>
#include <limber/study/study_file.h>

#include <algorithm>
#include <filesystem>

namespace limber
{
  namespace
  {
    // Between the values of a list: those of the scene may contain commas and
    // semicolons.
    constexpr char separator = '|';



    const Words<MeasureSource> &
    source_words()
    {
      static const Words<MeasureSource> words = {
        {"check",
         MeasureSource::check,
         "values of checks of the scene, with their references as scales; the "
         "worst of several counts"},
        {"column",
         MeasureSource::column,
         "columns of the statistics, added up, reduced over time"},
        {"summary", MeasureSource::summary, "a number of summary.json"}};
      return words;
    }



    const Words<Reduction> &
    reduction_words()
    {
      static const Words<Reduction> words = {
        {"last", Reduction::last, "value of the last row"},
        {"largest", Reduction::largest, "over all rows"},
        {"smallest", Reduction::smallest, "over all rows"},
        {"largest magnitude",
         Reduction::largest_magnitude,
         "largest absolute value over all rows"},
        {"last over first",
         Reduction::last_over_first,
         "ratio of the last row to the first"},
        {"largest over first",
         Reduction::largest_over_first,
         "ratio of the largest value to the first"},
        {"amplitude per step",
         Reduction::amplitude_per_step,
         "of an energy: the factor by which its amplitude changes in a step, "
         "(last / first)^(1 / (2 steps))"}};
      return words;
    }



    const Words<Runner> &
    runner_words()
    {
      static const Words<Runner> words = {
        {"points", Runner::points, "the material point method"},
        {"reference",
         Runner::reference,
         "the finite elements of 'limber reference'"}};
      return words;
    }



    const Words<Cost> &
    cost_words()
    {
      static const Words<Cost> words = {
        {"CPU seconds", Cost::cpu_seconds, "processor time of all ranks, s"},
        {"wall seconds", Cost::wall_seconds, "s"},
        {"memory", Cost::memory, "largest memory of the process, bytes"},
        {"steps", Cost::steps, "number of steps"}};
      return words;
    }



    Admissible
    settings_text()
    {
      return admissible::text(
        "list of 'Section/Name=value' separated by '|'",
        "Method/Transfer=apic | Method/Courant number=0.3");
    }



    Admissible
    values_text()
    {
      return admissible::text("values separated by '|'", "18, 10 | 36, 20");
    }



    void
    declare_study_top_level(Parameters &parameters)
    {
      using namespace admissible;
      parameters.declare("Title",
                         "",
                         text("a sentence", "Cantilever, nu = 0.3"),
                         "What stands over chart and table.");
      parameters.declare("Scene",
                         "",
                         text("path of a scene", "../cantilever.prm"),
                         "The scene that is varied; relative to the folder of "
                         "the study.");
      parameters.declare("Directory",
                         "",
                         text("path of a folder, or empty", "studies/beam"),
                         "Folder of the results; empty: 'studies/' and the "
                         "name of the file.");
      parameters.declare("Replace",
                         "false",
                         flag(),
                         "Whether the results of a former study in the folder "
                         "are overwritten.");
      parameters.declare("Settings",
                         "",
                         settings_text(),
                         "Entries of the scene that all variants change.");
      parameters.declare("Short settings",
                         "",
                         settings_text(),
                         "Further ones for the short version, '--short'.");
      parameters.declare_list("Methods",
                              "",
                              "Method ",
                              "Names of the lines of the chart; each has a "
                              "section 'Method NAME'. Each is run with every "
                              "variation.");
      parameters.declare("Short methods",
                         "",
                         names("cell, none"),
                         "Those of the short version; empty: all.");
      parameters.declare_list("Variations",
                              "",
                              "Variation ",
                              "Names of what changes along a line; each has a "
                              "section 'Variation NAME'. Of several, all "
                              "combinations are run.");
      parameters.declare_list("Measures",
                              "",
                              "Measure ",
                              "Names of what is taken from every run; each has "
                              "a section 'Measure NAME' and a chart of its "
                              "own.");
      parameters.declare("Error levels",
                         "0.1, 0.01",
                         text("numbers separated by commas", "0.1, 0.01"),
                         "Errors for which the cheapest variant is named.");
      declare_word(parameters,
                   "Cost",
                   "CPU seconds",
                   cost_words(),
                   "What a run is said to cost.");
      parameters.declare("Time limit",
                         "600",
                         positive_number("600"),
                         "Wall time after which a run is stopped, s; it then "
                         "has failed.");
    }



    void
    declare_axes(Parameters &parameters)
    {
      using namespace admissible;
      parameters.enter_subsection("Chart");
      parameters.declare("Horizontal axis",
                         "cost",
                         text("'cost', or name of a variation", "cost"),
                         "What the measures are drawn against. The labels of "
                         "the variation must be numbers.");
      parameters.declare("Horizontal label",
                         "",
                         text("text, or empty", "cut fraction"),
                         "What stands at the axis; empty: its name.");
      parameters.declare("Vertical label",
                         "",
                         text("text, or empty", "relative error"),
                         "What stands at the axis; empty: the name of the "
                         "measure.");
      parameters.declare("Logarithmic",
                         "both",
                         one_of({"both", "horizontal", "vertical", "none"}),
                         "Which axes are logarithmic.");
      parameters.leave_subsection();
    }



    void
    declare_bisection(Parameters &parameters)
    {
      using namespace admissible;
      parameters.enter_subsection("Bisection");
      parameters.declare("Entry",
                         "Method/Courant number",
                         text("full name of an entry of the scene",
                              "Method/Courant number"),
                         "The entry whose largest stable value 'limber "
                         "stability' seeks.");
      parameters.declare("Lower",
                         "0.01",
                         positive_number("0.01"),
                         "Smallest value that is tried.");
      parameters.declare("Upper",
                         "5",
                         positive_number("5"),
                         "Largest value that is tried; where it is stable, "
                         "there is no limit below it.");
      parameters.declare("Tolerance",
                         "0.005",
                         number_between(0, 1, "0.005"),
                         "Relative width of the bracket at which it ends.");
      parameters.declare("Steps",
                         "1000",
                         positive_integer("1000"),
                         "Steps that a run must survive.");
      parameters.declare("Growth",
                         "100",
                         number_between(1, 1e300, "100"),
                         "Kinetic plus strain energy over that of the start "
                         "beyond which a run is not stable.");
      parameters.leave_subsection();
    }



    void
    declare_study_method(Parameters &parameters, const std::string &name)
    {
      parameters.enter_subsection("Method " + name);
      parameters.declare("Settings",
                         "",
                         settings_text(),
                         "Entries of the scene that make this method; empty: "
                         "as in the scene.");
      declare_word(parameters,
                   "Run by",
                   "points",
                   runner_words(),
                   "What computes the scene.");
      parameters.declare("Closed form",
                         "",
                         admissible::text("formula of x, or empty",
                                          "sqrt(4*x/(2-x))"),
                         "What is expected, as a function of the variation on "
                         "the horizontal axis; drawn over the chart and "
                         "compared in the table.");
      parameters.leave_subsection();
    }



    void
    declare_variation(Parameters &parameters, const std::string &name)
    {
      parameters.enter_subsection("Variation " + name);
      parameters.declare("Entry",
                         "",
                         admissible::text("full name of an entry of the scene",
                                          "Grid/Cells"),
                         "The entry that is varied.");
      parameters.declare("Values",
                         "",
                         values_text(),
                         "What it is set to, one after the other.");
      parameters.declare("Labels",
                         "",
                         values_text(),
                         "Their names in tables and on axes; empty: the values "
                         "themselves.");
      parameters.declare("Short",
                         "",
                         admissible::text("labels separated by '|', or empty",
                                          "2 | 4"),
                         "Labels of those that belong to the short version; "
                         "empty: all.");
      parameters.declare("With",
                         "",
                         admissible::text("name of a variation, or empty",
                                          "refinement"),
                         "This entry changes in parallel with another "
                         "variation, value by value; empty: on its own.");
      parameters.leave_subsection();
    }



    void
    declare_measure(Parameters &parameters, const std::string &name)
    {
      using namespace admissible;
      parameters.enter_subsection("Measure " + name);
      declare_word(
        parameters, "Source", "check", source_words(), "Where it is found.");
      parameters.declare("Name",
                         "",
                         names("first mode"),
                         "Names of checks, columns, or of a number of the "
                         "summary.");
      declare_word(parameters,
                   "Reduction",
                   "last",
                   reduction_words(),
                   "Of columns: which number becomes of the rows.");
      parameters.declare("From time",
                         "0",
                         non_negative_number("0.1"),
                         "Rows before it do not count, s.");
      parameters.declare("Until time",
                         "",
                         non_negative_number("0.1").or_empty(),
                         "Rows after it do not count, s; empty: the end.");
      parameters.declare("Reference",
                         "",
                         number("1").or_empty(),
                         "r; the error is |value - r| / scale. Empty: the "
                         "value itself is drawn. Checks bring their own.");
      parameters.declare("Scale",
                         "",
                         positive_number("4905").or_empty(),
                         "What differences are divided by; empty: |r|.");
      parameters.leave_subsection();
    }



    std::vector<std::string>
    names_in(const Scan                     &scan,
             const std::vector<std::string> &overrides,
             const std::string              &list)
    {
      auto names = split(scanned_value(scan, overrides, {}, list, ""), ',');
      for (auto name = names.begin(); name != names.end(); ++name)
        if (std::find(names.begin(), name, *name) != name)
          throw InputError("The name " + in_quotes(*name) +
                           " stands twice in the list " + in_quotes(list) +
                           " of " + scan.origin +
                           ". Usually a line was copied. Remove one.");
      return names;
    }



    void
    declare_study(Parameters                     &parameters,
                  const std::vector<std::string> &methods,
                  const std::vector<std::string> &variations,
                  const std::vector<std::string> &measures)
    {
      declare_study_top_level(parameters);
      for (const std::string &name : methods)
        declare_study_method(parameters, name);
      for (const std::string &name : variations)
        declare_variation(parameters, name);
      for (const std::string &name : measures)
        declare_measure(parameters, name);
      declare_axes(parameters);
      declare_bisection(parameters);
    }



    /** Paths in a study are seen from its folder. */
    std::string
    beside(const std::string &study, const std::string &path)
    {
      const std::filesystem::path inner(path);
      if (inner.is_absolute())
        return path;
      return (std::filesystem::path(study).parent_path() / inner)
        .lexically_normal()
        .string();
    }



    std::vector<std::string>
    read_settings(const Section &section, const std::string &entry)
    {
      const auto settings = split(section.text(entry), separator);
      for (const std::string &setting : settings)
        if (setting.find('=') == std::string::npos)
          throw InputError("The setting " + in_quotes(setting) + " in " +
                           section.where(entry) +
                           " has no '='. Usually a '|' is misplaced. Write "
                           "'Method/Transfer=apic | Method/Courant "
                           "number=0.3', for instance.");
      return settings;
    }



    /** The choices of one entry, named by their labels. */
    std::vector<Choice>
    read_choices(const Section &section)
    {
      const std::string entry = section.required_text("Entry");
      const auto values = split(section.required_text("Values"), separator);
      const auto labels = section.is_empty("Labels") ?
                            values :
                            split(section.text("Labels"), separator);
      if (labels.size() != values.size())
        throw InputError("There are " + std::to_string(labels.size()) +
                         " labels for " + std::to_string(values.size()) +
                         " values in " + section.where("Labels") +
                         ". Usually a '|' is missing. Give each value a label, "
                         "or leave 'Labels' empty.");
      std::vector<Choice> choices;
      for (std::size_t i = 0; i < values.size(); ++i)
        {
          for (std::size_t j = 0; j < i; ++j)
            if (labels[j] == labels[i])
              throw InputError(
                "The label " + in_quotes(labels[i]) + " stands twice in " +
                section.where(section.is_empty("Labels") ? "Values" :
                                                           "Labels") +
                ". Usually a value was copied. Tell them apart "
                "with 'Labels'.");
          choices.push_back({labels[i], {entry + "=" + values[i]}});
        }
      return choices;
    }



    void
    keep_short(const Section &section, std::vector<Choice> &choices)
    {
      std::vector<Choice>      kept;
      std::vector<std::string> labels;
      for (const Choice &choice : choices)
        labels.push_back(choice.label);
      for (const std::string &label : split(section.text("Short"), separator))
        {
          const auto found = std::find(labels.begin(), labels.end(), label);
          if (found == labels.end())
            {
              const auto meant = nearest(label, labels);
              throw InputError(
                in_quotes(label) + " in " + section.where("Short") +
                " is no label of this variation. Usually it is "
                "misspelt. " +
                (meant ? "Did you mean " + in_quotes(*meant) + "?" :
                         "Choose from: " + join(labels, " | ") + "."));
            }
          kept.push_back(choices[found - labels.begin()]);
        }
      choices = kept;
    }



    void
    check_known(const std::string              &name,
                const std::vector<std::string> &known,
                const std::string              &what,
                const std::string              &where)
    {
      if (std::find(known.begin(), known.end(), name) != known.end())
        return;
      const auto meant = nearest(name, known);
      throw InputError(
        "There is no " + what + " " + in_quotes(name) + ", which is named in " +
        where + ". Usually it is misspelt. " +
        (meant         ? "Did you mean " + in_quotes(*meant) + "?" :
         known.empty() ? "None is declared." :
                         "Choose from: " + join(known, ", ") + "."));
    }



    std::vector<Variation>
    read_variations(const Section &root, const bool take_short)
    {
      const auto             names = root.list("Variations");
      std::vector<Variation> variations;
      for (const std::string &name : names)
        {
          const Section section = root.subsection("Variation " + name);
          if (section.is_empty("With"))
            variations.push_back({name, read_choices(section)});
        }
      std::vector<std::string> leaders;
      for (const Variation &variation : variations)
        leaders.push_back(variation.name);

      for (const std::string &name : names)
        {
          const Section section = root.subsection("Variation " + name);
          if (section.is_empty("With"))
            continue;
          const std::string leader = section.text("With");
          check_known(leader,
                      leaders,
                      "variation of its own right called",
                      section.where("With"));
          auto &choices =
            variations[std::find(leaders.begin(), leaders.end(), leader) -
                       leaders.begin()]
              .choices;
          const std::string entry = section.required_text("Entry");
          const auto values = split(section.required_text("Values"), separator);
          if (values.size() != choices.size())
            throw InputError("There are " + std::to_string(values.size()) +
                             " values in " + section.where("Values") +
                             ", but " + std::to_string(choices.size()) +
                             " in the variation " + in_quotes(leader) +
                             ", with which they change in parallel. Usually "
                             "one was added to one list alone. Make the "
                             "lists equally long.");
          for (std::size_t i = 0; i < values.size(); ++i)
            choices[i].settings.push_back(entry + "=" + values[i]);
        }
      if (take_short)
        for (Variation &variation : variations)
          {
            const Section section =
              root.subsection("Variation " + variation.name);
            if (!section.is_empty("Short"))
              keep_short(section, variation.choices);
          }
      return variations;
    }



    std::vector<StudyMethod>
    read_methods(const Section &root, const bool take_short)
    {
      const auto all   = root.list("Methods");
      auto       names = all;
      if (take_short && !root.is_empty("Short methods"))
        {
          names = root.list("Short methods");
          for (const std::string &name : names)
            check_known(name, all, "method", root.where("Short methods"));
        }
      std::vector<StudyMethod> methods;
      for (const std::string &name : names)
        {
          const Section section = root.subsection("Method " + name);
          StudyMethod   method{{name, read_settings(section, "Settings")},
                             read_word(section, "Run by", runner_words()),
                             {}};
          if (!section.is_empty("Closed form"))
            method.closed_form = Formula<2>(section.text("Closed form"),
                                            {},
                                            1,
                                            section.where("Closed form"));
          methods.push_back(method);
        }
      if (methods.empty())
        methods.push_back({{"as in the scene", {}}, Runner::points, {}});
      return methods;
    }



    std::optional<double>
    optional_number(const Section &section, const std::string &entry)
    {
      return section.is_empty(entry) ?
               std::nullopt :
               std::optional<double>(section.number(entry));
    }



    std::vector<Measure>
    read_measures(const Section &root)
    {
      std::vector<Measure> measures;
      for (const std::string &name : root.list("Measures"))
        {
          const Section section = root.subsection("Measure " + name);
          Measure       measure;
          measure.name   = name;
          measure.source = read_word(section, "Source", source_words());
          section.required_text("Name");
          measure.of = section.list("Name");
          measure.reduction =
            read_word(section, "Reduction", reduction_words());
          measure.from_time = section.number("From time");
          if (!section.is_empty("Until time"))
            measure.until_time = section.number("Until time");
          measure.reference = optional_number(section, "Reference");
          measure.scale     = optional_number(section, "Scale");
          if (measure.source == MeasureSource::check &&
              (measure.reference || measure.scale))
            throw InputError(
              "A reference or scale is given in " +
              section.where(measure.reference ? "Reference" : "Scale") +
              ", but a check brings its own. Usually it was "
              "meant for the scene. Set 'Check NAME/Reference' "
              "in 'Settings'.");
          if (measure.source == MeasureSource::summary &&
              measure.of.size() != 1)
            throw InputError("There are " + std::to_string(measure.of.size()) +
                             " names in " + section.where("Name") +
                             ", but of the summary one number is taken. Make "
                             "them measures of their own.");
          if (measure.reference && !measure.scale && *measure.reference == 0)
            throw InputError("The reference is 0 in " +
                             section.where("Reference") +
                             ", so the error needs another scale. Set 'Scale' "
                             "to the size of what is measured.");
          measures.push_back(measure);
        }
      return measures;
    }



    std::vector<double>
    read_levels(const Section &root)
    {
      std::vector<double> levels;
      for (const std::string &part : root.list("Error levels"))
        {
          const auto number = to_number(part);
          if (!number || *number <= 0)
            throw InputError("The error level " + in_quotes(part) + " in " +
                             root.where("Error levels") +
                             " is no number greater than 0. Write '0.1, "
                             "0.01', for instance.");
          levels.push_back(*number);
        }
      return levels;
    }



    void
    read_axes(const Section &root, StudyFile &study)
    {
      const Section            section = root.subsection("Chart");
      const std::string        axis    = section.text("Horizontal axis");
      std::vector<std::string> names   = {"cost"};
      for (const Variation &variation : study.variations)
        names.push_back(variation.name);
      check_known(axis, names, "axis", section.where("Horizontal axis"));
      study.logarithmic      = section.text("Logarithmic");
      study.horizontal_label = section.text("Horizontal label");
      study.vertical_label   = section.text("Vertical label");
      if (axis == "cost")
        return;
      study.horizontal_axis = axis;
      for (const Variation &variation : study.variations)
        if (variation.name == axis)
          for (const Choice &choice : variation.choices)
            if (!to_number(choice.label))
              throw InputError("The label " + in_quotes(choice.label) +
                               " of the variation " + in_quotes(axis) +
                               " is no number, but " +
                               section.where("Horizontal axis") +
                               " draws against it. Give 'Labels' that are.");
    }



    BisectionRequest
    read_bisection(const Section &root)
    {
      const Section    section = root.subsection("Bisection");
      BisectionRequest request;
      request.entry     = section.required_text("Entry");
      request.lower     = section.number("Lower");
      request.upper     = section.number("Upper");
      request.tolerance = section.number("Tolerance");
      request.steps     = static_cast<unsigned int>(section.number("Steps"));
      request.growth    = section.number("Growth");
      if (request.lower >= request.upper)
        throw InputError(
          "The lower end " + section.text("Lower") + " in " +
          section.where("Lower") + " is not below the upper one, " +
          section.text("Upper") + ". Usually they are exchanged.");
      return request;
    }
  } // namespace



  std::string
  name_of(const Cost cost)
  {
    for (const auto &word : cost_words())
      if (word.value == cost)
        return word.word;
    return "";
  }



  StudyFile
  read_study(const std::string              &path,
             const std::vector<std::string> &overrides,
             const bool                      take_short)
  {
    const ParameterText text = read_parameter_text(path);
    const Scan scan = scan_parameters(text.text, text.format, text.origin);
    Parameters parameters;
    declare_study(parameters,
                  names_in(scan, overrides, "Methods"),
                  names_in(scan, overrides, "Variations"),
                  names_in(scan, overrides, "Measures"));
    parameters.read(scan, overrides);
    const Section root = parameters.root();

    StudyFile study;
    study.path     = path;
    study.is_short = take_short;
    study.scene    = beside(path, root.required_text("Scene"));
    study.title    = root.is_empty("Title") ?
                       std::filesystem::path(path).stem().string() :
                       root.text("Title");
    study.directory =
      root.is_empty("Directory") ?
        "studies/" + std::filesystem::path(path).stem().string() :
        root.text("Directory");
    study.replace  = root.flag("Replace");
    study.settings = read_settings(root, "Settings");
    if (take_short)
      for (const std::string &setting : read_settings(root, "Short settings"))
        study.settings.push_back(setting);
    study.methods      = read_methods(root, take_short);
    study.variations   = read_variations(root, take_short);
    study.measures     = read_measures(root);
    study.error_levels = read_levels(root);
    study.cost         = read_word(root, "Cost", cost_words());
    study.time_limit   = root.number("Time limit");
    read_axes(root, study);
    study.bisection = read_bisection(root);
    return study;
  }



  void
  print_study_parameters(std::ostream &out, const PrintStyle style)
  {
    Parameters parameters;
    declare_study(parameters, {"cell"}, {"refinement"}, {"frequency"});
    Scan scan;
    scan.origin = "the template";
    parameters.read(
      scan, {"Methods=cell", "Variations=refinement", "Measures=frequency"});
    parameters.print(out, style);
  }
} // namespace limber
