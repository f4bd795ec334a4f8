// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/grid/grid_tools.h>

#include <limber/adaptation/cell_values.h>
#include <limber/base/records_of_ranks.h>
#include <limber/materials/plastic_strain.h>

#include <algorithm>
#include <map>

namespace limber
{
  template <int dim>
  double
  largest_wave_speed(const BackgroundGrid<dim> &grid,
                     const MaterialBody<dim>   &body)
  {
    return std::sqrt(dealii::Utilities::MPI::max(
      body.stress->wave_speed_squared(body.points.view()), grid.communicator));
  }



  // Coordinates relative to the cell centre, against cancellation.
  template <int dim>
  void
  MotionSums<dim>::add(const PointView<dim>    &points,
                       const std::size_t        p,
                       const CellGeometry<dim> &geometry)
  {
    const std::array<double, dim> xi  = natural_place(points, geometry, p);
    const double                  m   = points.mass[p];
    double                       *sum = sums.data();
    *sum++ += m;
    for (int d = 0; d < dim; ++d)
      *sum++ += m * (xi[d] - 0.5);
    for (int d = 0; d < dim; ++d)
      *sum++ += m * points.velocity[d][p];
    for (int d = 0; d < dim; ++d)
      for (int e = 0; e < dim; ++e)
        *sum++ += m * (xi[d] - 0.5) * (xi[e] - 0.5);
    for (int d = 0; d < dim; ++d)
      for (int e = 0; e < dim; ++e)
        *sum++ += m * points.velocity[d][p] * (xi[e] - 0.5);
  }



  template <int dim>
  void
  MotionSums<dim>::add(const MotionSums<dim>         &other,
                       const dealii::Tensor<1, dim>  &shift,
                       const std::array<double, dim> &scale)
  {
    const double *const theirs = other.sums.data(), *const places = theirs + 1,
                        *const velocities = places + dim,
                        *const squares    = velocities + dim,
                        *const motions    = squares + dim * dim;
    const double               mass       = *theirs;
    double                    *sum        = sums.data();
    *sum++ += mass;
    for (int d = 0; d < dim; ++d)
      *sum++ += scale[d] * places[d] + mass * shift[d];
    for (int d = 0; d < dim; ++d)
      *sum++ += velocities[d];
    for (int d = 0; d < dim; ++d)
      for (int e = 0; e < dim; ++e)
        *sum++ += scale[d] * scale[e] * squares[d * dim + e] +
                  scale[d] * places[d] * shift[e] +
                  shift[d] * scale[e] * places[e] + mass * shift[d] * shift[e];
    for (int d = 0; d < dim; ++d)
      for (int e = 0; e < dim; ++e)
        *sum++ += scale[e] * motions[d * dim + e] + velocities[d] * shift[e];
  }



  template <int dim>
  LinearMotion<dim>
  MotionSums<dim>::motion() const
  {
    constexpr double  least_spread = 0.1;
    LinearMotion<dim> result;
    const double     *sum = sums.data();
    result.mass           = *sum++;
    if (!(result.mass > 0))
      return result;
    dealii::Tensor<1, dim> shift;
    for (int d = 0; d < dim; ++d)
      shift[d] = *sum++ / result.mass;
    for (int d = 0; d < dim; ++d)
      result.velocity[d] = *sum++ / result.mass;
    dealii::Tensor<2, dim> spread, motion;
    for (int d = 0; d < dim; ++d)
      {
        result.centre[d] = 0.5 + shift[d];
        for (int e = 0; e < dim; ++e)
          spread[d][e] = *sum++ / result.mass - shift[d] * shift[e];
      }
    for (int d = 0; d < dim; ++d)
      for (int e = 0; e < dim; ++e)
        motion[d][e] = *sum++ / result.mass - result.velocity[d] * shift[e];
    result.has_gradient = determinant(spread) > std::pow(least_spread, 2 * dim);
    if (result.has_gradient)
      result.gradient = motion * invert(spread);
    return result;
  }



  namespace
  {
    /** Sums over the points of each cell, owned or ghost, by local number. */
    template <std::size_t n>
    using CellRecords = std::vector<std::array<double, n>>;

