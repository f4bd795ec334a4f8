// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_domain_means_h
#define limber_interpolation_domain_means_h

#include <limber/base/pack.h>
#include <limber/interpolation/nodal_means.h>

#include <stdexcept>

/**
 * @file Averages of a quantity q of points with domains (domain_shape.h) for
 * locking treatments: around nodes (nodal_means.h), or over the points of the
 * cell,
 *
 *   <q> = sum m q / sum m.
 *
 * As each point has its own stencil, the mean of the divergence is formed
 * from values at the points, in a sweep before the one that needs it. With
 * masses as weights the average is symmetric, so that the averaged pressure
 * acts on the gradients at the points: the exact transpose.
 */
namespace limber
{
  /** Contributions of the points of a cell to its mean. */
  template <int dim>
  class CellMeanSums
  {
  public:
    /** Add a point, anywhere in the cell. */
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



  /** Contributions of the points of a cell to the means around its nodes. */
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



  /** Throws std::logic_error if points with domains have no such treatment. */
  inline void
  check_treatment_of_domains(const Treatment kind)
  {
    if (kind != Treatment::none && kind != Treatment::cell &&
        kind != Treatment::node)
      throw std::logic_error("no such treatment with domains");
  }



  /**
   * The mean within a cell that a treatment needs: none, over its points, or
   * around its nodes. The kind is a run-time choice, once per batch and pack,
   * as the functions of domains outweigh it by far: compiled for each treatment
   * they took half as long again.
   */
  template <int dim>
  class DomainMean
  {
  public:
    /** With the @p records of the means; not used by 'none'. */
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

    /** Whether there is a mean; otherwise points keep their own value. */
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
    // of monomials
    std::array<double, Linear<dim>::n_nodes> coefficients{};
  };
} // namespace limber

#endif
