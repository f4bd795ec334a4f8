// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/mpi.h>

#include <limber/base/records_of_ranks.h>

namespace limber
{
  namespace MPI = dealii::Utilities::MPI;



  std::vector<Bytes>
  gather_bytes(const Bytes   &own,
               const MPI_Comm communicator,
               const bool     only_first)
  {
    return only_first ? MPI::gather(communicator, own) :
                        MPI::all_gather(communicator, own);
  }



  std::map<unsigned int, Bytes>
  exchange_bytes(const std::map<unsigned int, Bytes> &to_send,
                 const MPI_Comm                       communicator)
  {
    return MPI::some_to_some(communicator, to_send);
  }



  std::vector<std::vector<std::string>>
  gather_texts(const std::vector<std::string> &own, const MPI_Comm communicator)
  {
    return MPI::gather(communicator, own);
  }



  std::string
  broadcast_text(const std::string &text, const MPI_Comm communicator)
  {
    return MPI::broadcast(communicator, text);
  }
} // namespace limber
