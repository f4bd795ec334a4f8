// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/adaptation/mesh_change.h>

namespace limber
{
  namespace
  {
    /**
     * Repartition cells with their points; BackgroundGrid::complete() must
     * follow.
     */
    template <int dim>
    void
    redistribute(BackgroundGrid<dim>                             &grid,
                 std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies)
    {
      for (auto &body : bodies)
        body->points.prepare_mesh_change();

      // Weights for load balancing: empty cells cost memory but no time.
      using Cell        = typename BackgroundGrid<dim>::Cell;
      using Status      = typename dealii::Triangulation<dim>::CellStatus;
      const auto weight = [&](const Cell &cell, const Status) -> unsigned int {
        unsigned int n = 0;
        if (cell->is_active() && cell->is_locally_owned())
          for (const auto &body : bodies)
            n += body->points.n_in_cell(cell);
        return 1 + 100 * n;
      };
      const auto connection = grid.triangulation.signals.weight.connect(weight);
      grid.triangulation.repartition();
      connection.disconnect();

      grid.rebuild_cells();
      for (auto &body : bodies)
        body->points.finish_mesh_change();
    }
  } // namespace



  template <int dim>
  void
  balance(BackgroundGrid<dim>                             &grid,
          std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies)
  {
    redistribute(grid, bodies);
    grid.complete();
  }



  // Each pass brings every cell one level closer.
  template <int dim>
  bool
  change_mesh(BackgroundGrid<dim>                             &grid,
              std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies,
              const RefinedCells<dim>                         &mesh)
  {
    if (!grid.mark_towards(mesh))
      return false;
    for (auto &body : bodies)
      body->points.hand_over();
    const auto take_passes = [&]() {
      bool done = false;
      for (unsigned int n = 0; n < 2 * mesh.levels() && !done; ++n)
        {
          grid.triangulation.execute_coarsening_and_refinement();
          done = !grid.mark_towards(mesh);
        }
      grid.clear_marks();
      grid.rebuild_cells();
      for (auto &body : bodies)
        body->points.find_cells();
      return done;
    };
    if (!take_passes())
      {
        // Siblings on different ranks cannot be coarsened.
        redistribute(grid, bodies);
        grid.mark_towards(mesh);
        AssertThrow(take_passes(),
                    dealii::ExcMessage("The mesh cannot become what it is "
                                       "wanted to be."));
      }
    if (grid.has_parted_siblings())
      redistribute(grid, bodies);
    grid.complete();
    return true;
  }



  template void
  balance(BackgroundGrid<2> &, std::vector<std::unique_ptr<MaterialBody<2>>> &);
  template void
  balance(BackgroundGrid<3> &, std::vector<std::unique_ptr<MaterialBody<3>>> &);
  template bool
  change_mesh(BackgroundGrid<2> &,
              std::vector<std::unique_ptr<MaterialBody<2>>> &,
              const RefinedCells<2> &);
  template bool
  change_mesh(BackgroundGrid<3> &,
              std::vector<std::unique_ptr<MaterialBody<3>>> &,
              const RefinedCells<3> &);
} // namespace limber
