// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/cut_cells.h>

#include <algorithm>
#include <cmath>

/**
 * @file Search for cut cells. If obstacles move, only cells near these are
 * classified and cut anew in a step.
 */

namespace limber
{
  namespace
  {
    // In diagonals of a cell: a moving obstacle further away from its centre
    // affects neither the cell nor its neighbours, which may be twice as large.
    constexpr double far_off = 6;



    /** Signed distance of the centre of a cell from the nearest obstacle that
     * moves, or that is at rest, m. */
    template <int dim>
    double
    distance_of_middle(const CellGeometry<dim>               &cell,
                       const std::vector<ObstaclePlace<dim>> &places,
                       const std::vector<Obstacle<dim>>      &obstacles,
                       const bool                             that_move)
    {
      dealii::Point<dim> middle;
      for (unsigned int d = 0; d < dim; ++d)
        middle[d] = cell.origin[d] + 0.5 / cell.inverse_edge[d];
      double result = 1e300;
      for (std::size_t o = 0; o < obstacles.size(); ++o)
        if (obstacles[o].changes_place() == that_move)
          result = std::min(result, places[o].distance(middle).value);
      return result;
    }
  } // namespace



  template <int dim>
  bool
  CutCells<dim>::may_be(const RunParts<dim> &parts)
  {
    return !parts.problem.obstacles.empty() &&
           parts.problem.grid.kernel == KernelKind::linear &&
           std::any_of(parts.bodies.begin(),
                       parts.bodies.end(),
                       [](const auto &body) {
                         return body->description.is_liquid &&
                                body->stress->treatment().kind ==
                                  Treatment::cell;
                       });
  }



  template <int dim>
  CutCells<dim>::CutCells(const RunParts<dim> &parts)
    : parts(parts)
    , knowing(n_nodal_fields(parts.problem), false)
    , moves(std::any_of(parts.problem.obstacles.begin(),
                        parts.problem.obstacles.end(),
                        [](const auto &obstacle) {
                          return obstacle.changes_place();
                        }))
    , is_implicit(parts.problem.method.integration ==
                  TimeIntegration::semi_implicit)
  {
    for (const auto &body : parts.bodies)
      if (body->description.is_liquid)
        knowing[body->description.nodal_field] = true;
    for (const auto &body : parts.bodies)
      if (body->description.is_liquid &&
          body->stress->treatment().kind != Treatment::cell)
        knowing[body->description.nodal_field] = false;
    if (!is_implicit)
      {
        stiff_share    = courant_number() * courant_number() / 4;
        least_of_layer = std::max(0.15, stiff_share);
      }
    reinit(0);
  }



  // If the time step is given, its ratio to the time in which sound crosses the
  // smallest cell.
  template <int dim>
  double
  CutCells<dim>::courant_number() const
  {
    if (!(parts.problem.method.time_step > 0))
      return parts.problem.method.courant_number;
    double squared = 0; // of the speed of sound
    for (const auto &body : parts.bodies)
      if (knowing[body->description.nodal_field])
        squared =
          std::max(squared,
                   body->stress->wave_speed_squared(body->points.view()));
    return parts.problem.method.time_step / parts.grid.smallest_edge *
           std::sqrt(
             dealii::Utilities::MPI::max(squared, parts.grid.communicator));
  }



  template <int dim>
  void
  CutCells<dim>::reinit(const double time)
  {
    distance.clear();
    at_cut.reinit(parts.grid.vertices.n());
    at_covered.reinit(parts.grid.vertices.n());
    open_volumes.reinit(parts.grid.vertices.n());
    former.clear();
    holding.clear();
    Places places;
    for (const Obstacle<dim> &obstacle : parts.problem.obstacles)
      places.emplace_back(obstacle, time);
    find_cells(places);
  }



  template <int dim>
  void
  CutCells<dim>::find(const double time)
  {
    std::fill(wet.begin(), wet.end(), 0);
    if (!moves)
      return;
    find_holding();
    Places places;
    for (const Obstacle<dim> &obstacle : parts.problem.obstacles)
      places.emplace_back(obstacle, time);
    find_cells(places);
  }



