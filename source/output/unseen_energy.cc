// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/nodal_projection.h>
#include <limber/interpolation/nodal_means.h>
#include <limber/output/health_figures.h>
#include <limber/points/cell_batch.h>
#include <limber/transfer/project_on_nodes.h>

#include <algorithm>
#include <utility>

namespace limber
{
  namespace
  {
    /**
     * The functions of the grid that come nearest to values at the points, in
     * the norm of their masses: conjugate gradients for the normal equations
     * with lumped masses before them. A step is one projection on nodes.
     */
    template <int dim>
    class FitByGrid
    {
    public:
      explicit FitByGrid(const State<dim> &state)
        : state(state)
        , projection(state.grid)
        , direction(std::size_t(state.grid.n_nodes()) * Layout::stride)
      {
        for (const auto &body : state.bodies)
          {
            const std::size_t n = body->points.size();
            residual.emplace_back(n);
            along.emplace_back(n);
            ones.emplace_back(n, 1.);
          }
      }

      /** Leaves of the component @p d of the velocity what does not fit. */
      const std::vector<std::vector<double>> &
      residual_of(const unsigned int d)
      {
        for (std::size_t b = 0; b < residual.size(); ++b)
          {
            const double *const v = points(b).velocity[d];
            std::copy(v, v + residual[b].size(), residual[b].begin());
          }
        const double all  = square(residual);
        double       left = all, gamma = 0;
        for (unsigned int n = 0; n < most_steps && left > 0; ++n)
          {
            project_residual();
            const double before = std::exchange(gamma, square_on_nodes());
            turn(n == 0 || before == 0 ? 0 : gamma / before);
            const double length = square(along);
            if (!(length > 0) || !(gamma > 0))
              break;
            step_back(gamma / length);
            const double gain = gamma * gamma / length;
            left -= gain;
            if (!(gain > small_enough * all))
              break;
          }
        return residual;
      }

    private:
      using Layout = NodalMeanLayout;

      // Full cells need five; what more would find is less than is asked.
      static constexpr unsigned int most_steps   = 30;
      static constexpr double       small_enough = 1e-4;

      PointView<dim>
      points(const std::size_t b) const
      {
        return state.bodies[b]->points.view();
      }

      double
      square(const std::vector<std::vector<double>> &values) const
      {
        double result = 0;
        for (std::size_t b = 0; b < values.size(); ++b)
          {
            const double *const mass = points(b).mass;
            for (std::size_t p = 0; p < values[b].size(); ++p)
              result += mass[p] * values[b][p] * values[b][p];
          }
        return dealii::Utilities::MPI::sum(result, state.grid.communicator);
      }

      void
      project_residual()
      {
        GridView<dim> grid;
        grid.cells = state.grid.geometry.data();
        projection.clear(state.nodes.active_nodes());
        for (std::size_t b = 0; b < residual.size(); ++b)
          sum_weighted<dim>(points(b),
                            grid,
                            ones[b].data(),
                            residual[b].data(),
                            projection.data());
        projection.start_completion(state.nodes.node_plan());
        projection.finish_completion(state.nodes.active_nodes());
      }

      double
      square_on_nodes() const
      {
        double result = 0;
        for (const std::uint32_t node : state.nodes.active_nodes())
          if (state.nodes.owns(node))
            {
              const double mass =
                projection
                  .data()[std::size_t(node) * Layout::stride + Layout::mass];
              result += mass * projection.mean(node) * projection.mean(node);
            }
        return dealii::Utilities::MPI::sum(result, state.grid.communicator);
      }

      // The next direction, on nodes and then at the points.
      void
      turn(const double share_of_former)
      {
        const auto update = [&](const std::uint32_t node) {
          double &value =
            direction[std::size_t(node) * Layout::stride + Layout::value];
          value = projection.mean(node) + share_of_former * value;
        };
        for (const std::uint32_t node : state.nodes.active_nodes())
          update(node);
        for (const HangingNode &hanging : state.grid.hanging_nodes)
          update(hanging.node);
        for (std::size_t b = 0; b < along.size(); ++b)
          evaluate(points(b), along[b]);
      }

      void
      evaluate(const PointView<dim> &points, std::vector<double> &values) const
      {
        for_each_batch(points, [&](const CellBatch &batch) {
          if (batch.cell == invalid_cell)
            return;
          const CellGeometry<dim> &cell = state.grid.geometry[batch.cell];
          const NodalMean<dim, Projection::node> field(direction.data(), cell);
          for (std::size_t p = batch.begin; p < batch.end; ++p)
            {
              std::array<double, dim> xi;
              for (int d = 0; d < dim; ++d)
                xi[d] =
                  (points.place[d][p] - cell.origin[d]) * cell.inverse_edge[d];
              values[p] = field.template value<double>(xi);
            }
        });
      }

      void
      step_back(const double length)
      {
        for (std::size_t b = 0; b < residual.size(); ++b)
          for (std::size_t p = 0; p < residual[b].size(); ++p)
            residual[b][p] -= length * along[b][p];
      }

      const State<dim>                &state;
      NodalProjection<dim>             projection;
      LazyArray<double>                direction; // records, as a projection's
      std::vector<std::vector<double>> residual, along, ones; // per body
    };
  } // namespace



  template <int dim>
  std::vector<double>
  unseen_energy(const State<dim> &state)
  {
    std::vector<double> result(state.bodies.size());
    FitByGrid<dim>      fit(state);
    for (unsigned int d = 0; d < dim; ++d)
      {
        const auto &residual = fit.residual_of(d);
        for (std::size_t b = 0; b < result.size(); ++b)
          {
            const double *const mass = state.bodies[b]->points.view().mass;
            for (std::size_t p = 0; p < residual[b].size(); ++p)
              result[b] += 0.5 * mass[p] * residual[b][p] * residual[b][p];
          }
      }
    dealii::Utilities::MPI::sum(result, state.grid.communicator, result);
    return result;
  }



  template std::vector<double>
  unseen_energy(const State<2> &);
  template std::vector<double>
  unseen_energy(const State<3> &);
} // namespace limber
