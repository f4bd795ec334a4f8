// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/pack.h>
#include <limber/transfer/place_sums.h>

namespace limber
{
  template <int dim>
  void
  sum_at_places(const PlaceShares       &shares,
                const std::vector<char> &wanted,
                const double *const      values,
                double *const            sums)
  {
    constexpr int lanes = vector_lanes<dim>;
    using Number        = Pack<lanes>;
    for (std::size_t p = 0; p < shares.n_places(); ++p)
      {
        // Two sums, so that one need not wait for the other.
        Number one{}, other{};
        if (wanted[p])
          {
            const PlaceShare       *share = &shares.all[shares.begin[p]];
            const PlaceShare *const end   = &shares.all[shares.begin[p + 1]];
            for (; share + 1 < end; share += 2)
              {
                one +=
                  share[0].value *
                  load<Number>(values + std::size_t(share[0].node) * lanes);
                other +=
                  share[1].value *
                  load<Number>(values + std::size_t(share[1].node) * lanes);
              }
            if (share != end)
              one += share->value *
                     load<Number>(values + std::size_t(share->node) * lanes);
          }
        store(one + other, sums + p * lanes);
      }
  }



  template <int dim>
  void
  give_to_nodes(const PlaceShares       &shares,
                const std::vector<char> &gives,
                const double *const      given,
                double *const            values)
  {
    constexpr int lanes = vector_lanes<dim>;
    using Number        = Pack<lanes>;
    for (std::size_t p = 0; p < shares.n_places(); ++p)
      if (gives[p])
        {
          const auto all = load<Number>(given + p * lanes);
          for (std::size_t k = shares.begin[p]; k < shares.begin[p + 1]; ++k)
            {
              double *const of_node =
                values + std::size_t(shares.all[k].node) * lanes;
              store(load<Number>(of_node) + shares.all[k].value * all, of_node);
            }
        }
  }



  template <int dim>
  void
  take_given(const std::size_t   n,
             const double *const inverse_mass,
             double *const       given,
             double *const       values)
  {
    constexpr int lanes = vector_lanes<dim>;
    using Number        = Pack<lanes>;
    for (std::size_t i = 0; i < n; ++i)
      {
        store(load<Number>(values + i * lanes) +
                inverse_mass[i] * load<Number>(given + i * lanes),
              values + i * lanes);
        store(Number{}, given + i * lanes);
      }
  }



  template void
  sum_at_places<2>(const PlaceShares &,
                   const std::vector<char> &,
                   const double *,
                   double *);
  template void
  sum_at_places<3>(const PlaceShares &,
                   const std::vector<char> &,
                   const double *,
                   double *);
  template void
  give_to_nodes<2>(const PlaceShares &,
                   const std::vector<char> &,
                   const double *,
                   double *);
  template void
  give_to_nodes<3>(const PlaceShares &,
                   const std::vector<char> &,
                   const double *,
                   double *);
  template void
  take_given<2>(std::size_t, const double *, double *, double *);
  template void
  take_given<3>(std::size_t, const double *, double *, double *);
} // namespace limber