  // Largest displacement of moving obstacles since the last update, m. Their
  // motion is rigid, so it is largest at a corner of the grid's box.
  template <int dim>
  double
  CutCells<dim>::way_since_found(const Places &places) const
  {
    double result = 0;
    for (std::size_t o = 0; o < former.size(); ++o)
      for (unsigned int corner = 0;
           corner < n_nodes && parts.problem.obstacles[o].changes_place();
           ++corner)
        {
          dealii::Point<dim> x;
          for (unsigned int d = 0; d < dim; ++d)
            x[d] = corner >> d & 1 ? parts.problem.grid.upper[d] :
                                     parts.problem.grid.lower[d];
          result =
            std::max(result,
                     places[o].place_of(former[o].start_of(x)).distance(x));
        }
    return result;
  }



  template <int dim>
  double
  CutCells<dim>::diagonal(const std::uint32_t cell) const
  {
    double square = 0;
    for (const double inverse : parts.grid.geometry[cell].inverse_edge)
      square += 1 / (inverse * inverse);
    return std::sqrt(square);
  }



  template <int dim>
  void
  CutCells<dim>::find_distance_at_rest(const Places &places)
  {
    const std::uint32_t n = parts.grid.n_cells();
    distance_at_rest.resize(n);
    for (std::uint32_t cell = 0; cell < n; ++cell)
      distance_at_rest[cell] = distance_of_middle(parts.grid.geometry[cell],
                                                  places,
                                                  parts.problem.obstacles,
                                                  false);
    distance.assign(n, 0);
    is_untouched.assign(n, 0);
  }



  // Whether moving obstacles are, and were, too far away to affect a cell, so
  // that its former result holds. Their distance is evaluated anew only where
  // its bound is below the diagonal: twice the distance of the corners from the
  // centre, as the distance of a formula is of first order. For cells that an
  // obstacle at rest may cut the limit is that of is_untouched.
  template <int dim>
  bool
  CutCells<dim>::is_as_before(const std::uint32_t cell, const Places &places)
  {
    if (!moves)
      return false;
    const double across     = diagonal(cell);
    double      &of_cell    = distance[cell];
    const bool   may_be_cut = std::abs(distance_at_rest[cell]) <= across;
    if (std::abs(of_cell) <= (may_be_cut ? far_off : 1) * across)
      of_cell = distance_of_middle(parts.grid.geometry[cell],
                                   places,
                                   parts.problem.obstacles,
                                   true);
    const bool was_untouched = is_untouched[cell];
    is_untouched[cell]       = of_cell > far_off * across;
    return was_untouched && is_untouched[cell];
  }



  template <int dim>
  void
  CutCells<dim>::find_cells(const Places &places)
  {
    const std::uint32_t n = parts.grid.n_cells();
    if (former.empty())
      find_distance_at_rest(places);
    else if (const double way = way_since_found(places); way > 0)
      for (double &of_cell : distance)
        of_cell -= of_cell > 0 ? std::min(2 * way, of_cell) :
                                 std::max(-2 * way, of_cell);
    former = places;
    std::vector<Cell>          cells_before;
    std::vector<std::uint32_t> kinds_before(n, open);
    cells.swap(cells_before);
    kinds.swap(kinds_before);
    distances_of_cells.clear();
    std::vector<std::size_t> found; // cells that are cut anew
    for (std::uint32_t cell = 0; cell < n; ++cell)
      {
        if (!is_as_before(cell, places))
          {
            const std::size_t before = cells.size();
            look_at(cell, places);
            if (cells.size() > before)
              found.push_back(before);
            continue;
          }
        const std::uint32_t kind = kinds_before[cell];
        kinds[cell]              = kind;
        if (kind < first_cut)
          continue;
        kinds[cell] = first_cut + static_cast<std::uint32_t>(cells.size());
        cells.push_back(std::move(cells_before[kind - first_cut]));
      }
    for (std::size_t k = 0; k < found.size(); ++k)
      find_surfaces(cells[found[k]], distances_of_cells[k], places);
    wet.assign(cells.size() * knowing.size(), 0);

    const NodeTable<dim> &table = parts.grid.vertices;
    std::fill_n(at_cut.data(), table.n(), 0.);
    for (const Cell &cell : cells)
      if (cell.number < parts.grid.n_owned_cells() && cell.is_cut())
        for (const std::uint32_t offset : parts.grid.geometry[cell.number].node)
          at_cut[offset / NodeLayout<dim>::stride] = 1;
    std::fill_n(at_covered.data(), table.n(), 0.);
    for (std::uint32_t cell = 0; cell < parts.grid.n_owned_cells(); ++cell)
      if (is_covered(cell))
        for (unsigned int a = 0; a < n_nodes; ++a)
          at_covered[parts.grid.geometry[cell].node[a] /
                     NodeLayout<dim>::stride] += 1u << a;
    find_open_volumes();
    any_cut = dealii::Utilities::MPI::max<unsigned int>(
                std::any_of(cells.begin(),
                            cells.end(),
                            [](const Cell &cell) { return cell.is_cut(); }),
                parts.grid.communicator) > 0;
    ++times_found;
    sum_over_ranks(at_cut);
    sum_over_ranks(at_covered);
  }



