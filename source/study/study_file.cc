// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/study/study_parameters.h>

#include <algorithm>
#include <filesystem>

namespace limber
{
  namespace
  {
    // Between the values of a list: those of the scene may contain commas and
    // semicolons.
    constexpr char separator = '|';



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



    /** With the further ones of the short version. */
    std::vector<std::string>
    read_all_settings(const Section &section, const bool take_short)
    {
      auto settings = read_settings(section, "Settings");
      if (take_short)
        for (const std::string &setting :
             read_settings(section, "Short settings"))
          settings.push_back(setting);
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
            variations.push_back(
              {name, read_choices(section), section.flag("Another problem")});
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
          measure.reference   = optional_number(section, "Reference");
          measure.scale       = optional_number(section, "Scale");
          const bool is_check = measure.source == MeasureSource::check;
          const bool is_comparison =
            measure.source == MeasureSource::comparison;
          if ((is_check || is_comparison) &&
              (measure.reference || measure.scale))
            throw InputError(
              "A reference or scale is given in " +
              section.where(measure.reference ? "Reference" : "Scale") +
              (is_check ? ", but a check brings its own. Usually it was meant "
                          "for the scene. Set 'Check NAME/Reference' in "
                          "'Settings'." :
                          ", but a comparison is relative to what it compares "
                          "with. Leave it empty."));
          if ((measure.source == MeasureSource::summary || is_comparison) &&
              measure.of.size() != 1)
            throw InputError("There are " + std::to_string(measure.of.size()) +
                             " names in " + section.where("Name") + ", but " +
                             (is_comparison ? "one error is taken" :
                                              "of the summary one number is "
                                              "taken") +
                             ". Make them measures of their own.");
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



    /** Names of what is drawn, each one of @p known. */
    std::vector<std::string>
    read_drawn(const Section                  &chart,
               const std::string              &entry,
               const std::string              &what,
               const std::vector<std::string> &known)
    {
      const auto names = chart.list(entry);
      for (const std::string &name : names)
        check_known(name, known, what, chart.where(entry));
      return names;
    }



    void
    read_chart(const Section &root, StudyFile &study)
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
      study.drawn_methods =
        read_drawn(section, "Methods", "method", root.list("Methods"));
      study.drawn_measures =
        read_drawn(section, "Measures", "measure", root.list("Measures"));
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



  bool
  is_compared(const StudyFile &study)
  {
    return std::any_of(study.measures.begin(),
                       study.measures.end(),
                       [](const Measure &measure) {
                         return measure.source == MeasureSource::comparison;
                       });
  }



  std::string
  name_of(const Cost cost)
  {
    for (const auto &word : cost_words())
      if (word.value == cost)
        return word.word;
    return "";
  }



  void
  read_entries(const std::string              &path,
               const std::vector<std::string> &overrides,
               Parameters                     &parameters)
  {
    const ParameterText text = read_parameter_text(path);
    const Scan scan = scan_parameters(text.text, text.format, text.origin);
    if (scan.last_value({}, "Bodies"))
      throw InputError(in_quotes(text.origin) +
                       " is a scene and no study. Usually a word is too many. "
                       "Run it with 'limber " +
                       text.origin +
                       "', or write a study of it like "
                       "prm/studies/cantilever.prm.");
    declare_study(parameters,
                  names_in(scan, overrides, "Methods"),
                  names_in(scan, overrides, "Variations"),
                  names_in(scan, overrides, "Measures"));
    parameters.read(scan, overrides);
  }



  StudyFile
  read_study(const std::string              &path,
             const std::vector<std::string> &overrides,
             const bool                      take_short)
  {
    Parameters parameters;
    read_entries(path, overrides, parameters);
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
    study.replace            = root.flag("Replace");
    study.settings           = read_all_settings(root, take_short);
    study.methods            = read_methods(root, take_short);
    study.variations         = read_variations(root, take_short);
    study.measures           = read_measures(root);
    const Section comparison = root.subsection("Comparison");
    study.comparison         = {read_word(comparison, "With", standard_words()),
                                read_all_settings(comparison, take_short)};
    study.error_levels       = read_levels(root);
    study.cost               = read_word(root, "Cost", cost_words());
    study.time_limit         = root.number("Time limit");
    read_chart(root, study);
    study.bisection = read_bisection(root);
    return study;
  }
} // namespace limber
