// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_cell_means_h
#define limber_interpolation_cell_means_h

#include <limber/interpolation/batch_lanes.h>

namespace limber
{
  /**
   * The means over the points of a body in a cell, weighted by mass, of the
   * monomials in natural coordinates: lane k belongs to the product of the
   * coordinates whose bits are set in k. The last lane, which no derivative
   * of a multilinear function needs, has the mean of the volumetric variable.
   */
  template <int dim>
  class CellMeans
  {
  public:
    using Nodes = typename Linear<dim>::Nodes;

    /** Not to be asked where nothing is projected and there are no sums. */
    CellMeans(const CellSums<dim> *const sums, const std::uint32_t cell)
      : record(sums ? sums->now + cell * CellSums<dim>::stride : nullptr)
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
      return record[CellSums<dim>::volumetric] * inverse_mass;
    }

    /** The mean of the derivative with respect to natural coordinate d of a
     * function with monomial coefficients c(k). */
    template <class Coefficients>
    double
    derivative(const Coefficients &c, const int d) const
    {
      double sum = 0;
#pragma GCC unroll 8
      for (int k = 0; k < 1 << dim; ++k)
        if (k >> d & 1 && k != 1 << d)
          sum += c(k) * record[k ^ (1 << d)];
      return c(1 << d) + inverse_mass * sum;
    }

    /** The same of all components of a vector field, as lanes, for each d. */
    template <class VectorField>
    auto
    derivatives_of(const VectorField &c) const
    {
      std::array<typename VectorField::Components, dim> result;
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
        {
          typename VectorField::Components sum{};
#pragma GCC unroll 8
          for (int k = 0; k < 1 << dim; ++k)
            if (k >> d & 1 && k != 1 << d)
              sum += c.components(k) * record[k ^ (1 << d)];
          result[d] = c.components(1 << d) + inverse_mass * sum;
        }
      return result;
    }

    /** Lane k: the same of monomial k, times a factor. */
    Nodes
    derivatives(const int d, const double factor) const
    {
      return (factor * inverse_mass) *
             Linear<dim>::derivatives(load<Nodes>(record), d);
    }

  private:
    const double *const record;
    const double        inverse_mass;
  };



  /** Adds points that have moved to the sums of the cells they are in now. */
  template <int dim>
  class CellGatherer
  {
  public:
    using Number = PointPack<dim>;

    explicit CellGatherer(const CellSums<dim> &sums)
      : sums(sums)
    {}

    /** The points of a pack, all in that cell at natural places xi. */
    __attribute__((always_inline)) void
    add(const std::uint32_t            cell,
        const std::array<Number, dim> &xi,
        const Number                  &mass,
        const Number                  &volumetric) const
    {
      double *const record = sums.next + cell * CellSums<dim>::stride;
      Number        total  = sums_over_lanes(products(xi, mass, volumetric));
      if (rarely(sums.is_open(cell)))
        total += load<Number>(record);
      else
        sums.turn_of[cell] = sums.turn;
      store(total, record);
    }

    /** The points [begin, end), wherever they are now. */
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
          const CellGeometry<dim> &geometry = grid.cells[points.cell[p]];
          std::array<double, dim>  xi;
#pragma GCC unroll 8
          for (int d = 0; d < dim; ++d)
            xi[d] = (points.place[d][p] - geometry.origin[d]) *
                    geometry.inverse_edge[d];
          double *const record = sums.open(points.cell[p]);
          const auto added = products(xi, points.mass[p], points.volumetric[p]);
          for (unsigned int k = 0; k < added.size(); ++k)
            record[k] += added[k];
        }
    }

  private:
    /** What points add to the slots, each from one with a factor less. */
    template <class T>
    __attribute__((always_inline)) static std::array<T, 1 << dim>
    products(const std::array<T, dim> &xi, const T &mass, const T &volumetric)
    {
      std::array<T, 1 << dim> result;
      result[0] = mass;
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
#pragma GCC unroll 8
        for (int k = 0; k < 1 << d; ++k)
          result[k | 1 << d] = result[k] * xi[d];
      result[CellSums<dim>::volumetric] = mass * volumetric;
      return result;
    }

    const CellSums<dim> &sums;
  };
} // namespace limber

#endif
