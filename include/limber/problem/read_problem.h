// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_read_problem_h
#define limber_problem_read_problem_h

#include <limber/base/parameters.h>
#include <limber/problem/problem.h>

#include <iosfwd>
#include <string>
#include <vector>

namespace limber
{
  /**
   * A scene as the user wrote it: all entries known and of admissible form,
   * but not yet asked whether they fit together. It knows the dimension, so
   * that the program can choose the Problem<dim> to read.
   */
  class SceneFile
  {
  public:
    /**
     * Read a .prm or .json file, '--' for prm from standard input, on all
     * ranks alike. @p overrides are "Section/Name=value" from the command
     * line. Throws InputError.
     */
    explicit SceneFile(const std::string              &path,
                       const std::vector<std::string> &overrides = {});

    /** The same from a text in memory. */
    explicit SceneFile(const ParameterText            &text,
                       const std::vector<std::string> &overrides = {});

    /** 2 or 3. */
    unsigned int
    dimension() const;

    /** The text as given, comments included, for the run folder. */
    const std::string &
    original_text() const;

    /** "original.prm" or "original.json". */
    std::string
    original_name() const;

    /** All parameters with their values. */
    const Parameters &
    parameters() const;

    /** Lines for the log: repeated entries. */
    const std::vector<std::string> &
    warnings() const;

  private:
    ParameterText            input;
    Parameters               values;
    std::vector<std::string> notes;
  };



  /** The whole scene, read and checked. Throws InputError for contradictions,
   * for names that lead nowhere, and for formulas that cannot be evaluated. */
  template <int dim>
  Problem<dim>
  read_problem(const SceneFile &scene);

  /**
   * All parameters as the scene uses them, defaults included. Without a
   * scene: the documented template, a small scene with one of each named
   * thing, which can be read back.
   */
  void
  print_parameters(std::ostream    &out,
                   const PrintStyle style,
                   const SceneFile *scene = nullptr);
} // namespace limber

#endif
