// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/cut_cells.h>

#include <gtest/gtest.h>
#include <support/scene_run.h>

/** @file What is open of cells that obstacles cut, and what bounds it. */

using namespace limber;

namespace
{
  /** A drop in the upper left corner of a box of 8 cells along an edge, with an
   * obstacle elsewhere. */
  std::string
  box_with_obstacle(const int dim, const std::string &obstacle)
  {
    const bool in_3d = dim == 3;
    return "set Dimension = " + std::to_string(dim) +
           "\nset Bodies = drop\nset Obstacles = rock\n"
           "subsection Body drop\n set Shape = box\n subsection Box\n"
           " set Lower corner = 0, 0.875" +
           (in_3d ? ", 0" : "") + "\n set Upper corner = 0.125, 1" +
           (in_3d ? ", 0.125" : "") +
           "\n end\n set Material = newtonian fluid\nend\n"
           "subsection Obstacle rock\n" +
           obstacle + "\nend\nsubsection Grid\n set Upper corner = 1, 1" +
           (in_3d ? ", 1\n set Cells = 8, 8, 8" : "\n set Cells = 8, 8") +
           "\nend\n";
  }



  template <int dim>
  CutCells<dim>
  cut_cells_of(SceneRun<dim> &run)
  {
    return CutCells<dim>(
      RunParts<dim>{run.problem, run.grid, run.nodes, run.bodies, run.ledger});
  }



  /** Of the unit square, what has phi(xi) = c + g . xi > 0: its corners. */
  std::vector<dealii::Point<2>>
  clipped_square(const double c, const dealii::Tensor<1, 2> &g)
  {
    const std::vector<dealii::Point<2>> square = {{0, 0},
                                                  {1, 0},
                                                  {1, 1},
                                                  {0, 1}};
    std::vector<dealii::Point<2>>       result;
    for (unsigned int k = 0; k < 4; ++k)
      {
        const dealii::Point<2> &a = square[k], &b = square[(k + 1) % 4];
        const double            at_a = c + g * a, at_b = c + g * b;
        if (at_a > 0)
          result.push_back(a);
        if (at_a * at_b < 0)
          result.push_back(a + at_a / (at_a - at_b) * (b - a));
      }
    return result;
  }



  /** The area of a polygon and the integrals of the coordinates over it. */
  std::array<double, 3>
  area_and_moments(const std::vector<dealii::Point<2>> &corners)
  {
    std::array<double, 3> result{};
    for (std::size_t k = 0; k < corners.size(); ++k)
      {
        const dealii::Point<2> &a = corners[k],
                               &b = corners[(k + 1) % corners.size()];
        const double cross        = a[0] * b[1] - a[1] * b[0];
        result[0] += cross / 2;
        for (int d = 0; d < 2; ++d)
          result[1 + d] += cross * (a[d] + b[d]) / 6;
      }
    return result;
  }



  /** The mean over the unit cube, or what of it is open, of the derivative by
   * coordinate @p d of the function of corner @p a, from means of monomials. */
  template <int dim>
  double
  mean_derivative(const unsigned int                     a,
                  const unsigned int                     d,
                  const std::array<double, (1u << dim)> &monomials)
  {
    double result = 0;
    // the product of xi_e, or 1 - xi_e, over the other directions e
    for (unsigned int k = 0; k < 1u << dim; ++k)
      {
        if (k >> d & 1)
          continue;
        double coefficient = 1;
        for (unsigned int e = 0; e < dim; ++e)
          if (e != d)
            coefficient *= a >> e & 1 ? double(k >> e & 1) :
                           k >> e & 1 ? -1. :
                                        1.;
        result += coefficient * monomials[k];
      }
    return a >> d & 1 ? result : -result;
  }



