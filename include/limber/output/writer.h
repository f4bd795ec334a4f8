// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_writer_h
#define limber_output_writer_h

#include <limber/output/vtu.h>
#include <limber/state/material_body.h>

#include <string>
#include <utility>
#include <vector>

namespace limber
{
  /** The pictures written so far; plain, for checkpoints. */
  struct WriterState
  {
    // Times (s) and files of both series; as many of the one as of the other
    std::vector<std::pair<double, std::string>> points, grid;
  };



  /**
   * Pictures for ParaView: points and grid of each time, and the two series
   * points.pvd and grid.pvd that name them all. Grid values are those of the
   * last step, so a picture has to be taken before the nodes are cleared or
   * chosen anew.
   */
  template <int dim>
  class Writer
  {
  public:
    /** @p folder: the run folder, which exists. */
    explicit Writer(const std::string &folder);

    /** Collective; throws FileError on all ranks. */
    void
    write(const State<dim> &state);

    /**
     * Continue the series of a checkpoint: later pictures are removed.
     * Collective; throws FileError on all ranks.
     */
    void
    restore(const WriterState &former, MPI_Comm communicator);

    const WriterState &
    state() const
    {
      return written;
    }

  private:
    const std::string folder;
    WriterState       written;
  };
} // namespace limber

#endif
