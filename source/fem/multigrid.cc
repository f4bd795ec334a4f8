// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/fem/multigrid.h>

#include <Teuchos_ParameterList.hpp>
#include <ml_MultiLevelPreconditioner.h>

namespace limber
{
  void
  make_multigrid(dealii::TrilinosWrappers::PreconditionAMG    &multigrid,
                 const dealii::TrilinosWrappers::SparseMatrix &matrix,
                 const unsigned int                            dim,
                 const std::vector<double>                    &rigid_motions,
                 const MultigridForm                          &form)
  {
    Teuchos::ParameterList settings;
    ML_Epetra::SetDefaults("SA", settings);
    settings.set("ML output", 0);
    settings.set("smoother: type", "Chebyshev");
    settings.set("smoother: sweeps", form.sweeps);
    settings.set("prec type", form.cycle);
    settings.set("aggregation: damping factor", form.damping);
    settings.set("coarse: type", "Amesos-KLU");
    settings.set("PDE equations", int(dim));
    settings.set("null space: type", "pre-computed");
    settings.set("null space: dimension", dim == 2 ? 3 : 6);
    settings.set("null space: vectors",
                 const_cast<double *>(rigid_motions.data()));
    multigrid.initialize(matrix, settings);
  }
} // namespace limber
