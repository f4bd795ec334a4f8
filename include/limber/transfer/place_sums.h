// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_place_sums_h
#define limber_transfer_place_sums_h

#include <cstddef>
#include <cstdint>
#include <vector>

/**
 * @file Between nodes and places that see some of them with given numbers: sums
 * of what nodes have, and what goes back with the same numbers. Vectors take
 * vector_lanes<dim> doubles each, those beyond dim zero.
 */
namespace limber
{
  template <int dim>
  inline constexpr int vector_lanes = dim == 2 ? 2 : 4;



  struct PlaceShare
  {
    std::uint32_t node;
    double        value;
  };



  /** The shares of place p are [begin[p], begin[p + 1]); there may be room. */
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



  /** sums_p = sum_i a_pi values_i where @p wanted, zero elsewhere. */
  template <int dim>
  void
  sum_at_places(const PlaceShares       &shares,
                const std::vector<char> &wanted,
                const double            *values,
                double                  *sums);

  /** values_i += sum_p a_pi given_p, of the places that give. */
  template <int dim>
  void
  give_to_nodes(const PlaceShares       &shares,
                const std::vector<char> &gives,
                const double            *given,
                double                  *values);

  /** values_i += given_i / m_i, and given_i = 0, of n nodes. */
  template <int dim>
  void
  take_given(std::size_t   n,
             const double *inverse_mass,
             double       *given,
             double       *values);
} // namespace limber

#endif
