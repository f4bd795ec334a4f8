// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_size_estimate_h
#define limber_problem_size_estimate_h

#include <limber/problem/problem.h>

/** @file Size of a scene, estimated before memory is allocated for it. */
namespace limber
{
  /** What is to be computed for a scene. */
  enum class Task
  {
    run,
    reference // finite elements
  };



  /**
   * Number of processes of a run and the memory that they may take together.
   */
  struct Machine
  {
    unsigned int ranks = 1;     // of the whole run
    double       bytes = 1e300; // of all machines that it runs on
  };

  /** For one process. */
  Machine
  this_machine();

  /** The machine with the least memory per rank counts for all ranks, so every
   * rank gets the same. Collective. */
  Machine
  this_machine(MPI_Comm communicator);



  /**
   * Counts, and the memory that all ranks take together at most, bytes. The
   * constants are measured (doc/guide/troubleshooting.md says against which
   * runs) and hold within a factor of 1.5.
   */
  struct SizeEstimate
  {
    double              cells = 0; // of the grid, or finite elements
    std::vector<double> points;    // of each body; nodes of a reference
    double              bytes_of_programs = 0;
    double              bytes_of_cells    = 0; // nodes and pictures included
    std::vector<double> bytes_of_points;       // of each body, likewise

    double
    bytes() const;

    double
    all_points() const;
  };

  template <int dim>
  SizeEstimate
  estimate_size(const Problem<dim> &problem,
                const Task          task,
                const unsigned int  ranks,
                const double        elements_in_file = 1);

  /**
   * Throws InputError where the scene does not fit into the memory that there
   * is, or that 'Memory limit' allows; where its cells or nodes are more than
   * numbers of 32 bits can count; or where it asks for pictures, steps or load
   * steps without end. To be called before anything is built; elements of a
   * mesh from a file are known only when that has been read.
   */
  template <int dim>
  void
  check_size(const Problem<dim> &problem,
             const Task          task,
             const Machine      &machine,
             const double        elements_in_file = 1);

  /** The same for the number of steps, as soon as their length @p step, s, is
   * known. */
  template <int dim>
  void
  check_steps(const Problem<dim> &problem, Task task, double step);
} // namespace limber

#endif
