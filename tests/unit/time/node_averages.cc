// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <support/scene_run.h>

#include <algorithm>
#include <set>

/**
 * @file Averages around nodes in whole steps: of each body on its own, with
 * the formula of the textbook.
 */

using namespace limber;

namespace
{
  constexpr double stiffness[] = {1e6, 3e4}; // E of the two blocks, Pa



  /** Two blocks in motion, side by side in a common column of cells. */
  std::string
  two_blocks(const int dim)
  {
    const auto in_3d = [dim](const std::string &text) {
      return dim == 3 ? text : "";
    };
    const auto block = [&](const std::string &name,
                           const std::string &lower,
                           const std::string &upper,
                           const double       E) {
      return "subsection Body " + name + "\n subsection Box\n" +
             "set Lower corner = " + lower + in_3d(", 0.3") + "\n" +
             "set Upper corner = " + upper + in_3d(", 1") + "\n end\n" +
             "subsection Linear elastic\n set Density = 1000\n" +
             "set Young's modulus = " + digits(E) + "\n end\n" +
             "set Initial velocity = sin(7*x+3*y)*x; cos(5*x)*y" +
             in_3d("; 0") + "\n set Locking treatment = node\nend\n";
    };
    return "set Dimension = " + std::to_string(dim) +
           "\nset Bodies = left, right\n" +
           block("left", "0.25, 0.25", "0.9375, 0.8", stiffness[0]) +
           block("right", "0.9375, 0.25", "1.5, 1", stiffness[1]) +
           "subsection Grid\n set Upper corner = 2, 1.5" + in_3d(", 1.5") +
           "\n set Cells = 16, 12" + in_3d(", 12") + "\nend\n";
  }



  /** What a body is before a step. */
  template <int dim>
  struct Before
  {
    Before(SceneRun<dim> &run, const unsigned int b)
    {
      const PointView<dim> points = run.points(b);
      for (std::size_t p = 0; p < points.size; ++p)
        {
          place.push_back(run.position(p, b));
          cell.push_back(points.cell[p]);
          mass.push_back(points.mass[p]);
          pressure.push_back(points.pressure[p]);
        }
    }

    std::vector<dealii::Point<dim>> place;
    std::vector<std::uint32_t>      cell;
    std::vector<double>             mass, pressure;
  };



  /** N_i and grad N_i of the nodes of a cell at a place. */
  template <int dim>
  struct Shapes
  {
    Shapes(const CellGeometry<dim> &cell, const dealii::Point<dim> &place)
    {
      for (int i = 0; i < 1 << dim; ++i)
        {
          N[i] = 1;
          G[i].fill(1);
          for (int d = 0; d < dim; ++d)
            {
              const double xi =
                (place[d] - cell.origin[d]) * cell.inverse_edge[d];
              const double w = i >> d & 1 ? xi : 1 - xi;
              N[i] *= w;
              for (int e = 0; e < dim; ++e)
                G[i][e] *=
                  e != d ? w : (i >> d & 1 ? 1 : -1) * cell.inverse_edge[d];
            }
        }
    }

    std::array<double, 1 << dim>                  N;
    std::array<std::array<double, dim>, 1 << dim> G;
  };



  /** S div v at the points, of a velocity(record of node, direction). */
  template <int dim, class Velocity>
  std::vector<double>
  projected_divergence(const SceneRun<dim> &run,
                       const Before<dim>   &body,
                       const Velocity      &velocity)
  {
    const std::size_t   n = body.place.size();
    std::vector<double> mass(run.grid.vertices.n()), sum(mass.size()),
      result(n);
    for (const bool to_nodes : {true, false})
      for (std::size_t p = 0; p < n; ++p)
        {
          const auto       &cell = run.grid.geometry[body.cell[p]];
          const Shapes<dim> at(cell, body.place[p]);
          double            divergence = 0;
          for (int i = 0; i < 1 << dim; ++i)
            for (int d = 0; d < dim; ++d)
              divergence +=
                at.G[i][d] * velocity(run.nodes.record(cell.node[i] /
                                                       NodeLayout<dim>::stride),
                                      d);
          for (int i = 0; i < 1 << dim; ++i)
            {
              const auto node = cell.node[i] / NodeLayout<dim>::stride;
              if (to_nodes)
                {
                  mass[node] += body.mass[p] * at.N[i];
                  sum[node] += body.mass[p] * at.N[i] * divergence;
                }
              else if (mass[node] > 0)
                result[p] += at.N[i] * sum[node] / mass[node];
            }
        }
    return result;
  }



  template <int dim>
  bool
  share_cells(const Before<dim> &one, const Before<dim> &other)
  {
    const std::set<std::uint32_t> cells(one.cell.begin(), one.cell.end());
    return std::any_of(other.cell.begin(),
                       other.cell.end(),
                       [&](const auto cell) { return cells.count(cell) > 0; });
  }



  // What a step adds to the pressure is -K dt times the divergence, projected
  // with the masses of the body itself and of no other.
  template <int dim>
  void
  expect_own_averages(const std::string &order)
  {
    using Layout = NodeLayout<dim>;
    SceneRun<dim> run(two_blocks(dim), {"Method/Stress update=" + order});
    const double  step = 1e-4;
    run.advance(step, 2);
    run.integrator.reorganise(run.time);
    const Before<dim> before[] = {{run, 0}, {run, 1}};
    ASSERT_TRUE(share_cells(before[0], before[1]));

    run.integrator.advance(run.time, step);
    // that of the nodes which strains the points
    const auto velocity = [&](const double *const record, const int d) {
      return order == "musl" ?
               record[Layout::remapped + d] :
             order == "usl" ?
               record[Layout::velocity + d] :
               record[Layout::velocity + d] - record[Layout::increment + d];
    };
    for (unsigned int b = 0; b < 2; ++b)
      {
        const double K        = stiffness[b] / (3 * (1 - 2 * 0.3));
        const auto divergence = projected_divergence(run, before[b], velocity);
        double     largest    = 0;
        for (std::size_t p = 0; p < divergence.size(); ++p)
          {
            largest = std::max(largest, std::abs(divergence[p]));
            EXPECT_NEAR(run.points(b).pressure[p] - before[b].pressure[p],
                        -K * step * divergence[p],
                        1e-9 * K * step);
          }
        EXPECT_GT(largest, 0.1);
      }
  }
} // namespace



TEST(NodeAverages, AreThoseOfTheBodyAlone)
{
  for (const std::string order : {"usf", "usl", "musl"})
    {
      SCOPED_TRACE(order);
      expect_own_averages<2>(order);
      expect_own_averages<3>(order);
    }
}
