// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_nodal_projection_h
#define limber_grid_nodal_projection_h

#include <limber/base/lazy_array.h>
#include <limber/grid/grid_view.h>
#include <limber/grid/node_table.h>

namespace limber
{
  /**
   * Storage of the lumped projection on nodes of a quantity of one body:
   * records (NodalMeanLayout), owned and ghost, to which sweeps add and from
   * which they read the means (interpolation/nodal_means.h). All ranks that
   * hold a node get the same mean; hanging nodes get theirs from their masters.
   */
  template <int dim>
  class NodalProjection
  {
  public:
    explicit NodalProjection(const NodeTable<dim> &table);

    /** Adopt a changed mesh: all records zero. */
    void
    reinit();

    /** The records, for sweeps. */
    double *
    data()
    {
      return records.data();
    }

    const double *
    data() const
    {
      return records.data();
    }

    double
    mean(const std::uint32_t node) const
    {
      return records[std::size_t(node) * Layout::stride + Layout::value];
    }

    /** Set the records of the given nodes and of hanging ones to zero. */
    void
    clear(const std::vector<std::uint32_t> &nodes);

    /**
     * Complete the sums over ranks, and replace them by means at the given
     * nodes, which must be all with nonzero sums. No additions between start
     * and finish.
     */
    void
    start_completion(const ExchangePlan &plan);
    void
    finish_completion(const std::vector<std::uint32_t> &nodes);

  private:
    using Layout = NodalMeanLayout;

    double *
    record(const std::uint32_t node)
    {
      return records.data() + std::size_t(node) * Layout::stride;
    }

    const NodeTable<dim> &table;
    LazyArray<double>     records;
    RecordExchange        exchange{Layout::stride};
  };
} // namespace limber

#endif
