// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_fem_multigrid_h
#define limber_fem_multigrid_h

#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <vector>

namespace limber
{
  /** Parameters of a multigrid cycle. */
  struct MultigridForm
  {
    int         sweeps  = 2;     // of the smoother (Chebyshev)
    const char *cycle   = "MGV"; // ML's name: "MGV" or "MGW"
    double      damping = 1.333; // of the smoothed prolongation
  };



  /**
   * One cycle of smoothed aggregation multigrid (ML) for an elasticity matrix.
   * @p rigid_motions (near null space): values of each motion on the locally
   * owned degrees of freedom, one motion after the other, needed during this
   * call alone; @p dim: components of a node.
   */
  void
  make_multigrid(dealii::TrilinosWrappers::PreconditionAMG    &multigrid,
                 const dealii::TrilinosWrappers::SparseMatrix &matrix,
                 unsigned int                                  dim,
                 const std::vector<double>                    &rigid_motions,
                 const MultigridForm                          &form);
} // namespace limber

#endif
