// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_base_memory_h
#define limber_base_memory_h

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace limber
{
  /** Memory of this process that is in use now, bytes; 0: not known. */
  inline double
  resident_memory()
  {
    std::FILE *const file = std::fopen("/proc/self/statm", "r");
    if (file == nullptr)
      return 0;
    unsigned long pages = 0;
    const int     found = std::fscanf(file, "%*u %lu", &pages);
    std::fclose(file);
    return found == 1 ? double(pages) * double(sysconf(_SC_PAGESIZE)) : 0;
  }



  /** The most that it has been, bytes. */
  inline double
  largest_memory()
  {
    rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return 1024. * double(usage.ru_maxrss);
  }



  /** A limit in a file of the system, bytes; without one, 1e300. */
  inline double
  memory_limit_in(const char *const path)
  {
    std::FILE *const file = std::fopen(path, "r");
    if (file == nullptr)
      return 1e300;
    double    bytes = 0;
    const int found = std::fscanf(file, "%lf", &bytes); // not so for "max"
    std::fclose(file);
    return found == 1 && bytes > 0 ? bytes : 1e300;
  }



  /**
   * What @p n processes on this machine may take together, bytes: its memory,
   * less where a container or 'ulimit -v' allows less.
   */
  inline double
  machine_memory(const unsigned int n)
  {
    double bytes =
      double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
    for (const char *const path :
         {"/sys/fs/cgroup/memory.max",
          "/sys/fs/cgroup/memory/memory.limit_in_bytes"})
      bytes = std::min(bytes, memory_limit_in(path));
    rlimit of_process;
    if (getrlimit(RLIMIT_AS, &of_process) == 0 &&
        of_process.rlim_cur != RLIM_INFINITY)
      bytes = std::min(bytes, n * double(of_process.rlim_cur));
    return bytes;
  }
} // namespace limber

#endif
