// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_base_unforeseen_h
#define limber_base_unforeseen_h

#include <limber/base/exceptions.h>

#include <exception>

namespace limber
{
  /**
   * What libraries throw, as a message of ours: exhausted memory, and all that
   * nobody has foreseen.
   */
  ComputationError
  as_failure(const std::exception &unforeseen);

  /**
   * Where one of several ranks finds no memory, the others wait for it and its
   * destructors may wait for them. So it says what happened at once, and ends
   * all with the exit code of a failed computation.
   */
  void
  end_all_ranks_without_memory();
} // namespace limber

#endif
