// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/materials/law_list.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/words.h>

#include <algorithm>

namespace limber
{
  void
  declare_method(Parameters &parameters)
  {
    parameters.enter_subsection("Method");
    declare_word(parameters,
                 "Time integration",
                 "auto",
                 time_integration_words(),
                 "How a step in time is taken.");
    declare_word(parameters,
                 "Stress update",
                 "auto",
                 stress_update_words(),
                 "When in a step the stress follows the motion.");
    declare_word(parameters,
                 "Transfer",
                 "flip",
                 transfer_words(),
                 "How velocity goes from the nodes back to the points.");
    parameters.declare("Transfer order",
                       "4",
                       admissible::positive_integer("4"),
                       "k of FMPM(k) and XPIC(k): 1 is PIC, more keep shorter "
                       "waves; each beyond the first costs a pass over the "
                       "points.");
    parameters.declare("Transfer period",
                       "1",
                       admissible::positive_integer("10"),
                       "FMPM and XPIC act every so many steps; in between the "
                       "transfer is FLIP.");
    parameters.renamed("Damping time", "Blend time");
    parameters.declare("Blend time",
                       "0",
                       admissible::non_negative_number("0.1"),
                       "PIC/FLIP blend: time constant T, s, in which PIC takes "
                       "away what FLIP keeps; FLIP ratio 1 - dt/T; 0: pure "
                       "FLIP.");
    parameters.declare("Damping rate",
                       "0",
                       admissible::non_negative_number("0.3"),
                       "Mass-proportional damping: alpha, 1/s, of the "
                       "acceleration -alpha v of all material; brings a run "
                       "under slow loads to rest.");
    declare_word(parameters,
                 "Kernel",
                 "auto",
                 kernel_words(),
                 "Functions of the nodes: their weights at a point.");
    parameters.declare("Courant number",
                       "0.4",
                       admissible::number_from_to(1e-6, 100, "0.4"),
                       "CFL number C, no unit; step dt = C h / (c + |v|) with "
                       "the speed of sound c.");
    parameters.declare("Time step",
                       "0",
                       admissible::non_negative_number("1e-4"),
                       "dt, s; 0: from the Courant number.");
    parameters.declare("Newton tolerance",
                       "1e-6",
                       admissible::number_from_to(1e-12, 0.01, "1e-8"),
                       "Forces out of balance over forces, at which Newton's "
                       "method of implicit and quasi-static steps ends, no "
                       "unit.");
    parameters.declare("Ghost penalty",
                       "0.03",
                       admissible::non_negative_number("0.03"),
                       "Stiffness of quasi-static steps against "
                       "jumps of the strain (with splines: of its derivative) "
                       "next to a free surface, over Young's modulus, no unit: "
                       "holds the nodes of cells that are hardly filled.");
    parameters.only_with("Newton tolerance",
                         {"quasi-static", "implicit"},
                         "Time integration",
                         parameters.present_section());
    parameters.only_with("Ghost penalty",
                         {"quasi-static"},
                         "Time integration",
                         parameters.present_section());
    parameters.declare("Spectral radius at infinity",
                       "0.9",
                       admissible::number_from_to(0, 1, "0.8"),
                       "r, no unit, of implicit steps: what a step leaves of "
                       "vibrations that are much faster than it "
                       "(generalised-alpha method); 1: all, the trapezoidal "
                       "rule, which can create energy in large motion.");
    parameters.only_with("Spectral radius at infinity",
                         {"implicit"},
                         "Time integration",
                         parameters.present_section());
    parameters.declare("Lost points limit",
                       "0",
                       admissible::number_from_to(0, 1, "0.01"),
                       "Share of all points that may leave the grid before "
                       "the run is stopped, no unit.");
    parameters.declare("Energy growth limit",
                       "1",
                       admissible::positive_number("1"),
                       "Growth of the total energy over its scale that stops a "
                       "run as unstable, no unit.");
    parameters.leave_subsection();
  }



