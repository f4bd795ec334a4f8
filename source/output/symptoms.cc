// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/records_of_ranks.h>
#include <limber/output/diagnosis.h>

#include <algorithm>
#include <cmath>
#include <map>

/** @file Symptoms of numerical failures, from the points of a run. */
namespace limber
{
  namespace
  {
    /** Indices of a cell or node in the lattice of the grid. */
    template <int dim>
    using Lattice = std::array<int, dim>;

    /** Sums over the points of a body in a cell. */
    template <int dim>
    struct CellSymptoms
    {
      double                  count = 0;
      std::array<double, dim> place{}; // sum of natural coordinates
      double                  pressure = 0, pressure_squared = 0;

      double
      mean_pressure() const
      {
        return pressure / count;
      }
    };

    /** Nodal mass and momentum (P2G with linear functions). */
    template <int dim>
    struct NodeSymptoms
    {
      double                  mass = 0;
      std::array<double, dim> momentum{};
    };

    template <int dim>
    using CellMap = std::map<Lattice<dim>, CellSymptoms<dim>>;
    template <int dim>
    using NodeMap = std::map<Lattice<dim>, NodeSymptoms<dim>>;



    /** What one rank finds; the maps of all are merged on the first one. */
    template <int dim>
    struct Sighting
    {
      std::vector<CellMap<dim>> cells; // per body
      NodeMap<dim>              nodes;
      std::vector<double>       smallest_volume;
      double                    kinetic_energy = 0;
      unsigned long             not_finite     = 0;
    };



    template <int dim>
    void
    give_to_nodes(const PointView<dim>          &points,
                  const std::size_t              p,
                  const Lattice<dim>            &cell,
                  const std::array<double, dim> &xi,
                  Sighting<dim>                 &seen)
    {
      for (unsigned int corner = 0; corner < (1u << dim); ++corner)
        {
          Lattice<dim> node   = cell;
          double       weight = points.mass[p];
          for (int d = 0; d < dim; ++d)
            {
              const bool upper = (corner >> d & 1u) != 0;
              node[d] += upper;
              weight *= upper ? xi[d] : 1 - xi[d];
            }
          NodeSymptoms<dim> &sums = seen.nodes[node];
          sums.mass += weight;
          for (int d = 0; d < dim; ++d)
            sums.momentum[d] += weight * points.velocity[d][p];
        }
    }



    template <int dim>
    void
    look_at_body(const GridDescription<dim> &grid,
                 const MaterialBody<dim>    &body,
                 Sighting<dim>              &seen)
    {
      const PointView<dim> points = body.points.view();
      std::vector<double>  volume(points.size);
      body.stress->volume_ratio(points, volume.data());
      seen.cells.emplace_back();
      double smallest = 1;
      for (std::size_t p = 0; p < points.size; ++p)
        {
          Lattice<dim>            cell;
          std::array<double, dim> xi;
          double squared = 0, all = points.pressure[p] + volume[p];
          for (int d = 0; d < dim; ++d)
            {
              const double place = (points.place[d][p] - grid.lower[d]) *
                                   grid.cells[d] /
                                   (grid.upper[d] - grid.lower[d]);
              cell[d] = std::isfinite(place) ? int(std::floor(place)) : 0;
              xi[d]   = place - cell[d];
              squared += points.velocity[d][p] * points.velocity[d][p];
              all += place;
            }
          if (!std::isfinite(all + squared))
            {
              ++seen.not_finite;
              continue;
            }
          smallest = std::min(smallest, volume[p]);
          seen.kinetic_energy += 0.5 * points.mass[p] * squared;
          give_to_nodes<dim>(points, p, cell, xi, seen);

          CellSymptoms<dim> &sums     = seen.cells.back()[cell];
          const double       pressure = points.pressure[p] / volume[p];
          sums.count += 1;
          sums.pressure += pressure;
          sums.pressure_squared += pressure * pressure;
          for (int d = 0; d < dim; ++d)
            sums.place[d] += xi[d];
        }
      seen.smallest_volume.push_back(smallest);
    }



    /** Serialised for other ranks; bodies are in a fixed order. */
    template <int dim>
    std::vector<double>
    packed(const Sighting<dim> &seen)
    {
      std::vector<double> numbers = {seen.kinetic_energy,
                                     double(seen.not_finite)};
      numbers.insert(numbers.end(),
                     seen.smallest_volume.begin(),
                     seen.smallest_volume.end());
      for (const CellMap<dim> &cells : seen.cells)
        {
          numbers.push_back(double(cells.size()));
          for (const auto &[place, sums] : cells)
            {
              numbers.insert(numbers.end(), place.begin(), place.end());
              numbers.push_back(sums.count);
              numbers.insert(numbers.end(),
                             sums.place.begin(),
                             sums.place.end());
              numbers.push_back(sums.pressure);
              numbers.push_back(sums.pressure_squared);
            }
        }
      for (const auto &[place, sums] : seen.nodes)
        {
          numbers.insert(numbers.end(), place.begin(), place.end());
          numbers.push_back(sums.mass);
          numbers.insert(numbers.end(),
                         sums.momentum.begin(),
                         sums.momentum.end());
        }
      return numbers;
    }



