// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/memory.h>
#include <limber/base/text.h>
#include <limber/base/timing.h>
#include <limber/study/inf_sup.h>
#include <limber/study/study_commands.h>
#include <limber/study/study_folder.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <sstream>

namespace limber
{
  namespace
  {
    const std::string inf_sup_usage = R"(limber inf-sup [options]

Numerical inf-sup test of Chapelle and Bathe for the pressures of the locking
treatments: smallest nonzero beta of B S^-1 B^T q = beta^2 M q on the unit
square, no velocity on its boundary.

  --cells 4,8,12            cells per edge, one mesh after the other
  --pressure cell|node      one pressure per cell (DGQ0) or nodal (Q1); default
                            both
  --points n                points per cell edge that integrate; default Gauss
                            points, or 3 where the filling is random
  --fill share              probability that a point of the outermost cells is
                            there, default 1
  --samples n               random fillings; smallest and mean beta are told
  --output-directory path   also write study.csv, study.md and a chart there
  --replace                 also if there are such results of a former call

Exit codes: 0 done, 1 wrong input, 3 file error.
)";

    struct InfSupCall
    {
      std::vector<unsigned int>  cells     = {4, 8, 12, 16, 20};
      std::vector<PressureSpace> pressures = {PressureSpace::cell,
                                              PressureSpace::node};
      unsigned int               points    = 0;
      double                     fill      = 1;
      unsigned int               samples   = 1;
      std::string                directory;
      bool                       replace = false, help = false;
    };



    double
    number_of(const std::string &option,
              const std::string &word,
              const double       lower,
              const double       upper)
    {
      const auto number = to_number(word);
      if (!number || *number < lower || *number > upper)
        throw InputError("The value " + in_quotes(word) + " of " +
                         in_quotes(option) +
                         " on the command line is not admissible. Write a "
                         "number from " +
                         to_text(lower) + " to " + to_text(upper) + ".");
      return *number;
    }



    unsigned int
    count_of(const std::string &option,
             const std::string &word,
             const unsigned int lower,
             const unsigned int upper)
    {
      const double number = number_of(option, word, lower, upper);
      if (number != std::floor(number))
        throw InputError("The value " + in_quotes(word) + " of " +
                         in_quotes(option) +
                         " on the command line is no whole number.");
      return static_cast<unsigned int>(number);
    }



    /** The matrices of the test are full. */
    void
    check_memory_of(const unsigned int cells)
    {
      const double velocities = 2. * cells * cells;
      const double pressures  = (cells + 1.) * (cells + 1.);
      const double bytes =
        sizeof(double) * (velocities * velocities + 2 * velocities * pressures +
                          3 * pressures * pressures);
      const double there = machine_memory(1);
      if (bytes > there)
        throw InputError("The test with " + std::to_string(cells) +
                         " cells per edge ('--cells' on the command line) "
                         "needs some " +
                         brief(bytes / 1e9) + " GB of memory; there are " +
                         brief(there / 1e9) +
                         ". Its matrices are full. Write '--cells 4,8,12'.");
    }



    void
    take_inf_sup_option(const std::string &option,
                        const std::string &value,
                        InfSupCall        &call)
    {
      if (option == "--cells")
        {
          call.cells.clear();
          for (const std::string &part : split(value, ','))
            call.cells.push_back(count_of(option, part, 2, 64));
          if (call.cells.empty())
            throw InputError("The option '--cells' on the command line lists "
                             "no mesh. Write '--cells 4,8,12', for instance.");
        }
      else if (option == "--pressure")
        {
          if (value != "cell" && value != "node")
            throw InputError("The pressure " + in_quotes(value) +
                             " on the command line is not known. Write cell "
                             "or node.");
          call.pressures = {value == "cell" ? PressureSpace::cell :
                                              PressureSpace::node};
        }
      else if (option == "--points")
        call.points = count_of(option, value, 1, 16);
      else if (option == "--fill")
        call.fill = number_of(option, value, 0.05, 1);
      else if (option == "--samples")
        call.samples = count_of(option, value, 1, 1000);
      else if (option == "--output-directory")
        {
          call.directory = value;
          if (value.empty())
            throw InputError("The option '--output-directory' on the command "
                             "line has an empty value. Usually a variable of "
                             "the shell is not set. Name a folder, or leave "
                             "the option out.");
        }
    }



