// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_domain_means_h
#define limber_interpolation_domain_means_h

#include <limber/base/pack.h>
#include <limber/interpolation/nodal_means.h>

#include <stdexcept>

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



  /** Those that points with domains have; std::logic_error for the others. */
  inline void
  check_treatment_of_domains(const Treatment kind)
  {
    if (kind != Treatment::none && kind != Treatment::cell &&
        kind != Treatment::node)
      throw std::logic_error("no such treatment with domains");
  }



  /**
   * The mean within a cell that a treatment asks for: none, over its points,
   * or around its nodes. Which is asked once per batch, and whether there is
   * one once per pack of convected domains, whose functions outweigh it by far:
   * compiled for each treatment they took half as long again.
   */
  template <int dim>
  class DomainMean
  {
  public:
    /** With the @p records of the means, which none needs. */
    DomainMean(const Treatment          kind,
               const double *const      records,
               const CellGeometry<dim> &geometry,
               const std::uint32_t      cell)
      : averaged(kind != Treatment::none)
    {
      constexpr auto value = NodalMeanLayout::value;
      if (averages_around_nodes(kind))
        {
          for (int i = 0; i < Linear<dim>::n_nodes; ++i)
            coefficients[i] = records[nodal_mean_record(geometry, i) + value];
          Linear<dim>::to_monomials(coefficients);
        }
      else if (averaged)
        coefficients[0] =
          records[std::size_t(cell) * NodalMeanLayout::stride + value];
    }

    /** Whether there is one; else points keep their own value. */
    bool
    is_averaged() const
    {
      return averaged;
    }

    /** At natural coordinates xi. */
    template <class Number>
    Number
    value(const std::array<Number, dim> &xi) const
    {
      return Linear<dim>::template value<Number>(
        [this](const int k) { return coefficients[k]; }, xi);
    }

  private:
    const bool averaged;
    // of the monomials
    std::array<double, Linear<dim>::n_nodes> coefficients{};
  };
} // namespace limber

#endif
