// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/node_vector.h>
#include <limber/time/pressure_system.h>

#include <algorithm>
#include <cmath>

/**
 * @file The equations of the implicit pressure at rigid obstacles. Pieces of
 * surface in cells have rows of their own; at nodes that obstacles hold one by
 * one, the held directions are projected out of M^-1, as components that sides
 * hold are removed.
 */

namespace limber
{
  namespace
  {
    // Gram-Schmidt: a contact normal of which the others at the node leave less
    // than this depends on them and is dropped, as in ContactImpulses.
    constexpr double least_left = 0.1;

    // Regularisation of surface rows, relative to the diagonal, as the matrix
    // is only semidefinite: a surface whose row depends on those of others gets
    // their pressure.
    constexpr double give = 1e-12;
  } // namespace



  // The largest number of surface pieces that a row couples to, on any rank:
  // the number of their columns.
  template <int dim>
  unsigned int
  PressureSystem<dim>::most_surfaces_near() const
  {
    if (!cells.surfaces.any())
      return 0;
    unsigned int result = 0;
    for_each_row([&](std::uint32_t, const std::uint32_t cell) {
      unsigned int n     = 0;
      const auto   count = [&](const std::uint32_t near) {
        cells.surfaces.for_each_in(near, [&](std::uint32_t) { ++n; });
      };
      if (cells.corners.empty())
        cells.for_each_near(cell, 1, [&](unsigned int, const auto near) {
          count(near);
        });
      else
        for (const std::uint32_t near : coupled_to(cell))
          count(near);
      result = std::max(result, n);
    });
    return dealii::Utilities::MPI::max(result, parts.grid.communicator);
  }



  template <int dim>
  void
  PressureSystem<dim>::meet_nodes(const std::vector<HeldNode> *const nodes)
  {
    to_hold = nodes;
    is_released.assign(nodes->size(), 0);
  }



  template <int dim>
  void
  PressureSystem<dim>::hold_by_obstacles()
  {
    for (const Held &one : held)
      held_as[one.node] = 0;
    held.clear();
    for (std::size_t k = 0; k < to_hold->size(); ++k)
      {
        const HeldNode &contact = (*to_hold)[k];
        if (is_released[k] ||
            !(parts.nodes.record(contact.node)[Layout::mass] > 0))
          continue;
        const std::size_t first = std::size_t(contact.node) * dim;
        Vector            left  = contact.normal;
        for (int d = 0; d < dim; ++d)
          if (mobility[first + d] == 0)
            left[d] = 0;
        std::uint32_t &as = held_as[contact.node];
        if (as > 0)
          for (unsigned int i = 0; i < held[as - 1].n; ++i)
            left -=
              (left * held[as - 1].directions[i]) * held[as - 1].directions[i];
        const double norm = left.norm();
        if (norm < least_left)
          continue;
        left /= norm;
        double approach = contact.least;
        for (int d = 0; d < dim; ++d)
          approach -= contact.normal[d] * velocity[first + d];
        for (int d = 0; d < dim; ++d)
          velocity[first + d] += approach / norm * left[d];
        if (as == 0)
          {
            held.push_back({contact.node, 0, {}, {}, {}});
            as = held.size();
          }
        Held &of_node                 = held[as - 1];
        of_node.directions[of_node.n] = left;
        of_node.along[of_node.n]      = norm;
        of_node.contacts[of_node.n++] = k;
      }
  }



  // Project the held directions of a node out of a vector.
  template <int dim>
  void
  PressureSystem<dim>::move(const std::uint32_t node,
                            double *const       vector) const
  {
    const Held &of_node = held[held_as[node] - 1];
    for (unsigned int i = 0; i < of_node.n; ++i)
      {
        const Vector along = (vector_in<dim>(vector) * of_node.directions[i]) *
                             of_node.directions[i];
        for (int d = 0; d < dim; ++d)
          vector[d] -= along[d];
      }
  }



