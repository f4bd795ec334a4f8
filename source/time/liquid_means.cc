// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/liquid_means.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace limber
{
  namespace
  {
    // Limits of the volume of a cell over that of the liquid in it, in explicit
    // steps: a larger ratio would make sound faster than the step admits (CFL).
    constexpr double least_share = 0.8, largest_share = 1.25;

    // A cut cell at a surface begins to count as full from this fraction on,
    // gradually.
    constexpr double nearly_full = 0.9;
  } // namespace



  template <int dim>
  LiquidMeans<dim>::LiquidMeans(const RunParts<dim> &parts,
                                CutCells<dim> *const cut_cells)
    : parts(parts)
    , cut_cells(cut_cells)
  {
    std::map<unsigned int, Group> by_field;
    for (auto &body : parts.bodies)
      if (body->cell_sums)
        {
          Group &group =
            by_field.try_emplace(body->description.nodal_field, parts.grid)
              .first->second;
          if (body->description.is_liquid &&
              body->stress->treatment().kind == Treatment::cell)
            group.liquids.push_back(body.get());
          else
            group.solids.push_back(body.get());
        }
    for (auto &[field, group] : by_field)
      if (!group.liquids.empty())
        {
          const MaterialBody &first = *group.liquids.front();
          group.fills_cells         = first.cell_sums->stride == n_nodes;
          group.is_implicit         = first.implicit.has_value();
          group.field               = field;
          if (group.fills_cells || group.liquids.size() > 1)
            groups.push_back(std::move(group));
        }
    reinit();
  }



  template <int dim>
  void
  LiquidMeans<dim>::reinit()
  {
    for (Group &group : groups)
      {
        if (group.fills_cells)
          group.surroundings.reinit();
        for (MaterialBody *const body : group.liquids)
          {
            body->volume_shares.reinit(parts.grid.n_cells());
            std::fill_n(body->volume_shares.data(), parts.grid.n_cells(), 1.);
            if (cut_cells && !group.is_implicit)
              {
                body->strain_shares.reinit(parts.grid.n_cells());
                std::fill_n(body->strain_shares.data(),
                            parts.grid.n_cells(),
                            1.);
              }
          }
      }
  }



  template <int dim>
  void
  LiquidMeans<dim>::find()
  {
    const NodalFields<dim> &vertices = parts.nodes.vertices();
    for (Group &group : groups)
      {
        if (group.fills_cells)
          group.surroundings.find(
            vertices,
            [&](const std::uint32_t cell) {
              return !is_covered(cell) &&
                     (holds(group.liquids, cell) || holds(group.solids, cell));
            },
            cut_cells ? cut_cells->covered_corners() : nullptr);
        for (const auto *const cells : {&vertices.owned_occupied_cells(),
                                        &vertices.ghost_occupied_cells()})
          for (const std::uint32_t cell : *cells)
            find(group, cell);
      }
  }



  template <int dim>
  const Surroundings<dim> &
  LiquidMeans<dim>::surroundings(const unsigned int field) const
  {
    const auto group =
      std::find_if(groups.begin(), groups.end(), [&](const Group &each) {
        return each.field == field;
      });
    Assert(group != groups.end() && group->fills_cells,
           dealii::ExcInternalError());
    return group->surroundings;
  }



  template <int dim>
  bool
  LiquidMeans<dim>::holds(const std::vector<MaterialBody *> &bodies,
                          const std::uint32_t                cell) const
  {
    return std::any_of(bodies.begin(), bodies.end(), [&](auto *const body) {
      return body->cell_sums->present_mass(cell) > 0;
    });
  }



  template <int dim>
  void
  LiquidMeans<dim>::find(const Group &group, const std::uint32_t cell)
  {
    in_cell.clear();
    for (MaterialBody *const body : group.liquids)
      {
        const double mass = body->cell_sums->present_mass(cell);
        if (mass > 0)
          in_cell.push_back({body,
                             body->cell_sums->record(cell),
                             mass,
                             mass / body->stress->density(),
                             1});
      }
    if (in_cell.size() > 1)
      mix();
    for (const Part &part : in_cell)
      part.body->volume_shares[cell] = group.is_implicit ? 1 : part.share;
    if (const auto *const cut = cut_cells ? cut_cells->cell(cell) : nullptr)
      cut_cells->wets(cell, group.field) =
        !in_cell.empty() &&
        (group.surroundings.is_inside(cell) || reaches_surfaces(*cut));
    if (group.fills_cells && !in_cell.empty() && !is_covered(cell) &&
        !holds(group.solids, cell))
      fill(group, cell);
    if (cut_cells && !group.is_implicit)
      for (const Part &part : in_cell)
        {
          double &of_force = part.body->volume_shares[cell];
          if (!cut_cells->has_room(cell))
            of_force = 0;
          part.body->strain_shares[cell] = cut_cells->softness(cell) * of_force;
        }
  }



  // Several liquids in a cell: the shares s_k, and common means of monomials
  // over the points of all of them.
  template <int dim>
  void
  LiquidMeans<dim>::mix()
  {
    double volume = 0, compliance = 0;
    for (Part &part : in_cell)
      {
        const double J =
          part.sums[part.body->cell_sums->stride - 1] / part.mass;
        part.share = 1 / part.body->stress->volumetric_response(J).stiffness;
        volume += part.volume;
        compliance += part.volume * part.share;
      }
    for (Part &part : in_cell)
      part.share *= volume / compliance;
    const unsigned int n = in_cell.front().body->cell_sums->stride;
    for (unsigned int k = CellSums<dim>::mass + 1; k < n - 1; ++k)
      {
        double mean = 0;
        for (const Part &part : in_cell)
          mean += part.volume / volume * (part.sums[k] / part.mass);
        for (const Part &part : in_cell)
          part.sums[k] = part.mass * mean;
      }
  }



  // Replace means over points by those over the cell or its open part, in
  // directions along which the liquid is bounded or fills a layer.
  template <int dim>
  void
  LiquidMeans<dim>::fill(const Group &group, const std::uint32_t cell)
  {
    const auto *const cut    = cut_cells ? cut_cells->cell(cell) : nullptr;
    const double      filled = filling(cell) / (cut ? cut->open : 1);
    const bool        inside = group.surroundings.is_inside(cell);
    unsigned int      n_open = 0, open = 0; // directions that end at a surface
    bool              before = true, behind = true;
    const double      full = (filled - nearly_full) / (1 - nearly_full);
    if (inside && cut)
      fill_open_part(*cut, 1);
    else if (cut && group.is_implicit && cut->is_cut())
      fill_open_part(*cut, std::min(std::max(full, 0.), 1.));
    else
      for (unsigned int d = 0; d < dim; ++d)
        if (inside || (group.surroundings.is_bounded(cell, d, 0) &&
                       group.surroundings.is_bounded(cell, d, 1)))
          set_mean(d, cut ? cut->monomials[1u << d] : 0.5);
        else
          {
            ++n_open;
            open   = d;
            before = group.surroundings.is_bounded(cell, d, 0);
            behind = group.surroundings.is_bounded(cell, d, 1);
          }
    if (n_open == 1 && (before || behind))
      {
        const double half = 0.5 * std::min(1., filled);
        set_mean(open, before ? half : 1 - half);
      }
    if (inside)
      for (const Part &part : in_cell)
        part.body->volume_shares[cell] *=
          group.is_implicit ?
            1 / filled :
            std::min(std::max(1 / filled, least_share), largest_share);
  }



  // Set the mean of the coordinate along a direction, and accordingly those of
  // all monomials with it as a factor.
  template <int dim>
  void
  LiquidMeans<dim>::set_mean(const unsigned int direction, const double mean)
  {
    const unsigned int bit = 1u << direction;
    for (const Part &part : in_cell)
      for (unsigned int k = bit; k < n_nodes - 1; ++k)
        if (k & bit)
          part.sums[k] = mean * part.sums[k ^ bit];
  }



  // Blend the means of all monomials with those over the open part of a cell,
  // by this share.
  template <int dim>
  void
  LiquidMeans<dim>::fill_open_part(const typename CutCells<dim>::Cell &cut,
                                   const double                        share)
  {
    for (const Part &part : in_cell)
      for (unsigned int k = 1; k < n_nodes - 1; ++k)
        part.sums[k] += share * (part.mass * cut.monomials[k] - part.sums[k]);
  }



  // Whether the liquid in a cut cell touches a surface: its centroid is no
  // further from it than that of the open part, to a tenth of the edge.
  template <int dim>
  bool
  LiquidMeans<dim>::reaches_surfaces(
    const typename CutCells<dim>::Cell &cut) const
  {
    const CellGeometry<dim> &geometry = parts.grid.geometry[cut.number];
    double                   volume   = 0;
    dealii::Tensor<1, dim>   away; // of the centroid from that of the part
    for (const Part &part : in_cell)
      {
        volume += part.volume;
        for (unsigned int d = 0; d < dim; ++d)
          away[d] += part.volume *
                     (part.sums[1u << d] / part.mass - cut.monomials[1u << d]);
      }
    double smallest = 1e300;
    for (unsigned int d = 0; d < dim; ++d)
      {
        away[d] /= volume * geometry.inverse_edge[d];
        smallest = std::min(smallest, 1 / geometry.inverse_edge[d]);
      }
    return std::any_of(cut.surfaces.begin(),
                       cut.surfaces.end(),
                       [&](const auto &surface) {
                         return surface.normal * away <= 0.1 * smallest;
                       });
  }



  // Present volume of the liquids over that of the cell.
  template <int dim>
  double
  LiquidMeans<dim>::filling(const std::uint32_t cell) const
  {
    double result = 0;
    for (const Part &part : in_cell)
      result += part.sums[n_nodes - 1] * (part.volume / part.mass); // J V
    for (int d = 0; d < dim; ++d)
      result *= parts.grid.geometry[cell].inverse_edge[d];
    return result;
  }



  template class LiquidMeans<2>;
  template class LiquidMeans<3>;
} // namespace limber