  Method
  read_method(const Section &section)
  {
    Method method;
    method.integration =
      read_word(section, "Time integration", time_integration_words());
    method.order = read_word(section, "Stress update", stress_update_words());
    method.transfer = read_word(section, "Transfer", transfer_words());
    method.transfer_order =
      static_cast<unsigned int>(section.number("Transfer order"));
    method.transfer_period =
      static_cast<unsigned int>(section.number("Transfer period"));
    method.blend_time          = section.number("Blend time");
    method.damping_rate        = section.number("Damping rate");
    method.courant_number      = section.number("Courant number");
    method.time_step           = section.number("Time step");
    method.newton_tolerance    = section.number("Newton tolerance");
    method.ghost_penalty       = section.number("Ghost penalty");
    method.spectral_radius     = section.number("Spectral radius at infinity");
    method.lost_points_limit   = section.number("Lost points limit");
    method.energy_growth_limit = section.number("Energy growth limit");

    if (method.blend_time > 0 && method.transfer != Transfer::flip &&
        method.transfer != Transfer::aflip)
      throw InputError("The blend time " + section.text("Blend time") + " in " +
                       section.where("Blend time") +
                       " belongs to FLIP and AFLIP, but 'Transfer' is " +
                       in_quotes(section.text("Transfer")) +
                       ". Usually one of them was changed alone. Set "
                       "'Transfer = flip' or 'Blend time = 0'.");
    const auto refuse = [&](const std::string &entry,
                            const std::string &reason,
                            const std::string &remedy) {
      throw InputError("The entry " + in_quotes(section.text(entry)) + " in " +
                       section.where(entry) + " " + reason +
                       ". Usually one of them was changed alone. Set " +
                       remedy + ".");
    };
    if (method.spectral_radius != Method().spectral_radius &&
        method.integration != TimeIntegration::implicit_steps)
      refuse("Spectral radius at infinity",
             "damps implicit steps alone, but 'Time integration' is " +
               in_quotes(section.text("Time integration")),
             "'Time integration = implicit', or 'Spectral radius at infinity "
             "= 0.9'");
    const std::string transfer =
      "'Transfer = " + section.text("Transfer") + "'";
    if (!filters_velocity(method.transfer))
      {
        if (method.transfer_order != Method().transfer_order)
          refuse("Transfer order",
                 "has no effect with " + transfer,
                 "'Transfer = fmpm' or 'Transfer order = 4'");
        if (method.transfer_period != Method().transfer_period)
          refuse("Transfer period",
                 "has no effect with " + transfer,
                 "'Transfer = fmpm' or 'Transfer period = 1'");
      }
    else if (method.order != StressUpdateOrder::automatic &&
             method.order != StressUpdateOrder::usl)
      refuse("Stress update",
             "does not go with " + transfer +
               ", which strains with the velocity that it filters",
             "'Stress update = usl'");
    return method;
  }



  namespace
  {
    std::vector<std::string>
    field_words()
    {
      std::vector<std::string> words = {"displacement",
                                        "velocity",
                                        "pressure",
                                        "stress",
                                        "equivalent stress",
                                        "volume ratio",
                                        "mass",
                                        "point pressure",
                                        "point stress",
                                        "body"};
      for (const std::string &variable : names_of_variables())
        words.push_back(variable);
      words.push_back("none");
      return words;
    }
  } // namespace



