// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/adaptation/cell_values.h>
#include <limber/adaptation/joining.h>
#include <limber/points/single_point.h>

#include <algorithm>
#include <numeric>
#include <unordered_map>

namespace limber
{
  namespace
  {
    constexpr double velocity_tolerance = 1e-3; // of the wave speed
    constexpr double stress_tolerance   = 0.05; // of its mean

    using Set = std::vector<std::size_t>;

    /** Whether the velocity of the points of a cell is nearly linear. */
    template <int dim>
    bool
    moves_evenly(const BackgroundGrid<dim> &grid,
                 const PointView<dim>      &points,
                 const Set                 &of_cell,
                 const double               tolerance)
    {
      const CellGeometry<dim> &geometry =
        grid.geometry[points.cell[of_cell[0]]];
      MotionSums<dim> sums;
      for (const std::size_t p : of_cell)
        sums.add(points, p, geometry);
      const LinearMotion<dim> motion = sums.motion();
      if (!motion.has_gradient)
        return false;
      for (const std::size_t p : of_cell)
        {
          const std::array<double, dim> xi = natural_place(points, geometry, p);
          dealii::Tensor<1, dim>        shift, difference;
          for (int d = 0; d < dim; ++d)
            {
              shift[d]      = xi[d] - motion.centre[d];
              difference[d] = points.velocity[d][p] - motion.velocity[d];
            }
          difference -= motion.gradient * shift;
          if (!(difference.norm() < tolerance))
            return false;
        }
      return true;
    }



    /** J p and the deviator of J sigma, Pa. */
    template <int dim>
    using PointStress = std::array<double, 1 + n_deviator<dim>>;

    template <int dim>
    PointStress<dim>
    stress_of(const PointView<dim> &points, const std::size_t p)
    {
      PointStress<dim> result{};
      result[0] = points.pressure[p];
      if (points.deviator[0] != nullptr)
        for (unsigned int k = 0; k < n_deviator<dim>; ++k)
          result[1 + k] = points.deviator[k][p];
      return result;
    }

    template <int dim>
    double
    norm_of(const PointStress<dim> &stress)
    {
      const double xx = stress[1], yy = stress[2], zz = xx + yy;
      double squared = 3 * stress[0] * stress[0] + xx * xx + yy * yy + zz * zz;
      for (unsigned int k = 3; k < stress.size(); ++k)
        squared += 2 * stress[k] * stress[k];
      return std::sqrt(squared);
    }



    /** Whether their stress is nearly uniform. */
    template <int dim>
    bool
    is_loaded_evenly(const PointView<dim> &points,
                     const Set            &of_cell,
                     const double          smallest_tolerance)
    {
      PointStress<dim> mean{};
      double           mass = 0;
      for (const std::size_t p : of_cell)
        {
          const PointStress<dim> stress = stress_of(points, p);
          for (unsigned int k = 0; k < mean.size(); ++k)
            mean[k] += points.mass[p] * stress[k];
          mass += points.mass[p];
        }
      for (double &component : mean)
        component /= mass;
      const double tolerance =
        std::max(smallest_tolerance, stress_tolerance * norm_of<dim>(mean));
      return std::all_of(of_cell.begin(),
                         of_cell.end(),
                         [&](const std::size_t p) {
                           PointStress<dim> difference = stress_of(points, p);
                           for (unsigned int k = 0; k < mean.size(); ++k)
                             difference[k] -= mean[k];
                           return norm_of<dim>(difference) < tolerance;
                         });
    }



    /** Whether the point has been made by dividing a stretched one. */
    template <int dim>
    bool
    is_divided(const BackgroundGrid<dim> &grid,
               const MaterialBody<dim>   &body,
               const std::size_t          p)
    {
      const PointView<dim> points = body.points.view();
      for (int d = 0; d < dim; ++d)
        if (points.edge[d] != nullptr &&
            points.edge[d][p] < 0.75 * grid.description.edge(d) /
                                  body.description.points_per_cell_edge[d] /
                                  (1u << body.points.size_class(p)))
          return true;
      return false;
    }



    /**
     * Sort the points of a cell by the sub-boxes of points of its level; see
     * sets_to_join().
     */
    template <int dim>
    void
    add_sets(const BackgroundGrid<dim>               &grid,
             const MaterialBody<dim>                 &body,
             const std::unordered_set<std::uint64_t> &kept,
             const Set                               &of_cell,
             std::vector<Set>                        &sets)
    {
      const PointView<dim>     points   = body.points.view();
      const std::uint32_t      cell     = points.cell[of_cell[0]];
      const CellGeometry<dim> &geometry = grid.geometry[cell];
      const auto              &rooms    = body.description.points_per_cell_edge;
      std::size_t              n        = 1;
      for (const unsigned int along_edge : rooms)
        n *= along_edge;
      std::vector<Set> by_room(n);
      for (const std::size_t p : of_cell)
        {
          if (body.points.size_class(p) != grid.level_of(cell) + 1 ||
              is_divided(grid, body, p) || kept.count(body.points.id(p)) > 0)
            continue;
          const std::array<double, dim> xi = natural_place(points, geometry, p);
          std::size_t                   room = 0;
          for (int d = dim; d-- > 0;)
            room =
              room * rooms[d] + std::clamp(static_cast<int>(xi[d] * rooms[d]),
                                           0,
                                           static_cast<int>(rooms[d]) - 1);
          by_room[room].push_back(p);
        }
      // As points move, the number of points in a sub-box may vary.
      constexpr std::size_t family = 1 << dim;
      for (Set &set : by_room)
        if (4 * set.size() >= 3 * family && 2 * set.size() <= 3 * family)
          sets.push_back(std::move(set));
    }
  } // namespace



