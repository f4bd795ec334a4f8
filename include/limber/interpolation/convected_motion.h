// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_convected_motion_h
#define limber_interpolation_convected_motion_h

#include <limber/interpolation/convected_pack.h>

/**
 * @file G2P of velocities, motion, and convection of the domains of points with
 * domains, a pack at a time.
 */
namespace limber
{
  /** Results of G2P, by lanes. */
  template <int dim>
  struct VelocityFindings
  {
    PointPack<dim> speed_squared{}; // the largest, m^2/s^2
    PointPack<dim> removed{}; // kinetic energy that FLIP would have kept, J
  };



  /**
   * G2P for a pack (FLIP/PIC blend): v = alpha (v + sum N dv) + (1 - alpha) sum
   * N v with alpha = @p flip_share, from the means of dv and v (m/s).
   */
  template <int dim, class Lanes>
  __attribute__((always_inline)) inline void
  take_velocity(const PointView<dim>  &points,
                const Lanes           &lanes,
                const PointPack<dim>  *increment,
                const PointPack<dim>  *new_velocity,
                const double           flip_share,
                VelocityFindings<dim> &found)
  {
    using Number = PointPack<dim>;
    Number squared{}, kept_squared{};
    for (int d = 0; d < dim; ++d)
      {
        const Number flip = lanes.load(points.velocity[d]) + increment[d];
        const Number velocity =
          flip + (1 - flip_share) * (new_velocity[d] - flip);
        lanes.store(velocity, points.velocity[d]);
        kept_squared += flip * flip;
        squared += velocity * velocity;
      }
    found.speed_squared =
      larger(found.speed_squared, lanes.only_active(squared));
    found.removed += 0.5 * lanes.only_active(lanes.load(points.mass)) *
                     (kept_squared - squared);
  }



  /** The grid velocity at a position that is clamped to a cell, m/s. */
  template <int dim>
  inline std::array<double, dim>
  moving_velocity(const GridView<dim>           &grid,
                  const CellGeometry<dim>       &cell,
                  const std::array<double, dim> &x)
  {
    constexpr double        n_corners = 1 << dim;
    const auto              weights   = ConvectedDomain<dim>::weights(cell, x);
    std::array<double, dim> v{};
    for (int i = 0; i < Linear<dim>::n_nodes; ++i)
      for (int d = 0; d < dim; ++d)
        v[d] += (n_corners * weights[i]) *
                grid.nodes[cell.node[i] + NodeLayout<dim>::velocity + d];
    return v;
  }



  /**
   * CPDI2: move the corners of the domain of a point over @p step (s), each
   * with the grid velocity there, and return the displacement of the centroid,
   * m. A restricted domain (domain_shape.h) is convected by the mean gradient
   * instead, as in CPDI.
   */
  template <int dim>
  __attribute__((noinline)) std::array<double, dim>
  carry_corners(const PointView<dim> &points,
                const GridView<dim>  &grid,
                const std::uint32_t   cell,
                const std::size_t     p,
                const double          step)
  {
    using Shape = Hexahedron<dim, double>;
    const DomainShape<dim>  domain(points, grid, cell, p);
    std::array<double, dim> shift;
    Shape                   shape;
    if (usually(domain.is_whole))
      {
        std::array<std::array<double, dim>, Shape::n_corners> corners;
        std::array<double, dim>                               mean{};
        for (int c = 0; c < Shape::n_corners; ++c)
          {
            const auto x = domain.corner(c);
            const auto v =
              moving_velocity<dim>(grid,
                                   grid.cells[domain.cell_at(grid, x)],
                                   x);
            for (int d = 0; d < dim; ++d)
              {
                corners[c][d] = x[d] - points.position[d][p] + step * v[d];
                mean[d] += domain.share(c) / Shape::n_corners * step * v[d];
              }
          }
        const auto middle   = shape.set_corners(corners);
        const auto centroid = shape.find_centroid();
        for (int d = 0; d < dim; ++d)
          shift[d] = shape.smallest > 0 ? middle[d] + centroid[d] :
                                          mean[d]; // turned out
      }
    else
      {
        using Window = RecordWindow<dim, NodeLayout<dim>::velocity, dim>;
        const FieldsOnDomain<dim, Window> fields(
          ConvectedDomain<dim>(points, grid, cell, p), grid);
        const auto inverse = domain.inverse();
        for (int d = 0; d < dim; ++d)
          {
            const auto carried = [&](const auto &component) {
              double result = component(d);
              for (int e = 0; e < dim; ++e)
                result +=
                  step *
                  fields.slope(inverse, NodeLayout<dim>::velocity + d, e) *
                  component(e);
              return result;
            };
            shift[d] = step * fields.value(NodeLayout<dim>::velocity + d);
            for (int k = 0; k < dim; ++k)
              shape.edges[d][k] = carried(
                [&](const int e) { return points.domain[e * dim + k][p]; });
            for (int t = 0; t < Shape::n_twists; ++t)
              shape.twists[t][d] = carried([&](const int e) {
                return points.domain[dim * (dim + t) + e][p];
              });
          }
      }
    for (int d = 0; d < dim; ++d)
      {
        for (int k = 0; k < dim; ++k)
          points.domain[d * dim + k][p] = shape.edges[d][k];
        for (int t = 0; t < Shape::n_twists; ++t)
          points.domain[dim * (dim + t) + d][p] = shape.twists[t][d];
      }
    return shift;
  }



