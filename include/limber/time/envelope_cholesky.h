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
   * The Cholesky factor L L^T of the equations of one rank within the envelope
   * of their rows, from the first entry of each to the diagonal, with the rows
   * ordered after E. Cuthill and J. McKee (1969), reversed by A. George (1971):
   * narrow for layers of cells of which few lie on top of each other.
   */
  class EnvelopeCholesky
  {
  public:
    /** Adopt columns; returns the multiplications that a factor takes. */
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
