// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/point_support.h>
#include <limber/time/follower_loads.h>
#include <limber/time/point_deformation.h>
#include <limber/time/surface_closure.h>

#include <algorithm>

namespace limber
{
  template <int dim>
  bool
  FollowerLoads<dim>::any() const
  {
    return has_pressures() || has_body_force();
  }



  template <int dim>
  bool
  FollowerLoads<dim>::has_pressures() const
  {
    const auto &faces = parts.problem.loads.faces;
    return std::any_of(faces.begin(), faces.end(), [](const auto &load) {
      return load.is_pressure;
    });
  }



  template <int dim>
  bool
  FollowerLoads<dim>::has_body_force() const
  {
    const Loads<dim> &loads = parts.problem.loads;
    return loads.body_force_varies() && !loads.body_force_at_start;
  }



  // The support of a point in the nodes of its cell, numbers_in().
  template <int dim>
  Support<dim>
  FollowerLoads<dim>::at_free_nodes(Support<dim>        at,
                                    const std::uint32_t cell) const
  {
    const auto &corners = nodes.hanging_corners(nodes.number_of(cell));
    corners.condense(at.value.data(), 1);
    corners.condense(at.gradient.front().data(), dim);
    return at;
  }



  template <int dim>
  void
  FollowerLoads<dim>::find()
  {
    pieces.clear();
    for (LoadedFace<dim> &face : loads.loaded_faces())
      {
        if (!face.load.is_pressure)
          continue;
        const PointView<dim> points = face.body.points.view();
        for (const auto &[p, former] : face.here())
          {
            const Support<dim> at =
              at_free_nodes(support_of_point<dim>(parts.grid.view(), points, p),
                            points.cell[p]);
            const dealii::Tensor<2, dim> pull   = pull_back(points, p);
            const auto                   slopes = [&](const auto &vector) {
              const dealii::Tensor<1, dim> pulled = pull * vector;
              std::vector<double>          result(at.n);
              for (int i = 0; i < at.n; ++i)
                for (int d = 0; d < dim; ++d)
                  result[i] += at.gradient[i][d] * pulled[d];
              return result;
            };
            Piece piece;
            piece.face         = &face;
            piece.edges        = former->edges;
            const auto numbers = nodes.numbers_in(points.cell[p]);
            piece.numbers.assign(numbers.begin(), numbers.end());
            piece.moving = slopes(former->arm);
            for (int i = 0; i < at.n; ++i)
              piece.moving[i] += at.value[i];
            const Support<dim> of_force = at_free_nodes(
              support_of_piece(parts.grid.view(), points, p, *former),
              points.cell[p]);
            piece.weights.assign(of_force.value.begin(),
                                 of_force.value.begin() + at.n);
            for (unsigned int e = 0; e < dim - 1; ++e)
              piece.slopes[e] = slopes(former->edges[e]);
            for (int d = 0; d < dim; ++d)
              piece.place[d] = points.position[d][p] + former->arm[d];
            pieces.push_back(std::move(piece));
          }
      }
  }



  // Edges and position (in the member arm) of a piece after the displacement
  template <int dim>
  FacePiece<dim>
  FollowerLoads<dim>::moved(const Piece               &piece,
                            const std::vector<double> &displacement) const
  {
    FacePiece<dim> result;
    result.arm   = piece.place;
    result.edges = piece.edges;
    for (std::size_t i = 0; i < piece.numbers.size(); ++i)
      for (int d = 0; d < dim; ++d)
        {
          const double u =
            displacement[std::size_t(piece.numbers[i]) * dim + d];
          result.arm[d] += piece.moving[i] * u;
          for (unsigned int e = 0; e < dim - 1; ++e)
            result.edges[e][d] += piece.slopes[e][i] * u;
        }
    return result;
  }



  template <int dim>
  double
  FollowerLoads<dim>::pressure(const Piece          &piece,
                               const FacePiece<dim> &at) const
  {
    return factor *
           piece.face->load.formula.value(dealii::Point<dim>(at.arm), time);
  }



  template <int dim>
  void
  FollowerLoads<dim>::add_forces(const std::vector<double> &displacement,
                                 std::vector<double>       &forces) const
  {
    for (const LoadedFace<dim> &face : loads.loaded_faces())
      if (face.load.is_pressure)
        add_pressures(face, displacement, forces);
    for_each_point(displacement,
                   [&](const dealii::Point<dim> &place,
                       const double              mass,
                       const Support<dim>       &at,
                       const Numbers             numbers) {
                     const dealii::Tensor<1, dim> force =
                       factor * mass *
                       parts.problem.loads.body_force->vector(place, time);
                     for (int i = 0; i < at.n; ++i)
                       for (int d = 0; d < dim; ++d)
                         forces[std::size_t(numbers[i]) * dim + d] +=
                           at.value[i] * force[d];
                   });
  }



