// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/points/material_points.h>

#include <algorithm>
#include <unordered_map>

/** @file Splitting and joining of points (adaptivity). */
namespace limber
{
  // Half edges of the material of a point, as columns: of its domain, along the
  // axes or its own edges, or of its share of the cell that it was made for.
  template <int dim>
  dealii::Tensor<2, dim>
  MaterialPoints<dim>::half_edges(const PointView<dim>          &points,
                                  const std::size_t              p,
                                  const std::array<double, dim> &spacing) const
  {
    dealii::Tensor<2, dim> result;
    for (int d = 0; d < dim; ++d)
      if (points.has_domains())
        {
          for (int k = 0; k < dim; ++k)
            if (const double *const component = points.domain[d * dim + k])
              result[d][k] = component[p];
          if (points.has_boxes()) // with the length of the row, see half_box()
            {
              const double half = result[d].norm();
              result[d]         = 0;
              result[d][d]      = half;
            }
        }
      else
        result[d][d] = 0.5 * spacing[d] / (1u << size_classes[p]);
    return result;
  }



  // How far a part may be shifted along an axis within the cell; not onto its
  // face, where round-off would decide which cell a point is in.
  template <int dim>
  double
  MaterialPoints<dim>::room_in_cell(const PointView<dim> &points,
                                    const std::size_t     p,
                                    const unsigned int    axis) const
  {
    constexpr double         share    = 0.9;
    const CellGeometry<dim> &geometry = grid.geometry[cell[p]];
    const double below = points.place[axis][p] - geometry.origin[axis];
    const double above = 1 / geometry.inverse_edge[axis] - below;
    return std::max(0., share * std::min(below, above));
  }



  namespace
  {
    /**
     * Gradient dX/dx of initial positions by present ones, for the initial
     * positions of the parts of a point: least squares over the points of a
     * cell or, if they are in one row, of the cells around it. If the material
     * is mixed, or there are too few points, the unit tensor, as if each part
     * had been displaced as the whole.
     */
    template <int dim>
    class InitialPlaces
    {
    public:
      InitialPlaces(const BackgroundGrid<dim> &grid,
                    const MaterialPoints<dim> &points)
        : grid(grid)
        , view(points.view())
      {
        initial.reserve(view.size);
        for (std::size_t p = 0; p < view.size; ++p)
          {
            initial.push_back(points.reference_position(p));
            by_cell[view.cell[p]].push_back(p);
          }
      }

      dealii::Tensor<2, dim>
      gradient(const std::uint32_t cell)
      {
        const auto known = gradients.find(cell);
        if (known != gradients.end())
          return known->second;
        dealii::Tensor<2, dim> result;
        if (!fit(cell, by_cell[cell], result) &&
            !fit(cell, around(cell), result))
          result = dealii::unit_symmetric_tensor<dim>();
        return gradients[cell] = result;
      }

    private:
      using Set = std::vector<std::size_t>;

      Set
      around(const std::uint32_t cell)
      {
        const CellGeometry<dim> &geometry = grid.geometry[cell];
        std::vector<std::uint32_t>
            seen; // a larger one is in several directions
        Set result;
        for (unsigned int n = 0; n < (dim == 2 ? 9 : 27); ++n)
          {
            std::array<double, dim> x;
            for (int d = 0, k = n; d < dim; ++d, k /= 3)
              x[d] =
                geometry.origin[d] + (k % 3 - 0.5) / geometry.inverse_edge[d];
            const std::uint32_t other = grid.bins.cell_at(x);
            if (other == invalid_cell ||
                std::find(seen.begin(), seen.end(), other) != seen.end())
              continue;
            seen.push_back(other);
            const Set &theirs = by_cell[other];
            result.insert(result.end(), theirs.begin(), theirs.end());
          }
        return result;
      }

      /**
       * Linear fit; whether the points spread over a tenth of the cell in every
       * direction and the fit leaves less than a fifth of the spread of initial
       * positions.
       */
      bool
      fit(const std::uint32_t     cell,
          const Set              &set,
          dealii::Tensor<2, dim> &result) const
      {
        constexpr double       least_spread = 0.1, largest_rest = 0.04;
        dealii::Tensor<1, dim> x, X;
        double                 mass = 0;
        for (const std::size_t p : set)
          {
            mass += view.mass[p];
            for (int d = 0; d < dim; ++d)
              {
                x[d] += view.mass[p] * view.position[d][p];
                X[d] += view.mass[p] * initial[p][d];
              }
          }
        if (!(mass > 0))
          return false;
        x /= mass;
        X /= mass;
        dealii::Tensor<2, dim> spread, common;
        double                 whole = 0;
        for (const std::size_t p : set)
          {
            dealii::Tensor<1, dim> from, initially;
            for (int d = 0; d < dim; ++d)
              {
                from[d]      = view.position[d][p] - x[d];
                initially[d] = initial[p][d] - X[d];
              }
            spread += view.mass[p] / mass * outer_product(from, from);
            common += view.mass[p] / mass * outer_product(initially, from);
            whole += view.mass[p] / mass * initially.norm_square();
          }
        double edges = 1;
        for (int d = 0; d < dim; ++d)
          edges *= least_spread / grid.geometry[cell].inverse_edge[d];
        if (!(determinant(spread) > edges * edges))
          return false;
        result = common * invert(spread);
        // residual variance of the initial positions
        const double rest = whole - scalar_product(result, common);
        return rest < largest_rest * whole;
      }

