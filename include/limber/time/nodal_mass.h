// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_nodal_mass_h
#define limber_time_nodal_mass_h

#include <limber/time/numbered_nodes.h>

#include <vector>

namespace limber
{
  template <int dim>
  class NewtonTangent;



  /**
   * The (consistent) mass matrix of implicit steps, M_ij = sum_p m_p N_i N_j.
   * With it points that take increments (FLIP) gain the kinetic energy and the
   * angular momentum that the nodes gain: none is lost between steps (D.
   * Burgess, D. Sulsky, J. U. Brackbill, J. Comput. Phys. 103, 1992).
   *
   * Nodes that points see only from afar would get any velocity; their mass is
   * lumped in part.
   */
  template <int dim>
  class NodalMass
  {
  public:
    using Values = std::vector<double>; // by equation, dim for each node

    /** Of these nodes, those of the caller. */
    explicit NodalMass(const NumberedNodes<dim> &nodes)
      : nodes(nodes)
    {}

    /**
     * Assemble, once nodes are numbered; @p lumped: masses by equation, kg.
     * Where all bodies are in the initial frame nothing changes from step to
     * step, until clear(). Collective.
     */
    void
    update(const RunParts<dim> &parts, const Values &lumped);

    /** A diagonal one, kg by equation. */
    void
    lump(const Values &masses)
    {
      lumped = diagonal = masses;
      blocks.clear();
    }

    /** Forget what is known of former steps. */
    void
    clear()
    {
      blocks.clear();
    }

    /** M times a vector. */
    Values
    times(const Values &vector) const;

    /**
     * The nodal velocities whose momenta M v are @p momentum (kg m/s); with
     * that which points bring, P2G, the velocity of the nodes that is nearest
     * to theirs.
     */
    Values
    velocity(const Values &momentum) const;

    /** Add @p factor times M. */
    void
    add_to(NewtonTangent<dim> &tangent, double factor) const;

  private:
    void
    lump_light_nodes();

    const NumberedNodes<dim> &nodes;
    Values                    lumped;   // row sums, kg
    Values                    diagonal; // of what is not in blocks, kg
    std::vector<double>       blocks;   // by cell, kg; empty: all is lumped
  };
} // namespace limber

#endif
