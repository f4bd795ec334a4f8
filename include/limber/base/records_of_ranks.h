// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_base_records_of_ranks_h
#define limber_base_records_of_ranks_h

#include <mpi.h>

#include <cstring>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

/**
 * @file Plain records to and from other ranks, as bytes; all is collective.
 * deal.II's functions of these names send any type, by way of a compressed
 * archive that each file which calls them would compile again.
 */
namespace limber
{
  using Bytes = std::vector<char>;

  /** What each rank had; on the first rank alone with @p only_first. */
  std::vector<Bytes>
  gather_bytes(const Bytes &own, MPI_Comm communicator, bool only_first);

  /** Messages by rank to send; returns those received, by rank. */
  std::map<unsigned int, Bytes>
  exchange_bytes(const std::map<unsigned int, Bytes> &to_send,
                 MPI_Comm                             communicator);

  /** The texts of each rank, on the first rank. */
  std::vector<std::vector<std::string>>
  gather_texts(const std::vector<std::string> &own, MPI_Comm communicator);

  /** The text of the first rank, on all. */
  std::string
  broadcast_text(const std::string &text, MPI_Comm communicator);



  template <class Plain>
  Bytes
  bytes_of(const std::vector<Plain> &records)
  {
    // a pair of numbers is plain, but not trivial to assign
    static_assert(std::is_trivially_copy_constructible_v<Plain> &&
                  std::is_trivially_destructible_v<Plain>);
    Bytes bytes(records.size() * sizeof(Plain));
    if (!records.empty())
      std::memcpy(bytes.data(), records.data(), bytes.size());
    return bytes;
  }



  /** Add the records that these bytes are. */
  template <class Plain>
  void
  append_records(const Bytes &bytes, std::vector<Plain> &records)
  {
    if (bytes.empty())
      return;
    const std::size_t before = records.size();
    records.resize(before + bytes.size() / sizeof(Plain));
    std::memcpy(static_cast<void *>(&records[before]),
                bytes.data(),
                bytes.size());
  }



  /** The records of all ranks, by rank. */
  template <class Plain>
  std::vector<std::vector<Plain>>
  gather_records(const std::vector<Plain> &own,
                 const MPI_Comm            communicator,
                 const bool                only_first = false)
  {
    std::vector<std::vector<Plain>> result;
    for (const Bytes &bytes :
         gather_bytes(bytes_of(own), communicator, only_first))
      append_records(bytes, result.emplace_back());
    return result;
  }



  /** The records of all ranks on each, one rank after the other. */
  template <class Plain>
  void
  unite(std::vector<Plain> &records, const MPI_Comm communicator)
  {
    const Bytes own = bytes_of(records);
    records.clear();
    for (const Bytes &bytes : gather_bytes(own, communicator, false))
      append_records(bytes, records);
  }



  /** Records by rank to send; returns those received, by rank. */
  template <class Plain>
  std::map<unsigned int, std::vector<Plain>>
  exchange_records(const std::map<unsigned int, std::vector<Plain>> &to_send,
                   const MPI_Comm communicator)
  {
    std::map<unsigned int, Bytes> messages;
    for (const auto &[rank, records] : to_send)
      messages[rank] = bytes_of(records);
    std::map<unsigned int, std::vector<Plain>> result;
    for (const auto &[rank, bytes] : exchange_bytes(messages, communicator))
      append_records(bytes, result[rank]);
    return result;
  }
} // namespace limber

#endif
