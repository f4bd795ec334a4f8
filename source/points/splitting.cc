// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/points/material_points.h>

#include <algorithm>

/** @file Points of a MaterialPoints that become several, or one. */
namespace limber
{
  // A quarter of the edges of what the point stands for: its domain, along the
  // axes or its own edges, or its share of the cell that it was made for.
  template <int dim>
  dealii::Tensor<2, dim>
  MaterialPoints<dim>::shifts_of_children(
    const PointView<dim>          &points,
    const std::size_t              p,
    const std::array<double, dim> &spacing) const
  {
    dealii::Tensor<2, dim> result;
    for (int d = 0; d < dim; ++d)
      if (points.has_domains())
        {
          for (int k = 0; k < dim; ++k)
            if (const double *const component = points.domain[d * dim + k])
              result[d][k] = 0.5 * component[p];
          if (points.has_boxes()) // with the length of the row, see half_box()
            {
              const double half = result[d].norm();
              result[d]         = 0;
              result[d][d]      = half;
            }
        }
      else
        result[d][d] = 0.25 * spacing[d] / (1u << size_classes[p]);
    return result;
  }



  // How far a half may be shifted along an axis, nearly as far as the cell
  // reaches: on a face of the cell round-off would decide where a point is.
  template <int dim>
  double
  MaterialPoints<dim>::room_in_cell(const PointView<dim> &points,
                                    const std::size_t     p,
                                    const unsigned int    axis) const
  {
    constexpr double         share    = 0.9;
    const CellGeometry<dim> &geometry = grid.geometry[cell[p]];
    const double below = points.position[axis][p] - geometry.origin[axis];
    const double above = 1 / geometry.inverse_edge[axis] - below;
    return std::max(0., share * std::min(below, above));
  }



  template <int dim>
  void
  MaterialPoints<dim>::shift_point(const std::size_t             p,
                                   const dealii::Tensor<1, dim> &way)
  {
    for (int d = 0; d < dim; ++d)
      {
        fields[d][p] += way[d];
        if (layout.has_reference())
          fields[fields.size() - dim + d][p] += way[d];
      }
  }



  // Shifted alike to both sides: the centre of mass stays, and with it whatever
  // is linear in each direction within the cell.
  template <int dim>
  void
  MaterialPoints<dim>::split(const std::vector<std::size_t> &which,
                             const std::array<double, dim>  &spacing,
                             std::uint64_t                   next_id)
  {
    constexpr unsigned int n_children = 1 << dim;
    std::size_t            last       = size();
    resize(last + which.size() * (n_children - 1));
    const PointView<dim> points = view();
    for (const std::size_t p : which)
      {
        // column k: from the point to its children along its edge k
        dealii::Tensor<2, dim> shifts = shifts_of_children(points, p, spacing);
        for (int d = 0; d < dim; ++d)
          {
            double all = 0;
            for (int k = 0; k < dim; ++k)
              all += std::abs(shifts[d][k]);
            if (const double room = room_in_cell(points, p, d); all > room)
              shifts[d] *= room / all;
          }
        points.mass[p] /= n_children;
        for (double *const component : points.domain)
          if (component != nullptr)
            component[p] /= 2;
        if (points.reach != nullptr)
          points.reach[p] /= 2;
        for (double *const component : points.edge)
          if (component != nullptr)
            component[p] /= 2;
        ++size_classes[p];
        const auto way_to = [&](const unsigned int child) {
          dealii::Tensor<1, dim> way;
          for (int d = 0; d < dim; ++d)
            for (int k = 0; k < dim; ++k)
              way[d] += child >> k & 1 ? shifts[d][k] : -shifts[d][k];
          return way;
        };
        for (unsigned int child = 1; child < n_children; ++child, ++last)
          {
            move(p, last);
            ids[last] = next_id++;
            shift_point(last, way_to(child));
          }
        shift_point(p, way_to(0));
      }
    ++n_reorderings;
  }



