// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_base_unforeseen_h
#define limber_base_unforeseen_h

#include <limber/base/exceptions.h>

#include <mpi.h>

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
   * What several ranks do with a fault that they cannot agree upon: the first
   * on a machine says it and ends all with its exit code; the others wait for
   * that end. Exists once, while MPI runs; creation and end are collective.
   */
  class LastWord
  {
  public:
    /**
     * From here on a rank that finds no memory ends all: the others wait for
     * it, and its destructors may wait for them.
     */
    LastWord();
    ~LastWord();

    LastWord(const LastWord &) = delete;
    LastWord &
    operator=(const LastWord &) = delete;

    /** Says the failure; returns if there is one rank only. */
    void
    say(const Failure &failure) const;

  private:
    MPI_Win spoken;
  };
} // namespace limber

#endif