      const BackgroundGrid<dim>             &grid;
      const PointView<dim>                   view;
      std::vector<dealii::Point<dim>>        initial; // by point, m
      std::unordered_map<std::uint32_t, Set> by_cell;
      std::unordered_map<std::uint32_t, dealii::Tensor<2, dim>> gradients;
    };
  } // namespace



  // Shift the place of a point (PointView::place) within its cell. The other
  // one of its two positions, if it has two, follows by F or its inverse.
  template <int dim>
  void
  MaterialPoints<dim>::shift_point(const PointView<dim>         &points,
                                   const std::size_t             p,
                                   const dealii::Tensor<1, dim> &way,
                                   const dealii::Tensor<2, dim> &initial)
  {
    for (int d = 0; d < dim; ++d)
      points.place[d][p] += way[d];
    if (layout.initial_frame)
      for (int d = 0; d < dim; ++d)
        for (int e = 0; e < dim; ++e)
          points.position[d][p] += points.deformation[d * dim + e][p] * way[e];
    else if (layout.reference)
      for (int d = 0; d < dim; ++d)
        fields[fields.size() - dim + d][p] += (initial * way)[d];
  }



  // For all points before any of them changes; empty tensors where nobody asks.
  template <int dim>
  std::vector<dealii::Tensor<2, dim>>
  MaterialPoints<dim>::initial_gradients(
    const std::vector<std::size_t> &which) const
  {
    std::vector<dealii::Tensor<2, dim>> result(which.size());
    if (!layout.reference || layout.initial_frame || which.empty())
      return result;
    InitialPlaces<dim> places(grid, *this);
    for (std::size_t i = 0; i < which.size(); ++i)
      result[i] = places.gradient(cell[which[i]]);
    return result;
  }



  namespace
  {
    /**
     * Shorten the @p steps (columns) between the parts of a surface point along
     * the normal such that the outermost part, @p end steps away, moves by at
     * most 0.75 of the distance to the surface.
     */
    template <int dim>
    void
    keep_inside(const double                  reach,
                const dealii::Tensor<1, dim> &normal,
                const double                  end,
                dealii::Tensor<2, dim>       &steps)
    {
      constexpr double             share    = 0.75; // of the way to the surface
      const dealii::Tensor<1, dim> across   = normal * steps;
      double                       farthest = 0;
      for (int k = 0; k < dim; ++k)
        farthest += std::abs(end * across[k]);
      if (farthest > share * reach)
        steps -= (1 - share * reach / farthest) *
                 dealii::outer_product(normal, across);
    }



    /** The normal of a surface at the place of a point: in the initial frame
     * it is that before the deformation, along F^T n. */
    template <int dim>
    dealii::Tensor<1, dim>
    normal_at_place(const PointView<dim>         &points,
                    const std::size_t             p,
                    const dealii::Tensor<1, dim> &normal)
    {
      if (!points.in_initial_frame() || normal.norm() == 0)
        return normal;
      dealii::Tensor<1, dim> result;
      for (int d = 0; d < dim; ++d)
        for (int e = 0; e < dim; ++e)
          result[e] += points.deformation[d * dim + e][p] * normal[d];
      return result / result.norm();
    }
  } // namespace



