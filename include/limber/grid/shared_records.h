// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_shared_records_h
#define limber_grid_shared_records_h

#include <deal.II/base/partitioner.h>

#include <cstdint>
#include <functional>
#include <vector>

/**
 * @file Sums, or maxima, over ranks of nodal and cell records. Every rank that
 * holds a record, as its owner or as a ghost, sends its own contribution to
 * every other holder, and all add the same numbers in the order of ranks. So a
 * single exchange yields the same sum, bit by bit, on all of them, and owners
 * need not send results back.
 */
namespace limber
{
  /** The records of this rank that other ranks hold as well. */
  struct SharedRecords
  {
    struct Neighbour
    {
      unsigned int rank;
      // Local numbers, in the same order on both ranks.
      std::vector<std::uint32_t> records;
    };

    SharedRecords() = default;

    /** Collective: owners tell the holders of a ghost about each other. */
    explicit SharedRecords(const dealii::Utilities::MPI::Partitioner &records);

    MPI_Comm               communicator = MPI_COMM_SELF;
    std::vector<Neighbour> neighbours; // by rank
  };



  /**
   * The shared records that are really exchanged, as agreed with neighbours.
   */
  struct ExchangePlan
  {
    struct Neighbour
    {
      unsigned int               rank;
      std::vector<std::uint32_t> send, receive;
    };

    /** All shared records, in both directions. */
    explicit ExchangePlan(const SharedRecords &shared);

    /**
     * Only records to which the sender may contribute and which the receiver
     * needs; collective. Both functions get local numbers of shared records.
     */
    ExchangePlan(const SharedRecords                      &shared,
                 const std::function<bool(std::uint32_t)> &may_add,
                 const std::function<bool(std::uint32_t)> &wants);

    /** Add further records to send and receive, as agreed with neighbours. */
    void
    add(const std::vector<Neighbour> &more);

    MPI_Comm                   communicator;
    unsigned int               rank; // this one
    std::vector<Neighbour>     neighbours;
    std::vector<std::uint32_t> received;  // each once, ascending
    std::vector<std::uint32_t> contested; // received from several neighbours

  private:
    void
    collect_received();
  };



  /**
   * Exchanges of `stride` numbers per record, one at a time. Concurrent
   * exchanges of different objects are matched by the order in which they are
   * started, which must be the same on all ranks.
   */
  class RecordExchange
  {
  public:
    explicit RecordExchange(const unsigned int stride)
      : stride(stride)
    {}

    /** Send slots [first, last) of the records in @p values. */
    void
    start(const ExchangePlan &plan,
          const double       *values,
          unsigned int        first,
          unsigned int        last);

    /** Add what others have sent for the same slots. */
    void
    finish(double *values);

    /** Instead of finish(): the maximum over ranks. */
    void
    finish_largest(double *values);

  private:
    void
    add(const std::vector<std::uint32_t> &records,
        const std::vector<double>        &from,
        double                           *values) const;

    const unsigned int stride;

    // Of the exchange in progress; buffers are reused.
    const ExchangePlan              *plan  = nullptr;
    unsigned int                     first = 0, last = 0;
    std::vector<std::vector<double>> sent, received; // per neighbour
    std::vector<double>              own;
    std::vector<MPI_Request>         requests;
  };
} // namespace limber

#endif
