// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_shared_records_h
#define limber_grid_shared_records_h

#include <deal.II/base/partitioner.h>

#include <cstdint>
#include <functional>
#include <vector>

/**
 * @file Sums, or largest values, over ranks of the records of nodes and cells.
 * Every rank that holds a record, as its owner or as a ghost, sends what it has
 * summed up to every other that holds it too, and all add the same numbers in
 * the order of ranks. So one exchange leaves the same complete sum, to the last
 * bit, with all of them, and nothing has to be sent back by the owner.
 */
namespace limber
{
  /** The records of this rank that other ranks hold as well. */
  struct SharedRecords
  {
    struct Neighbour
    {
      unsigned int rank;
      // Local numbers; here and there they stand for the same records.
      std::vector<std::uint32_t> records;
    };

    SharedRecords() = default;

    /** Collective: owners tell those who hold a ghost about each other. */
    explicit SharedRecords(const dealii::Utilities::MPI::Partitioner &records);

    MPI_Comm               communicator = MPI_COMM_SELF;
    std::vector<Neighbour> neighbours; // by rank
  };



  /** Which of the shared records travel, as neighbours have agreed. */
  struct ExchangePlan
  {
    struct Neighbour
    {
      unsigned int               rank;
      std::vector<std::uint32_t> send, receive;
    };

    /** All of them, both ways. */
    explicit ExchangePlan(const SharedRecords &shared);

    /**
     * Those to which the sender may add and which the receiver wants to know;
     * collective. Both are asked for local numbers of shared records.
     */
    ExchangePlan(const SharedRecords                      &shared,
                 const std::function<bool(std::uint32_t)> &may_add,
                 const std::function<bool(std::uint32_t)> &wants);

    /** More records to send and to receive, which neighbours have agreed on. */
    void
    add(const std::vector<Neighbour> &more);

    MPI_Comm                   communicator;
    unsigned int               rank; // this one
    std::vector<Neighbour>     neighbours;
    std::vector<std::uint32_t> received;  // each once, ascending
    std::vector<std::uint32_t> contested; // those from several neighbours

  private:
    void
    collect_received();
  };



  /**
   * One exchange after the other of `stride` numbers per record. What ranks
   * send at the same time is told apart by the order in which it is started;
   * that has to be the same everywhere.
   */
  class RecordExchange
  {
  public:
    explicit RecordExchange(const unsigned int stride)
      : stride(stride)
    {}

    /** Send slots [first, last) of the records at @p values. */
    void
    start(const ExchangePlan &plan,
          const double       *values,
          unsigned int        first,
          unsigned int        last);

    /** Add what others have sent to the same slots. */
    void
    finish(double *values);

    /** Instead of finish(): keep the largest of all, the same everywhere. */
    void
    finish_largest(double *values);

  private:
    void
    add(const std::vector<std::uint32_t> &records,
        const std::vector<double>        &from,
        double                           *values) const;

    const unsigned int stride;

    // Of the exchange under way; the buffers stay.
    const ExchangePlan              *plan  = nullptr;
    unsigned int                     first = 0, last = 0;
    std::vector<std::vector<double>> sent, received; // per neighbour
    std::vector<double>              own;
    std::vector<MPI_Request>         requests;
  };
} // namespace limber

#endif
