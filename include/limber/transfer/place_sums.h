// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_place_sums_h
#define limber_transfer_place_sums_h

#include <cstddef>
#include <cstdint>
#include <vector>

/**
 * @file Sparse interpolation between nodes and positions with given weights,
 * and its transpose. Vectors take vector_lanes<dim> doubles each, zero beyond
 * dim.
 */
namespace limber
{
  template <int dim>
  inline constexpr int vector_lanes = dim == 2 ? 2 : 4;



  /** A weight of a node at a position: an entry of the sparse matrix. */
  struct PlaceShare
  {
    std::uint32_t node;
    double        value;
  };



  /**
   * Rows of the matrix: [begin[p], begin[p + 1]) of all, which may be larger.
   */
  struct PlaceShares
  {
    std::vector<std::size_t> begin{0};
    std::vector<PlaceShare>  all;

    std::size_t
    n_places() const
    {
      return begin.size() - 1;
    }
  };



  /** Interpolate: sums_p = sum_i a_pi values_i if @p wanted, else zero. */
  template <int dim>
  void
  sum_at_places(const PlaceShares       &shares,
                const std::vector<char> &wanted,
                const double            *values,
                double                  *sums);

  /** Transpose: values_i += sum_p a_pi given_p, for positions that give. */
  template <int dim>
  void
  give_to_nodes(const PlaceShares       &shares,
                const std::vector<char> &gives,
                const double            *given,
                double                  *values);

  /** values_i += given_i / m_i, and given_i = 0, for n nodes. */
  template <int dim>
  void
  take_given(std::size_t   n,
             const double *inverse_mass,
             double       *given,
             double       *values);
} // namespace limber

#endif
