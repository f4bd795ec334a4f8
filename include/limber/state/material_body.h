// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_state_material_body_h
#define limber_state_material_body_h

#include <limber/grid/cell_fields.h>
#include <limber/grid/nodal_fields.h>
#include <limber/grid/nodal_projection.h>
#include <limber/points/material_points.h>
#include <limber/state/cell_averages.h>
#include <limber/state/ledger.h>
#include <limber/stress/stress_update.h>

#include <memory>
#include <optional>

namespace limber
{
  /**
   * Results of the implicit pressure solver in each cell; see CellPressures.
   */
  struct ImplicitFields
  {
    explicit ImplicitFields(const std::size_t n_cells)
      : pressure(n_cells)
      , dilation(n_cells)
    {}

    CellPressures
    view(const bool is_liquid, const bool cuts_tension) const
    {
      return {is_liquid ? pressure.data() : nullptr,
              dilation.data(),
              is_whole,
              cuts_tension};
    }

    LazyArray<double> pressure; // J p, Pa
    // Volume strain of the step: the whole of it, as for solids, or only the
    // difference to the mean divergence
    LazyArray<double> dilation;
    bool              is_whole = false;
  };



  /**
   * A body at run time: its points, its law, and its means if its treatment
   * needs them.
   */
  template <int dim>
  struct MaterialBody
  {
    const Body<dim>                         &description;
    std::unique_ptr<const StressUpdate<dim>> stress;
    MaterialPoints<dim>                      points;
    // Hu-Washizu sums in DGQ0, only if the treatment or a control needs them
    std::optional<CellFields<dim>> cell_sums;
    // The same for the deviatoric strain; used within a step, else zero
    std::optional<CellFields<dim>> deviator_sums;
    // Means around nodes (Q1), likewise, of divergence and pressure
    std::optional<NodalProjection<dim>> nodal_means;
    // The same over cells, for points with domains
    std::optional<CellAverages> cell_averages = {};
    // Per cell, the change of the volumetric variable in this step by
    // checkerboard control; empty without it
    LazyArray<double> cell_shift = {};
    // Per cell, the dilation of this liquid over the mean divergence of the
    // cell (LiquidMeans), if the pressure is implicit, without the result of
    // the pressure system; empty for all other bodies
    LazyArray<double> volume_shares = {};
    // The same, less where an obstacle leaves a cell too little volume for the
    // step (CutCells::softness); empty where that cannot occur
    LazyArray<double> strain_shares = {};
    // Of the implicit pressure, by cell; only if the body has one
    std::optional<ImplicitFields> implicit = {};

    /** The named variable @p k of the law, by point. */
    const double *
    variable(const unsigned int k) const
    {
      return points.view().history[stress->first_variable() + k];
    }

    /** Discard all sums and means after a change of the mesh. */
    void
    reinit_sums(const BackgroundGrid<dim> &grid)
    {
      for (auto *const sums : {&cell_sums, &deviator_sums})
        if (*sums)
          (*sums)->reinit();
      if (cell_shift.size() > 0)
        cell_shift.reinit(grid.n_cells());
      if (implicit)
        implicit.emplace(grid.n_cells());
      if (nodal_means)
        nodal_means->reinit();
      if (cell_averages)
        cell_averages.emplace(grid.n_cells());
    }
  };



  /**
   * Complete these sums of all bodies that have them over the ranks;
   * collective.
   */
  template <int dim>
  void
  complete_sums(const std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies,
                std::optional<CellFields<dim>> MaterialBody<dim>::*const sums,
                const ExchangePlan                                      &plan)
  {
    for (auto &body : bodies)
      if (auto &own = (*body).*sums)
        own->start_completion(plan);
    for (auto &body : bodies)
      if (auto &own = (*body).*sums)
        own->finish_completion();
  }



  /** What output and observers may read between two steps. */
  template <int dim>
  struct State
  {
    const Problem<dim>                                    &problem;
    const BackgroundGrid<dim>                             &grid;
    const NodalFields<dim>                                &nodes;
    const std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies;

    unsigned long step      = 0;
    double        time      = 0; // s
    double        step_size = 0; // of the last step, s
    Ledger<dim>   ledger;        // of this rank
  };
} // namespace limber

#endif