  // The change of velocity is known along the orthonormal directions, but
  // impulses act along the contact normals, which also have parts along the
  // directions before: back substitution from the last one on. Impulses that
  // would pull are zero.
  template <int dim>
  std::vector<double>
  PressureSystem<dim>::impulses_on_nodes(const double step) const
  {
    std::vector<double> result(to_hold->size(), 0.);
    for (const Held &one : held)
      {
        const double *const record = parts.nodes.record(one.node);
        Vector              v      = vector_in<dim>(record + Layout::velocity) +
                   step / record[Layout::mass] *
                     vector_in<dim>(record + Layout::pressure_force);
        for (int d = 0; d < dim; ++d)
          if (mobility[std::size_t(one.node) * dim + d] == 0)
            v[d] = velocity[std::size_t(one.node) * dim + d];
        std::array<double, dim> change{};
        for (unsigned int i = 0; i < one.n; ++i)
          {
            const HeldNode &contact = (*to_hold)[one.contacts[i]];
            change[i] = (contact.least - contact.normal * v) / one.along[i];
            v += change[i] * one.directions[i];
          }
        for (unsigned int i = one.n; i-- > 0;)
          {
            const HeldNode &contact = (*to_hold)[one.contacts[i]];
            const double    across  = change[i] / one.along[i];
            for (unsigned int k = 0; k < i; ++k)
              change[k] -= across * (contact.normal * one.directions[k]);
            result[one.contacts[i]] =
              record[Layout::mass] * std::max(0., across);
          }
      }
    return result;
  }



  template <int dim>
  bool
  PressureSystem<dim>::release_nodes(const double step, const bool may_return)
  {
    int any = 0;
    for (std::size_t k = 0; k < to_hold->size(); ++k)
      {
        const HeldNode     &contact = (*to_hold)[k];
        const double *const record  = parts.nodes.record(contact.node);
        if (!(record[Layout::mass] > 0) ||
            (!is_released[k] && held_as[contact.node] == 0))
          continue;
        const Vector velocity =
          vector_in<dim>(record + Layout::velocity) +
          step / record[Layout::mass] *
            vector_in<dim>(record + Layout::pressure_force);
        const bool leaves = velocity * contact.normal > contact.least;
        if (leaves == bool(is_released[k]) || (!leaves && !may_return))
          continue;
        is_released[k] = leaves;
        any            = 1;
      }
    return dealii::Utilities::MPI::max(any, parts.grid.communicator) > 0;
  }



  template <int dim>
  const double *
  PressureSystem<dim>::covered_corners() const
  {
    return cells.surfaces.cells() ? cells.surfaces.cells()->covered_corners() :
                                    nullptr;
  }



  // Whether it is a corner of a cell that obstacles cut or cover.
  template <int dim>
  bool
  PressureSystem<dim>::is_at_obstacle(const std::uint32_t node) const
  {
    const CutCells<dim> *const cut = cells.surfaces.cells();
    return cut != nullptr &&
           (cut->is_cut(node) || cut->covered_corners()[node] > 0);
  }



  template <int dim>
  std::size_t
  PressureSystem<dim>::surface_entry(const std::uint32_t row,
                                     const std::uint32_t piece) const
  {
    const auto begin = mates.begin() + std::size_t(row) * equations.width;
    return std::find(begin + of_cells, begin + equations.width, piece) -
           mates.begin();
  }



  // Entries of a row in the columns of wet surfaces, dt^2 (B or A) M^-1 A^T, by
  // one node: @p scaled is its part of dt^2 (B or A) M^-1.
  template <int dim>
  void
  PressureSystem<dim>::couple_surfaces(const std::uint32_t node,
                                       const double *const scaled,
                                       const std::uint32_t row)
  {
    const Medium &liquids = cells.media.front();
    for (unsigned int b = 0; b < n_nodes; ++b)
      if (const std::uint32_t other = liquids.cells_around(node)[b]; other > 0)
        cells.surfaces.for_each_in(other - 1, [&](const std::uint32_t k) {
          const Piece &piece = cells.surfaces.pieces[k];
          if (!piece.is_wet)
            return;
          double &value = equations.values[surface_entry(row, k)];
          for (int d = 0; d < dim; ++d)
            value += scaled[d] * piece.entries[b * dim + d];
        });
  }



