// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_cell_means_h
#define limber_interpolation_cell_means_h

#include <limber/interpolation/batch_lanes.h>

namespace limber
{
  /**
   * Mass-weighted means over the points of a body in a cell of the monomials in
   * natural coordinates, in the order of the basis. The slot of the last one,
   * which no derivative of its functions needs, holds the mean of the
   * volumetric variable.
   */
  template <class Basis>
  class CellMeans
  {
  public:
    static constexpr int dim     = Basis::dim;
    static constexpr int n_nodes = Basis::n_nodes;

    /** Without sums (nothing is averaged) no mean may be asked for. */
    CellMeans(const CellSums<dim> *const sums, const std::uint32_t cell)
      : record(sums ? sums->now + std::size_t(cell) * n_nodes : nullptr)
      , inverse_mass(sums ? 1 / record[CellSums<dim>::mass] : 0)
    {}

    double
    operator[](const int k) const
    {
      return record[k] * inverse_mass;
    }

    double
    volumetric() const
    {
      return record[n_nodes - 1] * inverse_mass;
    }

    /**
     * The mean over the points of the derivative with respect to natural
     * coordinate d of a function with monomial coefficients c(k).
     */
    template <class Coefficients>
    double
    derivative(const Coefficients &c, const int d) const
    {
      constexpr auto stride = Basis::stride;
      double         sum    = 0;
#pragma GCC unroll 27
      for (int k = 0; k < n_nodes; ++k)
        if (Basis::power(k, d) > 0 && k != stride(d))
          sum += Basis::power(k, d) * c(k) * record[k - stride(d)];
      return c(stride(d)) + inverse_mass * sum;
    }

    /** The same for all components of a vector field, as lanes, for each d. */
    template <class VectorField>
    auto
    derivatives_of(const VectorField &c) const
    {
      constexpr auto                                    stride = Basis::stride;
      std::array<typename VectorField::Components, dim> result;
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
        {
          typename VectorField::Components sum{};
#pragma GCC unroll 27
          for (int k = 0; k < n_nodes; ++k)
            if (Basis::power(k, d) > 0 && k != stride(d))
              sum +=
                c.components(k) * (Basis::power(k, d) * record[k - stride(d)]);
          result[d] = c.components(stride(d)) + inverse_mass * sum;
        }
      return result;
    }

    /** The mean derivatives of all monomials (lane k), times a factor. */
    auto
    derivatives(const int d, const double factor) const
    {
      using Nodes = typename Basis::Nodes;
      return (factor * inverse_mass) *
             Basis::derivatives(load<Nodes>(record), d);
    }

    /** The mean derivative of monomial k in direction d. */
    double
    derivative_of(const int k, const int d) const
    {
      const int n = Basis::power(k, d);
      return n > 0 ? n * (record[k - Basis::stride(d)] * inverse_mass) : 0;
    }

  private:
    const double *const record;
    const double        inverse_mass;
  };



  /** Adds moved points to the sums (CellSums) of their new cells. */
  template <class Basis>
  class CellGatherer
  {
  public:
    static constexpr int dim     = Basis::dim;
    static constexpr int n_nodes = Basis::n_nodes;
    using Number                 = PointPack<dim>;

    explicit CellGatherer(const CellSums<dim> &sums)
      : sums(sums)
    {}

    /** Add a pack of points, all in that cell, at natural coordinates xi. */
    __attribute__((always_inline)) void
    add(const std::uint32_t            cell,
        const std::array<Number, dim> &xi,
        const Number                  &mass,
        const Number                  &volumetric) const
    {
      constexpr int width  = pack_width<Number>;
      double *const record = sums.next + std::size_t(cell) * n_nodes;
      const bool    opened = rarely(sums.is_open(cell));
      if (!opened)
        sums.turn_of[cell] = sums.turn;
      const auto    added    = products(xi, mass, volumetric);
      constexpr int in_packs = n_nodes / width * width;
#pragma GCC unroll 4
      for (int k = 0; k < in_packs; k += width)
        {
          std::array<Number, width> some;
          std::copy_n(&added[k], width, some.begin());
          Number total = sums_over_lanes(some);
          if (opened)
            total += load<Number>(record + k);
          store(total, record + k);
        }
      for (int k = in_packs; k < n_nodes; ++k)
        record[k] = sum(added[k]) + (opened ? record[k] : 0);
    }

    /** Add the points [begin, end), each in its own cell. */
    __attribute__((noinline, cold)) void
    add_one_by_one(const PointView<dim> &points,
                   const GridView<dim>  &grid,
                   const std::size_t     begin,
                   const std::size_t     end) const
    {
      for (std::size_t p = begin; p < end; ++p)
        {
          if (points.cell[p] == invalid_cell)
            continue;
          const auto xi = natural_place(points, grid.cells[points.cell[p]], p);
          double *const record = sums.open(points.cell[p]);
          const auto added = products(xi, points.mass[p], points.volumetric[p]);
          for (unsigned int k = 0; k < added.size(); ++k)
            record[k] += added[k];
        }
    }

  private:
    /** Contributions of points to the slots; each monomial from a lower one. */
    template <class T>
    __attribute__((always_inline)) static std::array<T, n_nodes>
    products(const std::array<T, dim> &xi, const T &mass, const T &volumetric)
    {
      std::array<T, n_nodes> result;
      result[0] = mass;
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
#pragma GCC unroll 27
        for (int k = Basis::stride(d); k < n_nodes; ++k)
          if (Basis::power(k, d) > 0 && last_direction(k) == d)
            result[k] = result[k - Basis::stride(d)] * xi[d];
      result[n_nodes - 1] = mass * volumetric;
      return result;
    }

    /** The last direction in which a monomial has a power. */
    static constexpr int
    last_direction(const int k)
    {
      int result = 0;
      for (int d = 1; d < dim; ++d)
        if (Basis::power(k, d) > 0)
          result = d;
      return result;
    }

    const CellSums<dim> &sums;
  };
} // namespace limber

#endif
