// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/point_support.h>
#include <limber/time/follower_pressure.h>

#include <algorithm>

namespace limber
{
  template <int dim>
  bool
  FollowerPressure<dim>::any() const
  {
    const auto &faces = parts.problem.loads.faces;
    return std::any_of(faces.begin(), faces.end(), [](const auto &load) {
      return load.is_pressure;
    });
  }



  template <int dim>
  void
  FollowerPressure<dim>::find()
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
              support_of_point<dim>(parts.grid.view(), points, p);
            const auto numbers = nodes.numbers_in(points.cell[p]);
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
            piece.load    = &face.load;
            piece.edges   = former->edges;
            piece.weights = slopes(former->arm);
            for (int i = 0; i < at.n; ++i)
              {
                piece.weights[i] += at.value[i];
                for (const std::uint32_t number : numbers)
                  if (nodes.on_grid()[number] == at.node[i])
                    piece.numbers.push_back(number);
              }
            AssertDimension(piece.numbers.size(), piece.weights.size());
            for (unsigned int e = 0; e < dim - 1; ++e)
              piece.slopes[e] = slopes(former->edges[e]);
            for (int d = 0; d < dim; ++d)
              piece.place[d] = points.position[d][p] + former->arm[d];
            pieces.push_back(std::move(piece));
          }
      }
  }



  // Place, as the arm, and edges
  template <int dim>
  FacePiece<dim>
  FollowerPressure<dim>::moved(const Piece               &piece,
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
          result.arm[d] += piece.weights[i] * u;
          for (unsigned int e = 0; e < dim - 1; ++e)
            result.edges[e][d] += piece.slopes[e][i] * u;
        }
    return result;
  }



  template <int dim>
  double
  FollowerPressure<dim>::pressure(const Piece          &piece,
                                  const FacePiece<dim> &at) const
  {
    return factor * piece.load->formula.value(dealii::Point<dim>(at.arm), time);
  }



  template <int dim>
  void
  FollowerPressure<dim>::add_forces(const std::vector<double> &displacement,
                                    std::vector<double>       &forces) const
  {
    for (const Piece &piece : pieces)
      {
        const FacePiece<dim>         now = moved(piece, displacement);
        const dealii::Tensor<1, dim> force =
          -pressure(piece, now) * now.area_vector();
        for (std::size_t i = 0; i < piece.numbers.size(); ++i)
          for (int d = 0; d < dim; ++d)
            forces[std::size_t(piece.numbers[i]) * dim + d] +=
              piece.weights[i] * force[d];
      }
  }



  template <int dim>
  void
  FollowerPressure<dim>::add_tangent(const std::vector<double> &displacement,
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



  template class FollowerPressure<2>;
  template class FollowerPressure<3>;
} // namespace limber
