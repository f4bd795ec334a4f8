// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/node_vector.h>
#include <limber/time/cell_functions.h>
#include <limber/time/contact.h>
#include <limber/time/contact_geometry.h>

#include <algorithm>

/**
 * @file Contact search at nodes: which nodes have mass of two bodies, their
 * contact normals, and whether the points there touch. All ranks that hold a
 * node get the same result.
 */
namespace limber
{
  template <int dim>
  void
  Contact<dim>::find(const double step)
  {
    grid = parts.nodes.view();
    points.clear();
    for (const auto &body : parts.bodies)
      points.push_back(body->points.view());
    find_cells();
    if (find_nodes() || cells_are_others)
      find_batches();
    find_gradients();
    fit_surfaces();
    find_normals();
    find_places(step);
  }



  template <int dim>
  void
  Contact<dim>::reinit()
  {
    find_reaches();
    impulses.reinit();
    cells_of.assign(parts.bodies.size(), {});
    contact_nodes.clear();
    batches.clear();
    groups.clear();
    first_of.reinit(parts.nodes.table.n());
    cell_nodes_of.reinit(std::size_t(parts.grid.n_cells()) * n_fields);
    looked_at.clear();
    forget_cell_nodes();
    ranks_of_vertex.clear();
    for (const auto &neighbour : parts.grid.vertices.shared.neighbours)
      for (const std::uint32_t vertex : neighbour.records)
        ranks_of_vertex[vertex].push_back(neighbour.rank);
    if (!parts.grid.has_levels())
      return;
    hanging_of.reinit(parts.nodes.table.n());
    std::uint32_t n = 0;
    for (const HangingNode &hanging : parts.nodes.table.hanging)
      hanging_of[hanging.node] = ++n;
  }



  // In most steps few points enter another cell, and still fewer one with
  // contact nodes: the comparison costs less than repeating what depends on
  // these.
  template <int dim>
  void
  Contact<dim>::find_cells()
  {
    const bool all   = parts.nodes.begin_noting();
    cells_are_others = all;
    for (unsigned int b = 0; b < parts.bodies.size(); ++b)
      {
        std::vector<std::uint32_t> &former = cells_of[b];
        const std::uint32_t *const  cells  = points[b].cell;
        const unsigned int          field  = field_of(b);
        if (all || former.size() != points[b].size)
          {
            cells_are_others = true;
            former.assign(cells, cells + points[b].size);
            for_each_batch(points[b], [&](const CellBatch &batch) {
              parts.nodes.note_cell(field, batch.cell);
            });
            continue;
          }
        for_each_block(points[b].size, [&](const CellBatch &block) {
          if (std::equal(cells + block.begin,
                         cells + block.end,
                         former.data() + block.begin))
            return;
          for (std::size_t p = block.begin; p < block.end; ++p)
            if (cells[p] != former[p])
              {
                parts.nodes.note_cell(field, cells[p]);
                cells_are_others |= may_have_corners(field, cells[p]) ||
                                    may_have_corners(field, former[p]);
                former[p] = cells[p];
              }
        });
      }
  }



  // Find nodes with mass of two fields and return whether they have changed:
  // nearly always they have not, and what depends on them stays valid.
  template <int dim>
  bool
  Contact<dim>::find_nodes()
  {
    found.clear();
    for (const std::uint32_t node : parts.nodes.nodes_of_two_fields())
      for (unsigned int a = 0; a + 1 < n_fields; ++a)
        {
          if (!(parts.nodes.record(a, node)[Layout::mass] > 0))
            continue;
          for (unsigned int b = a + 1; b < n_fields; ++b)
            if (parts.nodes.record(b, node)[Layout::mass] > 0)
              found.push_back({node, a, b});
        }
    if (found == contact_nodes)
      return false;
    for (const ContactNode &contact : contact_nodes)
      first_of[contact.node] = 0;
    contact_nodes.swap(found);
    for (std::size_t t = contact_nodes.size(); t-- > 0;)
      first_of[contact_nodes[t].node] = static_cast<std::uint32_t>(t + 1);
    forget_cell_nodes();
    return true;
  }



  template <int dim>
  void
  Contact<dim>::forget_cell_nodes()
  {
    for (const std::uint32_t cell : looked_at)
      cell_nodes_of[cell] = 0;
    looked_at.clear();
    cell_nodes.clear();
    corners.clear();
  }



  // Batches of points in cells with a node at which their body may separate
  // from another one. Of all other points only the cell is looked up.
  template <int dim>
  void
  Contact<dim>::find_batches()
  {
    batches.clear();
    groups.clear();
    if (contact_nodes.empty())
      return;
    for (unsigned int b = 0; b < parts.bodies.size(); ++b)
      {
        const unsigned int         field = field_of(b);
        const std::size_t          first = batches.size();
        const std::uint32_t *const of_cell =
          cell_nodes_of.data() + std::size_t(parts.grid.n_cells()) * field;
        for_each_batch(points[b], [&](const CellBatch &batch) {
          std::uint32_t entry = of_cell[batch.cell];
          if (entry == 0)
            entry = find_cell_nodes(field, batch.cell);
          if (entry > 1)
            batches.push_back({batch,
                               b,
                               cell_nodes[entry - 2].first,
                               cell_nodes[entry - 2].last});
        });
        if (batches.size() > first)
          groups.push_back({b, first, batches.size()});
      }
  }



