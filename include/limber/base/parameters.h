// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_base_parameters_h
#define limber_base_parameters_h

#include <deal.II/base/parameter_handler.h>

#include <limber/base/admissible.h>
#include <limber/base/parameter_scan.h>

#include <iosfwd>
#include <map>
#include <string>
#include <vector>

namespace limber
{
  class Section;

  enum class PrintStyle
  {
    prm,
    json,
    markdown
  };

  /** An entry that a scene may have. */
  struct Declaration
  {
    SectionPath section;
    std::string name, default_value;
    Admissible  admissible;
    std::string text; // symbol, unit, meaning, where the formula is
  };



  /**
   * The entries that a file may have, and their values. Declaration, storage
   * and printing as prm rest on deal.II's ParameterHandler; reading is ours,
   * because a message has to name the entry, guess what was meant, and say
   * what would work.
   *
   * Names that the user chooses (bodies, observables) need two passes: scan
   * the file, declare the sections of those names, then read().
   */
  class Parameters
  {
  public:
    void
    enter_subsection(const std::string &name);

    void
    leave_subsection();

    /** An entry of the present section. */
    void
    declare(const std::string &name,
            const std::string &default_value,
            const Admissible  &admissible,
            const std::string &text);

    /**
     * Say what the entry @p former of the present section is called now: a
     * scene with the old name is refused with the new one.
     */
    void
    renamed(const std::string &former, const std::string &now);

    /**
     * Say that the entry @p entry of the present section only has an effect
     * with one of the words @p words of the entry @p chooser of @p section.
     */
    void
    only_with(const std::string              &entry,
              const std::vector<std::string> &words,
              const std::string              &chooser,
              const SectionPath              &section);

    /** Where declare() puts entries. */
    SectionPath
    present_section() const;

    /**
     * Declare the entry @p list of the present section as a list of names,
     * each of which has a section called @p prefix + name beside it.
     */
    void
    declare_list(const std::string &list,
                 const std::string &default_value,
                 const std::string &prefix,
                 const std::string &text);

    /**
     * Take the values of a file and then those of the command line
     * ("Section/Name=value"). Throws InputError for an unknown section or
     * entry, for a value that is not admissible, and for one that has no effect
     * because the word that chooses it is not given.
     */
    void
    read(const Scan &scan, const std::vector<std::string> &overrides);

    /** The top level, to read from. */
    Section
    root() const;

    /** Full names ("Grid/Cells") and values of all entries. */
    std::vector<std::pair<std::string, std::string>>
    entries() const;

    /** All entries with their present values. */
    void
    print(std::ostream &out, const PrintStyle style) const;

    /** What was not wrong but worth a line in the log: repeated entries, and
     * those without effect. */
    const std::vector<std::string> &
    warnings() const;

  private:
    friend class Section;

    /** The section below which names of a list have their sections. */
    struct NameList
    {
      SectionPath section;
      std::string entry, prefix;
    };

    /** An entry that only counts with some words of another entry. */
    struct Condition
    {
      SectionPath              section;
      std::string              entry;
      SectionPath              chooser_section;
      std::string              chooser;
      std::vector<std::string> words;
    };

    const Declaration *
    find(const SectionPath &section, const std::string &name) const;

    /**
     * The entry beside @p section of which its name is a word, 'Material' for
     * 'Neo hookean'; null: the section is always in use. @p word is its name as
     * it stands there.
     */
    const Declaration *
    what_chooses(const SectionPath &section, std::string &word) const;

    /** Refuse or note what is given without effect. */
    void
    check_use();

    bool
    is_declared(const SectionPath &section) const;

    void
    set(const Declaration  &declaration,
        const ScannedEntry &entry,
        const std::string  &place);

    void
    read_override(const std::string &override_text);

    [[noreturn]] void
    refuse_section(const SectionPath &path, const std::string &place) const;

    [[noreturn]] void
    refuse_entry(const ScannedEntry &entry, const std::string &place) const;

    std::string
    value(const SectionPath &section, const std::string &name) const;

    std::string
    where(const SectionPath &section, const std::string &name) const;

    void
    print_json(std::ostream &out) const;

    void
    print_markdown(std::ostream &out) const;

    mutable dealii::ParameterHandler handler; // its print() is not const
    std::vector<Declaration>         declarations;
    std::vector<NameList>            lists;
    std::vector<Condition>           conditions;
    SectionPath                      present;

    // What entries of former versions are called now, by full former name.
    std::map<std::string, std::string> successors;

    // Where a value came from: "line 12 of scene.prm", by full name.
    std::map<std::string, std::string> places;
    std::vector<std::string>           notes;
  };



  /**
   * The values of one section. An entry that was not declared is an error of
   * the program, not of the user.
   */
  class Section
  {
  public:
    Section(const Parameters &parameters, const SectionPath &path);

    Section
    subsection(const std::string &name) const;

    /** The top level. */
    Section
    root() const;

    bool
    has_entry(const std::string &entry) const;

    /** The entry was left empty. */
    bool
    is_empty(const std::string &entry) const;

    std::string
    text(const std::string &entry) const;

    /** Throws InputError where the entry was left empty. */
    std::string
    required_text(const std::string &entry) const;

    double
    number(const std::string &entry) const;

    bool
    flag(const std::string &entry) const;

    /** Parts between commas. */
    std::vector<std::string>
    list(const std::string &entry) const;

    /** Numbers between commas. */
    std::vector<double>
    numbers(const std::string &entry) const;

    /** "section 'Body water', entry 'Placement' (line 12 of dam.prm)". */
    std::string
    where(const std::string &entry) const;

  private:
    const Parameters *parameters;
    SectionPath       path;
  };



  /**
   * The value of @p name in @p section as it stands in the file or, with
   * priority, on the command line; for lists of names, which are needed
   * before anything is declared.
   */
  std::string
  scanned_value(const Scan                     &scan,
                const std::vector<std::string> &overrides,
                const SectionPath              &section,
                const std::string              &name,
                const std::string              &default_value);
} // namespace limber

#endif