    /** Add the sums in ghost cells to those of the owners; collective. */
    template <int dim, std::size_t n>
    void
    give_to_owners(const BackgroundGrid<dim> &grid, CellRecords<n> &records)
    {
      std::map<unsigned int, std::vector<double>> to_send;
      for (std::uint32_t c = grid.n_owned_cells(); c < grid.n_cells(); ++c)
        if (records[c][0] > 0) // mass
          {
            std::vector<double> &message = to_send[grid.ghost_cell(c).owner];
            message.push_back(grid.ghost_cell(c).number);
            message.insert(message.end(), records[c].begin(), records[c].end());
          }
      for (const auto &[rank, message] :
           exchange_records(to_send, grid.communicator))
        for (std::size_t i = 0; i + n < message.size(); i += n + 1)
          {
            const std::uint32_t c = static_cast<std::uint32_t>(message[i]);
            for (std::size_t k = 0; k < n; ++k)
              records[c][k] += message[i + 1 + k];
          }
    }



    /** Sums by add(points, p, record) over points with a cell; collective. */
    template <std::size_t n, int dim, class Add>
    CellRecords<n>
    sums_over_points(const BackgroundGrid<dim> &grid,
                     const MaterialBody<dim>   &body,
                     const Add                 &add)
    {
      CellRecords<n>       records(grid.n_cells());
      const PointView<dim> points = body.points.view();
      for (std::size_t p = 0; p < points.size; ++p)
        if (points.cell[p] != invalid_cell)
          add(points, p, records[points.cell[p]]);
      give_to_owners(grid, records);
      return records;
    }



    /** Copy the owners' records to the ghost cells; collective. */
    template <int dim, std::size_t n>
    void
    give_to_ghosts(const BackgroundGrid<dim> &grid, CellRecords<n> &records)
    {
      using Cell   = typename BackgroundGrid<dim>::Cell;
      using Record = std::array<double, n>;
      dealii::GridTools::exchange_cell_data_to_ghosts<
        Record,
        typename BackgroundGrid<dim>::Mesh>(
        grid.triangulation,
        [&](const Cell &cell) { return records[grid.cell_number(cell)]; },
        [&](const Cell &cell, const Record &record) {
          records[grid.cell_number(cell)] = record;
        });
    }



    /**
     * See motion_of_cells(); ghost cells have the contribution of this rank
     * only.
     */
    template <int dim>
    CellRecords<MotionSums<dim>::n>
    motion_records(const BackgroundGrid<dim> &grid,
                   const MaterialBody<dim>   &body)
    {
      return sums_over_points<MotionSums<dim>::n>(
        grid, body, [&](const auto &points, const std::size_t p, auto &record) {
          MotionSums<dim> sums{record};
          sums.add(points, p, grid.geometry[points.cell[p]]);
          record = sums.sums;
        });
    }



    template <int dim>
    double
    longest_edge(const BackgroundGrid<dim> &grid, const std::uint32_t cell)
    {
      double result = 0;
      for (const double inverse : grid.geometry[cell].inverse_edge)
        result = std::max(result, 1 / inverse);
      return result;
    }



    template <int dim>
    void
    join_rates(const BackgroundGrid<dim> &grid,
               const MaterialBody<dim>   &body,
               std::vector<double>       &values)
    {
      const double c = largest_wave_speed(grid, body);
      if (!(c > 0))
        return;
      const auto records = motion_records(grid, body);
      for (std::uint32_t cell = 0; cell < values.size(); ++cell)
        {
          const LinearMotion<dim> motion =
            MotionSums<dim>{records[cell]}.motion();
          if (!motion.has_gradient)
            continue;
          dealii::Tensor<2, dim> gradient = motion.gradient;
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e)
              gradient[d][e] *= grid.geometry[cell].inverse_edge[e];
          // Norm of the 3d deviator, including zz in plane strain.
          const dealii::SymmetricTensor<2, dim> rate = symmetrize(gradient);
          const double                          norm = std::sqrt(
            std::max(0., rate * rate - trace(rate) * trace(rate) / 3));
          values[cell] =
            std::max(values[cell], longest_edge(grid, cell) * norm / c);
        }
    }



    template <int dim>
    void
    join_plastic_strains(const BackgroundGrid<dim> &grid,
                         const MaterialBody<dim>   &body,
                         std::vector<double>       &values)
    {
      const auto variable =
        plastic_strain_of(body.description.law, body.description.material);
      if (!variable)
        return;
      const double *const  strain  = body.variable(*variable);
      const CellRecords<2> records = sums_over_points<2>(
        grid, body, [&](const auto &points, const std::size_t p, auto &record) {
          record[0] += points.mass[p];
          record[1] += points.mass[p] * strain[p];
        });
      for (std::uint32_t cell = 0; cell < values.size(); ++cell)
        if (records[cell][0] > 0)
          values[cell] =
            std::max(values[cell], records[cell][1] / records[cell][0]);
    }



    // Mass, and J p and the deviator of J sigma, as sums m times or as means
    template <int dim>
    using StressRecord = std::array<double, 2 + n_deviator<dim>>;