    InfSupCall
    parse_inf_sup(const int argc, const char *const *argv)
    {
      const std::vector<std::string> known = {"--cells",
                                              "--pressure",
                                              "--points",
                                              "--fill",
                                              "--samples",
                                              "--output-directory",
                                              "--replace",
                                              "--help",
                                              "-h"};
      InfSupCall                     call;
      for (int i = 2; i < argc; ++i)
        {
          const std::string option = argv[i];
          if (option == "--help" || option == "-h" || option == "--replace")
            {
              (option == "--replace" ? call.replace : call.help) = true;
              continue;
            }
          if (std::find(known.begin(), known.end(), option) == known.end())
            {
              const auto meant = nearest(option, known);
              throw InputError("The word " + in_quotes(option) +
                               " on the command line is not known. Usually it "
                               "is misspelt. " +
                               (meant ?
                                  "Did you mean " + in_quotes(*meant) + "?" :
                                  "See 'limber inf-sup --help'."));
            }
          if (i + 1 == argc)
            throw InputError("The option " + in_quotes(option) +
                             " at the end of the command line lacks its "
                             "value. See 'limber inf-sup --help'.");
          take_inf_sup_option(option, argv[++i], call);
        }
      if (call.fill < 1 && call.points == 0)
        call.points = 3;
      for (const unsigned int cells : call.cells)
        check_memory_of(cells);
      return call;
    }



    const char *
    name_of(const PressureSpace space)
    {
      return space == PressureSpace::cell ? "cell (DGQ0)" : "node (Q1)";
    }



    /** The meshes as variants of a study, so that its table and chart serve. */
    StudyReport
    report_frame(const InfSupCall &call, const std::string &command)
    {
      StudyReport report;
      report.study.title =
        call.fill < 1 ? "Numerical inf-sup constant, outermost cells filled "
                        "at random, " +
                          brief(call.fill) :
                        "Numerical inf-sup constant";
      report.study.directory       = call.directory;
      report.study.horizontal_axis = "cells per edge";
      report.study.vertical_label  = "beta";
      report.caption               = caption_of(command);
      Measure beta;
      beta.name             = "beta";
      beta.source           = MeasureSource::summary;
      Measure mean          = beta;
      mean.name             = "mean beta of the fillings";
      Measure zero          = beta;
      zero.name             = "zero modes";
      report.study.measures = {beta, mean, zero};
      for (const PressureSpace space : call.pressures)
        report.study.methods.push_back(
          {{name_of(space), {}}, Runner::points, {}});
      Variation variation{"cells per edge", {}};
      for (const unsigned int n : call.cells)
        variation.choices.push_back({std::to_string(n), {}});
      report.study.variations = {variation};
      return report;
    }
  } // namespace



  int
  inf_sup_command(const int argc, const char *const *argv)
  {
    const InfSupCall call = parse_inf_sup(argc, argv);
    if (call.help)
      {
        std::cout << inf_sup_usage;
        return int(ExitCode::success);
      }
    std::string command = "limber";
    for (int i = 1; i < argc; ++i)
      if (argv[i] == std::string("--output-directory"))
        ++i;
      else if (argv[i] != std::string("--replace"))
        command += std::string(" ") + argv[i];
    StudyReport report = report_frame(call, command);
    FolderKind  kind   = study_folder_kind();
    kind.entry         = "--output-directory";
    kind.replace_by    = "--replace";
    kind.go_on_by      = "";
    FolderLock lock;
    if (!call.directory.empty())
      lock = claim_folder(call.directory,
                          kind,
                          call.replace ? FolderUse::replace : FolderUse::fresh);
    if (!lock.warning().empty())
      std::cout << "Warning: " << lock.warning() << std::endl;

    std::cout
      << "pressure      cells   beta     mean     n beta   zero modes\n";
    for (std::size_t s = 0; s < call.pressures.size(); ++s)
      for (std::size_t c = 0; c < call.cells.size(); ++c)
        {
          const double start    = cpu_time();
          double       smallest = 1e300, sum = 0;
          unsigned int zero_modes = 0;
          for (unsigned int sample = 1; sample <= call.samples; ++sample)
            {
              const InfSup found = inf_sup({call.cells[c],
                                            call.pressures[s],
                                            call.points,
                                            call.fill,
                                            sample});
              smallest           = std::min(smallest, found.beta);
              zero_modes         = std::max(zero_modes, found.zero_modes);
              sum += found.beta;
            }
          const double mean = sum / call.samples;
          StudyRow     row{{}, "finished", "", 0, {}, {}};
          row.variant.method           = s;
          row.variant.choices          = {c};
          row.measured                 = {{smallest, smallest},
                                          {mean, mean},
                                          {double(zero_modes), double(zero_modes)}};
          row.costs[Cost::cpu_seconds] = cpu_time() - start;
          report.rows.push_back(row);
          std::cout << std::left << std::setw(14) << name_of(call.pressures[s])
                    << std::setw(8) << call.cells[c] << std::fixed
                    << std::setprecision(4) << std::setw(9) << smallest
                    << std::setw(9) << mean << std::setw(9)
                    << smallest * call.cells[c] << zero_modes << std::endl;
        }
    if (!call.directory.empty())
      {
        write_report(report, "");
        std::cout << draw_chart(report.study) << std::endl;
      }
    return int(ExitCode::success);
  }
} // namespace limber