  /** The largest of |int_open grad N_i dV + int_surface N_i n dS| of the nodes
   * within the box, m^(dim-1). Nodes that no cell sees that is not covered have
   * nothing. */
  template <int dim>
  double
  largest_imbalance(const std::string &obstacle, unsigned int &n_cut)
  {
    SceneRun<dim>               run(box_with_obstacle(dim, obstacle));
    const CutCells<dim>         cut_cells = cut_cells_of(run);
    constexpr unsigned int      n_nodes   = 1 << dim;
    std::array<double, n_nodes> whole;
    for (unsigned int k = 0; k < n_nodes; ++k)
      whole[k] = std::pow(0.5, __builtin_popcount(k));

    std::vector<dealii::Tensor<1, dim>> sums(run.grid.vertices.n());
    n_cut = 0;
    for (std::uint32_t cell = 0; cell < run.grid.n_cells(); ++cell)
      {
        if (cut_cells.is_covered(cell))
          continue;
        const auto              *cut      = cut_cells.cell(cell);
        const CellGeometry<dim> &geometry = run.grid.geometry[cell];
        double                   volume   = cut ? cut->open : 1;
        for (unsigned int d = 0; d < dim; ++d)
          volume /= geometry.inverse_edge[d];
        n_cut += cut != nullptr && cut->is_cut();
        for (unsigned int a = 0; a < n_nodes; ++a)
          {
            auto &sum = sums[geometry.node[a] / NodeLayout<dim>::stride];
            for (unsigned int d = 0; d < dim; ++d)
              sum[d] +=
                volume * geometry.inverse_edge[d] *
                mean_derivative<dim>(a, d, cut ? cut->monomials : whole);
            if (cut)
              for (const auto &surface : cut->surfaces)
                sum += surface.area * surface.functions[a] * surface.normal;
          }
      }
    double largest = 0;
    for (std::uint32_t node = 0; node < run.grid.vertices.n(); ++node)
      if (run.grid.vertices.sides[node] == 0)
        largest = std::max(largest, sums[node].norm());
    return largest;
  }
} // namespace



// The distance from a line is linear, so that linear pieces are exact.
TEST(CutCells, OpenSharesOfHalfPlanesAreExact)
{
  for (const double degrees : {0., 10., 30., 45., 77., 90.})
    {
      SCOPED_TRACE(std::to_string(degrees) + " degrees");
      const double               angle = degrees * M_PI / 180;
      const dealii::Tensor<1, 2> normal({-std::sin(angle), std::cos(angle)});
      const dealii::Point<2>     through(0.5371, 0.4613);
      SceneRun<2>                run(
        box_with_obstacle(2,
                          " set Shape = half-space\n subsection Half-space\n"
                                         "  set Point = " +
                            digits(through[0]) + ", " + digits(through[1]) +
                            "\n  set Normal = " + digits(normal[0]) + ", " +
                            digits(normal[1]) + "\n end"));
      const CutCells<2> cut_cells = cut_cells_of(run);
      unsigned int      n_cut = 0, n_closed = 0;
      for (std::uint32_t cell = 0; cell < run.grid.n_cells(); ++cell)
        {
          const CellGeometry<2> &geometry = run.grid.geometry[cell];
          dealii::Point<2>       origin;
          dealii::Tensor<1, 2>   along = normal;
          for (unsigned int d = 0; d < 2; ++d)
            {
              origin[d] = geometry.origin[d];
              along[d] /= geometry.inverse_edge[d];
            }
          const auto expected = area_and_moments(
            clipped_square((origin - through) * normal, along));
          if (const auto *cut = cut_cells.cell(cell))
            {
              EXPECT_NEAR(cut->open, expected[0], 1e-12);
              for (unsigned int d = 0; d < 2; ++d)
                EXPECT_NEAR(cut->monomials[1u << d],
                            expected[1 + d] / expected[0],
                            1e-12);
              n_cut += cut->is_cut();
            }
          else if (cut_cells.is_closed(cell))
            {
              EXPECT_GT(expected[0], 0);
              EXPECT_LT(expected[0], CutCells<2>::least_open);
              ++n_closed;
            }
          else
            {
              EXPECT_NEAR(expected[0],
                          cut_cells.is_covered(cell) ? 0 : 1,
                          1e-12);
            }
        }
      EXPECT_GT(n_cut + n_closed, 7u);
    }
}



// What a constant pressure does to the open part is borne by the same pressure
// on the surfaces: the divergence theorem for the function of each node. Flat
// pieces, as those of a curved surface have one normal each.
TEST(CutCells, SurfacesBearAConstantPressure)
{
  unsigned int n_cut;
  for (const std::string obstacle :
       {" set Shape = box\n subsection Box\n"
        "  set Lower corner = 0.39, 0.21\n"
        "  set Upper corner = 0.83, 0.66\n end",
        " set Shape = half-space\n subsection Half-space\n"
        "  set Point = 0.52, 0.47\n  set Normal = -0.3, 1\n end"})
    {
      SCOPED_TRACE(obstacle);
      EXPECT_LT(largest_imbalance<2>(obstacle, n_cut), 1e-14);
      EXPECT_GT(n_cut, 6u);
    }
  EXPECT_LT(largest_imbalance<3>(" set Shape = half-space\n"
                                 " subsection Half-space\n"
                                 "  set Point = 0.52, 0.47, 0.51\n"
                                 "  set Normal = -0.3, 1, -0.2\n end",
                                 n_cut),
            1e-14);
  EXPECT_GT(n_cut, 20u);
}
