// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <support/scene_parts.h>
#include <support/scene_run.h>

#include <cmath>

/**
 * @file A block under the same stress everywhere, at 20 degrees to the grid, is
 * moved by ten cells. Within it the forces of the nodes should vanish. With
 * linear functions a point that goes to another cell changes them by
 * 2 sigma V / h, that is 2 / n^2 of sigma h (n points per cell edge), and what
 * is left at any time has this order; smooth functions sum up evenly spaced
 * points better.
 */

using namespace limber;

namespace
{
  constexpr double stressed_angle = dealii::numbers::PI / 9;
  constexpr double stressed_edge  = 12; // of the block, in cells of 1 m

  std::string
  stressed_block()
  {
    const double c = std::cos(stressed_angle), s = std::sin(stressed_angle);
    const auto   corner = [&](const double along, const double across) {
      return digits(7 + stressed_edge * (along * c - across * s)) + ", " +
             digits(3 + stressed_edge * (along * s + across * c));
    };
    return R"(
    set Bodies = block
    subsection Body block
      set Shape = block
      subsection Block
        set Corners = )" +
           corner(0, 0) + "; " + corner(1, 0) + "; " + corner(1, 1) + "; " +
           corner(0, 1) + R"(
      end
      set Placement = fitted
      set Frame = current
      set Locking treatment = none
      subsection Linear elastic
        set Density = 1
        set Young's modulus = 1
      end
    end
    subsection Grid
      set Upper corner = 34, 24
      set Cells = 34, 24
    end
)" + free_sides +
           R"(    subsection Method
      set Transfer = flip
      set Stress update = musl
    end)";
  }



  /** Whether a place lies in the moved block, two cells from its surface. */
  bool
  is_deep(const dealii::Tensor<1, 2> &place)
  {
    const double c = std::cos(stressed_angle), s = std::sin(stressed_angle);
    const double along  = place[0] * c + place[1] * s;
    const double across = place[1] * c - place[0] * s;
    return std::min(along, across) > 2 &&
           std::max(along, across) < stressed_edge - 2;
  }



  /** Root mean square of the forces of nodes within the block, over sigma h. */
  double
  force_noise(const std::string &kernel, const unsigned int points)
  {
    using Layout = NodeLayout<2>;
    SceneRun<2>                run(stressed_block(),
                    {"Method/Kernel=" + kernel,
                                    "Body block/Points per cell edge=" +
                                      std::to_string(points)});
    constexpr unsigned int     n_places = 50;
    constexpr double           sigma = 1, step = 1e-9;
    const dealii::Tensor<1, 2> shift({10. / n_places, 3.7 / n_places});

    double      sum = 0;
    std::size_t n   = 0;
    for (unsigned int k = 1; k <= n_places; ++k)
      {
        run.translate(shift);
        const PointView<2> view = run.points();
        for (std::size_t p = 0; p < view.size; ++p)
          {
            view.pressure[p] = -sigma;
            for (int d = 0; d < 2; ++d)
              view.velocity[d][p] = 0;
          }
        run.advance(step);
        const GridView<2> grid = run.nodes.view();
        for (const std::uint32_t cell : run.nodes.owned_occupied_cells())
          {
            // a node of each cell: its lowest corner, or its middle
            const auto          &geometry = grid.cells[cell];
            const bool           splines  = grid.quadratics != nullptr;
            dealii::Tensor<1, 2> place;
            for (int d = 0; d < 2; ++d)
              place[d] = geometry.origin[d] + (splines ? 0.5 : 0);
            if (!is_deep(place - dealii::Tensor<1, 2>({7., 3.}) - k * shift))
              continue;
            const double *const record =
              grid.nodes +
              (splines ? grid.quadratics[cell].node[4] : geometry.node[0]);
            for (int d = 0; d < 2; ++d, ++n)
              sum += std::pow(record[Layout::mass] *
                                record[Layout::increment + d] / step,
                              2);
          }
      }
    const double result = std::sqrt(sum / n) / sigma;
    std::printf("%s, %u points along an edge: %.5f\n",
                kernel.c_str(),
                points,
                result);
    return result;
  }
} // namespace



TEST(ForceNoise, OfAStressedBlockThatMovesThroughTheGrid)
{
  for (const unsigned int points : {2u, 3u, 4u})
    {
      SCOPED_TRACE(points);
      const double linear   = force_noise("linear", points);
      const double crossing = 2. / (points * points);
      EXPECT_GT(linear, 0.25 * crossing);
      EXPECT_LT(linear, 4 * crossing);
      const double quadratic = force_noise("quadratic", points);
      EXPECT_LT(quadratic, 0.2 * linear);
      EXPECT_LT(force_noise("cubic", points), 0.2 * quadratic);
    }
}
