// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/contact.h>

#include <cmath>

/** @file Contact search: spatial hash of the points near other bodies. */
namespace limber
{
  template <int dim>
  typename Contact<dim>::Bins::Bin
  Contact<dim>::Bins::at(const dealii::Point<dim> &place) const
  {
    Bin result;
    for (int d = 0; d < dim; ++d)
      result[d] = std::int64_t(std::floor(place[d] * inverse_edge));
    return result;
  }



  template <int dim>
  std::uint64_t
  Contact<dim>::Bins::key(const Bin &bin)
  {
    constexpr int bits   = 64 / dim;
    std::uint64_t result = 0;
    for (int d = dim - 1; d >= 0; --d)
      result = (result << bits) +
               std::uint64_t(bin[d] + (std::int64_t(1) << (bits - 1)));
    return result;
  }



  // The entry of the key, or the free one where it would be inserted: Fibonacci
  // hashing with linear probing (Knuth, The Art of Computer Programming 3, 6.4)
  template <int dim>
  std::size_t
  Contact<dim>::Bins::entry(const std::uint64_t key) const
  {
    const std::size_t mask = first.size() - 1;
    std::size_t       at   = (key * 0x9e3779b97f4a7c15u >> 32) & mask;
    while (first[at] != none && keys[at] != key)
      at = (at + 1) & mask;
    return at;
  }



  template <int dim>
  void
  Contact<dim>::Bins::fill(const std::vector<Candidate> &candidates,
                           const double                  edge)
  {
    inverse_edge     = 1 / edge;
    knows_last       = false;
    std::size_t size = 16;
    while (size < 2 * candidates.size())
      size *= 2;
    first.assign(size, none);
    keys.resize(size);
    next.resize(candidates.size());
    for (std::size_t k = candidates.size(); k-- > 0;)
      {
        const std::uint64_t of_bin = key(at(candidates[k].place));
        const std::size_t   slot   = entry(of_bin);
        keys[slot]                 = of_bin;
        next[k]                    = first[slot];
        first[slot]                = static_cast<std::uint32_t>(k);
      }
  }



  // The last result is kept: points come in the order of cells, so many in
  // succession ask for the same bin.
  template <int dim>
  const std::vector<std::uint32_t> &
  Contact<dim>::Bins::around(const dealii::Point<dim> &place)
  {
    const Bin middle = at(place);
    if (knows_last && middle == last)
      return found;
    last       = middle;
    knows_last = true;
    found.clear();
    constexpr int n = dim == 2 ? 9 : 27;
    for (int k = 0; k < n; ++k)
      {
        Bin bin = middle;
        bin[0] += k % 3 - 1;
        bin[1] += k / 3 % 3 - 1;
        if (dim == 3)
          bin[dim - 1] += k / 9 - 1;
        for (std::uint32_t candidate = first[entry(key(bin))];
             candidate != none;
             candidate = next[candidate])
          found.push_back(candidate);
      }
    return found;
  }



  template void
  Contact<2>::Bins::fill(const std::vector<Candidate> &, double);
  template const std::vector<std::uint32_t> &
  Contact<2>::Bins::around(const dealii::Point<2> &);
  template void
  Contact<3>::Bins::fill(const std::vector<Candidate> &, double);
  template const std::vector<std::uint32_t> &
  Contact<3>::Bins::around(const dealii::Point<3> &);
} // namespace limber
