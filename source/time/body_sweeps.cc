// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/domain_means.h>
#include <limber/time/body_sweeps.h>
#include <limber/time/contact.h>
#include <limber/transfer/convected_transfer.h>
#include <limber/transfer/dual_domain_transfer.h>
#include <limber/transfer/project_on_nodes.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace limber
{
  namespace
  {
    /** The sums of a projected body for the sweeps; nothing for others. */
    template <int dim>
    std::optional<CellSums<dim>>
    sums_of(MaterialBody<dim> &body)
    {
      if (!body.cell_sums)
        return std::nullopt;
      return body.cell_sums->view();
    }



    /** See LiquidMeans; null for other bodies. */
    template <int dim>
    const double *
    shares_of(const MaterialBody<dim> &body)
    {
      return body.volume_shares.size() > 0 ? body.volume_shares.data() :
                                             nullptr;
    }



    /** The records of what has been projected; null for other bodies. */
    template <int dim>
    double *
    projected(MaterialBody<dim> &body)
    {
      return body.nodal_means   ? body.nodal_means->data() :
             body.cell_averages ? body.cell_averages->data() :
                                  nullptr;
    }
  } // namespace



  template <int dim>
  BodySweeps<dim>::BodySweeps(const RunParts<dim> &parts)
    : parts(parts)
  {
    if (parts.problem.grid.kernel == KernelKind::ddmp)
      for (unsigned int field = 0; field < n_nodal_fields(parts.problem);
           ++field)
        dual_domains.emplace_back(parts.grid.nodes(), field);
    if (is_affine(parts.problem.method.transfer) && parts.grid.has_levels())
      affine_at_levels.emplace();
    reinit();
  }



  template <int dim>
  void
  BodySweeps<dim>::reinit()
  {
    for (DualDomain<dim> &dual_domain : dual_domains)
      dual_domain.reinit();
    if (affine_at_levels)
      affine_at_levels->reinit(parts.grid);
  }



  template <int dim>
  std::size_t
  BodySweeps<dim>::points_to_grid(P2GOptions what)
  {
    if (what.force)
      {
        for (DualDomain<dim> &dual_domain : dual_domains)
          dual_domain.clear_stress(parts.nodes);
        project_on_nodes([&](MaterialBody<dim> &body, double *const records) {
          sum_pressure<dim>(body.points.view(), nodes_of(body), records);
        });
        average_over_cells([](MaterialBody<dim> &body, double *const records) {
          sum_pressure_over_cells<dim>(body.points.view(), records);
        });
      }
    std::size_t n_batches  = 0;
    const bool  with_force = what.force;
    for (auto &body : parts.bodies)
      {
        // An implicit pressure is added by ImplicitPressure.
        what.pressure = !body->implicit;
        what.force =
          with_force && (what.pressure || body->stress->has_deviator());
        what.inverse_density    = 1 / body->stress->density();
        what.treatment          = body->stress->treatment();
        what.projected_pressure = projected(*body);
        what.volume_shares      = shares_of(*body);
        const auto sums         = sums_of(*body);
        n_batches += limber::points_to_grid<dim>(body->points.view(),
                                                 nodes_of(*body),
                                                 what,
                                                 sums ? &*sums : nullptr);
        if (affine_at_levels && what.affine)
          affine_at_levels->add(body->points.view(),
                                nodes_of(*body),
                                NodeLayout<dim>::momentum);
      }
    return n_batches;
  }



  template <int dim>
  void
  BodySweeps<dim>::finish_points_to_grid(const P2GOptions &what)
  {
    for (DualDomain<dim> &dual_domain : dual_domains)
      {
        if (what.momentum)
          dual_domain.find_volumes(parts.nodes, parts.bodies);
        if (what.force)
          dual_domain.add_forces(parts.nodes);
      }
  }



  template <int dim>
  void
  BodySweeps<dim>::average_gradients(const unsigned int slot)
  {
    for (DualDomain<dim> &dual_domain : dual_domains)
      dual_domain.average_gradients(parts.nodes, slot);
  }



  // Lumped projection on nodes for bodies with the treatments `node` and
  // `hybrid`; sum(body, records) adds the contributions of points.
  template <int dim>
  template <class Sum>
  void
  BodySweeps<dim>::project_on_nodes(const Sum &sum)
  {
    const NodalFields<dim> &vertices = parts.nodes.vertices();
    for (auto &body : parts.bodies)
      if (body->nodal_means)
        {
          body->nodal_means->clear(vertices.active_nodes());
          sum(*body, body->nodal_means->data());
          body->nodal_means->start_completion(vertices.node_plan());
        }
    for (auto &body : parts.bodies)
      if (body->nodal_means)
        body->nodal_means->finish_completion(vertices.active_nodes());
  }



  // Means over cells for bodies whose points have domains, likewise.
  template <int dim>
  template <class Sum>
  void
  BodySweeps<dim>::average_over_cells(const Sum &sum)
  {
    const auto &cells = parts.nodes.owned_occupied_cells();
    for (auto &body : parts.bodies)
      if (body->cell_averages)
        {
          body->cell_averages->clear(cells);
          sum(*body, body->cell_averages->data());
          body->cell_averages->finish(cells);
        }
  }



  template <int dim>
  void
  BodySweeps<dim>::grid_to_points(const G2POptions &what,
                                  StepExtremes     &extremes)
  {
    for (auto &body : parts.bodies)
      grid_to_points(*body, what, extremes);
  }



  template <int dim>
  void
  BodySweeps<dim>::grid_to_points_ahead(const G2POptions &what,
                                        StepExtremes     &extremes)
  {
    for (auto &body : parts.bodies)
      if (!body->stress->takes_velocity())
        grid_to_points(*body, what, extremes);
  }



  template <int dim>
  void
  BodySweeps<dim>::grid_to_points(MaterialBody<dim> &body,
                                  const G2POptions  &what,
                                  StepExtremes      &extremes)
  {
    const auto sums = sums_of(body);
    G2POptions own  = what;
    own.light_density *= body.stress->density();
    const auto found = limber::grid_to_points<dim>(body.points.view(),
                                                   nodes_of(body),
                                                   own,
                                                   sums ? &*sums : nullptr);
    if (affine_at_levels && what.remap)
      affine_at_levels->add(body.points.view(),
                            nodes_of(body),
                            NodeLayout<dim>::remapped);
    extremes.speed_squared =
      std::max(extremes.speed_squared, found.speed_squared);
    extremes.displacement = std::max(extremes.displacement, found.displacement);
    parts.ledger.transfer += found.removed;
  }



  // Fraction by which a history approaches the mean in a time @p length.
  template <int dim>
  double
  BodySweeps<dim>::relaxation(const Body<dim>       &body,
                              const HistoryTreatment history,
                              const double           length,
                              const double           speed) const
  {
    if (!(length > 0))
      return 0;
    switch (history)
      {
        case HistoryTreatment::keep:
          return 0;
        case HistoryTreatment::relax:
          return -std::expm1(-length / body.relaxation_time);
        case HistoryTreatment::crossing:
          return -std::expm1(-length * speed / parts.grid.smallest_edge);
        case HistoryTreatment::replace:
          return 1;
      }
    return 0;
  }



  template <int dim>
  void
  BodySweeps<dim>::relax_deviators(const Pace &pace)
  {
    for (auto &body : parts.bodies)
      if (body->deviator_sums)
        body->stress->sum_deviators(body->points.view(),
                                    body->deviator_sums->view());
    complete_sums(parts.bodies,
                  &MaterialBody<dim>::deviator_sums,
                  parts.nodes.cell_plan());
    for (auto &body : parts.bodies)
      if (body->deviator_sums)
        {
          const Body<dim> &description = body->description;
          parts.ledger.history += body->stress->relax_deviators(
            body->points.view(),
            body->deviator_sums->view().now,
            relaxation(description,
                       description.deviatoric_history,
                       pace.deviatoric,
                       pace.speed));
        }
  }



  template <int dim>
  void
  BodySweeps<dim>::update_stress(StressSweep   what,
                                 const Pace   &pace,
                                 StepExtremes &extremes)
  {
    const bool remapped = what.remapped;
    relax_deviators(pace);
    project_on_nodes([&](MaterialBody<dim> &body, double *const records) {
      sum_divergence<dim>(body.points.view(),
                          nodes_of(body),
                          what.remapped,
                          records);
    });
    average_over_cells([&](MaterialBody<dim> &body, double *const records) {
      const auto points = body.points.view();
      const auto nodes  = nodes_of(body);
      if (!dual_domains.empty())
        sum_divergence_of_dual_domain<CellMeanSums<dim>>(points,
                                                         nodes,
                                                         what.remapped,
                                                         records);
      else
        sum_divergence_of_domains<CellMeanSums<dim>>(points,
                                                     nodes,
                                                     what.remapped,
                                                     records);
    });
    for (auto &body : parts.bodies)
      {
        const Body<dim> &description = body->description;
        what.projected_divergence    = projected(*body);
        what.relaxation              = relaxation(description,
                                     description.history,
                                     pace.volumetric,
                                     pace.speed);
        what.shift =
          body->cell_shift.size() > 0 ? body->cell_shift.data() : nullptr;
        what.volume_shares = body->strain_shares.size() > 0 ?
                               body->strain_shares.data() :
                               shares_of(*body);
        what.uniform_divergence =
          description.is_liquid && body->implicit.has_value();
        CellPressures pressures;
        if (body->implicit)
          pressures = body->implicit->view(description.is_liquid,
                                           description.cuts_tension ||
                                             !parts.problem.obstacles.empty());
        what.implicit = body->implicit ? &pressures : nullptr;
        what.remapped =
          remapped && !(body->implicit && !body->implicit->is_whole);
        const auto sums  = sums_of(*body);
        const auto found = body->stress->update(body->points.view(),
                                                nodes_of(*body),
                                                sums ? &*sums : nullptr,
                                                what);
        extremes.wave_squared =
          std::max(extremes.wave_squared,
                   body->implicit ? body->stress->deviatoric_wave_speed_squared(
                                      body->points.view()) :
                                    found.wave_speed_squared);
        extremes.displacement =
          std::max(extremes.displacement, found.displacement);
        extremes.speed_squared =
          std::max(extremes.speed_squared, found.speed_squared);
        parts.ledger.transfer += found.removed;
        parts.ledger.viscous += found.viscous;
        parts.ledger.history += found.history;
        parts.ledger.plastic += found.plastic;
      }
  }



  template class BodySweeps<2>;
  template class BodySweeps<3>;
} // namespace limber
