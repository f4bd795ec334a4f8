// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/mpi.h>

#include <limber/base/records_of_ranks.h>
#include <limber/grid/refined_cells.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace limber
{
  namespace
  {
    void
    put_in_order(std::vector<std::uint64_t> &cells)
    {
      std::sort(cells.begin(), cells.end());
      cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    }
  } // namespace



  template <int dim>
  RefinedCells<dim>::RefinedCells(const std::array<unsigned int, dim> &cells,
                                  const unsigned int                   levels)
    : cells(cells)
    , of_level(levels)
  {}



  template <int dim>
  std::uint64_t
  RefinedCells<dim>::number(const unsigned int level, const Place &place) const
  {
    std::uint64_t result = 0;
    for (int d = dim - 1; d >= 0; --d)
      result = result * (std::uint64_t(cells[d]) << level) + place[d];
    return result;
  }



  template <int dim>
  typename RefinedCells<dim>::Place
  RefinedCells<dim>::place(const unsigned int level, std::uint64_t number) const
  {
    Place result;
    for (int d = 0; d < dim; ++d)
      {
        const std::uint64_t n = std::uint64_t(cells[d]) << level;
        result[d]             = number % n;
        number /= n;
      }
    return result;
  }



  template <int dim>
  void
  RefinedCells<dim>::divide(unsigned int level, const Place &place)
  {
    Place ancestor = place;
    for (++level; level-- > 0;)
      {
        of_level[level].push_back(number(level, ancestor));
        for (auto &step : ancestor)
          step /= 2;
      }
  }



  template <int dim>
  void
  RefinedCells<dim>::join(const RefinedCells &other)
  {
    for (std::size_t level = 0; level < of_level.size(); ++level)
      {
        Cells &own = of_level[level];
        own.insert(own.end(),
                   other.of_level[level].begin(),
                   other.of_level[level].end());
        put_in_order(own);
      }
  }



  template <int dim>
  void
  RefinedCells<dim>::keep_common(const RefinedCells &other)
  {
    for (std::size_t level = 0; level < of_level.size(); ++level)
      {
        const Cells &theirs = other.of_level[level];
        Cells        common;
        std::set_intersection(of_level[level].begin(),
                              of_level[level].end(),
                              theirs.begin(),
                              theirs.end(),
                              std::back_inserter(common));
        of_level[level].swap(common);
      }
  }



  template <int dim>
  bool
  RefinedCells<dim>::is_inside(const unsigned int level,
                               const Place       &place) const
  {
    for (int d = 0; d < dim; ++d)
      if (place[d] >= cells[d] << level)
        return false;
    return true;
  }



  template <int dim>
  void
  RefinedCells<dim>::sum_over_ranks(const MPI_Comm communicator)
  {
    for (Cells &own : of_level)
      {
        put_in_order(own);
        if (dealii::Utilities::MPI::n_mpi_processes(communicator) == 1)
          continue;
        unite(own, communicator);
        put_in_order(own);
      }
  }



  template <int dim>
  typename RefinedCells<dim>::Cells
  RefinedCells<dim>::with_neighbours(const unsigned int level,
                                     const Cells       &given) const
  {
    // Dilation by one direction after the other: fewer cells to be sorted each
    // time than 3^dim times as many at once.
    Cells result = given;
    for (int d = 0; d < dim; ++d)
      {
        Cells wider;
        wider.reserve(3 * result.size());
        for (const std::uint64_t cell : result)
          {
            Place other = place(level, cell);
            --other[d]; // unsigned underflow: is_inside() is false then
            for (unsigned int k = 0; k < 3; ++k, ++other[d])
              if (is_inside(level, other))
                wider.push_back(number(level, other));
          }
        put_in_order(wider);
        result.swap(wider);
      }
    return result;
  }



  // From the finest level to the coarsest: the neighbours that a level needs
  // exist if their parents on the next coarser level are divided.
  template <int dim>
  void
  RefinedCells<dim>::grade(const unsigned int buffer)
  {
    for (unsigned int level = of_level.size(); level-- > 0;)
      {
        Cells &own = of_level[level];
        for (unsigned int n = 0; n < buffer; ++n)
          own = with_neighbours(level, own);
        if (level + 1 < of_level.size())
          {
            Cells parents;
            for (const std::uint64_t cell : of_level[level + 1])
              {
                Place at = place(level + 1, cell);
                for (auto &step : at)
                  step /= 2;
                parents.push_back(number(level, at));
              }
            put_in_order(parents);
            parents = with_neighbours(level, parents);
            own.insert(own.end(), parents.begin(), parents.end());
            put_in_order(own);
          }
      }
  }



  template <int dim>
  bool
  RefinedCells<dim>::is_divided(const unsigned int level,
                                const Place       &place) const
  {
    return level < of_level.size() &&
           std::binary_search(of_level[level].begin(),
                              of_level[level].end(),
                              number(level, place));
  }



  template <int dim>
  std::vector<std::uint64_t>
  RefinedCells<dim>::numbers() const
  {
    std::vector<std::uint64_t> result;
    for (const Cells &level : of_level)
      {
        result.push_back(level.size());
        result.insert(result.end(), level.begin(), level.end());
      }
    return result;
  }



  template <int dim>
  void
  RefinedCells<dim>::set(const std::vector<std::uint64_t> &numbers)
  {
    const auto refuse = []() {
      throw std::invalid_argument("no list of divided cells");
    };
    auto next = numbers.begin();
    for (unsigned int level = 0; level < of_level.size(); ++level)
      {
        if (next == numbers.end() ||
            *next > std::uint64_t(numbers.end() - next - 1))
          refuse();
        const auto    n        = std::ptrdiff_t(*next++);
        std::uint64_t n_places = 1;
        for (const unsigned int per_edge : cells)
          n_places *= std::uint64_t(per_edge) << level;
        of_level[level].assign(next, next + n);
        next += n;
        const Cells &own = of_level[level];
        if (!std::is_sorted(own.begin(), own.end(), std::less_equal<>()) ||
            (!own.empty() && own.back() >= n_places))
          refuse();
        // The parent of a divided cell must be divided.
        for (const std::uint64_t cell : own)
          if (level > 0)
            {
              Place at = place(level, cell);
              for (auto &step : at)
                step /= 2;
              if (!is_divided(level - 1, at))
                refuse();
            }
      }
    if (next != numbers.end())
      refuse();
  }



  template class RefinedCells<2>;
  template class RefinedCells<3>;
} // namespace limber
