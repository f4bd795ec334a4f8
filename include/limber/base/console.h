// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_base_console_h
#define limber_base_console_h

#include <limber/base/text_file.h>

#include <iosfwd>
#include <map>
#include <optional>
#include <string>

namespace limber
{
  /**
   * What the program says: on the screen and, once the run folder exists, in
   * its log. Only rank 0 speaks; on the others every call does nothing but
   * count warnings. Nothing here communicates.
   */
  class Console
  {
  public:
    /** @p screen must outlive the console. */
    Console(const bool speaks, std::ostream &screen);

    /**
     * Continue in a file as well, which also receives what was said before;
     * @p append keeps what stands there, for a run that is resumed. Throws
     * FileError. So does, once, whatever is said when the log can no longer be
     * written; it is then on the screen alone.
     */
    void
    open_log(const std::string &path, const bool append = false);

    /** Nothing more is said. Throws FileError if the log is not whole. */
    void
    close_log();

    /** A line, or several. */
    void
    say(const std::string &text);

    /** Only on the screen: what would make the log long or irreproducible. */
    void
    show(const std::string &text);

    /** A line that begins with "Warning:". */
    void
    warn(const std::string &text);

    /**
     * A warning that may come up in every step: said the first time,
     * counted afterwards. @p key tells kinds of warnings apart.
     */
    void
    warn_once(const std::string &key, const std::string &text);

    /** How often each kind of warn_once() came up, for the summary. */
    const std::map<std::string, unsigned int> &
    warning_counts() const;

    /** Count on from those of a checkpoint. */
    void
    restore_counts(const std::map<std::string, unsigned int> &former);

  private:
    void
    write_to_log(const std::string &text);

    const bool                          speaks;
    std::ostream                       &screen;
    std::optional<TextFile>             log;
    std::string                         said_before_log;
    std::map<std::string, unsigned int> counts;
  };
} // namespace limber

#endif
