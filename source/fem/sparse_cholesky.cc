// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <limber/fem/sparse_cholesky.h>

#include <Epetra_CrsMatrix.h>
#include <cholmod.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace limber
{
  namespace
  {
    // One triangle of a symmetric matrix, whose rows are its columns
    cholmod_sparse
    view_of(const dealii::TrilinosWrappers::SparseMatrix &matrix)
    {
      const Epetra_CrsMatrix &stored = matrix.trilinos_matrix();
      int                    *starts = nullptr, *places = nullptr;
      double                 *values = nullptr;
      if (stored.ExtractCrsDataPointers(starts, places, values) != 0)
        throw std::logic_error("the matrix is not stored in one piece");
      cholmod_sparse result{};
      result.nrow = result.ncol = stored.NumMyRows();
      result.nzmax              = stored.NumMyNonzeros();
      result.p                  = starts;
      result.i                  = places;
      result.x                  = values;
      result.stype              = 1;
      result.itype              = CHOLMOD_INT;
      result.xtype              = CHOLMOD_REAL;
      result.dtype              = CHOLMOD_DOUBLE;
      result.sorted             = true;
      result.packed             = true;
      return result;
    }
  } // namespace



  struct SparseCholesky::Factors
  {
    Factors()
    {
      cholmod_start(&common);
      common.print              = 0; // says nothing
      common.nmethods           = 1; // METIS takes more time than it saves
      common.method[0].ordering = CHOLMOD_AMD;
      // With Debian's default BLAS dense blocks are slower than rows for all
      // but the largest matrices.
      common.supernodal = CHOLMOD_SIMPLICIAL;
      // L L^T, which ends where a matrix is not definite, unlike L D L^T
      common.final_ll                   = true;
      common.quick_return_if_not_posdef = true;
    }

    Factors(const Factors &) = delete;

    ~Factors()
    {
      cholmod_free_factor(&factor, &common);
      cholmod_free_dense(&result, &common);
      cholmod_free_dense(&buffers[0], &common);
      cholmod_free_dense(&buffers[1], &common);
      cholmod_finish(&common);
    }

    bool
    has_pattern_of(const cholmod_sparse &matrix) const
    {
      const int *const        starts = static_cast<const int *>(matrix.p),
                       *const places = static_cast<const int *>(matrix.i);
      return begin.size() == matrix.nrow + 1 &&
             columns.size() == matrix.nzmax &&
             std::equal(begin.begin(), begin.end(), starts) &&
             std::equal(columns.begin(), columns.end(), places);
    }

    cholmod_common   common;
    cholmod_factor  *factor     = nullptr;
    cholmod_dense   *result     = nullptr;
    cholmod_dense   *buffers[2] = {nullptr, nullptr};
    std::vector<int> begin, columns; // of the matrix whose order is known
  };



  SparseCholesky::SparseCholesky()
    : factors(std::make_unique<Factors>())
  {}



  SparseCholesky::~SparseCholesky() = default;



  bool
  SparseCholesky::factorise(
    const dealii::TrilinosWrappers::SparseMatrix &matrix)
  {
    cholmod_sparse  view   = view_of(matrix);
    cholmod_common &common = factors->common;
    if (!factors->has_pattern_of(view))
      {
        const int *const        starts = static_cast<const int *>(view.p),
                         *const places = static_cast<const int *>(view.i);
        factors->begin.assign(starts, starts + view.nrow + 1);
        factors->columns.assign(places, places + view.nzmax);
        cholmod_free_factor(&factors->factor, &common);
        factors->factor = cholmod_analyze(&view, &common);
      }
    if (factors->factor != nullptr)
      cholmod_factorize(&view, factors->factor, &common);
    if (common.status == CHOLMOD_OUT_OF_MEMORY)
      throw std::bad_alloc();
    return common.status == CHOLMOD_OK;
  }



  void
  SparseCholesky::solve(NodalVector &solution, const NodalVector &right_side)
  {
    cholmod_dense b{};
    b.nrow = b.d = b.nzmax = right_side.size();
    b.ncol                 = 1;
    b.x     = const_cast<double *>(right_side.begin()); // is only read
    b.xtype = CHOLMOD_REAL;
    b.dtype = CHOLMOD_DOUBLE;
    if (!cholmod_solve2(CHOLMOD_A,
                        factors->factor,
                        &b,
                        nullptr,
                        &factors->result,
                        nullptr,
                        &factors->buffers[0],
                        &factors->buffers[1],
                        &factors->common))
      throw std::bad_alloc();
    const double *const found = static_cast<const double *>(factors->result->x);
    std::copy_n(found, right_side.size(), solution.begin());
  }
} // namespace limber
