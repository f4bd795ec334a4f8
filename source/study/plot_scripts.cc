// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/study/child_process.h>
#include <limber/study/plot_scripts.h>

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <vector>

// Given on the command line of the compiler, see CMakeLists.txt.
#ifndef LIMBER_PLOT_FOLDER
#  define LIMBER_PLOT_FOLDER "contrib/plot"
#endif

namespace limber
{
  namespace fs = std::filesystem;



  std::string
  plot_script(const std::string &name)
  {
    const fs::path prefix =
      fs::path(this_program()).parent_path().parent_path();
    const fs::path installed = prefix / "share/limber/plot" / name;
    return fs::exists(installed) ? installed.string() :
                                   LIMBER_PLOT_FOLDER "/" + name;
  }



  std::string
  plot_python()
  {
    if (const char *const chosen = std::getenv("LIMBER_PYTHON"))
      return chosen;
    const std::string of_the_system = "/usr/bin/python3";
    return fs::exists(of_the_system) ? of_the_system : "python3";
  }



  bool
  is_plot_command(const int argc, const char *const *argv)
  {
    const std::string word = argc > 1 ? argv[1] : "";
    return word == "plot" || word == "animate";
  }



  int
  run_plot_command(const int argc, const char *const *argv)
  {
    const std::string script = plot_script(std::string(argv[1]) + ".py");
    if (!fs::exists(script))
      throw FileError("The script " + in_quotes(script) +
                      " that draws is not there. Usually the folder in which "
                      "the program was built has moved. Build it anew, or "
                      "install it with 'cmake --install'.");
    const std::string         python = plot_python();
    std::vector<const char *> words  = {python.c_str(), "-B", script.c_str()};
    words.insert(words.end(), argv + 2, argv + argc);
    words.push_back(nullptr);
    execvp(words[0], const_cast<char *const *>(words.data()));
    throw FileError("The program " + in_quotes(python) +
                    " cannot be started: " + std::strerror(errno) +
                    ". Pictures need Python 3 with numpy and matplotlib. "
                    "Usually it is not installed, or LIMBER_PYTHON names "
                    "another one. On Debian: apt-get install "
                    "python3-matplotlib.");
  }
} // namespace limber
