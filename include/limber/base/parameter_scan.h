// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_base_parameter_scan_h
#define limber_base_parameter_scan_h

#include <optional>
#include <string>
#include <vector>

/**
 * @file What stands in a parameter file, before anyone asks whether it may
 * stand there. Names and places are kept, so that a message can point at them.
 */
namespace limber
{
  /** Names of the enclosing sections, outermost first. */
  using SectionPath = std::vector<std::string>;

  /** Path with '/' between the names; empty at the top level. */
  std::string
  to_text(const SectionPath &path);

  enum class FileFormat
  {
    prm, // 'set a = b' and 'subsection s ... end', '#' starts a comment
    json // nested objects with plain names; arrays stand for comma lists
  };

  struct ScannedEntry
  {
    SectionPath  section;
    std::string  name, value;
    unsigned int line = 0; // 0: not known (JSON, --set)
  };

  struct ScannedSection
  {
    SectionPath  path;
    unsigned int line = 0;
  };

  /** All entries and sections of one file, in order of appearance. */
  struct Scan
  {
    std::string                 origin; // file name as the user typed it
    std::vector<ScannedEntry>   entries;
    std::vector<ScannedSection> sections;

    /** The value that counts: the last one. */
    std::optional<std::string>
    last_value(const SectionPath &section, const std::string &name) const;

    bool
    has_section(const SectionPath &path) const;
  };

  /** Takes a text apart; throws InputError where its structure is broken. */
  Scan
  scan_parameters(const std::string &text,
                  const FileFormat   format,
                  const std::string &origin);

  struct ParameterText
  {
    std::string text;
    FileFormat  format = FileFormat::prm;
    std::string origin;
  };

  /**
   * Read a file on rank 0 and hand it to all: '.json' is JSON, everything else
   * prm, '--' prm from standard input. Throws InputError on every rank where
   * the file cannot be read.
   */
  ParameterText
  read_parameter_text(const std::string &path);
} // namespace limber

#endif