  void
  declare_output(Parameters &parameters)
  {
    parameters.enter_subsection("Output");
    parameters.declare("Directory",
                       "output",
                       admissible::text("path of a folder", "output"),
                       "The run folder; it is made, with those above it.");
    parameters.declare("Replace",
                       "false",
                       admissible::flag(),
                       "Whether a folder that holds a run is overwritten.");
    parameters.declare("Time interval",
                       "0",
                       admissible::non_negative_number("0.1"),
                       "Time between pictures for ParaView, s; 0: none, only "
                       "statistics.");
    parameters.declare("Fields",
                       "displacement, velocity, pressure",
                       admissible::some_of(field_words()),
                       "What is written with the points. Pressure is positive "
                       "in compression, stress in tension (Cauchy). They are "
                       "those that act after the locking treatment; 'point "
                       "pressure' and 'point stress' are those before it. "
                       "Variables of materials with a memory go by their "
                       "names; they are zero in other bodies.");
    parameters.declare("Point arrays",
                       "false",
                       admissible::flag(),
                       "Whether an HDF5 file is written beside each picture "
                       "of the points, for 'limber compare' and programs of "
                       "your own. Displacement, velocity, pressure, stress and "
                       "mass are then fields of the picture as well.");
    parameters.declare("Statistics interval",
                       "1",
                       admissible::positive_integer("10"),
                       "Steps between rows of the statistics.");
    parameters.declare("Progress interval",
                       "5",
                       admissible::non_negative_number("5"),
                       "Wall time between lines on the screen, s; 0: a line "
                       "for every step.");
    parameters.leave_subsection();
  }



  OutputRequest
  read_output(const Section &section)
  {
    OutputRequest output;
    output.directory     = section.required_text("Directory");
    output.replace       = section.flag("Replace");
    output.time_interval = section.number("Time interval");
    output.statistics_interval =
      static_cast<unsigned int>(section.number("Statistics interval"));
    output.progress_interval = section.number("Progress interval");

    output.fields = section.list("Fields");
    for (const std::string &field : output.fields)
      if (field == "none")
        {
          if (output.fields.size() > 1)
            throw InputError("The word 'none' stands beside other fields in " +
                             section.where("Fields") +
                             ". Usually it was left over. Write 'none' alone "
                             "or fields alone, for instance 'velocity, "
                             "pressure'.");
          output.fields.clear();
          break;
        }
    output.point_arrays = section.flag("Point arrays");
    if (output.point_arrays && output.time_interval == 0)
      throw InputError("The entry 'Point arrays' is true in " +
                       section.where("Point arrays") +
                       ", but there are no times to write them at. Usually "
                       "'Time interval' was forgotten. Set 'Output/Time "
                       "interval = 0.1', for instance.");
    if (output.point_arrays)
      for (const char *const field :
           {"displacement", "velocity", "pressure", "stress", "mass"})
        if (std::find(output.fields.begin(), output.fields.end(), field) ==
            output.fields.end())
          output.fields.push_back(field);
    return output;
  }



  void
  declare_checkpoint(Parameters &parameters)
  {
    parameters.enter_subsection("Checkpoint");
    parameters.declare("Interval",
                       "3600",
                       admissible::non_negative_number("600"),
                       "Wall time between checkpoints, s; 0: only when the "
                       "run is stopped.");
    parameters.declare("Steps",
                       "0",
                       admissible::non_negative_integer("1000"),
                       "Steps between checkpoints, beside the interval; 0: "
                       "the interval alone counts.");
    parameters.declare("Wall time limit",
                       "0",
                       admissible::non_negative_number("3500"),
                       "Wall time after which the run writes a checkpoint and "
                       "ends with exit code 143, s; 0: none.");
    parameters.declare("At the end",
                       "true",
                       admissible::flag(),
                       "Whether a run that has finished writes one as well, "
                       "so that --resume with a later 'End time' extends it.");
    parameters.leave_subsection();
  }



  CheckpointRequest
  read_checkpoint(const Section &section)
  {
    CheckpointRequest checkpoint;
    checkpoint.interval = section.number("Interval");
    checkpoint.steps    = static_cast<unsigned int>(section.number("Steps"));
    checkpoint.wall_time_limit = section.number("Wall time limit");
    checkpoint.at_the_end      = section.flag("At the end");
    return checkpoint;
  }
} // namespace limber