  // Parts are shifted symmetrically: the centre of mass is conserved, and so
  // are sums of anything multilinear within the cell.
  template <int dim>
  void
  MaterialPoints<dim>::split(const std::vector<std::size_t>            &which,
                             const unsigned int                         parts,
                             const std::array<double, dim>             &spacing,
                             std::uint64_t                              next_id,
                             const std::vector<dealii::Tensor<1, dim>> &normals)
  {
    const unsigned int n_children = dealii::Utilities::fixed_power<dim>(parts);
    const unsigned int own        = parts == 2 ? 0 : n_children / 2;
    const double       end        = 0.5 * (parts - 1); // in steps
    const auto         initial    = initial_gradients(which);
    std::size_t        last       = size();
    resize(last + which.size() * (n_children - 1));
    const PointView<dim> points = view();
    for (std::size_t i = 0; i < which.size(); ++i)
      {
        const std::size_t p = which[i];
        // column k: from one child to the next along edge k
        dealii::Tensor<2, dim> steps =
          2. / parts * half_edges(points, p, spacing);
        const auto way_to = [&](const unsigned int child) {
          dealii::Tensor<1, dim> way;
          for (int k = 0, digits = child; k < dim; ++k, digits /= parts)
            for (int d = 0; d < dim; ++d)
              way[d] += (digits % parts - end) * steps[d][k];
          return way;
        };
        const auto cell_at = [&](const dealii::Tensor<1, dim> &way) {
          std::array<double, dim> x;
          for (int d = 0; d < dim; ++d)
            x[d] = points.place[d][p] + way[d];
          return grid.bins.cell_at(x);
        };
        const auto all_have_cells = [&]() {
          for (unsigned int child = 0; child < n_children; ++child)
            if (cell_at(way_to(child)) == invalid_cell)
              return false;
          return true;
        };
        // Domains of children fill that of the point: where they overlap, they
        // leave gaps elsewhere, and a body under stress creeps.
        const bool may_leave_cell = points.has_domains() && all_have_cells();
        for (int d = 0; d < dim && !may_leave_cell; ++d)
          {
            double all = 0;
            for (int k = 0; k < dim; ++k)
              all += std::abs(end * steps[d][k]);
            if (const double room = room_in_cell(points, p, d); all > room)
              steps[d] *= room / all;
          }
        const double reach = points.reach != nullptr ? points.reach[p] : 0;
        const dealii::Tensor<1, dim> normal =
          reach > 0 && !normals.empty() ?
            normal_at_place(points, p, normals[i]) :
            dealii::Tensor<1, dim>();
        keep_inside(reach, normal, end, steps);
        points.mass[p] /= n_children;
        for (double *const component : points.domain)
          if (component != nullptr)
            component[p] /= parts;
        for (double *const component : points.edge)
          if (component != nullptr)
            component[p] /= parts;
        ++size_classes[p];
        const auto place = [&](const std::size_t q, const unsigned int child) {
          const dealii::Tensor<1, dim> way = way_to(child);
          if (may_leave_cell)
            cell[q] = cell_at(way);
          shift_point(points, q, way, initial[i]);
          if (reach > 0)
            points.reach[q] =
              normal.norm() > 0 ? reach - normal * way : reach / parts;
        };
        for (unsigned int child = 0; child < n_children; ++child)
          if (child != own)
            {
              move(p, last);
              ids[last] = next_id++;
              place(last++, child);
            }
        place(p, own);
      }
    ++n_reorderings;
  }



  // `reach` is not changed: contact is usually in the stretched direction, and
  // normal to it the material reaches as far as before.
  template <int dim>
  double
  MaterialPoints<dim>::divide(const std::vector<Division<dim>> &which,
                              std::uint64_t                     next_id)
  {
    std::size_t              last = size();
    std::size_t              all  = last;
    std::vector<std::size_t> numbers;
    for (const Division<dim> &division : which)
      {
        all += division.parts - 1;
        numbers.push_back(division.point);
      }
    const auto initial = initial_gradients(numbers);
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
    for (std::size_t i = 0; i < which.size(); ++i)
      {
        const Division<dim>   &division = which[i];
        const std::size_t      p        = division.point;
        const unsigned int     along = division.direction, n = division.parts;
        const double           end  = 0.5 * (n - 1); // in steps
        dealii::Tensor<1, dim> step = 2. / n * division.half_edge;
        // Parts stay clear of the sides of the box and of cells that this rank
        // does not know.
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
          shift_point(points, q, way, initial[i]);
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



  // Distance from the centre of a set to the surface, from its outermost
  // surface point, as if along an axis.
  template <int dim>
  double
  MaterialPoints<dim>::joint_reach(const std::vector<std::size_t> &set) const
  {
    const PointView<dim>   points = view();
    dealii::Tensor<1, dim> middle;
    double                 mass = 0;
    for (const std::size_t p : set)
      {
        mass += points.mass[p];
        for (int d = 0; d < dim; ++d)
          middle[d] += points.mass[p] * points.position[d][p];
      }
    middle /= mass;
    double result = 0;
    for (const std::size_t p : set)
      if (points.reach[p] > 0)
        {
          double way = 0;
          for (int d = 0; d < dim; ++d)
            way = std::max(way, std::abs(points.position[d][p] - middle[d]));
          const double reach = points.reach[p] + way;
          result             = result > 0 ? std::min(result, reach) : reach;
        }
    return result;
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
        const double reach = points.reach != nullptr ? joint_reach(set) : 0;
        for (auto &field : fields)
          {
            if (field.data() == mass)
              continue;
            // Differences from the first one: exact for equal numbers.
            double sum = 0;
            for (const std::size_t p : set)
              sum += mass[p] * (field[p] - field[set[0]]);
            field[set[0]] += sum / all;
          }
        mass[set[0]] = all;
        if (points.reach != nullptr)
          points.reach[set[0]] = reach;
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
                           const unsigned int,
                           const std::array<double, 2> &,
                           std::uint64_t,
                           const std::vector<dealii::Tensor<1, 2>> &);
  template void
  MaterialPoints<3>::split(const std::vector<std::size_t> &,
                           const unsigned int,
                           const std::array<double, 3> &,
                           std::uint64_t,
                           const std::vector<dealii::Tensor<1, 3>> &);
  template double
  MaterialPoints<2>::divide(const std::vector<Division<2>> &, std::uint64_t);
  template double
  MaterialPoints<3>::divide(const std::vector<Division<3>> &, std::uint64_t);
  template void
  MaterialPoints<2>::join(const std::vector<std::vector<std::size_t>> &);
  template void
  MaterialPoints<3>::join(const std::vector<std::vector<std::size_t>> &);
} // namespace limber