    template <int dim>
    void
    merge(const std::vector<double> &numbers, Sighting<dim> &all)
    {
      auto       next       = numbers.begin();
      const auto take_place = [&]() {
        Lattice<dim> place;
        for (int d = 0; d < dim; ++d)
          place[d] = int(*next++);
        return place;
      };
      all.kinetic_energy += *next++;
      all.not_finite += static_cast<unsigned long>(*next++);
      for (double &smallest : all.smallest_volume)
        smallest = std::min(smallest, *next++);
      for (CellMap<dim> &cells : all.cells)
        for (auto n = static_cast<std::size_t>(*next++); n > 0; --n)
          {
            CellSymptoms<dim> &sums = cells[take_place()];
            sums.count += *next++;
            for (int d = 0; d < dim; ++d)
              sums.place[d] += *next++;
            sums.pressure += *next++;
            sums.pressure_squared += *next++;
          }
      while (next != numbers.end())
        {
          NodeSymptoms<dim> &sums = all.nodes[take_place()];
          sums.mass += *next++;
          for (int d = 0; d < dim; ++d)
            sums.momentum[d] += *next++;
        }
    }



    template <int dim>
    const CellSymptoms<dim> *
    neighbour(const CellMap<dim> &cells,
              Lattice<dim>        place,
              const int           d,
              const int           step)
    {
      place[d] += step;
      const auto found = cells.find(place);
      return found == cells.end() ? nullptr : &found->second;
    }



    template <int dim>
    bool
    is_isolated(const CellMap<dim> &cells, const Lattice<dim> &place)
    {
      for (unsigned int i = 0; i < std::pow(3, dim); ++i)
        {
          Lattice<dim> other = place;
          unsigned int digit = i;
          for (int d = 0; d < dim; ++d, digit /= 3)
            other[d] += int(digit % 3) - 1;
          if (other != place && cells.count(other) > 0)
            return false;
        }
      return true;
    }



    template <int dim>
    void
    look_at_cells(const CellMap<dim> &cells, BodySymptoms &symptoms)
    {
      double scatter = 0, means = 0, kinks = 0, n_kinks = 0, squares = 0;
      double isolated = 0, fullest = 0;
      for (const auto &[place, sums] : cells)
        fullest = std::max(fullest, sums.count);
      for (const auto &[place, sums] : cells)
        {
          const double mean = sums.mean_pressure();
          scatter +=
            std::max(0., sums.pressure_squared - sums.count * mean * mean);
          means += sums.count * mean * mean;
          isolated += is_isolated<dim>(cells, place);
          for (int d = 0; d < dim; ++d)
            {
              const double at     = sums.place[d] / sums.count;
              const auto  *before = neighbour<dim>(cells, place, d, -1);
              const auto  *behind = neighbour<dim>(cells, place, d, 1);
              if (before != nullptr && behind == nullptr)
                symptoms.filling = std::min(symptoms.filling, at);
              if (before == nullptr && behind != nullptr)
                symptoms.filling = std::min(symptoms.filling, 1 - at);
              // cells with less than half the points tell little
              if (before != nullptr && behind != nullptr &&
                  std::min({sums.count, before->count, behind->count}) >=
                    0.5 * fullest)
                {
                  const double kink = mean - 0.5 * (before->mean_pressure() +
                                                    behind->mean_pressure());
                  kinks += kink * kink;
                  squares += mean * mean;
                  ++n_kinks;
                }
            }
        }
      symptoms.pressure_scatter =
        scatter > 0 ? std::sqrt(scatter / std::max(means, 1e-300)) : 0;
      symptoms.checkerboard =
        n_kinks > 0 && squares > 0 ? std::sqrt(kinks / squares) : 0;
      symptoms.isolated_cells = cells.empty() ? 0 : isolated / cells.size();
    }



    template <int dim>
    double
    unseen_share(const Sighting<dim> &seen)
    {
      double grid = 0;
      for (const auto &[place, sums] : seen.nodes)
        if (sums.mass > 0)
          for (const double momentum : sums.momentum)
            grid += 0.5 * momentum * momentum / sums.mass;
      return seen.kinetic_energy > 0 ? 1 - grid / seen.kinetic_energy : 0;
    }
  } // namespace



  template <int dim>
  double
  smallest_edge_with_points(const State<dim> &state)
  {
    double largest_inverse = 0;
    for (const auto &body : state.bodies)
      {
        const PointView<dim> points = body->points.view();
        for (std::size_t p = 0; p < points.size; ++p)
          if (points.cell[p] != invalid_cell)
            for (const double inverse :
                 state.grid.geometry[points.cell[p]].inverse_edge)
              largest_inverse = std::max(largest_inverse, inverse);
      }
    return 1 / dealii::Utilities::MPI::max(largest_inverse,
                                           state.grid.communicator);
  }



  template <int dim>
  Symptoms
  find_symptoms(const State<dim> &state, const double signal_speed)
  {
    Sighting<dim> own;
    for (const auto &body : state.bodies)
      look_at_body(state.problem.grid, *body, own);
    const auto    parts = gather_records(packed(own),
                                      state.grid.communicator,
                                      /*only_first=*/true);
    Sighting<dim> all;
    all.cells.resize(state.bodies.size());
    all.smallest_volume.assign(state.bodies.size(), 1.);
    for (const auto &part : parts)
      merge(part, all);

    Symptoms symptoms;
    symptoms.courant_number =
      state.step_size * signal_speed / smallest_edge_with_points(state);
    symptoms.not_finite    = all.not_finite;
    symptoms.unseen_energy = unseen_share(all);
    for (std::size_t b = 0; b < state.bodies.size(); ++b)
      {
        BodySymptoms body;
        body.body            = state.bodies[b]->description.name;
        body.smallest_volume = all.smallest_volume[b];
        look_at_cells<dim>(all.cells[b], body);
        symptoms.bodies.push_back(body);
      }
    return symptoms;
  }



  template double
  smallest_edge_with_points<2>(const State<2> &);
  template double
  smallest_edge_with_points<3>(const State<3> &);
  template Symptoms
  find_symptoms<2>(const State<2> &, double);
  template Symptoms
  find_symptoms<3>(const State<3> &, double);
} // namespace limber
