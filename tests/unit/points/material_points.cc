// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/points/material_points.h>

#include <gtest/gtest.h>

namespace
{
  using namespace limber;



  /** Points on four cells per axis, each with values that tell its number. */
  template <int dim>
  class Marked
  {
  public:
    Marked()
      : grid(description(), MPI_COMM_WORLD)
      , points(grid, layout())
    {
      for (const auto &cell : grid.triangulation.active_cell_iterators())
        if (cell->is_locally_owned() && cell->center()[0] < 0.5)
          for (unsigned int i = 0; i < 1 << dim; ++i)
            {
              dealii::Point<dim> place = cell->vertex(0);
              for (unsigned int d = 0; d < dim; ++d)
                place[d] += 0.0625 + (i >> d & 1) * 0.125;
              points.add(grid.cell_number(cell), place, 1.);
            }
      points.finish_adding();
      const PointView<dim> view = points.view();
      for (std::size_t p = 0; p < view.size; ++p)
        {
          view.mass[p]       = 1 + points.id(p);
          view.history[1][p] = -2. * points.id(p);
          // Away from where it was, but in the cell
          view.position[1][p] += 1e-3;
        }
    }

    /** Everything that a point carries is still its own. */
    void
    expect_unharmed()
    {
      const PointView<dim>   view = points.view();
      dealii::Tensor<1, dim> shift;
      shift[1] = 1e-3;
      for (std::size_t p = 0; p < view.size; ++p)
        {
          EXPECT_EQ(view.mass[p], 1 + points.id(p));
          EXPECT_EQ(view.history[1][p], -2. * points.id(p));
          const auto        &cell = grid.geometry[view.cell[p]];
          dealii::Point<dim> place;
          for (int d = 0; d < dim; ++d)
            {
              place[d] = view.position[d][p];
              const double xi =
                (place[d] - cell.origin[d]) * cell.inverse_edge[d];
              EXPECT_GE(xi, 0);
              EXPECT_LE(xi, 1);
            }
          EXPECT_LT((place - points.reference_position(p) - shift).norm(),
                    1e-14);
        }
    }

    BackgroundGrid<dim> grid;
    MaterialPoints<dim> points;

  private:
    static GridDescription<dim>
    description()
    {
      GridDescription<dim> result;
      for (unsigned int d = 0; d < dim; ++d)
        {
          result.upper[d] = 1;
          result.cells[d] = 4;
        }
      return result;
    }

    static PointLayout
    layout()
    {
      PointLayout result;
      result.n_history = 2;
      result.reference = true;
      return result;
    }
  };



  template <int dim>
  void
  refine_with_points()
  {
    Marked<dim>         marked;
    const unsigned long n     = marked.points.n_global();
    const unsigned long order = marked.points.order();

    for (const auto &cell : marked.grid.triangulation.active_cell_iterators())
      if (cell->is_locally_owned() && cell->center()[1] < 0.5)
        cell->set_refine_flag();
    marked.grid.triangulation.prepare_coarsening_and_refinement();
    marked.points.prepare_mesh_change();
    marked.grid.triangulation.execute_coarsening_and_refinement();
    marked.grid.rebuild();
    marked.points.finish_mesh_change();

    EXPECT_EQ(marked.points.n_global(), n);
    EXPECT_NE(marked.points.order(), order);
    marked.expect_unharmed();
  }



  TEST(MaterialPoints, AreUnharmedByChangesOfTheMesh)
  {
    refine_with_points<2>();
    refine_with_points<3>();
  }



  TEST(MaterialPoints, KeepTheirNumbersWhenSortedAndThinnedOut)
  {
    Marked<2>         marked;
    auto             &points = marked.points;
    PointView<2>      view   = points.view();
    const std::size_t n      = view.size;
    // The lower half moves to the end of the box.
    for (std::size_t p = 0; p < n; ++p)
      if (view.position[1][p] < 0.5)
        {
          view.position[1][p] += 0.5;
          view.position[0][p] += 0.5;
          const std::array<double, 2> place{
            {view.position[0][p], view.position[1][p]}};
          view.cell[p] = marked.grid.bins.cell_at(place);
        }
    points.sort_by_cell();
    view = points.view();
    for (std::size_t p = 1; p < n; ++p)
      EXPECT_LE(view.cell[p - 1], view.cell[p]);

    for (std::size_t p = 0; p < n; ++p)
      if (view.position[0][p] > 0.5)
        view.cell[p] = invalid_cell;
    const auto lost = points.remove_lost();
    EXPECT_EQ(lost.size() + points.size(), n);
    for (const auto &point : lost)
      EXPECT_EQ(point.mass, 1 + point.id);
    marked.expect_unharmed();
  }
} // namespace
