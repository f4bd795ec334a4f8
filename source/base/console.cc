// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/console.h>
#include <limber/base/exceptions.h>
#include <limber/base/text.h>

#include <ostream>

namespace limber
{
  Console::Console(const bool speaks, std::ostream &screen)
    : speaks(speaks)
    , screen(screen)
  {}



  void
  Console::open_log(const std::string &path, const bool append)
  {
    if (!speaks)
      return;
    log.open(path, append ? std::ios::app : std::ios::trunc);
    if (!log)
      throw FileError(
        "The log " + in_quotes(path) +
        " in the run folder cannot be written. Usually the disk "
        "is full or the folder belongs to someone else. Choose "
        "another with --output-directory, for instance /tmp/run.");
    log << said_before_log << std::flush;
    said_before_log.clear();
  }



  void
  Console::say(const std::string &text)
  {
    show(text);
    if (!speaks)
      return;
    // A run that is killed must leave a complete log.
    if (log.is_open())
      log << text << std::endl;
    else
      said_before_log += text + "\n";
  }



  void
  Console::show(const std::string &text)
  {
    if (speaks)
      screen << text << std::endl;
  }



  void
  Console::warn(const std::string &text)
  {
    say("Warning: " + text);
  }



  void
  Console::warn_once(const std::string &key, const std::string &text)
  {
    if (++counts[key] == 1)
      warn(text);
  }



  const std::map<std::string, unsigned int> &
  Console::warning_counts() const
  {
    return counts;
  }



  void
  Console::restore_counts(const std::map<std::string, unsigned int> &former)
  {
    counts = former;
  }
} // namespace limber
