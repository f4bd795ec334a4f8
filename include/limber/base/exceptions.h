// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_base_exceptions_h
#define limber_base_exceptions_h

#include <stdexcept>
#include <string>

namespace limber
{
  /**
   * What the program returns to the shell. Study drivers and batch scripts
   * tell a typing mistake from an unstable run by these numbers.
   */
  enum class ExitCode
  {
    success            = 0, // finished as asked
    wrong_input        = 1, // wrong use or wrong input, nothing was computed
    computation_failed = 2, // not finite, unstable, too many points lost
    file_error         = 3, // a file could not be read or written
    check_missed       = 4, // finished, but a requested check was missed
    stopped_by_signal  = 128
  };



  /**
   * A failure that the user can mend. Its message has four parts, in this
   * order: what happened, with the offending value; where (section and entry,
   * or body, place and time); the usual cause; what to change.
   */
  class Failure : public std::runtime_error
  {
  public:
    Failure(const ExitCode code, const std::string &message)
      : std::runtime_error(message)
      , code(code)
    {}

    const ExitCode code;
  };



  /** The scene or the command line is wrong; nothing was computed. */
  class InputError : public Failure
  {
  public:
    explicit InputError(const std::string &message)
      : Failure(ExitCode::wrong_input, message)
    {}
  };



  /** In which way a computation has failed, for scripts. */
  enum class FailureKind
  {
    other,
    growing_energy, // or nodes faster than the grid can follow
    not_finite,
    inverted_point, // turned inside out: J <= 0
    lost_points,
    step_too_small,
    passed_side // of a body in its initial frame
  };

  /** "growing energy", ...; "failed" for other ones. */
  inline const char *
  word_for(const FailureKind kind)
  {
    switch (kind)
      {
        case FailureKind::growing_energy:
          return "growing energy";
        case FailureKind::not_finite:
          return "not finite";
        case FailureKind::inverted_point:
          return "inverted point";
        case FailureKind::lost_points:
          return "lost points";
        case FailureKind::step_too_small:
          return "step too small";
        case FailureKind::passed_side:
          return "passed side";
        case FailureKind::other:
          break;
      }
    return "failed";
  }

  /** Of the run: "unstable", or "failed" where nothing has grown. */
  inline const char *
  verdict_of(const FailureKind kind)
  {
    return kind == FailureKind::other ? "failed" : "unstable";
  }



  /** The run became unstable, not finite, or lost too many points. */
  class ComputationError : public Failure
  {
  public:
    explicit ComputationError(const std::string &message,
                              const FailureKind  kind = FailureKind::other)
      : Failure(ExitCode::computation_failed, message)
      , kind(kind)
    {}

    const FailureKind kind;
  };



  /** A file could not be read or written. */
  class FileError : public Failure
  {
  public:
    explicit FileError(const std::string &message)
      : Failure(ExitCode::file_error, message)
    {}
  };
} // namespace limber

#endif