  /** The same for a pack, one by one: corners in any cells. */
  template <int dim>
  __attribute__((noinline, cold)) std::array<PointPack<dim>, dim>
  carry_corners_one_by_one(const ConvectedPack<dim> &domains,
                           const std::size_t         first,
                           const int                 n,
                           const double              step)
  {
    std::array<PointPack<dim>, dim> result;
    set_zero(result);
    for (int i = 0; i < n; ++i)
      {
        const auto shift = carry_corners<dim>(
          domains.points, domains.grid, domains.cell, first + i, step);
        for (int d = 0; d < dim; ++d)
          result[d][i] = shift[d];
      }
    return result;
  }



  /**
   * The same for a pack, with corner velocities in @p velocity; domains that
   * become inverted move by the mean velocity.
   */
  template <int dim, class Lanes>
  __attribute__((noinline)) std::array<PointPack<dim>, dim>
  carry_hexahedra(const ConvectedPack<dim> &domains,
                  const Lanes              &lanes,
                  const FieldOnPack<dim>   &velocity,
                  const double              step)
  {
    if (rarely(!domains.has_corners()))
      return carry_corners_one_by_one<dim>(domains, lanes.first, lanes.n, step);
    using Shape = Hexahedron<dim, PointPack<dim>>;
    Shape      shape;
    const auto middle =
      shape.set_corners(domains.moved_corners(velocity, step));
    const auto                      centroid = shape.find_centroid();
    std::array<PointPack<dim>, dim> shift;
    for (int d = 0; d < dim; ++d)
      {
        shift[d] =
          lanes.only_active(shape.smallest > 0. ? middle[d] + centroid[d] :
                                                  step * velocity.value[d]);
        for (int k = 0; k < dim; ++k)
          lanes.store(shape.edges[d][k], domains.points.domain[d * dim + k]);
        for (int t = 0; t < Shape::n_twists; ++t)
          lanes.store(shape.twists[t][d],
                      domains.points.domain[dim * (dim + t) + d]);
      }
    return shift;
  }



  /**
   * Convect the domains of a pack (CPDI): R += @p step grad v R, step in s,
   * with given R^-1. Boxes of fixed size do not change.
   */
  template <int dim, class Lanes>
  __attribute__((always_inline)) inline void
  carry_domains(const ConvectedPack<dim>               &domains,
                const Lanes                            &lanes,
                const SmallMatrix<dim, PointPack<dim>> &inverse,
                const FieldOnPack<dim>                 &velocity,
                const double                            step)
  {
    using Number                 = PointPack<dim>;
    const PointView<dim> &points = domains.points;
    if (points.domain_form == DomainForm::box)
      return;
    // R as stored, which may be larger than the restricted one.
    SmallMatrix<dim, Number> R, slope;
#pragma GCC unroll 3
    for (int d = 0; d < dim; ++d)
#pragma GCC unroll 3
      for (int e = 0; e < dim; ++e)
        {
          R[d][e]     = lanes.load(points.domain[d * dim + e]);
          slope[d][e] = step * velocity.slope(inverse, d, e);
        }
#pragma GCC unroll 3
    for (int d = 0; d < dim; ++d)
#pragma GCC unroll 3
      for (int k = 0; k < dim; ++k)
        {
          Number edge = R[d][k];
#pragma GCC unroll 3
          for (int e = 0; e < dim; ++e)
            edge += slope[d][e] * R[e][k];
          lanes.store(edge, points.domain[d * dim + k]);
        }
  }



