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
  /** What an implicit pressure finds for a cell; see CellPressures. */
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
    // Of the step, without dimension: all of it, as for solids, or less than
    // the mean divergence
    LazyArray<double> dilation;
    bool              is_whole = false;
  };



  /** A body at run time: its points, its law, its means if projected. */
  template <int dim>
  struct MaterialBody
  {
    const Body<dim>                         &description;
    std::unique_ptr<const StressUpdate<dim>> stress;
    MaterialPoints<dim>                      points;
    // Hu-Washizu sums in DGQ0, only where treatment or control need them
    std::optional<CellFields<dim>> cell_sums;
    // Likewise of the deviatoric strain; only within a step, else zero
    std::optional<CellFields<dim>> deviator_sums;
    // Means around nodes (Q1), likewise: of the divergence, of the pressure
    std::optional<NodalProjection<dim>> nodal_means;
    // The same over cells, of points with domains
    std::optional<CellAverages> cell_averages = {};
    // Per cell, what the volumetric variable gets in this step against
    // checkerboards; empty where they are not controlled
    LazyArray<double> cell_shift = {};
    // Per cell, the dilation of this liquid over the mean divergence of the
    // cell (LiquidMeans), where the pressure is implicit without what the
    // system has found; empty for all other bodies
    LazyArray<double> volume_shares = {};
    // The same, less where a cell has too little room beside an obstacle for
    // the step (CutCells::softness); empty where that may not be
    LazyArray<double> strain_shares = {};
    // Of an implicit pressure, by cell; only where the body has one
    std::optional<ImplicitFields> implicit = {};

    /** Of the named variable @p k of the law, by points. */
    const double *
    variable(const unsigned int k) const
    {
      return points.view().history[stress->first_variable() + k];
    }

    /** Forget all sums and means, of a mesh that has changed. */
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
   * Complete what a sweep has gathered in these sums of all bodies that have
   * them, with what other ranks have; collective.
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



  /** What the outside may look at between two steps. */
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
