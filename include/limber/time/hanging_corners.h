// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_hanging_corners_h
#define limber_time_hanging_corners_h

#include <cstdint>

namespace limber
{
  /**
   * The hanging corners of a cell on a graded mesh (2:1), and what follows from
   * them. Linear functions of such a cell depend on as many free nodes as it
   * has corners: in the place of a hanging corner i is the corner i of its
   * parent. With the corner c that cell and parent share, the corner i is in
   * the middle of an edge or face of the parent, and has the mean of the values
   * of its corners, which are those j with j_d = c_d or i_d in each direction
   * d; in a face all corners but c hang.
   *
   * Values are by corner, then by component, and change in place.
   */
  template <int dim>
  struct HangingCorners
  {
    std::uint8_t hanging = 0; // as bits, by corner
    std::uint8_t shared  = 0; // with the parent: c

    bool
    hangs(const unsigned int corner) const
    {
      return hanging >> corner & 1;
    }

    /** From values at free nodes those at corners. */
    void
    interpolate(double *const values, const unsigned int n_components) const
    {
      // in faces first, from values in edges that are those of nodes still
      for (int n = dim - 1; n > 0; --n)
        for_each_in(n, [&](const unsigned int i, const double weight) {
          double *const of_corner = values + i * n_components;
          for (unsigned int k = 0; k < n_components; ++k)
            {
              double sum = of_corner[k];
              for_each_other_master(i, [&](const unsigned int j) {
                sum += values[j * n_components + k];
              });
              of_corner[k] = weight * sum;
            }
        });
    }

    /** Transpose: what acts on corners is handed over to free nodes. */
    void
    condense(double *const values, const unsigned int n_components) const
    {
      for (int n = 1; n < dim; ++n)
        for_each_in(n, [&](const unsigned int i, const double weight) {
          double *const of_corner = values + i * n_components;
          for (unsigned int k = 0; k < n_components; ++k)
            {
              of_corner[k] *= weight;
              for_each_other_master(i, [&](const unsigned int j) {
                values[j * n_components + k] += of_corner[k];
              });
            }
        });
    }

    /** Rows and columns of a matrix, row by row. */
    void
    condense_matrix(double *const matrix, const unsigned int n_components) const
    {
      if (hanging == 0)
        return;
      const unsigned int n = n_components << dim;
      for (unsigned int row = 0; row < n; ++row)
        condense(matrix + row * n, n_components);
      condense(matrix, n_components * n);
    }

    /** Call work(j) for the corners of the parent besides i on which a hanging
     * corner i depends. */
    template <class Work>
    void
    for_each_other_master(const unsigned int i, const Work &work) const
    {
      for (unsigned int j = 0; j < 1 << dim; ++j)
        if (j != i && ((j ^ shared) & ~(i ^ shared)) == 0)
          work(j);
    }

    /** Call work(i) for those in edges of the parent, then for those in faces.
     */
    template <class Work>
    void
    for_each_hanging(const Work &work) const
    {
      for (int n = 1; n < dim; ++n)
        for_each_in(n, [&](const unsigned int i, double) { work(i); });
    }

  private:
    // Of the parent's edges (n = 1) or faces (n = 2)
    template <class Work>
    void
    for_each_in(const int n, const Work &work) const
    {
      if (hanging == 0)
        return;
      for (unsigned int i = 0; i < 1 << dim; ++i)
        if (hangs(i) && __builtin_popcount(i ^ shared) == n)
          work(i, 1. / (1 << n));
    }
  };
} // namespace limber

#endif
