// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/size_estimate.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace limber
{
  namespace
  {
    // deal.II and p4est count cells and nodes in 32 bits, and we the numbers
    // of a rank's nodal records.
    constexpr double most_cells   = 2e9;
    constexpr double most_records = 4e9;

    constexpr double most_pictures = 1e5;
    constexpr double most_steps    = 1e9;



    std::string
    gigabytes(const double bytes)
    {
      return brief(bytes / 1e9) + " GB";
    }



    /**
     * Factor for the cells along each edge that brings the scene below the
     * limit.
     */
    template <int dim>
    double
    factor_per_edge(const double excess)
    {
      return 0.9 * std::pow(excess, -1. / dim);
    }



    template <class Numbers>
    std::string
    scaled(const Numbers &numbers, const double factor)
    {
      std::vector<std::string> parts;
      for (const auto n : numbers)
        parts.push_back(
          std::to_string(static_cast<long>(std::clamp(n * factor, 1., 1e9))));
      return join(parts, ", ");
    }



    /** The same for numbers of cells, rounded to common factors of two. */
    template <std::size_t dim>
    std::string
    scaled_cells(const std::array<unsigned int, dim> &cells,
                 const double                         factor)
    {
      const double smallest =
        factor * *std::min_element(cells.begin(), cells.end());
      unsigned int unit = 1;
      while (unit * 32 <= smallest)
        unit *= 2;
      std::vector<std::string> parts;
      for (const unsigned int n : cells)
        parts.push_back(std::to_string(
          static_cast<long>(std::max(1., n * factor / unit)) * unit));
      return join(parts, ", ");
    }



    /**
     * What to write instead: reduces what takes the most memory until it fits.
     */
    template <int dim>
    std::string
    remedy_for(const Problem<dim> &problem,
               const SizeEstimate &size,
               const Task          task,
               const double        limit)
    {
      const auto   largest = std::max_element(size.bytes_of_points.begin(),
                                            size.bytes_of_points.end());
      const double rest    = std::max(1., limit - size.bytes_of_programs);
      if (task == Task::reference)
        {
          if (problem.reference.refinements > 0)
            return "'Reference/Refinements = 0'";
          const double factor = factor_per_edge<dim>(*largest / rest);
          return problem.reference.elements.empty() ?
                   "'Reference/Elements over depth = " +
                     scaled(
                       std::array<unsigned int, 1>{
                         {problem.reference.over_depth}},
                       factor) +
                     "'" :
                   "'Reference/Elements = " +
                     scaled(problem.reference.elements, factor) + "'";
        }
      const Body<dim> &body =
        problem.bodies[largest - size.bytes_of_points.begin()];
      // Fewer cells mean fewer points, unless a cell holds too many of them.
      const double per_cell = std::accumulate(body.points_per_cell_edge.begin(),
                                              body.points_per_cell_edge.end(),
                                              1.,
                                              std::multiplies<double>());
      const double factor =
        factor_per_edge<dim>((size.bytes() - size.bytes_of_programs) / rest);
      if (body.placement != Placement::fitted &&
          *largest > size.bytes_of_cells &&
          factor_per_edge<dim>(*largest / rest) *
              std::pow(per_cell, 1. / dim) >=
            1)
        return in_quotes("Body " + body.name) + ", 'Points per cell edge = " +
               scaled(body.points_per_cell_edge,
                      factor_per_edge<dim>(*largest / rest)) +
               "'";
      if (body.placement == Placement::fitted && *largest > size.bytes_of_cells)
        return in_quotes("Body " + body.name) +
               ", 'Points along edges = " + scaled(body.lattice, factor) + "'";
      return "'Grid/Cells = " + scaled_cells(problem.grid.cells, factor) + "'";
    }



    template <int dim>
    void
    check_memory(const Problem<dim> &problem,
                 const SizeEstimate &size,
                 const Task          task,
                 const Machine      &machine)
    {
      const bool   own   = problem.memory_limit > 0;
      const double limit = own ? problem.memory_limit : machine.bytes;
      if (size.bytes() <= limit)
        return;
      if (limit <= size.bytes_of_programs)
        throw InputError(
          "The scene needs some " + gigabytes(size.bytes()) +
          " of memory, the program alone " + gigabytes(size.bytes_of_programs) +
          "; " + (own ? "'Memory limit' is " : "there are ") +
          gigabytes(limit) + ". Usually " +
          (own ? "it was meant in GB. Set 'Memory limit = " +
                   brief(std::ceil(size.bytes() / 1e8) / 10) + "', GB." :
                 "a limit of the shell or of a queue is too "
                 "low. Ask for " +
                   gigabytes(size.bytes()) + ", or use fewer ranks."));
      throw InputError(
        "The scene needs some " + gigabytes(size.bytes()) + " of memory for " +
        brief(size.cells) +
        (task == Task::run ? " cells and " : " elements and ") +
        brief(size.all_points()) +
        (task == Task::run ? " points; " : " nodes; ") +
        (own ? "'Memory limit' is " : "there are ") + gigabytes(limit) +
        ". Usually a number has a digit too many. Set " +
        remedy_for(problem, size, task, limit) + ", or 'Memory limit', GB.");
    }



    template <int dim>
    void
    check_counts(const SizeEstimate &size,
                 const Task          task,
                 const unsigned int  ranks)
    {
      constexpr double stride  = dim == 2 ? 8 : 10; // numbers per record
      const double     records = size.cells / ranks * stride;
      if (size.cells <= most_cells && size.all_points() <= 1e15 &&
          (task == Task::reference ? size.all_points() * dim <= most_records :
                                     records <= most_records))
        return;
      throw InputError(
        "The scene has " + brief(size.cells) +
        (task == Task::run ? " cells and " : " elements and ") +
        brief(size.all_points()) + (task == Task::run ? " points" : " nodes") +
        ", more than the program can count. Usually a number has a digit too "
        "many. Set " +
        (task == Task::run ? "'Grid/Cells' to 1000 in each direction, or "
                             "'Points per cell edge' to 2." :
                             "'Reference/Elements over depth' to 8 and "
                             "'Reference/Refinements' to 0."));
    }



    void
    check_frequencies(const ReferenceRequest &request, const Task task)
    {
      constexpr unsigned int most = 1000;
      if (task == Task::run || request.frequencies <= most)
        return;
      throw InputError("The scene asks for " +
                       std::to_string(request.frequencies) +
                       " natural frequencies ('Reference/Frequencies'); at "
                       "most " +
                       std::to_string(most) +
                       " are computed, and only the lowest are accurate. Set "
                       "'Reference/Frequencies = 3', for instance.");
    }



    template <int dim>
    void
    check_pictures(const Problem<dim> &problem, const Task task)
    {
      if (problem.output.time_interval <= 0)
        return;
      double n = problem.end_time / problem.output.time_interval;
      if (task == Task::run && problem.end_step > 0)
        n = std::min(n, double(problem.end_step));
      if (n <= most_pictures)
        return;
      throw InputError(
        "The scene asks for " + brief(n) +
        " pictures, one every 'Output/Time interval' = " +
        brief(problem.output.time_interval) + " s until 'End time' = " +
        brief(problem.end_time) + " s; at most " + brief(most_pictures) +
        " are written. Usually the units differ. Set 'Output/Time interval = " +
        brief(problem.end_time / 100) + "'.");
    }
  } // namespace



  template <int dim>
  void
  check_size(const Problem<dim> &problem,
             const Task          task,
             const Machine      &machine,
             const double        elements_in_file)
  {
    const SizeEstimate size =
      estimate_size(problem, task, machine.ranks, elements_in_file);
    check_counts<dim>(size, task, machine.ranks);
    check_memory(problem, size, task, machine);
    check_pictures(problem, task);
    check_frequencies(problem.reference, task);
    const double step =
      task == Task::run ? problem.method.time_step :
      problem.reference.method == ReferenceMethod::quasi_static ?
                          problem.end_time / problem.reference.load_steps :
                          problem.reference.time_step;
    if (step > 0)
      check_steps(problem, task, step);
  }



  template <int dim>
  void
  check_steps(const Problem<dim> &problem, const Task task, const double step)
  {
    double n = problem.end_time / step;
    if (task == Task::run && problem.end_step > 0)
      n = std::min(n, double(problem.end_step));
    if (n <= most_steps)
      return;
    throw InputError(
      "The end time of " + brief(problem.end_time) + " s takes " + brief(n) +
      " steps of " + brief(step) + " s; at most " + brief(most_steps) +
      " are done. Usually 'End time' and the step have different units. Set "
      "'End time = " +
      brief(1e5 * step) + "', or " +
      (task == Task::run ? "'End step = 1000'." :
                           "a longer 'Reference/Time step'."));
  }



  template void
  check_size<2>(const Problem<2> &, const Task, const Machine &, const double);
  template void
  check_size<3>(const Problem<3> &, const Task, const Machine &, const double);
  template void
  check_steps<2>(const Problem<2> &, const Task, const double);
  template void
  check_steps<3>(const Problem<3> &, const Task, const double);
} // namespace limber
