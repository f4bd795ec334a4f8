// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/console.h>

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
    log.emplace(path, append ? TextFile::Mode::append : TextFile::Mode::create);
    write_to_log(said_before_log);
    said_before_log.clear();
  }



  void
  Console::close_log()
  {
    if (log)
      log->close();
    log.reset();
  }



  void
  Console::write_to_log(const std::string &text)
  {
    try
      {
        log->write(text);
      }
    catch (const FileError &)
      {
        log.reset(); // what is said about this failure cannot be logged
        throw;
      }
  }



  void
  Console::say(const std::string &text)
  {
    show(text);
    if (!speaks)
      return;
    // A run that is killed must leave a complete log.
    if (log)
      write_to_log(text + "\n");
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