  template <int dim>
  bool
  any_finer_than_cells(
    const BackgroundGrid<dim>                             &grid,
    const std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies)
  {
    unsigned int any = 0;
    for (const auto &body : bodies)
      {
        const PointView<dim> points = body->points.view();
        for (std::size_t p = 0; p < points.size && any == 0; ++p)
          any = points.cell[p] != invalid_cell &&
                body->points.size_class(p) > grid.level_of(points.cell[p]);
      }
    return dealii::Utilities::MPI::max(any, grid.communicator) > 0;
  }



  template <int dim>
  std::vector<Set>
  sets_to_join(const BackgroundGrid<dim>               &grid,
               const Occupancy<dim>                    &occupancy,
               const MaterialBody<dim>                 &body,
               const std::unordered_set<std::uint64_t> &kept)
  {
    const double speed = largest_wave_speed(grid, body);
    const double impact =
      velocity_tolerance * speed * speed * body.stress->density();
    const PointView<dim> points = body.points.view();
    std::vector<Set>     by_cell(grid.n_cells()), sets;
    for (std::size_t p = 0; p < points.size; ++p)
      if (points.cell[p] != invalid_cell)
        by_cell[points.cell[p]].push_back(p);
    for (const auto &cell : grid.triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const Set &of_cell = by_cell[grid.cell_number(cell)];
          const auto level   = grid.level_of(cell);
          const auto place   = grid.place_of(cell);
          const auto is_fine = [&](const std::size_t p) {
            return body.points.size_class(p) == level + 1;
          };
          if (std::any_of(of_cell.begin(), of_cell.end(), is_fine) &&
              occupancy.points_in(level, place) == of_cell.size() &&
              !occupancy.is_near_empty(level, place, 1) &&
              moves_evenly(grid, points, of_cell, velocity_tolerance * speed) &&
              is_loaded_evenly(points, of_cell, impact))
            add_sets(grid, body, kept, of_cell, sets);
        }
    return sets;
  }



  template <int dim>
  double
  join(const std::vector<Set> &sets, MaterialBody<dim> &body)
  {
    if (sets.empty())
      return 0;
    const auto strain_energy = [&](const std::size_t p) {
      return body.stress->summarize(only(body.points.view(), p)).strain_energy;
    };
    const PointView<dim> points = body.points.view();
    // By set: the difference of sums over all points would be round-off.
    std::vector<double>                            strain(sets.size(), 0.);
    std::unordered_map<std::uint64_t, std::size_t> set_of; // by first id
    double                                         kinetic = 0;
    for (std::size_t s = 0; s < sets.size(); ++s)
      {
        const Set &set = sets[s];
        set_of.emplace(body.points.id(set[0]), s);
        for (const std::size_t p : set)
          strain[s] += strain_energy(p);
        dealii::Tensor<1, dim> momentum;
        double                 mass = 0;
        for (const std::size_t p : set)
          {
            mass += points.mass[p];
            for (int d = 0; d < dim; ++d)
              momentum[d] += points.mass[p] * points.velocity[d][p];
          }
        for (const std::size_t p : set)
          for (int d = 0; d < dim; ++d)
            {
              const double own = points.velocity[d][p] - momentum[d] / mass;
              kinetic += 0.5 * points.mass[p] * own * own;
            }
      }
    body.points.join(sets);
    for (std::size_t p = 0; p < body.points.size(); ++p)
      if (const auto found = set_of.find(body.points.id(p));
          found != set_of.end())
        strain[found->second] -= strain_energy(p);
    return std::accumulate(strain.begin(), strain.end(), kinetic);
  }



  template bool
  any_finer_than_cells(const BackgroundGrid<2> &,
                       const std::vector<std::unique_ptr<MaterialBody<2>>> &);
  template bool
  any_finer_than_cells(const BackgroundGrid<3> &,
                       const std::vector<std::unique_ptr<MaterialBody<3>>> &);
  template std::vector<Set>
  sets_to_join(const BackgroundGrid<2> &,
               const Occupancy<2> &,
               const MaterialBody<2> &,
               const std::unordered_set<std::uint64_t> &);
  template std::vector<Set>
  sets_to_join(const BackgroundGrid<3> &,
               const Occupancy<3> &,
               const MaterialBody<3> &,
               const std::unordered_set<std::uint64_t> &);
  template double
  join(const std::vector<Set> &, MaterialBody<2> &);
  template double
  join(const std::vector<Set> &, MaterialBody<3> &);
} // namespace limber
