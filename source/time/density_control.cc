// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/density_control.h>

#include <algorithm>

namespace limber
{
  namespace
  {
    // Displacement of the fastest point, in cells, in a step that removes the
    // whole share C of the excess.
    constexpr double longest_way = 0.4;

    // Bound of |e|: points that have been thrown together separate no faster
    // than by a twentieth of the largest velocity from cell to cell.
    constexpr double largest_excess = 0.1;
  } // namespace



  template <int dim>
  DensityControl<dim>::DensityControl(const RunParts<dim>       &parts,
                                      const LiquidMeans<dim>    &means,
                                      const CutCells<dim> *const cut_cells)
    : parts(parts)
    , means(means)
    , nodal_volumes(parts.grid, cut_cells)
  {
    for (auto &body : parts.bodies)
      if (body->description.density_control > 0 &&
          !body->description.implicit_pressure)
        liquids.push_back(body.get());
    reinit();
  }



  template <int dim>
  void
  DensityControl<dim>::reinit()
  {
    if (liquids.empty())
      return;
    nodal_volumes.reinit();
    at_surface.reinit(parts.grid.vertices.n());
    filling.reinit(parts.grid.vertices.n());
  }



  template <int dim>
  void
  DensityControl<dim>::act(const double way)
  {
    for (MaterialBody *const body : liquids)
      {
        find_excess(*body);
        find_shifts(*body,
                    body->description.density_control *
                      std::min(way / longest_way, 1.));
      }
  }



  template <int dim>
  void
  DensityControl<dim>::find_excess(MaterialBody &body)
  {
    const NodalFields<dim>  &vertices     = parts.nodes.vertices();
    const unsigned int       field        = body.description.nodal_field;
    const Surroundings<dim> &surroundings = means.surroundings(field);
    const auto               sums         = body.cell_sums->view();
    for (const std::uint32_t node : vertices.active_nodes())
      at_surface[node] = 0;
    for (const std::uint32_t cell : vertices.owned_occupied_cells())
      if (sums.present_mass(cell) > 0 && !surroundings.is_inside(cell))
        for (unsigned int a = 0; a < n_corners; ++a)
          at_surface[surroundings.node_of(cell, a)] += 1;
    exchange.start(vertices.node_plan(), at_surface.data(), 0, 1);
    exchange.finish(at_surface.data());

    const double inverse_density = 1 / body.stress->density();
    for (const std::uint32_t node : vertices.active_nodes())
      {
        const double nodal_volume = nodal_volumes.at(node);
        const bool   is_known =
          nodal_volume > 0 && at_surface[node] == 0 && !is_shared(field, node);
        filling[node] = is_known ?
                          vertices.record(field, node)[NodeLayout<dim>::mass] *
                            inverse_density / nodal_volume :
                          0;
      }
  }



  template <int dim>
  bool
  DensityControl<dim>::is_shared(const unsigned int  field,
                                 const std::uint32_t node) const
  {
    const NodalFields<dim> &vertices = parts.nodes.vertices();
    for (unsigned int other = 0; other < vertices.n_fields(); ++other)
      if (other != field &&
          vertices.record(other, node)[NodeLayout<dim>::mass] > 0)
        return true;
    return false;
  }



  template <int dim>
  void
  DensityControl<dim>::find_shifts(MaterialBody &body, const double share) const
  {
    const NodalFields<dim> &vertices = parts.nodes.vertices();
    const auto              sums     = body.cell_sums->view();
    // whether Stabilization::control_checkerboards() has set cell_shift
    const bool is_set = body.description.checkerboard_control > 0;
    for (const auto *const cells :
         {&vertices.owned_occupied_cells(), &vertices.ghost_occupied_cells()})
      for (const std::uint32_t cell : *cells)
        {
          double &shift = body.cell_shift[cell];
          if (!is_set)
            shift = 0;
          const double mass = sums.present_mass(cell);
          if (!(mass > 0))
            continue;
          const double J =
            sums.now[cell * sums.stride + sums.volumetric()] / mass;
          double excess = 0;
          for (unsigned int a = 0; a < n_corners; ++a)
            {
              const std::uint32_t node =
                parts.grid.geometry[cell].node[a] / NodeLayout<dim>::stride;
              if (filling[node] > 0)
                excess += std::clamp(J * filling[node] - 1,
                                     -largest_excess,
                                     largest_excess);
            }
          shift -= share * excess / n_corners;
        }
  }



  template class DensityControl<2>;
  template class DensityControl<3>;
} // namespace limber
