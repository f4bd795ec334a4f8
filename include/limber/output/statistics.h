// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_statistics_h
#define limber_output_statistics_h

#include <limber/base/text_file.h>
#include <limber/output/observables.h>

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace limber
{
  /** Header of a column of a table. */
  struct Column
  {
    std::string name, unit; // unit: empty for numbers without one
  };



  /**
   * A table in a text file: numbered columns with their units in the header,
   * as deal.II's table_with_separate_column_description, then one line per
   * row, every number in the shortest form that reads back the same. One rank
   * writes it. Rows are held back for at most a second.
   */
  class Statistics
  {
  public:
    /** Begin a table. Throws FileError, as does everything below. */
    Statistics(const std::string &path, const std::vector<Column> &columns);

    /** Continue one of which the first @p length bytes are valid. */
    Statistics(const std::string   &path,
               const std::uintmax_t length,
               const unsigned int   n_columns);

    /** Writes what has been held back; a failure then goes unnoticed. */
    ~Statistics();

    void
    add(const std::vector<double> &row);

    void
    flush();

    /** The table is complete. */
    void
    close();

    /** Bytes in the file after flush(), for checkpoints. */
    std::uintmax_t
    length() const
    {
      return written;
    }

  private:
    const std::size_t                     n_columns;
    TextFile                              file;
    std::string                           buffer;
    std::uintmax_t                        written = 0;
    std::chrono::steady_clock::time_point last_flush;
  };



  /**
   * The fixed columns, the plastic work where a body may flow, then the
   * observables.
   */
  template <int dim>
  std::vector<Column>
  statistics_columns(const Problem<dim> &problem);

  /** The numbers for these columns. */
  template <int dim>
  std::vector<double>
  statistics_row(const State<dim>          &state,
                 const Totals<dim>         &totals,
                 const std::vector<double> &observed);
} // namespace limber

#endif
