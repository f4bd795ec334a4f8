// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/study/study_parameters.h>

namespace limber
{
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
      {"summary", MeasureSource::summary, "a number of summary.json"},
      {"comparison",
       MeasureSource::comparison,
       "relative L2 error of a field over body and time, or of an observable "
       "over time, as 'limber compare' finds it against section 'Comparison'"}};
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



  const Words<Standard> &
  standard_words()
  {
    static const Words<Standard> words = {
      {"reference",
       Standard::reference,
       "the finite elements of 'limber reference'"},
      {"points", Standard::points, "another run, usually a finer one"},
      {"exact",
       Standard::exact,
       "the formulas in section 'Exact solution' of the scene"}};
    return words;
  }



  namespace
  {
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
      parameters.declare(
        "Methods",
        "",
        names("cell, none"),
        "Those that are drawn; empty: all. The table has all.");
      parameters.declare(
        "Measures",
        "",
        names("frequency"),
        "Those that are drawn, a panel each, and whose cheapest "
        "variants are named; empty: all. The table has all.");
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
    declare_comparison(Parameters &parameters)
    {
      parameters.enter_subsection("Comparison");
      declare_word(parameters,
                   "With",
                   "reference",
                   standard_words(),
                   "What runs are compared with where a measure asks for it. "
                   "It is computed once, before all variants.");
      parameters.declare("Settings",
                         "",
                         settings_text(),
                         "Entries of the scene that make it, besides the "
                         "settings of the study.");
      parameters.declare("Short settings",
                         "",
                         settings_text(),
                         "Further ones for the short version, '--short'.");
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
      parameters.declare("Another problem",
                         "false",
                         admissible::flag(),
                         "Whether another value makes another problem: the "
                         "cheapest variant for an error is then named for "
                         "each value, and so is what no other one beats.");
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
                         "Names of checks, of columns, of a number of the "
                         "summary, or of what is compared: displacement, "
                         "velocity, pressure, stress, or an observable.");
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
  } // namespace



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
    declare_comparison(parameters);
    declare_axes(parameters);
    declare_bisection(parameters);
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
