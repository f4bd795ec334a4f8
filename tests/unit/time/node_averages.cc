// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <support/scene_run.h>

#include <algorithm>
#include <iterator>
#include <set>

/**
 * @file Averages around nodes in whole steps: of each body on its own, with
 * the formula of the textbook.
 */

using namespace limber;

namespace
{
  // Two blocks side by side that share a column of cells, moving apart.
  std::string
  two_blocks(const int dim)
  {
    const std::string z     = dim == 3 ? ", 0.3" : "",
                      far_z = dim == 3 ? ", 1" : "";
    const std::string w     = dim == 3 ? "; 0" : "";
    const auto        block =
      [&](const std::string &name, const std::string &box, const double E) {
        return "subsection Body " + name + "\n subsection Box\n" + box +
               "\n end\n subsection Linear elastic\n set Density = 1000\n"
               "set Young's modulus = " +
               digits(E) +
               "\n end\n set Initial velocity = sin(7*x+3*y)*x; cos(5*x)*y" +
               w + "\n set Locking treatment = node\nend\n";
      };
    return "set Dimension = " + std::to_string(dim) +
           "\nset Bodies = left, right\n" +
           block("left",
                 "set Lower corner = 0.25, 0.25" + z +
                   "\n set Upper corner = 0.9375, 0.8" + far_z,
                 1e6) +
           block("right",
                 "set Lower corner = 0.9375, 0.25" + z +
                   "\n set Upper corner = 1.5, 1" + far_z,
                 3e4) +
           "subsection Grid\n set Upper corner = 2, 1.5" +
           (dim == 3 ? std::string(", 1.5") : "") + "\n set Cells = 16, 12" +
           (dim == 3 ? std::string(", 12") : "") + "\nend\n";
  }



  template <int dim>
  class NodeAverages : public SceneRun<dim>
  {
  public:
    using SceneRun<dim>::SceneRun;
    using Layout = NodeLayout<dim>;

    /** S div v of a body at its points, from places before the step. */
    std::vector<double>
    projected_divergence(const std::vector<dealii::Point<dim>> &places,
                         const std::vector<std::uint32_t>      &cells,
                         const std::vector<double>             &masses,
                         const unsigned int                     slot)
    {
      std::vector<double> mass(this->grid.n_nodes()), sum(mass.size());
      for (unsigned int pass = 0; pass < 2; ++pass)
        {
          std::vector<double> result(places.size());
          for (std::size_t p = 0; p < places.size(); ++p)
            {
              const auto                  &cell = this->grid.geometry[cells[p]];
              double                       divergence = 0;
              std::array<double, 1 << dim> N;
              for (int i = 0; i < 1 << dim; ++i)
                {
                  std::array<double, dim> w, dw;
                  N[i] = 1;
                  for (int d = 0; d < dim; ++d)
                    {
                      const double xi =
                        (places[p][d] - cell.origin[d]) * cell.inverse_edge[d];
                      w[d]  = i >> d & 1 ? xi : 1 - xi;
                      dw[d] = (i >> d & 1 ? 1 : -1) * cell.inverse_edge[d];
                      N[i] *= w[d];
                    }
                  const double *const record =
                    this->nodes.record(cell.node[i] / Layout::stride);
                  for (int d = 0; d < dim; ++d)
                    {
                      double G = dw[d];
                      for (int e = 0; e < dim; ++e)
                        if (e != d)
                          G *= w[e];
                      divergence += G * record[slot + d];
                    }
                }
              for (int i = 0; i < 1 << dim; ++i)
                {
                  const auto n = cell.node[i] / Layout::stride;
                  if (pass == 0)
                    {
                      mass[n] += masses[p] * N[i];
                      sum[n] += masses[p] * N[i] * divergence;
                    }
                  else if (mass[n] > 0)
                    result[p] += N[i] * sum[n] / mass[n];
                }
            }
          if (pass == 1)
            return result;
        }
      return {};
    }
  };



  // What a step adds to the pressure is K dt times the divergence, projected
  // with the masses of the body itself and of no other.
  template <int dim>
  void
  expect_own_averages(const std::string &order)
  {
    NodeAverages<dim> run(two_blocks(dim), {"Method/Stress update=" + order});
    const double      step = 1e-4;
    run.advance(step, 2);
    run.integrator.reorganise();

    std::vector<std::vector<dealii::Point<dim>>> places(2);
    std::vector<std::vector<std::uint32_t>>      cells(2);
    std::vector<std::vector<double>>             masses(2), pressures(2);
    std::set<std::uint32_t>                      of_body[2];
    for (unsigned int b = 0; b < 2; ++b)
      for (std::size_t p = 0; p < run.points(b).size; ++p)
        {
          places[b].push_back(run.position(p, b));
          cells[b].push_back(run.points(b).cell[p]);
          masses[b].push_back(run.points(b).mass[p]);
          pressures[b].push_back(run.points(b).pressure[p]);
          of_body[b].insert(cells[b].back());
        }
    std::vector<std::uint32_t> common;
    std::set_intersection(of_body[0].begin(),
                          of_body[0].end(),
                          of_body[1].begin(),
                          of_body[1].end(),
                          std::back_inserter(common));
    ASSERT_FALSE(common.empty());

    run.integrator.advance(run.time, step);
    const unsigned int slot =
      order == "last" ? NodeLayout<dim>::velocity : NodeLayout<dim>::remapped;
    for (unsigned int b = 0; b < 2; ++b)
      {
        const double K = (b == 0 ? 1e6 : 3e4) / (3 * (1 - 2 * 0.3));
        const auto   divergence =
          run.projected_divergence(places[b], cells[b], masses[b], slot);
        double largest = 0;
        for (std::size_t p = 0; p < divergence.size(); ++p)
          {
            largest = std::max(largest, std::abs(divergence[p]));
            EXPECT_NEAR(run.points(b).pressure[p] - pressures[b][p],
                        -K * step * divergence[p],
                        1e-9 * K * step);
          }
        EXPECT_GT(largest, 0.1);
      }
  }
} // namespace



TEST(NodeAverages, AreThoseOfTheBodyAlone)
{
  for (const std::string &order : stress_update_orders)
    {
      SCOPED_TRACE(order);
      expect_own_averages<2>(order);
      expect_own_averages<3>(order);
    }
}
