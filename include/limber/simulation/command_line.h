// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_simulation_command_line_h
#define limber_simulation_command_line_h

#include <limber/base/parameters.h>

#include <optional>
#include <string>
#include <vector>

namespace limber
{
  /** What the user asked for in the shell. */
  struct CommandLine
  {
    bool help     = false;
    bool version  = false;
    bool validate = false; // build everything, run nothing
    bool resume   = false; // go on from the checkpoint in the run folder

    std::optional<PrintStyle>  print_parameters;
    std::optional<std::string> list; // topic of --list
    std::optional<std::string> output_directory;
    std::optional<std::string> frequencies; // how many, for 'reference'

    // "Section/Name=value", in order; --output-directory is among them.
    std::vector<std::string> overrides;

    // Path of the scene; "--": standard input; empty: none was given.
    std::string scene;
  };

  /** Throws InputError for an unknown option or a missing value. */
  CommandLine
  parse_command_line(const int argc, const char *const *argv);

  /**
   * Throw InputError if the first word looks like a misspelt command: no
   * option, no file, but near to `study`, `plot` and their like.
   */
  void
  check_first_word(const int argc, const char *const *argv);

  /** What --help prints. */
  std::string
  usage();

  /**
   * What --list prints: name and one line for each choice of a topic, laws,
   * kernels, schemes, shapes, sides, contact or exact. Throws InputError for
   * another topic.
   */
  std::string
  list_text(const std::string &topic);
} // namespace limber

#endif
