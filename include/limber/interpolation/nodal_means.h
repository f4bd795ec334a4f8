// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_nodal_means_h
#define limber_interpolation_nodal_means_h

#include <limber/interpolation/linear.h>
#include <limber/materials/treatment.h>

/**
 * @file The projection S of a quantity q of the points of a body on continuous
 * Q1 functions with lumped masses,
 *
 *   q_i = sum m N_i q / sum m N_i,   (S q)_p = sum N_i(x_p) q_i,
 *
 * from the points to the nodes (NodalSums) and back (NodalMean). With masses
 * as weights it is symmetric, sum m a (S b) = sum m (S a) b, but S S is not S:
 * strain and stress both have to pass through it (doc/theory/treatments.md).
 */
namespace limber
{
  /** Offset of the projection record of node i of a cell. */
  template <int dim>
  inline std::size_t
  nodal_mean_record(const CellGeometry<dim> &cell, const int i)
  {
    return std::size_t(cell.node[i] / NodeLayout<dim>::stride) *
           NodalMeanLayout::stride;
  }



  /** Contributions of the points of a cell to the sums of its nodes. */
  template <int dim>
  class NodalSums
  {
  public:
    using Nodes = typename Linear<dim>::Nodes;

    /**
     * Add a point at natural coordinates @p xi. As products of weights, tiny
     * sums are exact relative to their size, so that their ratio is always a
     * mean.
     */
    __attribute__((always_inline)) void
    add(const std::array<double, dim> &xi, const double mass, const double q)
    {
      Nodes weight = mass * Linear<dim>::weights(0, xi[0]);
#pragma GCC unroll 8
      for (int d = 1; d < dim; ++d)
        weight *= Linear<dim>::weights(d, xi[d]);
      masses += weight;
      values += q * weight;
    }

    __attribute__((always_inline)) void
    add_to_nodes(const CellGeometry<dim> &cell, double *const records) const
    {
      for (int i = 0; i < Linear<dim>::n_nodes; ++i)
        {
          double *const record = records + nodal_mean_record(cell, i);
          record[NodalMeanLayout::mass] += masses[i];
          record[NodalMeanLayout::value] += values[i];
        }
    }

  private:
    Nodes masses{}, values{};
  };



  /**
   * S q within a cell, if the treatment needs it; otherwise empty, without
   * records.
   */
  template <int dim, Treatment kind>
  class NodalMean
  {
  public:
    NodalMean(const double *const records, const CellGeometry<dim> &cell)
    {
      if constexpr (averages_around_nodes(kind))
        {
          for (int i = 0; i < Linear<dim>::n_nodes; ++i)
            coefficients[i] =
              records[nodal_mean_record(cell, i) + NodalMeanLayout::value];
          Linear<dim>::to_monomials(coefficients);
        }
    }

    /** At natural coordinates xi. */
    template <class Number>
    Number
    value(const std::array<Number, dim> &xi) const
    {
      static_assert(averages_around_nodes(kind));
      return Linear<dim>::template value<Number>(
        [this](const int k) { return coefficients[k]; }, xi);
    }

  private:
    std::array<double, averages_around_nodes(kind) ? 1 << dim : 0> coefficients;
  };
} // namespace limber

#endif
