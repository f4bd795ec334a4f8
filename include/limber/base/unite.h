// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_base_unite_h
#define limber_base_unite_h

#include <deal.II/base/mpi.h>

#include <cstring>
#include <vector>

namespace limber
{
  /** Plain records of all ranks, one rank after the other; collective. */
  template <class Plain>
  void
  unite(std::vector<Plain> &records, const MPI_Comm communicator)
  {
    std::vector<char> bytes(records.size() * sizeof(Plain));
    if (!records.empty())
      std::memcpy(bytes.data(), records.data(), bytes.size());
    const auto of_ranks =
      dealii::Utilities::MPI::all_gather(communicator, bytes);
    records.clear();
    for (const std::vector<char> &of_rank : of_ranks)
      {
        const std::size_t before = records.size();
        records.resize(before + of_rank.size() / sizeof(Plain));
        if (!of_rank.empty())
          std::memcpy(static_cast<void *>(&records[before]),
                      of_rank.data(),
                      of_rank.size());
      }
  }
} // namespace limber

#endif
