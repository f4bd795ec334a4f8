// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_grid_reset_h
#define limber_time_grid_reset_h

#include <limber/stress/trial_stress.h>
#include <limber/time/numbered_nodes.h>

#include <functional>
#include <memory>
#include <vector>

namespace limber
{
  /**
   * What the grid does to the forces of a prestressed body in the current frame
   * as it is set back after a step (doc/theory/implicit_steps.md): points have
   * moved, their cells have not, so that a cell that has been stretched holds
   * more than it did. To first order in the displacement of the step the forces
   * grow by
   *
   *   f_ia += sum_jc D_iajc u_jc,   D_iajc = sum_p V s_ac N_i,c N_j,c,
   *
   * with the stress s at its start. They were to act as u grew, but act from
   * the next step on. Under tension this delay feeds vibrations: kinetic energy
   * grows as exp(2 d t / dt) at most, with d = s / (C + s) and the stiffness C
   * against extension. So implicit steps have them in their equations. Here D
   * is made symmetric.
   */
  template <int dim>
  class GridReset
  {
  public:
    using Responses = std::vector<std::unique_ptr<const TrialStress<dim>>>;

    /** Of these nodes, those of the caller. */
    explicit GridReset(const NumberedNodes<dim> &nodes)
      : nodes(nodes)
    {}

    /**
     * From the stress of the points of bodies in the current frame, once nodes
     * are numbered. Pressure counts up to a third of Young's modulus, as D must
     * not overcome the elastic stiffness, and not at all in bodies that flow,
     * which may have none. Collective.
     */
    void
    find(const RunParts<dim> &parts, const Responses &responses);

    /**
     * Forces are zero where each cell turns as it does with these
     * displacements, those without forces: to second order rotations are
     * strains, and must not be resisted. After find() at none.
     */
    void
    expect(const std::vector<double> &displacement);

    /** Until then, D u. */
    void
    expect_nothing()
    {
      at_turned.clear();
    }

    /** Add D (u - u_turned) to @p forces, N; returns its potential. @p work: of
     * the mean of the forces at both ends on u, J. */
    double
    add_forces(const std::vector<double> &displacement,
               std::vector<double>       &forces,
               double                    &work) const;

    /** Call @p add for the numbers of the nodes and the block of each cell. */
    using Add = std::function<void(const std::uint32_t *numbers,
                                   unsigned int         n_nodes,
                                   const double        *block)>;
    void
    add_tangent(const Add &add) const;

  private:
    const NumberedNodes<dim> &nodes;
    std::vector<double>       blocks;    // by cell, N/m; empty: none
    std::vector<double>       at_turned; // D u_turned, N; empty: zero
  };
} // namespace limber

#endif