  /** Whether all cells around a cell are occupied. */
  template <int dim>
  inline bool
  is_surrounded(const GridView<dim> &grid, const std::uint32_t cell)
  {
    const BinView<dim> &bins = grid.bins;
    if (!bins.one_per_cell)
      return false;
    std::array<std::int64_t, 3> begin{}, end{{1, 1, 1}}; // bins
    for (int d = 0; d < dim; ++d)
      {
        const auto bin = static_cast<std::int64_t>(
          (grid.cells[cell].origin[d] - bins.lower[d]) * bins.inverse_edge[d] +
          0.5);
        begin[d] = std::max<std::int64_t>(bin - 1, 0);
        end[d]   = std::min(bin + 2, bins.n[d]);
      }
    bool result = true;
    for (std::int64_t k = begin[2]; k < end[2]; ++k)
      for (std::int64_t j = begin[1]; j < end[1]; ++j)
        {
          const std::int64_t row = (k * bins.n[1] + j) * bins.n[0];
          for (std::int64_t i = begin[0]; i < end[0]; ++i)
            {
              const std::uint32_t there = bins.table[row + i];
              result &= there != invalid_cell && grid.occupied[there];
            }
        }
    return result;
  }



  /**
   * Mark the cells as occupied that corners of the points of a pack are in now.
   * The points were in @p cell.
   */
  template <int dim, class Lanes>
  __attribute__((always_inline)) inline void
  enter_corners(const PointView<dim> &points,
                const GridView<dim>  &grid,
                const std::uint32_t   cell,
                const Lanes          &lanes)
  {
    using Number                      = PointPack<dim>;
    const CellGeometry<dim> &geometry = grid.cells[cell];
    auto                     inside = Number{} == Number{}, near = inside;
#pragma GCC unroll 3
    for (int d = 0; d < dim; ++d)
      {
        const auto load = [&](const double *const array)
          __attribute__((always_inline))
        {
          return lanes.load(array);
        };
        Number half{};
        if (points.has_boxes())
          half = half_box<dim>(points, d, load);
        else
#pragma GCC unroll 3
          for (int k = 0; k < dim; ++k)
            half += magnitude(load(points.domain[d * dim + k]));
        if (rarely(points.domain_form == DomainForm::hexahedron))
          {
            for (unsigned int t = 0; t < n_twists(dim); ++t)
              half += magnitude(load(points.domain[dim * (dim + t) + d]));
            half *= 2.; // x_0 is at most that far from the centroid
          }
        half *= geometry.inverse_edge[d];
        const Number xi =
          (lanes.load(points.position[d]) - geometry.origin[d]) *
          geometry.inverse_edge[d];
        inside &= (xi >= half) & (xi + half <= 1.);
        near &= (xi + 1. >= half) & (xi + half <= 2.);
      }
    if (all(inside) || (usually(all(near)) && is_surrounded(grid, cell)))
      return;
    enter_corners_one_by_one(points, grid, lanes.first, lanes.first + lanes.n);
  }



  /**
   * Move the points of a pack with the grid @p velocity over @p step (s), and
   * update their domains, with given R^-1. Returns the displacement over the
   * edge of their cell.
   */
  template <int dim, class Lanes>
  __attribute__((always_inline)) inline PointPack<dim>
  move_domains(const ConvectedPack<dim>               &domains,
               const Lanes                            &lanes,
               const SmallMatrix<dim, PointPack<dim>> &inverse,
               const FieldOnPack<dim>                 &velocity,
               const double                            step)
  {
    const PointView<dim>           &points = domains.points;
    const GridView<dim>            &grid   = domains.grid;
    std::array<PointPack<dim>, dim> shift;
    if (rarely(points.domain_form == DomainForm::hexahedron))
      shift = carry_hexahedra<dim>(domains, lanes, velocity, step);
    else
      {
        for (int d = 0; d < dim; ++d)
          shift[d] = lanes.only_active(step * velocity.value[d]);
        carry_domains<dim>(domains, lanes, inverse, velocity, step);
      }
    const auto moved =
      move_points<dim>(points, grid, domains.cell, lanes, shift);
    enter_corners<dim>(points, grid, domains.cell, lanes);
    return moved.displacement;
  }
} // namespace limber

#endif
