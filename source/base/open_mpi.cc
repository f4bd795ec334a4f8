// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/open_mpi.h>

#include <cstdlib>

namespace limber
{
  namespace
  {
    /** Whether mpirun or a batch system has started this process. */
    bool
    is_part_of_a_job()
    {
      for (const char *const name :
           {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK", "SLURM_PROCID"})
        if (std::getenv(name) != nullptr)
          return true;
      return false;
    }



    void
    set_unless_set(const char *const name, const char *const value)
    {
      setenv(name, value, /*overwrite=*/0);
    }
  } // namespace



  void
  tune_open_mpi()
  {
    // Ranks wait for many small messages. What is larger than 4 kB Open MPI
    // lets the receiver fetch by a system call, which takes longer than two
    // copies through shared memory (doc/developer/speed.md).
    set_unless_set("OMPI_MCA_btl_vader_single_copy_mechanism", "none");
    // Programs that are started without mpirun share a folder for files in
    // shared memory, and the first to end removes it: others then could not
    // open a file. Nothing here has file pointers that are shared.
    set_unless_set("OMPI_MCA_sharedfp", "^sm");
    if (!is_part_of_a_job())
      isolate_from_jobs();
  }



  void
  isolate_from_jobs()
  {
    set_unless_set("OMPI_MCA_ess_singleton_isolated", "1");
    set_unless_set("OMPI_MCA_orte_create_session_dirs", "0");
  }
} // namespace limber