  // What the parts may touch is usually along the stretched direction, across
  // which their material reaches as far as before.
  template <int dim>
  double
  MaterialPoints<dim>::divide(const std::vector<Division<dim>> &which,
                              std::uint64_t                     next_id)
  {
    std::size_t last = size();
    std::size_t all  = last;
    for (const Division<dim> &division : which)
      all += division.parts - 1;
    resize(all);
    const PointView<dim> points  = view();
    const auto           cell_at = [&](const std::size_t             p,
                             const dealii::Tensor<1, dim> &way) {
      std::array<double, dim> x;
      for (int d = 0; d < dim; ++d)
        x[d] = points.position[d][p] + way[d];
      return grid.bins.cell_at(x);
    };
    double energy = 0;
    for (const Division<dim> &division : which)
      {
        const std::size_t      p     = division.point;
        const unsigned int     along = division.direction, n = division.parts;
        const double           end  = 0.5 * (n - 1); // in steps
        dealii::Tensor<1, dim> step = 2. / n * division.half_edge;
        // Nothing comes close to the sides of the box, or goes where this rank
        // knows no cell.
        if (cell_at(p, -1.1 * end * step) == invalid_cell ||
            cell_at(p, 1.1 * end * step) == invalid_cell)
          for (int d = 0; d < dim; ++d)
            {
              const double room = room_in_cell(points, p, d) / end;
              step[d]           = std::clamp(step[d], -room, room);
            }
        points.mass[p] /= n;
        if (points.edge[along] != nullptr)
          points.edge[along][p] /= n;
        if (points.has_domains())
          for (int k = 0; k < dim; ++k) // a row of a box, or the edge
            points.domain[points.has_boxes() ? along * dim + k :
                                               k * dim + along][p] /= n;
        const auto place = [&](const std::size_t q, const unsigned int part) {
          const dealii::Tensor<1, dim> way = (part - end) * step;
          cell[q]                          = cell_at(q, way);
          shift_point(q, way);
          for (int d = 0; d < dim; ++d)
            points.velocity[d][q] += division.rate * way[d];
          energy += 0.5 * points.mass[q] * division.rate * division.rate *
                    way.norm_square();
        };
        const unsigned int own = (n - 1) / 2; // keeps the number
        for (unsigned int part = 0; part < n; ++part)
          if (part != own)
            {
              move(p, last);
              ids[last] = next_id++;
              place(last++, part);
            }
        place(p, own);
      }
    ++n_reorderings;
    return energy;
  }



  template <int dim>
  void
  MaterialPoints<dim>::join(const std::vector<std::vector<std::size_t>> &sets)
  {
    const PointView<dim> points = view();
    double *const        mass   = points.mass;
    for (const auto &set : sets)
      {
        double all = 0;
        for (const std::size_t p : set)
          all += mass[p];
        for (auto &field : fields)
          {
            if (field.data() == mass)
              continue;
            // Differences from the first: a mean of equal numbers is that one.
            double sum = 0;
            for (const std::size_t p : set)
              sum += mass[p] * (field[p] - field[set[0]]);
            field[set[0]] += sum / all;
          }
        mass[set[0]] = all;
        if (points.reach != nullptr)
          points.reach[set[0]] *= 2;
        for (double *const component : points.edge)
          if (component != nullptr)
            component[set[0]] *= 2;
        --size_classes[set[0]];
        for (std::size_t i = 1; i < set.size(); ++i)
          cell[set[i]] = invalid_cell;
      }
    remove_lost();
  }



  template void
  MaterialPoints<2>::split(const std::vector<std::size_t> &,
                           const std::array<double, 2> &,
                           std::uint64_t);
  template void
  MaterialPoints<3>::split(const std::vector<std::size_t> &,
                           const std::array<double, 3> &,
                           std::uint64_t);
  template double
  MaterialPoints<2>::divide(const std::vector<Division<2>> &, std::uint64_t);
  template double
  MaterialPoints<3>::divide(const std::vector<Division<3>> &, std::uint64_t);
  template void
  MaterialPoints<2>::join(const std::vector<std::vector<std::size_t>> &);
  template void
  MaterialPoints<3>::join(const std::vector<std::vector<std::size_t>> &);
} // namespace limber
