// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/batch_lanes.h>
#include <limber/interpolation/spline.h>
#include <limber/transfer/meeting_bodies.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  namespace
  {
    // Lanes are components.
    template <int dim>
    using Components = Pack<(dim == 2 ? 2 : 4)>;



    /** Linear functions in the form of SplineFactors of degree 1. */
    struct LinearFactors
    {
      template <class Number>
      __attribute__((always_inline)) static void
      to_nodes(double, double, Number *const a, const int stride)
      {
        a[0] -= a[stride];
      }
    };

    template <int degree>
    using FactorsOf =
      std::conditional_t<degree == 1,
                         LinearFactors,
                         SplineFactors<degree == 1 ? 2 : degree>>;



    template <int dim, int degree>
    struct Powers
    {
      static constexpr int along = degree + 1;
      static constexpr int n = dim == 2 ? along * along : along * along * along;

      static constexpr int
      stride(const int d)
      {
        return d == 0 ? 1 : d == 1 ? along : along * along;
      }

      static constexpr int
      of(const int i, const int d)
      {
        return i / stride(d) % along;
      }
    };



    // Moments sum_p V_p xi^a eta^b zeta^c: functions are polynomials in a cell.
    template <int dim, int degree>
    __attribute__((
      always_inline)) inline std::array<double, Powers<dim, degree>::n>
    moments(const PointView<dim>    &points,
            const CellGeometry<dim> &cell,
            const CellBatch         &batch,
            const double             inverse_density)
    {
      using P      = Powers<dim, degree>;
      using Number = PointPack<dim>;
      std::array<Number, P::n> result;
      set_zero(result);
      for_each_pack<dim>(
        batch, [&](const auto &lanes) __attribute__((always_inline)) {
          const auto xi = lanes.natural(points, cell);
          std::array<std::array<Number, P::along>, dim> powers;
#pragma GCC unroll 3
          for (int d = 0; d < dim; ++d)
            {
              powers[d][0] =
                d == 0 ?
                  lanes.only_active(lanes.load(points.mass)) * inverse_density :
                  broadcast<Number>(1.);
#pragma GCC unroll 4
              for (int k = 1; k < P::along; ++k)
                powers[d][k] = powers[d][k - 1] * xi[d];
            }
#pragma GCC unroll 64
          for (int i = 0; i < P::n; ++i)
            {
              Number product = powers[0][P::of(i, 0)];
#pragma GCC unroll 2
              for (int d = 1; d < dim; ++d)
                product *= powers[d][P::of(i, d)];
              result[i] += product;
            }
        });
      return all_sums(result);
    }



    template <int dim, int degree, class Spline>
    void
    add_gradients(const PointView<dim> &points,
                  const GridView<dim>  &grid,
                  const MeetingBatches &batches,
                  const Spline         &spline,
                  double *const         gradients)
    {
      using P       = Powers<dim, degree>;
      using Factors = FactorsOf<degree>;
      for (const MeetingBatch *some = batches.begin; some != batches.end;
           ++some)
        {
          const CellGeometry<dim>          &cell = grid.cells[some->batch.cell];
          const auto                        m    = moments<dim, degree>(points,
                                              cell,
                                              some->batch,
                                              batches.inverse_density);
          std::array<Components<dim>, P::n> sums;
#pragma GCC unroll 64
          for (int i = 0; i < P::n; ++i)
            {
              sums[i] = Components<dim>{};
#pragma GCC unroll 3
              for (int d = 0; d < dim; ++d)
                if (P::of(i, d) > 0)
                  sums[i][d] =
                    cell.inverse_edge[d] * P::of(i, d) * m[i - P::stride(d)];
            }
          const auto [lower, upper] = spline(some->batch.cell);
#pragma GCC unroll 3
          for (int d = 0; d < dim; ++d)
#pragma GCC unroll 64
            for (int i = 0; i < P::n; ++i)
              if (P::of(i, d) == 0)
                Factors::to_nodes(lower[d], upper[d], &sums[i], P::stride(d));
          for (std::uint32_t c = some->first; c < some->last; ++c)
            {
              const MeetingCorner &corner = batches.corners[c];
              double *const slot = gradients + std::size_t(corner.slot) * dim;
              for (int d = 0; d < dim; ++d)
                slot[d] += corner.share * sums[corner.k][d];
            }
        }
    }



    /** Half the edges of cubes of these volumes. */
    template <int dim, class Number>
    inline Number
    half_edges_of(const Number &volume)
    {
      if constexpr (dim == 2)
        return 0.5 * square_root(volume);
      else
        {
          const Number inverse = inverse_cube_root(volume);
          return 0.5 * volume * (inverse * inverse);
        }
    }



    // Positions of a pack of points.
    template <int dim>
    struct PlacesOfPack
    {
      using Number = PointPack<dim>;

      std::array<Number, dim> x;
      Number                  half_edge, reach;

      template <class Lanes>
      __attribute__((always_inline)) PlacesOfPack(const PointView<dim> &points,
                                                  const Lanes          &lanes,
                                                  const double inverse_density)
        : half_edge(half_edges_of<dim>(
            Number(lanes.load(points.mass) * inverse_density)))
        , reach(half_edge)
      {
        for (int d = 0; d < dim; ++d)
          x[d] = lanes.load(points.place[d]);
        if (points.reach != nullptr)
          {
            const Number of_surface = lanes.load(points.reach);
            reach                   = of_surface > 0. ? of_surface : half_edge;
          }
      }

      __attribute__((always_inline)) Number
      along(const double *const direction) const
      {
        Number result = direction[0] * x[0];
        for (int d = 1; d < dim; ++d)
          result += direction[d] * x[d];
        return result;
      }
    };



    double
    sign_of(const MeetingCorner &corner)
    {
      return corner.slot % 2 == 0 ? 1 : -1;
    }
  } // namespace



  template <int dim>
  void
  add_volume_gradients(const PointView<dim> &points,
                       const GridView<dim>  &grid,
                       const MeetingBatches &batches,
                       double *const         gradients)
  {
    const auto factors_of = [](const auto *const cells) {
      return [cells](const std::uint32_t cell) {
        return std::make_pair(cells[cell].lower, cells[cell].upper);
      };
    };
    if (grid.quadratics != nullptr)
      add_gradients<dim, 2>(
        points, grid, batches, factors_of(grid.quadratics), gradients);
    else if (grid.cubics != nullptr)
      add_gradients<dim, 3>(
        points, grid, batches, factors_of(grid.cubics), gradients);
    else
      add_gradients<dim, 1>(
        points,
        grid,
        batches,
        [](std::uint32_t) {
          return std::pair<std::array<double, dim>, std::array<double, dim>>();
        },
        gradients);
  }



  template <int dim>
  void
  find_directions(const std::size_t   n,
                  const double *const gradients,
                  double *const       directions)
  {
    using Direction           = std::array<double, dim>;
    const auto inverse_length = [](const Direction &vector) {
      double square = 0;
      for (int d = 0; d < dim; ++d)
        square += vector[d] * vector[d];
      return square > 0 ? 1 / std::sqrt(square) : 0.;
    };
    for (std::size_t k = 0; k < n; ++k)
      {
        const double *const g = gradients + k * 2 * dim;
        Direction           of_a, of_b, of_both;
        for (int d = 0; d < dim; ++d)
          {
            of_a[d] = g[d];
            of_b[d] = -g[dim + d];
          }
        const double a = inverse_length(of_a), b = inverse_length(of_b);
        for (int d = 0; d < dim; ++d)
          of_both[d] = (of_a[d] *= a) + (of_b[d] *= b);
        const double both = inverse_length(of_both);
        for (int d = 0; d < dim; ++d)
          {
            double *const result = directions + k * n_separations * dim + d;
            result[0]            = of_a[d];
            result[dim]          = of_b[d];
            result[2 * dim]      = of_both[d] * both;
          }
      }
  }



  template <int dim>
  void
  Extents<dim>::clear(const std::size_t n_slots)
  {
    of_lanes.assign(n_slots * n_separations * pack_width<PointPack<dim>>,
                    -1e300);
  }



  template <int dim>
  void
  Extents<dim>::add(const PointView<dim> &points,
                    const MeetingBatches &batches,
                    const double *const   directions)
  {
    using Number        = PointPack<dim>;
    constexpr int lanes = pack_width<Number>;
    for (const MeetingBatch *some = batches.begin; some != batches.end; ++some)
      for_each_pack<dim>(
        some->batch, [&](const auto &pack) __attribute__((always_inline)) {
          const PlacesOfPack<dim> places(points, pack, batches.inverse_density);
          for (std::uint32_t c = some->first; c < some->last; ++c)
            {
              const MeetingCorner &corner = batches.corners[c];
              const double *const  direction =
                directions +
                std::size_t(corner.slot / 2) * (n_separations * dim);
              double *const furthest =
                of_lanes.data() +
                std::size_t(corner.slot) * (n_separations * lanes);
              const double sign = sign_of(corner);
#pragma GCC unroll 3
              for (int k = 0; k < n_separations; ++k)
                store(larger<Number>(load<Number>(furthest + k * lanes),
                                     sign * places.along(direction + k * dim) +
                                       places.reach),
                      furthest + k * lanes);
            }
        });
  }



  template <int dim>
  void
  Extents<dim>::find_largest()
  {
    using Number = PointPack<dim>;
    largest.resize(of_lanes.size() / pack_width<Number>);
    for (std::size_t k = 0; k < largest.size(); ++k)
      largest[k] =
        maximum(load<Number>(of_lanes.data() + k * pack_width<Number>));
  }



  template <int dim>
  void
  list_near_points(const PointView<dim>       &points,
                   const MeetingBatch         &some,
                   const MeetingCorner *const  corners,
                   const double                inverse_density,
                   const Faces<dim> *const     faces,
                   const double                stretch,
                   const double                largest_reach,
                   std::vector<std::uint32_t> &near)
  {
    using Number       = PointPack<dim>;
    const auto face_at = [&](const std::uint32_t c) -> const Faces<dim> & {
      return faces[corners[c].slot / 2];
    };
    double            difference = 0; // of normals, squared
    const Faces<dim> &first      = face_at(some.first);
    for (std::uint32_t c = some.first + 1; c < some.last; ++c)
      {
        double square = 0;
        for (int d = 0; d < dim; ++d)
          {
            const double of_d = face_at(c).normal[d] - first.normal[d];
            square += of_d * of_d;
          }
        difference = std::max(difference, square);
      }
    // Margin for different normals: material in contact is within four half
    // edges, so their difference changes distances by up to 4 |dn| half edges.
    const double turned = 4 * std::sqrt(difference);
    for_each_pack<dim>(
      some.batch, [&](const auto &pack) __attribute__((always_inline)) {
        const PlacesOfPack<dim> places(points, pack, inverse_density);
        Number                  depth = broadcast<Number>(1e300);
        for (std::uint32_t c = some.first; c < some.last; ++c)
          {
            const Faces<dim> &face  = face_at(c);
            const double      other = face.furthest[1 - corners[c].slot % 2];
            depth                   = -larger<Number>(-depth,
                                    sign_of(corners[c]) *
                                        places.along(face.normal.data()) +
                                      other);
          }
        // To the face is the other's reach less half its edge more than the
        // gap and the own reach; and of what is faced, that counts which is
        // less than its reach behind what is nearest. A quarter of an edge of
        // room is half of the way to the next row.
        const Number furthest = stretch * (2. * places.reach + largest_reach) +
                                (turned - 0.5) * places.half_edge;
        for (int k = 0; k < pack.n; ++k)
          if (depth[k] <= furthest[k])
            near.push_back(static_cast<std::uint32_t>(pack.first + k));
      });
  }



  template void
  find_directions<2>(std::size_t, const double *, double *);
  template void
  find_directions<3>(std::size_t, const double *, double *);
  template struct Extents<2>;
  template struct Extents<3>;
  template void
  add_volume_gradients(const PointView<2> &,
                       const GridView<2> &,
                       const MeetingBatches &,
                       double *);
  template void
  add_volume_gradients(const PointView<3> &,
                       const GridView<3> &,
                       const MeetingBatches &,
                       double *);
  template void
  list_near_points(const PointView<2> &,
                   const MeetingBatch &,
                   const MeetingCorner *,
                   double,
                   const Faces<2> *,
                   double,
                   double,
                   std::vector<std::uint32_t> &);
  template void
  list_near_points(const PointView<3> &,
                   const MeetingBatch &,
                   const MeetingCorner *,
                   double,
                   const Faces<3> *,
                   double,
                   double,
                   std::vector<std::uint32_t> &);
} // namespace limber
