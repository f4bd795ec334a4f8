// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/records_of_ranks.h>
#include <limber/grid/shared_records.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

namespace limber
{
  namespace
  {
    using Index = dealii::types::global_dof_index;

    // deal.II's own messages have tags above 300.
    constexpr int plan_tag = 47, sum_tag = 48;



    /** Which other ranks hold an owned record, by local number. */
    std::map<std::uint32_t, std::vector<unsigned int>>
    find_holders(const dealii::Utilities::MPI::Partitioner &records)
    {
      std::vector<std::uint32_t> exported;
      for (const auto &[begin, end] : records.import_indices())
        for (unsigned int i = begin; i < end; ++i)
          exported.push_back(i);

      std::map<std::uint32_t, std::vector<unsigned int>> holders;
      auto next = exported.begin();
      for (const auto &[rank, n] : records.import_targets())
        for (unsigned int i = 0; i < n; ++i)
          holders[*next++].push_back(rank);
      return holders;
    }
  } // namespace



  SharedRecords::SharedRecords(
    const dealii::Utilities::MPI::Partitioner &records)
    : communicator(records.get_mpi_communicator())
  {
    std::map<unsigned int, std::set<Index>>                             shared;
    std::map<unsigned int, std::vector<std::pair<Index, unsigned int>>> news;
    for (const auto &[record, holders] : find_holders(records))
      {
        const Index index = records.local_to_global(record);
        for (const unsigned int holder : holders)
          {
            shared[holder].insert(index);
            for (const unsigned int other : holders)
              if (other != holder)
                news[holder].emplace_back(index, other);
          }
      }
    auto ghost = records.ghost_indices().begin();
    for (const auto &[owner, n] : records.ghost_targets())
      for (unsigned int i = 0; i < n; ++i)
        shared[owner].insert(*ghost++);
    for (const auto &[owner, told] : exchange_records(news, communicator))
      for (const auto &[index, holder] : told)
        shared[holder].insert(index);

    for (const auto &[rank, indices] : shared)
      {
        neighbours.push_back({rank, {}});
        for (const Index index : indices)
          neighbours.back().records.push_back(records.global_to_local(index));
      }
  }



  ExchangePlan::ExchangePlan(const SharedRecords &shared)
    : communicator(shared.communicator)
    , rank(dealii::Utilities::MPI::this_mpi_process(communicator))
  {
    for (const auto &[other, records] : shared.neighbours)
      neighbours.push_back({other, records, records});
    collect_received();
  }



  ExchangePlan::ExchangePlan(const SharedRecords                      &shared,
                             const std::function<bool(std::uint32_t)> &may_add,
                             const std::function<bool(std::uint32_t)> &wants)
    : communicator(shared.communicator)
    , rank(dealii::Utilities::MPI::this_mpi_process(communicator))
  {
    const std::size_t                       n = shared.neighbours.size();
    std::vector<std::vector<unsigned char>> here(n), there(n);
    std::vector<MPI_Request>                requests(2 * n);
    constexpr unsigned char                 adds = 1, reads = 2;
    for (std::size_t k = 0; k < n; ++k)
      {
        const auto &[other, records] = shared.neighbours[k];
        for (const std::uint32_t record : records)
          here[k].push_back((may_add(record) ? adds : 0) |
                            (wants(record) ? reads : 0));
        there[k].resize(records.size());
        MPI_Irecv(there[k].data(),
                  records.size(),
                  MPI_UNSIGNED_CHAR,
                  other,
                  plan_tag,
                  communicator,
                  &requests[2 * k]);
        MPI_Isend(here[k].data(),
                  records.size(),
                  MPI_UNSIGNED_CHAR,
                  other,
                  plan_tag,
                  communicator,
                  &requests[2 * k + 1]);
      }
    MPI_Waitall(requests.size(), requests.data(), MPI_STATUSES_IGNORE);

    for (std::size_t k = 0; k < n; ++k)
      {
        const auto &[other, records] = shared.neighbours[k];
        Neighbour neighbour{other, {}, {}};
        for (std::size_t i = 0; i < records.size(); ++i)
          {
            if ((here[k][i] & adds) && (there[k][i] & reads))
              neighbour.send.push_back(records[i]);
            if ((there[k][i] & adds) && (here[k][i] & reads))
              neighbour.receive.push_back(records[i]);
          }
        neighbours.push_back(std::move(neighbour));
      }
    collect_received();
  }



