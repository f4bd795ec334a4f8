// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_domain_means_h
#define limber_interpolation_domain_means_h

#include <limber/base/pack.h>
#include <limber/interpolation/nodal_means.h>

/**
 * @file What treatments average of a quantity q of points with domains
 * (convected.h): around nodes (nodal_means.h), or over the points of the cell,
 *
 *   <q> = sum m q / sum m.
 *
 * As with any stencil of a point's own, the mean of the divergence is formed
 * from values at the points, in a sweep before the one that needs it. With
 * masses as weights it is symmetric, so that the mean of the pressure acts on
 * the gradients at the points: the exact transpose.
 */
namespace limber
{
  /** What points of a cell give to its mean. */
  template <int dim>
  class CellMeanSums
  {
  public:
    /** A point, wherever it is in the cell. */
    void
    add(const std::array<double, dim> &, const double mass, const double q)
    {
      masses += mass;
      values += mass * q;
    }

    void
    add_to(const CellGeometry<dim> &,
           const std::uint32_t cell,
           double *const       records) const
    {
      double *const record = records + std::size_t(cell) * Layout::stride;
      record[Layout::mass] += masses;
      record[Layout::value] += values;
    }

  private:
    using Layout = NodalMeanLayout;

    double masses = 0, values = 0;
  };



  /** What points of a cell give to the means around its nodes. */
  template <int dim>
  class NodalMeanSums : public NodalSums<dim>
  {
  public:
    void
    add_to(const CellGeometry<dim> &geometry,
           std::uint32_t,
           double *const records) const
    {
      this->add_to_nodes(geometry, records);
    }
  };



  /** The mean within a cell that a projection asks for; nothing for 'none'. */
  template <int dim, Projection kind>
  class DomainMean
  {
  public:
    DomainMean(const double *const      records,
               const CellGeometry<dim> &geometry,
               const std::uint32_t      cell)
      : around_nodes(records, geometry)
      , in_cell(averages_volume_in_cells(kind) ?
                  records[std::size_t(cell) * NodalMeanLayout::stride +
                          NodalMeanLayout::value] :
                  0)
    {}

    /** At natural coordinates xi. */
    template <class Number>
    Number
    value(const std::array<Number, dim> &xi) const
    {
      if constexpr (averages_around_nodes(kind))
        return around_nodes.template value<Number>(xi);
      else
        return broadcast<Number>(in_cell);
    }

  private:
    const NodalMean<dim, kind> around_nodes;
    const double               in_cell;
  };
} // namespace limber

#endif