    /** The Frobenius norm of the difference of two stresses, Pa. */
    template <int dim>
    double
    jump_between(const StressRecord<dim> &a, const StressRecord<dim> &b)
    {
      const auto difference = [&](const unsigned int k) { return a[k] - b[k]; };
      const double pressure = difference(1), xx = difference(2),
                   yy = difference(3), zz = xx + yy;
      double squared = 3 * pressure * pressure + xx * xx + yy * yy + zz * zz;
      for (unsigned int k = 4; k < 2 + n_deviator<dim>; ++k)
        squared += 2 * difference(k) * difference(k);
      return std::sqrt(squared);
    }



    template <int dim>
    void
    join_stress_jumps(const BackgroundGrid<dim> &grid,
                      const MaterialBody<dim>   &body,
                      std::vector<double>       &values)
    {
      using Record      = StressRecord<dim>;
      using Cell        = typename BackgroundGrid<dim>::Cell;
      constexpr auto n  = std::tuple_size<Record>::value;
      auto           of = sums_over_points<n>(
        grid, body, [](const auto &points, const std::size_t p, auto &record) {
          record[0] += points.mass[p];
          record[1] += points.mass[p] * points.pressure[p];
          if (points.deviator[0] != nullptr)
            for (unsigned int k = 0; k < n_deviator<dim>; ++k)
              record[2 + k] += points.mass[p] * points.deviator[k][p];
        });
      for (Record &record : of)
        for (unsigned int k = 1; k < n && record[0] > 0; ++k)
          record[k] /= record[0];
      give_to_ghosts(grid, of);

      const auto compare = [&](const Cell &cell, const Cell &other) {
        const std::uint32_t own = grid.cell_number(cell);
        const Record       &a = of[own], &b = of[grid.cell_number(other)];
        if (a[0] > 0 && b[0] > 0)
          values[own] = std::max(values[own], jump_between<dim>(a, b));
      };
      for (const Cell &cell : grid.triangulation.active_cell_iterators())
        if (cell->is_locally_owned())
          for (const unsigned int face : cell->face_indices())
            {
              if (cell->at_boundary(face))
                continue;
              if (cell->neighbor(face)->is_active())
                compare(cell, Cell(cell->neighbor(face)));
              else
                for (unsigned int part = 0;
                     part < cell->face(face)->n_active_descendants();
                     ++part)
                  compare(cell, cell->neighbor_child_on_subface(face, part));
            }
    }
  } // namespace



  template <int dim>
  std::vector<MotionSums<dim>>
  motion_of_cells(const BackgroundGrid<dim> &grid,
                  const MaterialBody<dim>   &body)
  {
    auto records = motion_records(grid, body);
    give_to_ghosts(grid, records);
    std::vector<MotionSums<dim>> result;
    result.reserve(records.size());
    for (const auto &record : records)
      result.push_back({record});
    return result;
  }



  template <int dim>
  std::vector<double>
  cell_values(const Refinement<dim>                                 &refinement,
              const BackgroundGrid<dim>                             &grid,
              const std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies)
  {
    std::vector<double> values(grid.n_owned_cells());
    const auto         &names = refinement.bodies;
    for (const auto &body : bodies)
      if (names.empty() ||
          std::find(names.begin(), names.end(), body->description.name) !=
            names.end())
        switch (refinement.criterion)
          {
            case RefinementCriterion::stress:
              join_stress_jumps(grid, *body, values);
              break;
            case RefinementCriterion::rate:
              join_rates(grid, *body, values);
              break;
            case RefinementCriterion::plastic_strain:
              join_plastic_strains(grid, *body, values);
              break;
            default:
              Assert(false, dealii::ExcMessage("a criterion without a scale"));
          }
    return values;
  }



  template double
  largest_wave_speed(const BackgroundGrid<2> &, const MaterialBody<2> &);
  template double
  largest_wave_speed(const BackgroundGrid<3> &, const MaterialBody<3> &);
  template struct MotionSums<2>;
  template struct MotionSums<3>;
  template std::vector<MotionSums<2>>
  motion_of_cells(const BackgroundGrid<2> &, const MaterialBody<2> &);
  template std::vector<MotionSums<3>>
  motion_of_cells(const BackgroundGrid<3> &, const MaterialBody<3> &);
  template std::vector<double>
  cell_values(const Refinement<2> &,
              const BackgroundGrid<2> &,
              const std::vector<std::unique_ptr<MaterialBody<2>>> &);
  template std::vector<double>
  cell_values(const Refinement<3> &,
              const BackgroundGrid<3> &,
              const std::vector<std::unique_ptr<MaterialBody<3>>> &);
} // namespace limber
