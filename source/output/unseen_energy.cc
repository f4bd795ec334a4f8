// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/nodal_projection.h>
#include <limber/interpolation/point_support.h>
#include <limber/output/health_figures.h>

#include <algorithm>
#include <utility>

namespace limber
{
  namespace
  {
    /**
     * Weighted least squares: the functions of the grid that are closest to
     * values at the points, in the norm of their masses. Conjugate gradients
     * for the normal equations (consistent mass matrix), preconditioned by the
     * lumped mass. One iteration costs one projection on nodes (P2G).
     */
    template <int dim>
    class FitByGrid
    {
    public:
      explicit FitByGrid(const State<dim> &state)
        : state(state)
        , table(state.grid.nodes())
        , grid(state.grid.view())
        , projection(table)
        , direction(table.n())
      {
        for (const auto &body : state.bodies)
          {
            const std::size_t n = body->points.size();
            residual.emplace_back(n);
            along.emplace_back(n);
          }
      }

      /**
       * The residual of component @p d of the velocity: its null-space part.
       */
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

      // Full cells need five; more accuracy than this is not needed.
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
        projection.clear(state.nodes.active_nodes());
        double *const records = projection.data();
        for (std::size_t b = 0; b < residual.size(); ++b)
          for_each_support(b, [&](const std::size_t p, const Support<dim> &at) {
            const double mass = points(b).mass[p];
            for (int i = 0; i < at.n; ++i)
              {
                double *const record =
                  records + std::size_t(at.node[i]) * Layout::stride;
                record[Layout::mass] += mass * at.value[i];
                record[Layout::value] += mass * at.value[i] * residual[b][p];
              }
          });
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

      // The next search direction, on nodes (P2G) and interpolated to points.
      void
      turn(const double share_of_former)
      {
        const auto update = [&](const std::uint32_t node) {
          double &value = direction[node];
          value         = projection.mean(node) + share_of_former * value;
        };
        for (const std::uint32_t node : state.nodes.active_nodes())
          update(node);
        for (const HangingNode &hanging : table.hanging)
          update(hanging.node);
        for (std::size_t b = 0; b < along.size(); ++b)
          for_each_support(b, [&](const std::size_t p, const Support<dim> &at) {
            along[b][p] = 0;
            for (int i = 0; i < at.n; ++i)
              along[b][p] += at.value[i] * direction[at.node[i]];
          });
      }

      template <class Work>
      void
      for_each_support(const std::size_t b, const Work &work) const
      {
        const PointView<dim> of_body = points(b);
        for (std::size_t p = 0; p < of_body.size; ++p)
          if (of_body.cell[p] != invalid_cell)
            work(p, support_of_point<dim, false>(grid, of_body, p));
      }

      void
      step_back(const double length)
      {
        for (std::size_t b = 0; b < residual.size(); ++b)
          for (std::size_t p = 0; p < residual[b].size(); ++p)
            residual[b][p] -= length * along[b][p];
      }

      const State<dim>                &state;
      const NodeTable<dim>            &table;
      const GridView<dim>              grid;
      NodalProjection<dim>             projection;
      LazyArray<double>                direction;       // by node
      std::vector<std::vector<double>> residual, along; // per body
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