  template <int dim>
  void
  FollowerLoads<dim>::add_pressures(const LoadedFace<dim>     &face,
                                    const std::vector<double> &displacement,
                                    std::vector<double>       &forces) const
  {
    std::vector<std::pair<const Piece *, FacePiece<dim>>> of_face;
    for (const Piece &piece : pieces)
      if (piece.face == &face)
        of_face.emplace_back(&piece, moved(piece, displacement));

    SurfaceClosure<dim> surface(face.centre_at_start());
    const bool          is_closed = face.is_closed();
    if (is_closed)
      {
        for (const auto &[piece, now] : of_face)
          surface.add(dealii::Point<dim>(now.arm), now.area_vector());
        surface.finish(parts.grid.communicator);
      }
    for (const auto &[piece, now] : of_face)
      {
        dealii::Tensor<1, dim> area = now.area_vector();
        if (is_closed)
          area += surface.change(dealii::Point<dim>(now.arm), area);
        const dealii::Tensor<1, dim> force = -pressure(*piece, now) * area;
        for (std::size_t i = 0; i < piece->numbers.size(); ++i)
          for (int d = 0; d < dim; ++d)
            forces[std::size_t(piece->numbers[i]) * dim + d] +=
              piece->weights[i] * force[d];
      }
  }



  // Call work(place, mass, support, numbers of nodes) for the points of this
  // rank, at their places after the displacement, if there is a body force.
  template <int dim>
  template <class Work>
  void
  FollowerLoads<dim>::for_each_point(const std::vector<double> &displacement,
                                     const Work                &work) const
  {
    if (!has_body_force())
      return;
    for (const auto &body : parts.bodies)
      {
        const PointView<dim> points = body->points.view();
        for (std::size_t p = 0; p < points.size; ++p)
          {
            const Support<dim> at =
              at_free_nodes(support_of_point<dim>(parts.grid.view(), points, p),
                            points.cell[p]);
            const auto         numbers = nodes.numbers_in(points.cell[p]);
            dealii::Point<dim> place;
            for (int d = 0; d < dim; ++d)
              {
                place[d] = points.position[d][p];
                for (int i = 0; i < at.n; ++i)
                  place[d] += at.value[i] *
                              displacement[std::size_t(numbers[i]) * dim + d];
              }
            work(place, points.mass[p], at, numbers);
          }
      }
  }



  template <int dim>
  void
  FollowerLoads<dim>::add_tangent(const std::vector<double> &displacement,
                                  const bool                 symmetric,
                                  const Add                 &add) const
  {
    add_tangent_of_pressures(displacement, symmetric, add);
    add_tangent_of_body_force(displacement, symmetric, add);
  }



  // The derivative of the formula by central differences.
  template <int dim>
  void
  FollowerLoads<dim>::add_tangent_of_body_force(
    const std::vector<double> &displacement,
    const bool                 symmetric,
    const Add                 &add) const
  {
    const double        h = 1e-2 * parts.grid.smallest_edge;
    std::vector<double> block;
    for_each_point(displacement,
                   [&](const dealii::Point<dim> &place,
                       const double              mass,
                       const Support<dim>       &at,
                       const Numbers             numbers) {
                     dealii::Tensor<2, dim> slope; // of minus the force
                     for (int e = 0; e < dim; ++e)
                       {
                         dealii::Tensor<1, dim> way;
                         way[e]            = h;
                         const auto &force = *parts.problem.loads.body_force;
                         const dealii::Tensor<1, dim> change =
                           force.vector(place - way, time) -
                           force.vector(place + way, time);
                         for (int d = 0; d < dim; ++d)
                           slope[d][e] = factor * mass / (2 * h) * change[d];
                       }
                     if (symmetric)
                       slope = dealii::Tensor<2, dim>(symmetrize(slope));
                     const std::size_t n = std::size_t(at.n) * dim;
                     block.resize(n * n);
                     for (std::size_t k = 0; k < n; ++k)
                       for (std::size_t l = 0; l < n; ++l)
                         block[k * n + l] = at.value[k / dim] *
                                            at.value[l / dim] *
                                            slope[k % dim][l % dim];
                     add(numbers.data(), at.n, block.data());
                   });
  }



  template <int dim>
  void
  FollowerLoads<dim>::add_tangent_of_pressures(
    const std::vector<double> &displacement,
    const bool                 symmetric,
    const Add                 &add) const
  {
    std::vector<double> block;
    for (const Piece &piece : pieces)
      {
        const FacePiece<dim> now = moved(piece, displacement);
        const double         p   = pressure(piece, now);
        // n da is linear in each edge: its change with component c of one
        std::array<dealii::Tensor<2, dim>, dim - 1> of_edge; // [c] is a vector
        for (unsigned int e = 0; e < dim - 1; ++e)
          for (int c = 0; c < dim; ++c)
            {
              FacePiece<dim> unit = now;
              unit.edges[e]       = 0.;
              unit.edges[e][c]    = 1;
              of_edge[e][c]       = unit.area_vector();
            }
        const std::size_t n = piece.numbers.size() * dim;
        block.assign(n * n, 0.);
        for (std::size_t k = 0; k < n; ++k)
          for (std::size_t l = 0; l < n; ++l)
            for (unsigned int e = 0; e < dim - 1; ++e)
              {
                const double value = p * piece.weights[k / dim] *
                                     piece.slopes[e][l / dim] *
                                     of_edge[e][l % dim][k % dim];
                if (symmetric)
                  {
                    block[k * n + l] += 0.5 * value;
                    block[l * n + k] += 0.5 * value;
                  }
                else
                  block[k * n + l] += value;
              }
        add(piece.numbers.data(), piece.numbers.size(), block.data());
      }
  }



  template class FollowerLoads<2>;
  template class FollowerLoads<3>;
} // namespace limber
