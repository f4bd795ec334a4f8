// SPDX-License-Identifier: LGPL-2.1-or-later
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
      using P = Powers<dim, degree>;
      std::array<double, P::n> result{};
      for (std::size_t p = batch.begin; p < batch.end; ++p)
        {
          const auto xi = natural_place(points, cell, p);
          std::array<std::array<double, P::along>, dim> powers;
#pragma GCC unroll 3
          for (int d = 0; d < dim; ++d)
            {
              powers[d][0] = d == 0 ? points.mass[p] * inverse_density : 1;
#pragma GCC unroll 4
              for (int k = 1; k < P::along; ++k)
                powers[d][k] = powers[d][k - 1] * xi[d];
            }
#pragma GCC unroll 64
          for (int i = 0; i < P::n; ++i)
            {
              double product = powers[0][P::of(i, 0)];
#pragma GCC unroll 2
              for (int d = 1; d < dim; ++d)
                product *= powers[d][P::of(i, d)];
              result[i] += product;
            }
        }
      return result;
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



    // Positions of a pack of points; idle lanes repeat the last one.
    template <int dim>
    struct PlacesOfPack
    {
      using Number = Pack<Extents<dim>::lanes>;

      std::array<Number, dim> x;
      Number                  half_edge, reach;

      PlacesOfPack(const PointView<dim> &points,
                   const std::size_t     first,
                   const std::size_t     end,
                   const double          inverse_density)
      {
        for (int k = 0; k < Extents<dim>::lanes; ++k)
          {
            const std::size_t p = std::min(first + k, end - 1);
            for (int d = 0; d < dim; ++d)
              x[d][k] = points.place[d][p];
            half_edge[k] = points.mass[p] * inverse_density;
          }
        double volume = -1, edge = 0;
        for (int k = 0; k < Extents<dim>::lanes; ++k)
          {
            if (half_edge[k] != volume) // usually the same volume as before
              edge = half_edge_of<dim>(volume = half_edge[k]);
            half_edge[k] = edge;
            reach[k]     = reach_of(points, std::min(first + k, end - 1), edge);
          }
      }

      Number
      along(const double *const direction, const double sign) const
      {
        Number result = (sign * direction[0]) * x[0];
        for (int d = 1; d < dim; ++d)
          result += (sign * direction[d]) * x[d];
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
    numbers.assign(n_slots * n, -1e300);
  }



  template <int dim>
  void
  Extents<dim>::add(const PointView<dim> &points,
                    const MeetingBatches &batches,
                    const double *const   directions)
  {
    using Number = Pack<lanes>;
    for (const MeetingBatch *some = batches.begin; some != batches.end; ++some)
      for (std::size_t p = some->batch.begin; p < some->batch.end; p += lanes)
        {
          const PlacesOfPack<dim> places(points,
                                         p,
                                         some->batch.end,
                                         batches.inverse_density);
          for (std::uint32_t c = some->first; c < some->last; ++c)
            {
              const MeetingCorner &corner = batches.corners[c];
              const double *const  direction =
                directions +
                std::size_t(corner.slot / 2) * (n_separations * dim);
              double *const furthest =
                numbers.data() + std::size_t(corner.slot) * n;
              const double sign = sign_of(corner);
              for (int k = 0; k < n_separations; ++k)
                store(larger<Number>(load<Number>(furthest + k * lanes),
                                     places.along(direction + k * dim, sign) +
                                       places.reach),
                      furthest + k * lanes);
            }
        }
  }



  template <int dim>
  void
  Extents<dim>::find_largest()
  {
    for (std::size_t k = 0; k < numbers.size(); k += lanes)
      numbers[k] =
        *std::max_element(numbers.data() + k, numbers.data() + k + lanes);
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
    constexpr int lanes = Extents<dim>::lanes;
    using Number        = Pack<lanes>;
    const auto face_at  = [&](const std::uint32_t c) -> const Faces<dim>  &{
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
    for (std::size_t p = some.batch.begin; p < some.batch.end; p += lanes)
      {
        const PlacesOfPack<dim> places(points,
                                       p,
                                       some.batch.end,
                                       inverse_density);
        Number                  depth = broadcast<Number>(1e300);
        for (std::uint32_t c = some.first; c < some.last; ++c)
          {
            const Faces<dim> &face  = face_at(c);
            const double      other = face.furthest[1 - corners[c].slot % 2];
            depth                   = -larger<Number>(-depth,
                                    places.along(face.normal.data(),
                                                 sign_of(corners[c])) +
                                      other);
          }
        // To the face is the other's reach less half its edge more than the
        // gap and the own reach; and of what is faced, that counts which is
        // less than its reach behind what is nearest. A quarter of an edge of
        // room is half of the way to the next row.
        for (int k = 0; k < lanes && p + k < some.batch.end; ++k)
          {
            const double half_edge = places.half_edge[k];
            if (depth[k] <= stretch * (2 * places.reach[k] + largest_reach) +
                              (turned - 0.5) * half_edge)
              near.push_back(static_cast<std::uint32_t>(p + k));
          }
      }
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
