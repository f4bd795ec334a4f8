// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/config.h>

#include <limber/base/run_info.h>

#include <mpi.h>

// Given on the command line of the compiler, see CMakeLists.txt.
#ifndef LIMBER_VERSION
#  define LIMBER_VERSION "0.1.0"
#endif
#ifndef LIMBER_REVISION
#  define LIMBER_REVISION "unknown"
#endif

namespace limber
{
  namespace
  {
    /** "13.2.0" from the macros that deal.II keeps of its libraries. */
    std::string
    version_text(const int major, const int minor, const int subminor)
    {
      return std::to_string(major) + "." + std::to_string(minor) + "." +
             std::to_string(subminor);
    }
  } // namespace



  RunInfo
  run_info()
  {
    RunInfo info;
    info.version  = LIMBER_VERSION;
    info.revision = LIMBER_REVISION;
#ifdef DEBUG
    info.debug = true;
#endif
    info.deal_ii    = DEAL_II_PACKAGE_VERSION;
    info.trilinos   = version_text(DEAL_II_TRILINOS_VERSION_MAJOR,
                                 DEAL_II_TRILINOS_VERSION_MINOR,
                                 DEAL_II_TRILINOS_VERSION_SUBMINOR);
    info.p4est      = version_text(DEAL_II_P4EST_VERSION_MAJOR,
                              DEAL_II_P4EST_VERSION_MINOR,
                              DEAL_II_P4EST_VERSION_SUBMINOR);
    int initialized = 0, ranks = 1;
    MPI_Initialized(&initialized);
    if (initialized)
      MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    info.ranks = ranks;
    return info;
  }



  std::string
  banner(const RunInfo &info)
  {
    std::string text =
      "Limber " + info.version + " (revision " + info.revision + ", " +
      (info.debug ? "debug" : "release") + " build)\n" + "deal.II " +
      info.deal_ii + ", Trilinos " + info.trilinos + ", p4est " + info.p4est +
      ", " + std::to_string(info.ranks) +
      (info.ranks == 1 ? " rank" : " ranks");
    if (info.debug)
      text += "\nThis is a debug build: it checks itself, and its timings mean "
              "nothing.";
    return text;
  }
} // namespace limber
