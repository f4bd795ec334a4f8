// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_dual_domain_h
#define limber_time_dual_domain_h

#include <limber/state/material_body.h>

namespace limber
{
  /**
   * Nodal part of the dual domain method (DDMP) between the sweeps over points
   * (interpolation/dual_domain.h): volumes around nodes, the stress mapped from
   * points and its forces, mean velocity gradients, of the bodies of one nodal
   * field. Points must be on the ranks that own their cells, all cells of one
   * size. All functions but data() and clear_stress() are collective.
   */
  template <int dim>
  class DualDomain
  {
  public:
    DualDomain(const NodeTable<dim> &table, unsigned int field);

    /** Adopt a changed mesh: all records zero. */
    void
    reinit();

    /** The records (DualDomainLayout), for sweeps. */
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

    /** To be called before points map their stress to the nodes. */
    void
    clear_stress(const NodalFields<dim> &nodes);

    /**
     * Once the masses of the nodes are known: which cells the points of
     * solids are in, how much each counts, and the volumes around nodes.
     */
    void
    find_volumes(NodalFields<dim>                                      &nodes,
                 const std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies);

    /** Add the forces of the stress mapped to the nodes. */
    void
    add_forces(NodalFields<dim> &nodes);

    /**
     * The mean gradients around nodes of the velocity in @p slot.
     */
    void
    average_gradients(NodalFields<dim> &nodes, unsigned int slot);

  private:
    using Layout = DualDomainLayout<dim>;

    struct WeighedCell
    {
      std::uint32_t cell;
      double        weight;
    };

    double *
    record(const std::uint32_t node)
    {
      return records.data() + std::size_t(node) * Layout::stride;
    }

    void
    sum_up(const NodalFields<dim> &nodes, unsigned int first, unsigned int n);
    void
    clear(const NodalFields<dim> &nodes, unsigned int first, unsigned int n);
    void
    divide_by_volumes(const NodalFields<dim> &nodes);

    const NodeTable<dim>    &table;
    const unsigned int       field;
    LazyArray<double>        records;
    std::vector<WeighedCell> cells; // that points are in
    LazyArray<std::uint32_t> met;   // per cell: last turn with points in it
    std::uint32_t            turn = 0;
    RecordExchange           exchange{Layout::stride};
  };
} // namespace limber

#endif
