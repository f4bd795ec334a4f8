// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/mpi.h>

#include <limber/base/exceptions.h>
#include <limber/base/memory.h>
#include <limber/base/text.h>
#include <limber/problem/point_list.h>
#include <limber/problem/size_estimate.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace limber
{
  namespace
  {
    // Bytes, as measured; in two and in three dimensions. Those of splines and
    // of the filter are reckoned from the tables they take.
    constexpr double of_program              = 165e6;
    constexpr double of_cell[]               = {400, 750};
    constexpr double of_quadratic_cell[]     = {80, 170};
    constexpr double of_cubic_cell[]         = {96, 304};
    constexpr double of_coarse_cell[]        = {450, 900}; // on every rank
    constexpr double of_point[]              = {90, 125};
    constexpr double of_point_affine[]       = {32, 72};
    constexpr double of_point_quadratic[]    = {20, 40}; // sums of its cell
    constexpr double of_point_cubic[]        = {36, 96};
    constexpr double of_point_filtered[]     = {35, 60}; // FMPM, XPIC
    constexpr double of_point_reference[]    = {16, 24};
    constexpr double of_point_on_its_way[]   = {350, 450}; // to another rank
    constexpr double of_cell_in_a_picture[]  = {750, 1500};
    constexpr double of_point_in_a_picture[] = {350, 450};
    constexpr double of_element_node[]       = {2700, 16000};
    constexpr double of_explicit_node[]      = {1800, 9500};
    constexpr double grid_built_anew         = 1.6; // more than one rank



    /** Common factors of two are refinements, as when the mesh is built. */
    template <std::size_t dim>
    double
    count_coarse(std::array<unsigned int, dim> cells)
    {
      while (std::all_of(cells.begin(), cells.end(), [](const unsigned int n) {
        return n > 0 && n % 2 == 0;
      }))
        for (unsigned int &n : cells)
          n /= 2;
      return std::accumulate(cells.begin(),
                             cells.end(),
                             1.,
                             [](double a, unsigned int b) { return a * b; });
    }



    template <class Numbers>
    double
    product(const Numbers &numbers)
    {
      double result = 1;
      for (const auto n : numbers)
        result *= n;
      return result;
    }



    /** Volume, m^dim: exact for blocks, of other shapes by sampling. */
    template <int dim>
    double
    volume_of(const Shape<dim> &shape)
    {
      if (const auto *block = dynamic_cast<const BlockShape<dim> *>(&shape))
        {
          Corners<dim> all;
          for (int d = 0; d < dim; ++d)
            all.second[d] = 1;
          return std::abs(block->volume(all));
        }
      constexpr unsigned int n      = dim == 2 ? 64 : 16;
      const Corners<dim>     box    = shape.bounding_box();
      double                 volume = 1;
      for (int d = 0; d < dim; ++d)
        volume *= box.second[d] - box.first[d];
      const unsigned int n_all  = dim == 2 ? n * n : n * n * n;
      unsigned int       inside = 0;
      for (unsigned int i = 0; i < n_all; ++i)
        {
          dealii::Point<dim> place;
          unsigned int       rest = i;
          for (int d = 0; d < dim; ++d, rest /= n)
            place[d] = box.first[d] +
                       (rest % n + 0.5) / n * (box.second[d] - box.first[d]);
          inside += shape.contains(place);
        }
      // A shape thinner than the spacing of samples has some volume.
      return volume * std::max(inside, 1u) / n_all;
    }



    /** Upper bound of the number of cells that refinement adds within a box;
     * regions given by a formula count with their boxes. */
    template <int dim>
    double
    added_by_levels(const GridDescription<dim> &grid,
                    const Corners<dim>         &within)
    {
      double result = 0;
      for (const Refinement<dim> &refinement : grid.refinements)
        {
          double cells = std::pow(2., dim * double(refinement.level)) - 1;
          for (int d = 0; d < dim; ++d)
            cells *=
              std::max(0.,
                       std::min(within.second[d], refinement.box.second[d]) -
                         std::max(within.first[d], refinement.box.first[d])) /
              grid.edge(d);
          result += cells;
        }
      return result;
    }



    template <int dim>
    double
    count_points(const Body<dim> &body, const GridDescription<dim> &grid)
    {
      if (body.placement == Placement::fitted)
        return product(body.lattice);
      if (const auto *list =
            dynamic_cast<const PointListShape<dim> *>(body.shape.get()))
        return list->points.size();
      double cell = 1;
      for (int d = 0; d < dim; ++d)
        cell *= grid.edge(d);
      const double volume = volume_of(*body.shape);
      const double finest =
        volume / cell * std::pow(2., dim * double(grid.levels));
      return std::min(finest,
                      volume / cell +
                        added_by_levels(grid, body.shape->bounding_box())) *
             product(body.points_per_cell_edge);
    }



    template <int dim>
    SizeEstimate
    estimate_run(const Problem<dim> &problem, const unsigned int ranks)
    {
      constexpr int k           = dim - 2;
      const bool    in_parallel = ranks > 1;
      const bool    pictures    = problem.output.time_interval > 0;
      SizeEstimate  size;
      size.cells =
        product(problem.grid.cells) +
        added_by_levels<dim>(problem.grid,
                             {problem.grid.lower, problem.grid.upper});
      size.bytes_of_programs = of_program * ranks;
      const bool quadratic   = problem.grid.kernel == KernelKind::quadratic;
      const bool cubic       = problem.grid.kernel == KernelKind::cubic;
      size.bytes_of_cells =
        size.cells *
          (of_cell[k] + (quadratic ? of_quadratic_cell[k] :
                         cubic     ? of_cubic_cell[k] :
                                     0)) *
          (in_parallel ? grid_built_anew : 1) +
        count_coarse(problem.grid.cells) * of_coarse_cell[k] * ranks;

      double per_point = of_point[k];
      if (is_affine(problem.method.transfer))
        per_point += of_point_affine[k];
      if (quadratic)
        per_point += of_point_quadratic[k];
      if (cubic)
        per_point += of_point_cubic[k];
      if (filters_velocity(problem.method.transfer))
        per_point += of_point_filtered[k];
      if (problem.keeps_initial_places())
        per_point += of_point_reference[k];
      if (in_parallel)
        per_point += of_point_on_its_way[k];
      for (const Body<dim> &body : problem.bodies)
        {
          size.points.push_back(count_points(body, problem.grid));
          const bool domains =
            has_domains(problem.grid.kernel) && !body.is_liquid;
          const unsigned int of_domain =
            problem.grid.kernel == KernelKind::gimp  ? dim :
            problem.grid.kernel == KernelKind::cpdi2 ? dim * ((1 << dim) - 1) :
                                                       dim * dim;
          const double own =
            per_point + (domains ? of_domain * sizeof(double) : 0);
          // While points are placed, the places in one cell are kept; the
          // lattice of 'fitted' has none.
          const double places = body.placement == Placement::fitted ?
                                  0 :
                                  product(body.points_per_cell_edge);
          size.bytes_of_points.push_back(size.points.back() * own +
                                         places * sizeof(double) * (dim + 1));
        }
      if (!pictures)
        return size;
      // Pictures of cells and points are written one after the other: the
      // larger one counts.
      const double of_grid = size.cells * of_cell_in_a_picture[k];
      const double of_all  = size.all_points() * of_point_in_a_picture[k];
      if (of_grid > of_all)
        size.bytes_of_cells += of_grid;
      else
        for (std::size_t b = 0; b < size.points.size(); ++b)
          size.bytes_of_points[b] += size.points[b] * of_point_in_a_picture[k];
      return size;
    }



    /**
     * Coarse elements along each edge, as the mesh of the reference will have
     * them.
     */
    template <int dim>
    std::array<unsigned int, dim>
    coarse_elements(const ReferenceRequest &request)
    {
      std::array<unsigned int, dim> result;
      result.fill(request.over_depth);
      std::copy(request.elements.begin(),
                request.elements.end(),
                result.begin());
      return result;
    }



    /** Product of all edges over the shortest one. */
    template <int dim>
    double
    slenderness(const Body<dim> &body)
    {
      const Corners<dim>      box = body.shape->bounding_box();
      std::array<double, dim> length;
      for (int d = 0; d < dim; ++d)
        length[d] = box.second[d] - box.first[d];
      const double shortest = *std::min_element(length.begin(), length.end());
      double       result   = 1;
      for (const double edge : length)
        result *= edge / shortest;
      return result;
    }



    template <int dim>
    SizeEstimate
    estimate_reference(const Problem<dim> &problem,
                       const unsigned int  ranks,
                       const double        elements_in_file)
    {
      constexpr int           k       = dim - 2;
      const ReferenceRequest &request = problem.reference;
      SizeEstimate            size;
      size.bytes_of_programs = of_program * ranks;
      size.cells             = request.mesh_file.empty() ?
                                 product(coarse_elements<dim>(request)) :
                                 elements_in_file;
      if (request.mesh_file.empty() && request.elements.empty())
        size.cells *= slenderness(problem.bodies.front());
      size.cells *= std::pow(2., double(dim) * request.refinements);

      const bool linear = request.element == ReferenceElement::q1 ||
                          request.element == ReferenceElement::q1_p0_p0;
      const bool solves = request.method != ReferenceMethod::explicit_steps ||
                          request.frequencies > 0;
      size.points          = {size.cells * (linear ? 1 : 1 << dim)};
      size.bytes_of_points = {
        size.points.front() *
        (solves ? of_element_node[k] : of_explicit_node[k]) *
        (dim == 3 && linear ? 0.55 : 1)};
      return size;
    }
  } // namespace



  Machine
  this_machine()
  {
    return {1, machine_memory(1)};
  }



  Machine
  this_machine(const MPI_Comm communicator)
  {
    MPI_Comm here;
    MPI_Comm_split_type(
      communicator, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here);
    const unsigned int ranks_here =
      dealii::Utilities::MPI::n_mpi_processes(here);
    MPI_Comm_free(&here);
    const unsigned int ranks =
      dealii::Utilities::MPI::n_mpi_processes(communicator);
    const double per_rank = machine_memory(ranks_here) / ranks_here;
    return {ranks, ranks * dealii::Utilities::MPI::min(per_rank, communicator)};
  }



  double
  SizeEstimate::bytes() const
  {
    return std::accumulate(bytes_of_points.begin(),
                           bytes_of_points.end(),
                           bytes_of_programs + bytes_of_cells);
  }



  double
  SizeEstimate::all_points() const
  {
    return std::accumulate(points.begin(), points.end(), 0.);
  }



  template <int dim>
  SizeEstimate
  estimate_size(const Problem<dim> &problem,
                const Task          task,
                const unsigned int  ranks,
                const double        elements_in_file)
  {
    return task == Task::run ?
             estimate_run(problem, ranks) :
             estimate_reference(problem, ranks, elements_in_file);
  }



  template SizeEstimate
  estimate_size<2>(const Problem<2> &,
                   const Task,
                   const unsigned int,
                   const double);
  template SizeEstimate
  estimate_size<3>(const Problem<3> &,
                   const Task,
                   const unsigned int,
                   const double);
} // namespace limber