  // Sum up over ranks, as ghost cells hold points of other ranks.
  template <int dim>
  void
  CutCells<dim>::find_holding()
  {
    holding.assign(parts.grid.n_cells(), 0.);
    for (const auto &body : parts.bodies)
      if (body->cell_sums)
        for (std::uint32_t cell = 0; cell < holding.size(); ++cell)
          holding[cell] += body->cell_sums->present_mass(cell);
    const ExchangePlan all(parts.grid.shared_cells);
    exchange.start(all, holding.data(), 0, 1);
    exchange.finish(holding.data());
  }



  template <int dim>
  void
  CutCells<dim>::sum_over_ranks(LazyArray<double> &of_nodes)
  {
    const ExchangePlan all(parts.grid.vertices.shared);
    exchange.start(all, of_nodes.data(), 0, 1);
    exchange.finish(of_nodes.data());
  }



  // Integrals of N_i over the open volume, with N_i expanded in monomials.
  template <int dim>
  void
  CutCells<dim>::find_open_volumes()
  {
    std::fill_n(open_volumes.data(), parts.grid.vertices.n(), 0.);
    for (std::uint32_t number = 0; number < parts.grid.n_owned_cells();
         ++number)
      {
        if (is_covered(number))
          continue;
        const CellGeometry<dim> &geometry = parts.grid.geometry[number];
        double                   volume   = 1;
        for (const double inverse : geometry.inverse_edge)
          volume /= inverse;
        const Cell *const cut = cell(number);
        for (unsigned int a = 0; a < n_nodes; ++a)
          {
            double mean = 1. / n_nodes; // of N_a over the cell
            if (cut != nullptr)
              {
                auto means = cut->monomials;
                for (unsigned int d = 0; d < dim; ++d)
                  for (unsigned int k = 0; k < n_nodes; ++k)
                    if (!(k >> d & 1) && !(a >> d & 1))
                      means[k] -= means[k | 1u << d];
                mean = cut->open * means[a];
              }
            open_volumes[geometry.node[a] / NodeLayout<dim>::stride] +=
              mean * volume;
          }
      }
    sum_over_ranks(open_volumes);
  }



  template bool
  CutCells<2>::may_be(const RunParts<2> &);
  template CutCells<2>::CutCells(const RunParts<2> &);
  template void
  CutCells<2>::reinit(double);
  template void
                  CutCells<2>::find(double);
  template double CutCells<2>::diagonal(std::uint32_t) const;
  template bool
  CutCells<3>::may_be(const RunParts<3> &);
  template CutCells<3>::CutCells(const RunParts<3> &);
  template void
  CutCells<3>::reinit(double);
  template void
                  CutCells<3>::find(double);
  template double CutCells<3>::diagonal(std::uint32_t) const;
} // namespace limber