  template <int dim>
  std::uint32_t
  Contact<dim>::find_cell_nodes(const unsigned int  field,
                                const std::uint32_t cell)
  {
    const auto first = static_cast<std::uint32_t>(corners.size());
    with_degree(grid, [&](const auto degree) {
      add_corners(field,
                  CellFunctions<dim, decltype(degree)::value>::nodes_of(grid,
                                                                        cell));
    });
    const std::size_t at   = std::size_t(parts.grid.n_cells()) * field + cell;
    const auto        last = static_cast<std::uint32_t>(corners.size());
    looked_at.push_back(static_cast<std::uint32_t>(at));
    cell_nodes_of[at] = 1;
    if (last > first)
      {
        cell_nodes.push_back({first, last});
        cell_nodes_of[at] = static_cast<std::uint32_t>(1 + cell_nodes.size());
      }
    return cell_nodes_of[at];
  }



  template <int dim>
  template <std::size_t n>
  void
  Contact<dim>::add_corners(const unsigned int                  field,
                            const std::array<std::uint32_t, n> &nodes)
  {
    for (unsigned int k = 0; k < n; ++k)
      {
        const std::uint32_t node = nodes[k] / Layout::stride;
        add_corner(field, node, k, 1);
        if (hanging_of.size() > 0 && hanging_of[node] > 0)
          for (const auto &[master, share] :
               parts.nodes.table.hanging[hanging_of[node] - 1].masters)
            add_corner(field, master, k, share);
      }
  }



  template <int dim>
  void
  Contact<dim>::add_corner(const unsigned int  field,
                           const std::uint32_t node,
                           const unsigned int  k,
                           const double        share)
  {
    if (first_of[node] == 0)
      return;
    for (std::size_t t = first_of[node] - 1;
         t < contact_nodes.size() && contact_nodes[t].node == node;
         ++t)
      if ((contact_nodes[t].a == field || contact_nodes[t].b == field) &&
          law(contact_nodes[t].a, contact_nodes[t].b).law ==
            ContactLaw::separate)
        corners.push_back({static_cast<std::uint32_t>(
                             2 * t + (contact_nodes[t].a == field ? 0 : 1)),
                           k,
                           share});
  }



  template <int dim>
  MeetingBatches
  Contact<dim>::batches_of(const Group &group) const
  {
    return {batches.data() + group.first,
            batches.data() + group.last,
            corners.data(),
            1 / parts.bodies[group.body]->stress->density()};
  }



  template <int dim>
  void
  Contact<dim>::find_gradients()
  {
    volume_gradients.assign(contact_nodes.size() * 2 * dim, 0.);
    for (const Group &group : groups)
      add_volume_gradients<dim>(points[group.body],
                                parts.nodes.view(),
                                batches_of(group),
                                volume_gradients.data());
    share(gradients_of_ranks, [this](const std::size_t t) {
      std::array<double *, 2 * dim> slots;
      for (int d = 0; d < 2 * dim; ++d)
        slots[d] = &volume_gradients[t * 2 * dim + d];
      return slots;
    });
    end_at_sides();
  }



  // At sides with boundary conditions remove the component normal to the side:
  // as if the material continued behind it, the side is no surface.
  template <int dim>
  void
  Contact<dim>::end_at_sides()
  {
    for (std::size_t t = 0; t < contact_nodes.size(); ++t)
      if (const auto sides_of_box =
            parts.nodes.table.sides[contact_nodes[t].node])
        for (unsigned int side = 0; side < 2 * dim; ++side)
          if ((sides_of_box >> side & 1) &&
              parts.problem.sides[side].held != HeldComponents::none)
            for (unsigned int body = 0; body < 2; ++body)
              volume_gradients[(2 * t + body) * dim + side / 2] = 0;
  }



  // Choose the direction of largest separation: over all directions it is the
  // distance of convex bodies (separating axis). At the end of the face of one
  // body its own normal points past the corner; that of the other is right, and
  // the points are further apart along it. Where both are right, the mean is
  // taken: round-off must not decide.
  template <int dim>
  void
  Contact<dim>::find_normals()
  {
    directions.resize(contact_nodes.size() * n_separations * dim);
    find_directions<dim>(contact_nodes.size(),
                         volume_gradients.data(),
                         directions.data());
    extents.clear(2 * contact_nodes.size());
    for (const Group &group : groups)
      extents.add(points[group.body], batches_of(group), directions.data());
    extents.find_largest();
    const auto furthest = [this](const std::size_t slot,
                                 const int         k) -> double & {
      return extents.largest[slot * n_separations + k];
    };
    share(extents_of_ranks, [&](const std::size_t t) {
      std::array<double *, 2 * n_separations> slots;
      for (int k = 0; k < n_separations; ++k)
        {
          slots[k]                 = &furthest(2 * t, k);
          slots[n_separations + k] = &furthest(2 * t + 1, k);
        }
      return slots;
    });
    faces.assign(contact_nodes.size(), {{}, {{-1e300, -1e300}}});
    points_touch.assign(contact_nodes.size(), 0);
    for (std::size_t t = 0; t < contact_nodes.size(); ++t)
      {
        double       largest = -1e300;
        const double nothing =
          1e-6 * std::min(edge[contact_nodes[t].a], edge[contact_nodes[t].b]);
        for (int k = n_separations; k-- > 0;)
          {
            const Vector direction =
              vector_in<dim>(&directions[(t * n_separations + k) * dim]);
            const double of_a = furthest(2 * t, k),
                         of_b = furthest(2 * t + 1, k);
            if (-of_b - of_a > largest + nothing && direction != Vector())
              {
                largest = -of_b - of_a;
                store_vector<dim>(direction, faces[t].normal.data());
                faces[t].furthest = {{of_a, of_b}};
              }
          }
        points_touch[t] = largest <= 0;
      }
  }



  template void
  Contact<2>::reinit();
  template void
  Contact<3>::reinit();
  template void
  Contact<2>::find(double);
  template void
  Contact<3>::find(double);
} // namespace limber