  void
  ExchangePlan::add(const std::vector<Neighbour> &more)
  {
    for (const Neighbour &added : more)
      {
        auto at = std::lower_bound(neighbours.begin(),
                                   neighbours.end(),
                                   added.rank,
                                   [](const auto &neighbour, const auto other) {
                                     return neighbour.rank < other;
                                   });
        if (at == neighbours.end() || at->rank != added.rank)
          at = neighbours.insert(at, Neighbour{added.rank, {}, {}});
        at->send.insert(at->send.end(), added.send.begin(), added.send.end());
        at->receive.insert(at->receive.end(),
                           added.receive.begin(),
                           added.receive.end());
      }
    collect_received();
  }



  void
  ExchangePlan::collect_received()
  {
    received.clear();
    contested.clear();
    for (const Neighbour &neighbour : neighbours)
      received.insert(received.end(),
                      neighbour.receive.begin(),
                      neighbour.receive.end());
    std::sort(received.begin(), received.end());
    for (std::size_t i = 1; i < received.size(); ++i)
      if (received[i] == received[i - 1])
        contested.push_back(received[i]);
    const auto drop_copies = [](std::vector<std::uint32_t> &records) {
      records.erase(std::unique(records.begin(), records.end()), records.end());
    };
    drop_copies(received);
    drop_copies(contested);
  }



  namespace
  {
    /** Copy slots [first, last) of the given records to a buffer. */
    void
    pack(const std::vector<std::uint32_t> &records,
         const double *const               values,
         const unsigned int                stride,
         const unsigned int                first,
         const unsigned int                last,
         std::vector<double>              &into)
    {
      into.resize(records.size() * (last - first));
      double *to = into.data();
      for (const std::uint32_t record : records)
        {
          const double *const from = values + std::size_t(record) * stride;
          to                       = std::copy(from + first, from + last, to);
        }
    }
  } // namespace



  void
  RecordExchange::start(const ExchangePlan &new_plan,
                        const double *const values,
                        const unsigned int  first_slot,
                        const unsigned int  last_slot)
  {
    plan  = &new_plan;
    first = first_slot;
    last  = last_slot;
    sent.resize(plan->neighbours.size());
    received.resize(plan->neighbours.size());
    requests.clear();
    for (std::size_t k = 0; k < plan->neighbours.size(); ++k)
      {
        const auto &neighbour = plan->neighbours[k];
        received[k].resize(neighbour.receive.size() * (last - first));
        if (!received[k].empty())
          MPI_Irecv(received[k].data(),
                    received[k].size(),
                    MPI_DOUBLE,
                    neighbour.rank,
                    sum_tag,
                    plan->communicator,
                    &requests.emplace_back());
      }
    for (std::size_t k = 0; k < plan->neighbours.size(); ++k)
      {
        const auto &neighbour = plan->neighbours[k];
        pack(neighbour.send, values, stride, first, last, sent[k]);
        if (!sent[k].empty())
          MPI_Isend(sent[k].data(),
                    sent[k].size(),
                    MPI_DOUBLE,
                    neighbour.rank,
                    sum_tag,
                    plan->communicator,
                    &requests.emplace_back());
      }
  }



  void
  RecordExchange::add(const std::vector<std::uint32_t> &records,
                      const std::vector<double>        &from,
                      double *const                     values) const
  {
    const double *next = from.data();
    for (const std::uint32_t record : records)
      {
        double *const to = values + std::size_t(record) * stride;
        for (unsigned int k = first; k < last; ++k)
          to[k] += *next++;
      }
  }



  void
  RecordExchange::finish(double *const values)
  {
    // For a bitwise equal sum: two contributions commute; with more, this
    // rank's has to be added in the order of ranks.
    pack(plan->contested, values, stride, first, last, own);
    for (const std::uint32_t record : plan->contested)
      std::fill_n(values + std::size_t(record) * stride + first,
                  last - first,
                  0.);
    MPI_Waitall(requests.size(), requests.data(), MPI_STATUSES_IGNORE);

    std::size_t k = 0;
    for (; k < plan->neighbours.size() && plan->neighbours[k].rank < plan->rank;
         ++k)
      add(plan->neighbours[k].receive, received[k], values);
    add(plan->contested, own, values);
    for (; k < plan->neighbours.size(); ++k)
      add(plan->neighbours[k].receive, received[k], values);
  }



  void
  RecordExchange::finish_largest(double *const values)
  {
    MPI_Waitall(requests.size(), requests.data(), MPI_STATUSES_IGNORE);
    for (std::size_t k = 0; k < plan->neighbours.size(); ++k)
      {
        const double *next = received[k].data();
        for (const std::uint32_t record : plan->neighbours[k].receive)
          for (unsigned int slot = first; slot < last; ++slot)
            {
              double &value = values[std::size_t(record) * stride + slot];
              value         = std::max(value, *next++);
            }
      }
  }
} // namespace limber
