// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <limber/fem/sparse_cholesky.h>

#include <gtest/gtest.h>

/** @file Factors of symmetric matrices, definite or not. */
using namespace limber;

namespace
{
  constexpr unsigned int n = 40;

  using Matrix = dealii::TrilinosWrappers::SparseMatrix;



  void
  reinit(Matrix &matrix)
  {
    dealii::DynamicSparsityPattern pattern(n, n);
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
        if ((i > j ? i - j : j - i) % 7 <= 1)
          pattern.add(i, j);
    matrix.reinit(pattern);
  }



  // -1 off the diagonal; definite if this is larger than their number
  void
  fill(Matrix &matrix, const double diagonal)
  {
    for (auto entry = matrix.begin(); entry != matrix.end(); ++entry)
      matrix.set(entry->row(),
                 entry->column(),
                 entry->row() == entry->column() ?
                   diagonal + 0.1 * entry->row() :
                   -1.);
    matrix.compress(dealii::VectorOperation::insert);
  }



  NodalVector
  known_solution()
  {
    NodalVector result(n);
    for (unsigned int i = 0; i < n; ++i)
      result[i] = 1 + i % 5;
    return result;
  }



  NodalVector
  product_with_solution(const Matrix &matrix)
  {
    NodalVector result(n);
    matrix.vmult(result, known_solution());
    return result;
  }



  double
  error(const NodalVector &solution)
  {
    NodalVector result = known_solution();
    result -= solution;
    return result.linfty_norm();
  }
} // namespace



TEST(SparseCholesky, FactorsSolve)
{
  Matrix matrix;
  reinit(matrix);
  SparseCholesky factors;
  NodalVector    solution(n);
  for (const double diagonal : {20., 300.}) // in the same places
    {
      fill(matrix, diagonal);
      ASSERT_TRUE(factors.factorise(matrix));
      factors.solve(solution, product_with_solution(matrix));
      EXPECT_LT(error(solution), 1e-12);
    }

  Matrix                         other;
  dealii::DynamicSparsityPattern pattern(n, n);
  for (unsigned int i = 0; i < n; ++i)
    pattern.add(i, i);
  other.reinit(pattern);
  fill(other, 2);
  ASSERT_TRUE(factors.factorise(other));
  factors.solve(solution, product_with_solution(other));
  EXPECT_LT(error(solution), 1e-12);
}



TEST(SparseCholesky, WhatIsNotDefiniteHasNone)
{
  Matrix matrix;
  reinit(matrix);
  SparseCholesky factors;
  fill(matrix, 1);
  EXPECT_FALSE(factors.factorise(matrix));
  fill(matrix, 20);
  EXPECT_TRUE(factors.factorise(matrix));
}



TEST(SparseCholesky, IndefiniteEquationsAreSolvedAllTheSame)
{
  Matrix matrix;
  reinit(matrix);
  LinearSolver solver(SolutionMethod::cholesky, 1, {});
  NodalVector  solution(n);
  for (const double diagonal : {20., 1., 20.})
    {
      SCOPED_TRACE(diagonal);
      fill(matrix, diagonal);
      solver.set_matrix(matrix);
      solver.solve(solution, product_with_solution(matrix));
      EXPECT_LT(error(solution), 1e-10);
    }
}
