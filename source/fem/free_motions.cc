// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/full_matrix.h>

#include <limber/fem/free_motions.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  template <int dim>
  double
  rigid_motion(const unsigned int        motion,
               const unsigned int        component,
               const dealii::Point<dim> &place,
               const dealii::Point<dim> &centre)
  {
    if (motion < dim)
      return component == motion ? 1 : 0;
    // about the axis r in space, about z in the plane
    const unsigned int r = motion - dim;
    const unsigned int a = dim == 2 ? 0 : (r + 1) % 3;
    const unsigned int b = dim == 2 ? 1 : (r + 2) % 3;
    if (component == a)
      return -(place[b] - centre[b]);
    return component == b ? place[a] - centre[a] : 0;
  }



  namespace
  {
    /** Rigid motions of a part, rotations divided by its size. */
    template <int dim>
    class MotionsOfPart
    {
    public:
      MotionsOfPart(const std::vector<dealii::Point<dim>> &places,
                    const std::vector<std::uint32_t>      &of_part)
        : lower(places[of_part.front()])
        , upper(lower)
      {
        for (const std::uint32_t i : of_part)
          {
            centre += places[i] / double(of_part.size());
            for (int d = 0; d < dim; ++d)
              {
                lower[d] = std::min(lower[d], places[i][d]);
                upper[d] = std::max(upper[d], places[i][d]);
              }
          }
        size = std::max(lower.distance(upper), 1e-300);
      }

      double
      at(const dealii::Point<dim> &place,
         const unsigned int        motion,
         const unsigned int        component) const
      {
        return rigid_motion<dim>(motion, component, place, centre) /
               (motion < dim ? 1 : size);
      }

      dealii::Point<dim> lower, upper;

    private:
      dealii::Point<dim> centre;
      double             size;
    };



    /** Normal matrix (sum of the squares) of the constraint rows in terms of
     * the rigid motions of parts. */
    template <int dim>
    class SumOfSquares
    {
    public:
      explicit SumOfSquares(const std::vector<MotionsOfPart<dim>> &parts)
        : parts(parts)
        , matrix(parts.size() * n_rigid_motions<dim>)
      {}

      /** Part in the row of a component at a place, with its sign. */
      struct InRow
      {
        std::uint32_t part;
        double        sign;
      };
      void
      add(const std::vector<InRow> &row,
          const dealii::Point<dim> &place,
          const unsigned int        component)
      {
        constexpr unsigned int n = n_rigid_motions<dim>;
        for (const InRow &a : row)
          for (const InRow &b : row)
            for (unsigned int i = 0; i < n; ++i)
              for (unsigned int j = 0; j < n; ++j)
                matrix(a.part * n + i, b.part * n + j) +=
                  a.sign * parts[a.part].at(place, i, component) * b.sign *
                  parts[b.part].at(place, j, component);
      }

      /** Index of the first vanishing pivot of a Cholesky factorisation. */
      std::optional<unsigned int>
      vanishing_pivot()
      {
        constexpr double negligible = 1e-12; // beside the number of rows
        for (unsigned int k = 0; k < matrix.m(); ++k)
          {
            double pivot = matrix(k, k);
            for (unsigned int j = 0; j < k; ++j)
              pivot -= matrix(k, j) * matrix(k, j);
            if (!(pivot > negligible * (1 + matrix(k, k))))
              return k;
            matrix(k, k) = std::sqrt(pivot);
            for (unsigned int i = k + 1; i < matrix.m(); ++i)
              {
                for (unsigned int j = 0; j < k; ++j)
                  matrix(i, k) -= matrix(i, j) * matrix(k, j);
                matrix(i, k) /= matrix(k, k);
              }
          }
        return std::nullopt;
      }

    private:
      const std::vector<MotionsOfPart<dim>> &parts;
      dealii::FullMatrix<double>             matrix;
    };



    template <int dim>
    std::string
    name_of(const unsigned int motion)
    {
      return (motion < dim ? "the translation along " : "the rotation about ") +
             std::string(1,
                         "xyz"[motion < dim ? motion :
                               dim == 2     ? 2 :
                                              motion - dim]);
    }
  } // namespace



  // Each held component, and each component of a place shared by two parts, is
  // a constraint row, which is zero for admissible motions. In the normal
  // matrix of all rows a pivot vanishes if its motion, combined with some of
  // those before it, is free.
  template <int dim>
  std::optional<FreeMotion<dim>>
  free_rigid_motion(const std::vector<dealii::Point<dim>>         &places,
                    const std::vector<std::array<bool, dim>>      &held,
                    const std::vector<std::vector<std::uint32_t>> &parts)
  {
    constexpr std::size_t most_parts = 200;
    if (parts.size() > most_parts)
      return std::nullopt;

    std::vector<MotionsOfPart<dim>>         motions;
    std::vector<std::vector<std::uint32_t>> parts_at(places.size());
    for (std::uint32_t part = 0; part < parts.size(); ++part)
      {
        motions.emplace_back(places, parts[part]);
        for (const std::uint32_t i : parts[part])
          parts_at[i].push_back(part);
      }

    SumOfSquares<dim> squares(motions);
    for (std::uint32_t i = 0; i < places.size(); ++i)
      for (int d = 0; d < dim; ++d)
        for (std::size_t k = 0; k < parts_at[i].size(); ++k)
          if (held[i][d])
            squares.add({{parts_at[i][k], 1}}, places[i], d);
          else if (k > 0)
            squares.add({{parts_at[i][0], 1}, {parts_at[i][k], -1}},
                        places[i],
                        d);

    const auto pivot = squares.vanishing_pivot();
    if (!pivot)
      return std::nullopt;
    const auto &part = motions[*pivot / n_rigid_motions<dim>];
    return FreeMotion<dim>{name_of<dim>(*pivot % n_rigid_motions<dim>),
                           part.lower,
                           part.upper};
  }



  template double
  rigid_motion<2>(unsigned int,
                  unsigned int,
                  const dealii::Point<2> &,
                  const dealii::Point<2> &);
  template std::optional<FreeMotion<2>>
  free_rigid_motion<2>(const std::vector<dealii::Point<2>> &,
                       const std::vector<std::array<bool, 2>> &,
                       const std::vector<std::vector<std::uint32_t>> &);
  template double
  rigid_motion<3>(unsigned int,
                  unsigned int,
                  const dealii::Point<3> &,
                  const dealii::Point<3> &);
  template std::optional<FreeMotion<3>>
  free_rigid_motion<3>(const std::vector<dealii::Point<3>> &,
                       const std::vector<std::array<bool, 3>> &,
                       const std::vector<std::vector<std::uint32_t>> &);
} // namespace limber
