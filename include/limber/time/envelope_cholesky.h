// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_envelope_cholesky_h
#define limber_time_envelope_cholesky_h

#include <cstddef>
#include <cstdint>
#include <vector>

namespace limber
{
  struct PressureEquations;

  /**
   * Envelope (skyline) Cholesky factorisation L L^T of the equations of one
   * rank: each row is stored from its first entry to the diagonal, in reverse
   * Cuthill-McKee order (E. Cuthill and J. McKee 1969, A. George 1971). The
   * envelope is narrow for layers that are few cells thick.
   */
  class EnvelopeCholesky
  {
  public:
    /** Order the rows and set up the envelope; returns the number of
     * multiplications of a factorisation. */
    double
    set_pattern(const PressureEquations &equations);

    /** Factorise these values. Returns whether the matrix is positive
     * definite to round-off. */
    bool
    factorise(const PressureEquations &equations);

    /** Overwrite the right side @p b by the solution. */
    void
    solve(std::vector<double> &b);

  private:
    void
    order(const PressureEquations &equations);

    std::vector<std::uint32_t>   place;   // of a row in the order
    std::vector<std::uint32_t>   first;   // column of a row, in the order
    std::vector<std::size_t>     begin;   // of a row, less its first column
    std::vector<std::size_t>     target;  // of an entry; none: `nowhere`
    std::vector<double>          values;  // row by row, up to the diagonal
    std::vector<double>          ordered; // right side
    static constexpr std::size_t nowhere = ~std::size_t(0);
  };
} // namespace limber

#endif
