// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_base_memory_h
#define limber_base_memory_h

#include <sys/resource.h>
#include <unistd.h>

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
} // namespace limber

#endif