  // dt^2 A M^-1 (B^T P + A^T q) = dt (A v_o - A v*)
  template <int dim>
  void
  PressureSystem<dim>::assemble_surfaces(const double step)
  {
    for (std::uint32_t k = 0; k < cells.surfaces.n_of_rank(); ++k)
      {
        const Piece        &piece = cells.surfaces.pieces[k];
        const std::uint32_t row   = cells.first_of_surfaces() + k;
        if (!piece.is_wet)
          continue;
        may_be_cut[row] = 1;
        couple(piece.entries.data(), piece.cell, row, step);
        equations.right_side[row] += step * piece.leaving;
      }
  }



  // Symmetric scaling as for the rows of cells, and the pressure in the cell as
  // initial guess; returns what they add to the sum of squares in scale().
  template <int dim>
  double
  PressureSystem<dim>::scale_surfaces()
  {
    auto         &surfaces = cells.surfaces;
    const Medium &liquids  = cells.media.front();
    double        squares  = 0;
    for (std::uint32_t k = 0; k < surfaces.n_of_rank(); ++k)
      {
        Piece              &piece    = surfaces.pieces[k];
        const std::uint32_t row      = cells.first_of_surfaces() + k;
        double             &diagonal = equations.values[surface_entry(row, k)];
        diagonal *= 1 + give;
        const bool acts = diagonal > 0;
        if (!acts)
          {
            diagonal                  = 1;
            equations.right_side[row] = 0;
            may_be_cut[row]           = 0;
          }
        scales[row] = piece.scale = 1 / std::sqrt(diagonal);
        equations.right_side[row] *= scales[row];
        if (!acts)
          continue;
        const double *const of_cell = liquids.record(piece.cell);
        pressures[row] =
          of_cell[Record::moment] / of_cell[Record::volume] / scales[row];
        const double volume = of_cell[Record::volume] * scales[row];
        squares += volume * volume;
      }
    surfaces.share(&Piece::scale);
    return squares;
  }



  template unsigned int
  PressureSystem<2>::most_surfaces_near() const;
  template void
  PressureSystem<2>::meet_nodes(const std::vector<HeldNode> *);
  template void
  PressureSystem<2>::hold_by_obstacles();
  template void
  PressureSystem<2>::move(std::uint32_t, double *) const;
  template std::vector<double>
  PressureSystem<2>::impulses_on_nodes(double) const;
  template bool
  PressureSystem<2>::release_nodes(double, bool);
  template const double                      *
  PressureSystem<2>::covered_corners() const;
  template bool        PressureSystem<2>::is_at_obstacle(std::uint32_t) const;
  template std::size_t PressureSystem<2>::surface_entry(std::uint32_t,
                                                        std::uint32_t) const;
  template void
  PressureSystem<2>::couple_surfaces(std::uint32_t,
                                     const double *,
                                     std::uint32_t);
  template void
  PressureSystem<2>::assemble_surfaces(double);
  template double
  PressureSystem<2>::scale_surfaces();
  template unsigned int
  PressureSystem<3>::most_surfaces_near() const;
  template void
  PressureSystem<3>::meet_nodes(const std::vector<HeldNode> *);
  template void
  PressureSystem<3>::hold_by_obstacles();
  template void
  PressureSystem<3>::move(std::uint32_t, double *) const;
  template std::vector<double>
  PressureSystem<3>::impulses_on_nodes(double) const;
  template bool
  PressureSystem<3>::release_nodes(double, bool);
  template const double                      *
  PressureSystem<3>::covered_corners() const;
  template bool        PressureSystem<3>::is_at_obstacle(std::uint32_t) const;
  template std::size_t PressureSystem<3>::surface_entry(std::uint32_t,
                                                        std::uint32_t) const;
  template void
  PressureSystem<3>::couple_surfaces(std::uint32_t,
                                     const double *,
                                     std::uint32_t);
  template void
  PressureSystem<3>::assemble_surfaces(double);
  template double
  PressureSystem<3>::scale_surfaces();
} // namespace limber
