// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/envelope_cholesky.h>
#include <limber/time/pressure_solver.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace limber
{
  namespace
  {
    /** With four partial sums, for vectorisation. */
    double
    scalar_product(const double *const a, const double *const b, std::size_t n)
    {
      double      sums[4] = {0, 0, 0, 0};
      std::size_t k       = 0;
      for (; k + 4 <= n; k += 4)
        for (unsigned int i = 0; i < 4; ++i)
          sums[i] += a[k + i] * b[k + i];
      for (; k < n; ++k)
        sums[0] += a[k] * b[k];
      return (sums[0] + sums[1]) + (sums[2] + sums[3]);
    }
  } // namespace



  // Reverse Cuthill-McKee: breadth first search in each connected part, from a
  // pseudo-peripheral row, the last one found by a first search from any row.
  void
  EnvelopeCholesky::order(const PressureEquations &equations)
  {
    const std::uint32_t        n       = equations.n;
    constexpr std::uint32_t    unknown = PressureEquations::no_column;
    std::vector<std::uint32_t> found, degree(n, 0), search(n, unknown);
    found.reserve(n);
    const auto for_each_neighbour = [&](const std::uint32_t row,
                                        const auto         &work) {
      for (unsigned int k = 0; k < equations.width; ++k)
        if (const std::uint32_t column =
              equations.columns[std::size_t(row) * equations.width + k];
            column != PressureEquations::no_column && column != row)
          work(column);
    };
    for (std::uint32_t row = 0; row < n; ++row)
      for_each_neighbour(row, [&](std::uint32_t) { ++degree[row]; });

    const auto by_degree = [&](const std::uint32_t a, const std::uint32_t b) {
      return degree[a] < degree[b];
    };
    std::vector<std::uint32_t> near;
    const auto                 spread = [&](const std::uint32_t start,
                            const std::uint32_t number) {
      std::size_t next = found.size();
      found.push_back(start);
      search[start] = number;
      for (; next < found.size(); ++next)
        {
          near.clear();
          for_each_neighbour(found[next], [&](const std::uint32_t column) {
            if (search[column] != number)
              {
                search[column] = number;
                near.push_back(column);
              }
          });
          std::stable_sort(near.begin(), near.end(), by_degree);
          found.insert(found.end(), near.begin(), near.end());
        }
    };
    std::uint32_t number = 0;
    for (std::uint32_t row = 0; row < n; ++row)
      if (search[row] == unknown)
        {
          const std::size_t former = found.size();
          spread(row, number++);
          const std::uint32_t rim = found.back();
          found.resize(former);
          spread(rim, number++);
        }
    place.resize(n);
    for (std::uint32_t k = 0; k < n; ++k)
      place[found[k]] = n - 1 - k;
  }



  double
  EnvelopeCholesky::set_pattern(const PressureEquations &equations)
  {
    order(equations);
    const std::uint32_t n = equations.n;
    first.resize(n);
    for (std::uint32_t row = 0; row < n; ++row)
      {
        std::uint32_t &least = first[place[row]];
        least                = place[row];
        for (unsigned int k = 0; k < equations.width; ++k)
          if (const auto column =
                equations.columns[std::size_t(row) * equations.width + k];
              column != PressureEquations::no_column)
            least = std::min(least, place[column]);
      }
    begin.resize(n);
    double      work = 0;
    std::size_t size = 0;
    for (std::uint32_t i = 0; i < n; ++i)
      {
        begin[i] = size - first[i]; // may wrap around; sums with columns do not
        size += i - first[i] + 1;
        work += 0.5 * double(i - first[i]) * double(i - first[i]);
      }
    values.assign(size, 0.);
    target.assign(equations.columns.size(), nowhere);
    for (std::uint32_t row = 0; row < n; ++row)
      for (unsigned int k = 0; k < equations.width; ++k)
        {
          const std::size_t at     = std::size_t(row) * equations.width + k;
          const auto        column = equations.columns[at];
          if (column != PressureEquations::no_column &&
              place[column] <= place[row])
            target[at] = begin[place[row]] + place[column];
        }
    ordered.resize(n);
    return work;
  }



  bool
  EnvelopeCholesky::factorise(const PressureEquations &equations)
  {
    std::fill(values.begin(), values.end(), 0.);
    for (std::size_t at = 0; at < target.size(); ++at)
      if (target[at] != nowhere)
        values[target[at]] = equations.values[at];
    for (std::uint32_t i = 0; i < equations.n; ++i)
      {
        double *const row = values.data() + begin[i] + first[i];
        for (std::uint32_t j = first[i]; j < i; ++j)
          {
            const std::uint32_t from  = std::max(first[i], first[j]);
            const double *const other = values.data() + begin[j] + first[j];
            row[j - first[i]] =
              (row[j - first[i]] - scalar_product(row + (from - first[i]),
                                                  other + (from - first[j]),
                                                  j - from)) /
              other[j - first[j]];
          }
        const std::uint32_t width = i - first[i];
        const double pivot = row[width] - scalar_product(row, row, width);
        // relative to the diagonal, which is scaled to one
        if (!(pivot > std::numeric_limits<double>::epsilon()))
          return false;
        row[width] = std::sqrt(pivot);
      }
    return true;
  }



  void
  EnvelopeCholesky::solve(std::vector<double> &b)
  {
    const std::uint32_t n = b.size();
    for (std::uint32_t row = 0; row < n; ++row)
      ordered[place[row]] = b[row];
    for (std::uint32_t i = 0; i < n; ++i)
      {
        const double *const row   = values.data() + begin[i] + first[i];
        const std::uint32_t width = i - first[i];
        ordered[i] =
          (ordered[i] - scalar_product(row, ordered.data() + first[i], width)) /
          row[width];
      }
    for (std::uint32_t i = n; i-- > 0;)
      {
        const double *const row   = values.data() + begin[i] + first[i];
        const std::uint32_t width = i - first[i];
        ordered[i] /= row[width];
        for (std::uint32_t k = 0; k < width; ++k)
          ordered[first[i] + k] -= ordered[i] * row[k];
      }
    for (std::uint32_t row = 0; row < n; ++row)
      b[row] = ordered[place[row]];
  }
} // namespace limber
