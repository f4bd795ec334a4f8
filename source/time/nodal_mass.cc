// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/point_support.h>
#include <limber/time/newton_tangent.h>
#include <limber/time/nodal_mass.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace limber
{
  template <int dim>
  void
  NodalMass<dim>::update(const RunParts<dim> &parts, const Values &of_points)
  {
    lumped                      = of_points;
    const std::size_t in_cell   = nodes.of_cell(0).size();
    const std::size_t n_entries = nodes.n_cells() * in_cell * in_cell;
    if (blocks.size() == n_entries &&
        std::all_of(parts.bodies.begin(),
                    parts.bodies.end(),
                    [](const auto &body) {
                      return body->description.frame == Frame::initial;
                    }))
      return;
    blocks.assign(n_entries, 0.);
    diagonal.assign(lumped.size(), 0.);
    const GridView<dim> grid = parts.nodes.view();
    for (const auto &body : parts.bodies)
      {
        const PointView<dim> points = body->points.view();
        for (std::size_t p = 0; p < points.size; ++p)
          {
            const std::size_t cell = nodes.number_of(points.cell[p]);
            const auto support = support_of_point<dim, false>(grid, points, p);
            double    *entry   = &blocks[cell * in_cell * in_cell];
            for (std::size_t i = 0; i < in_cell; ++i)
              for (std::size_t j = 0; j < in_cell; ++j)
                *entry++ +=
                  points.mass[p] * support.value[i] * support.value[j];
          }
      }
    for (std::size_t c = 0; c < nodes.n_cells(); ++c)
      nodes.hanging_corners(c).condense_matrix(&blocks[c * in_cell * in_cell],
                                               1);
    nodes.sum(blocks.data(), blocks.size());
    lump_light_nodes();
  }



  // Of nodes that points see only from afar: blocks become t_i t_j M_ij, and
  // the rest of a row goes to the diagonal. With linear functions M_ii over m_i
  // is (2/3)^dim times the filled part of the cells of a node i. Outermost
  // splines have 3/10 along a direction, and less by the square of that part.
  template <int dim>
  void
  NodalMass<dim>::lump_light_nodes()
  {
    constexpr double    filled = 0.2; // part of a cell
    const double        full   = std::pow(2. / 3., dim);
    std::vector<double> mass(nodes.size()), squares(nodes.size());
    const auto          for_entries = [&](const auto &work) {
      double *entry = blocks.data();
      for (std::size_t c = 0; c < nodes.n_cells(); ++c)
        for (const std::uint32_t i : nodes.of_cell(c))
          for (const std::uint32_t j : nodes.of_cell(c))
            work(i, j, *entry++);
    };
    for_entries([&](const std::uint32_t i, const std::uint32_t j, double m) {
      mass[i] += m;
      if (i == j)
        squares[i] += m;
    });
    std::vector<double> t(nodes.size());
    for (std::size_t i = 0; i < t.size(); ++i)
      if (mass[i] > 0)
        t[i] = std::sqrt(std::min(1., squares[i] / mass[i] / (filled * full)));
    for_entries([&](const std::uint32_t i, const std::uint32_t j, double &m) {
      const double kept = t[i] * t[j] * m;
      for (int d = 0; d < dim; ++d)
        diagonal[std::size_t(i) * dim + d] += m - kept;
      m = kept;
    });
  }



  template <int dim>
  typename NodalMass<dim>::Values
  NodalMass<dim>::times(const Values &vector) const
  {
    Values result(vector.size());
    for (std::size_t k = 0; k < vector.size(); ++k)
      result[k] = diagonal[k] * vector[k];
    if (blocks.empty())
      return result;
    const double *entry = blocks.data();
    for (std::size_t c = 0; c < nodes.n_cells(); ++c)
      {
        const auto numbers = nodes.of_cell(c);
        for (const std::uint32_t i : numbers)
          {
            std::array<double, dim> sum{};
            for (const std::uint32_t j : numbers)
              {
                const double mass = *entry++;
                for (int d = 0; d < dim; ++d)
                  sum[d] += mass * vector[std::size_t(j) * dim + d];
              }
            for (int d = 0; d < dim; ++d)
              result[std::size_t(i) * dim + d] += sum[d];
          }
      }
    return result;
  }



  // Conjugate gradients from the lumped solution on, preconditioned by it. M is
  // singular where more nodes than points are in motion; what P2G brings is in
  // its range.
  template <int dim>
  typename NodalMass<dim>::Values
  NodalMass<dim>::velocity(const Values &momentum) const
  {
    constexpr unsigned int most_iterations = 200;
    constexpr double       tolerance       = 1e-14; // of the momentum
    const auto             by_lumped       = [&](const Values &values) {
      Values result(values.size());
      for (std::size_t k = 0; k < values.size(); ++k)
        if (lumped[k] > 0)
          result[k] = values[k] / lumped[k];
      return result;
    };
    const auto product = [](const Values &a, const Values &b) {
      return std::inner_product(a.begin(), a.end(), b.begin(), 0.);
    };
    Values result = by_lumped(momentum);
    if (blocks.empty())
      return result;
    const double enough    = tolerance * tolerance * product(result, momentum);
    Values       remaining = times(result);
    for (std::size_t k = 0; k < result.size(); ++k)
      remaining[k] = momentum[k] - remaining[k];
    Values direction, next = by_lumped(remaining);
    double size = product(remaining, next), former_size = 0;
    for (unsigned int n = 0; n < most_iterations && size > enough; ++n)
      {
        if (n == 0)
          direction = next;
        else
          for (std::size_t k = 0; k < next.size(); ++k)
            direction[k] = next[k] + size / former_size * direction[k];
        const Values along = times(direction);
        const double step  = size / product(direction, along);
        for (std::size_t k = 0; k < result.size(); ++k)
          {
            result[k] += step * direction[k];
            remaining[k] -= step * along[k];
          }
        next        = by_lumped(remaining);
        former_size = size;
        size        = product(remaining, next);
      }
    return result;
  }



  template <int dim>
  void
  NodalMass<dim>::add_to(NewtonTangent<dim> &tangent, const double factor) const
  {
    Values values = diagonal;
    for (double &value : values)
      value *= factor;
    tangent.add_to_diagonal(values);
    if (blocks.empty())
      return;
    const std::size_t   in_cell = nodes.of_cell(0).size();
    std::vector<double> block(in_cell * in_cell);
    for (std::size_t c = 0; c < nodes.n_cells(); ++c)
      {
        std::transform(&blocks[c * block.size()],
                       &blocks[c * block.size()] + block.size(),
                       block.begin(),
                       [&](const double mass) { return factor * mass; });
        tangent.add_alike(nodes.of_cell(c).data(), in_cell, block.data());
      }
  }



  template class NodalMass<2>;
  template class NodalMass<3>;
} // namespace limber
