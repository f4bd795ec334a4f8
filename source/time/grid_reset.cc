// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/assumed_deformation.h>
#include <limber/interpolation/point_support.h>
#include <limber/points/cell_batch.h>
#include <limber/time/grid_reset.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace limber
{
  namespace
  {
    // Stress of a point as rows, J sigma, with the pressure given.
    template <int dim>
    std::array<std::array<double, dim>, dim>
    stress_of(const PointView<dim> &points,
              const std::size_t     p,
              const double          pressure)
    {
      std::array<double, n_deviator<dim>> deviator;
      for (unsigned int k = 0; k < deviator.size(); ++k)
        deviator[k] = points.deviator[k][p];
      auto result = rows_of<dim>(deviator);
      for (int d = 0; d < dim; ++d)
        result[d][d] -= pressure;
      return result;
    }



    // Add to the diagonal so that no principal stress is below @p lowest, by
    // Gershgorin's circles.
    template <int dim>
    void
    raise(std::array<std::array<double, dim>, dim> &stress, const double lowest)
    {
      double least = lowest;
      for (int d = 0; d < dim; ++d)
        {
          double bound = stress[d][d];
          for (int e = 0; e < dim; ++e)
            if (e != d)
              bound -= std::abs(stress[d][e]);
          least = std::min(least, bound);
        }
      for (int d = 0; d < dim; ++d)
        stress[d][d] += lowest - least;
    }
  } // namespace



  namespace
  {
    // Displacement gradients of the points of a cell, as the law gets them, for
    // unit displacements of each degree of freedom: by point, then by degree.
    template <int dim>
    std::vector<SmallMatrix<dim, double>>
    strains_of(const PointView<dim>  &points,
               const GridView<dim>   &grid,
               const CellBatch       &batch,
               const StrainTreatment &treatment)
    {
      constexpr std::size_t                 n = dim << dim;
      std::vector<SmallMatrix<dim, double>> result((batch.end - batch.begin) *
                                                   n);
      for (auto &matrix : result)
        matrix = {};
      for (std::size_t p = batch.begin; p < batch.end; ++p)
        {
          const auto support = support_of_point<dim>(grid, points, p);
          for (std::size_t k = 0; k < n; ++k)
            for (int d = 0; d < dim; ++d)
              result[(p - batch.begin) * n + k][k % dim][d] =
                support.gradient[k / dim][d];
        }
      if (treatment.kind != Treatment::assumed_strain)
        return result;
      for (std::size_t k = 0; k < n; ++k)
        {
          AssumedDeformation<dim, false, double> assumed(treatment);
          const auto for_points = [&](const auto &work) {
            for (std::size_t p = batch.begin; p < batch.end; ++p)
              work(p,
                   natural_place(points, grid.cells[batch.cell], p),
                   result[(p - batch.begin) * n + k]);
          };
          for_points([&](const std::size_t p, const auto &xi, auto &gradient) {
            assumed.add(gradient, xi, points.mass[p]);
          });
          assumed.finish();
          for_points([&](const std::size_t, const auto &xi, auto &gradient) {
            gradient = assumed.evaluate(gradient, xi);
          });
        }
      return result;
    }
  } // namespace



  template <int dim>
  void
  GridReset<dim>::find(const RunParts<dim> &parts, const Responses &responses)
  {
    blocks.clear();
    at_turned.clear();
    if (std::all_of(parts.bodies.begin(),
                    parts.bodies.end(),
                    [](const auto &body) {
                      return body->description.frame == Frame::initial;
                    }))
      return;
    constexpr std::size_t n = dim << dim;
    blocks.assign(nodes.n_cells() * n * n, 0.);
    const GridView<dim> grid = parts.nodes.view();
    for (std::size_t b = 0; b < parts.bodies.size(); ++b)
      {
        if (parts.bodies[b]->description.frame == Frame::initial ||
            !responses[b]->has_finite_strain())
          continue;
        const PointView<dim>   points    = parts.bodies[b]->points.view();
        const StrainTreatment &treatment = responses[b]->treatment();
        const double           density   = responses[b]->density();
        const double lowest = parts.bodies[b]->description.is_plastic ?
                                0 :
                                -responses[b]->young_modulus() / 3;
        for_each_batch(points, [&](const CellBatch &batch) {
          double pressure = 0, mass = 0;
          for (std::size_t p = batch.begin; p < batch.end; ++p)
            {
              pressure += points.mass[p] * points.pressure[p];
              mass += points.mass[p];
            }
          const auto    strains = strains_of(points, grid, batch, treatment);
          double *const block   = &blocks[nodes.number_of(batch.cell) * n * n];
          for (std::size_t p = batch.begin; p < batch.end; ++p)
            {
              auto stress = stress_of<dim>(points,
                                           p,
                                           treatment.kind == Treatment::cell ?
                                             pressure / mass :
                                             points.pressure[p]);
              raise<dim>(stress, lowest);
              const double      volume = points.mass[p] / density;
              const auto *const own    = &strains[(p - batch.begin) * n];
              // half the derivative of sum_ac s_ac G_ac G_cc, so symmetric
              for (std::size_t k = 0; k < n; ++k)
                for (std::size_t l = 0; l < n; ++l)
                  for (int a = 0; a < dim; ++a)
                    for (int c = 0; c < dim; ++c)
                      block[k * n + l] += 0.5 * volume * stress[a][c] *
                                          (own[k][a][c] * own[l][c][c] +
                                           own[l][a][c] * own[k][c][c]);
            }
        });
      }
    for (std::size_t c = 0; c < nodes.n_cells(); ++c)
      nodes.hanging_corners(c).condense_matrix(&blocks[c * n * n], dim);
    nodes.sum(blocks.data(), blocks.size());
  }



  // By Cayley's formula, as the trapezoidal rule turns a body: with the mean
  // spin w of a cell, W x = w x x, R - 1 = (W + W W / 2) / (1 + w w / 4).
  template <int dim>
  void
  GridReset<dim>::expect(const std::vector<double> &displacement)
  {
    at_turned.clear();
    if (blocks.empty())
      return;
    at_turned.assign(displacement.size(), 0.);
    constexpr std::size_t n      = dim << dim;
    const auto           &places = nodes.places();
    for (std::size_t c = 0; c < nodes.n_cells(); ++c)
      {
        const auto            numbers = nodes.of_cell(c);
        std::array<double, n> at_corners;
        for (std::size_t k = 0; k < n; ++k)
          at_corners[k] =
            displacement[std::size_t(numbers[k / dim]) * dim + k % dim];
        nodes.hanging_corners(c).interpolate(at_corners.data(), dim);
        SmallMatrix<dim, double> gradient{}, turn{};
        for (std::size_t i = 0; i < numbers.size(); ++i)
          for (int e = 0; e < dim; ++e)
            for (int d = 0; d < dim; ++d)
              gradient[d][e] += ((i >> e & 1) ? 2. : -2.) /
                                (numbers.size() * nodes.edge(c, e)) *
                                at_corners[i * dim + d];
        double squared = 0;
        for (int d = 0; d < dim; ++d)
          for (int e = 0; e < dim; ++e)
            {
              turn[d][e] = 0.5 * (gradient[d][e] - gradient[e][d]);
              squared += 0.5 * turn[d][e] * turn[d][e];
            }
        const auto            twice = times<dim>(turn, turn);
        std::array<double, n> way;
        for (std::size_t i = 0; i < numbers.size(); ++i)
          for (int d = 0; d < dim; ++d)
            {
              way[i * dim + d] = 0;
              for (int e = 0; e < dim; ++e)
                way[i * dim + d] +=
                  (turn[d][e] + 0.5 * twice[d][e]) / (1 + 0.25 * squared) *
                  (places[numbers[i]][e] - places[numbers[0]][e]);
            }
        const double *entry = &blocks[c * n * n];
        for (std::size_t k = 0; k < n; ++k)
          for (std::size_t l = 0; l < n; ++l)
            at_turned[std::size_t(numbers[k / dim]) * dim + k % dim] +=
              *entry++ * way[l];
      }
  }



  template <int dim>
  double
  GridReset<dim>::add_forces(const std::vector<double> &displacement,
                             std::vector<double>       &forces,
                             double                    &work) const
  {
    work = 0;
    if (blocks.empty())
      return 0;
    double energy = 0;
    if (!at_turned.empty())
      for (std::size_t k = 0; k < forces.size(); ++k)
        {
          forces[k] -= at_turned[k];
          energy -= at_turned[k] * displacement[k];
          work -= 0.5 * at_turned[k] * displacement[k];
        }
    const double *entry = blocks.data();
    for (std::size_t c = 0; c < nodes.n_cells(); ++c)
      {
        const auto numbers = nodes.of_cell(c);
        for (const std::uint32_t i : numbers)
          for (int a = 0; a < dim; ++a)
            {
              double force = 0;
              for (const std::uint32_t j : numbers)
                for (int b = 0; b < dim; ++b)
                  force += *entry++ * displacement[std::size_t(j) * dim + b];
              forces[std::size_t(i) * dim + a] += force;
              const double half =
                0.5 * force * displacement[std::size_t(i) * dim + a];
              energy += half;
              work += half;
            }
      }
    return energy;
  }



  template <int dim>
  void
  GridReset<dim>::add_tangent(const Add &add) const
  {
    if (blocks.empty())
      return;
    const std::size_t n = nodes.of_cell(0).size() * dim;
    for (std::size_t c = 0; c < nodes.n_cells(); ++c)
      add(nodes.of_cell(c).data(), n / dim, &blocks[c * n * n]);
  }



  template class GridReset<2>;
  template class GridReset<3>;
} // namespace limber
