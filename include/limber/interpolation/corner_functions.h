// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_corner_functions_h
#define limber_interpolation_corner_functions_h

#include <limber/interpolation/domain_shape.h>
#include <limber/interpolation/mean_functions.h>

namespace limber
{
  /**
   * CPDI and CPDI2 functions of the nodes of a block, interpolated from the
   * corners of domains (domain_shape.h), points as lanes. Both G2P and P2G go
   * via the corners.
   */
  template <int dim>
  class CornerFunctions : public MeanFunctions<dim>
  {
  public:
    using Block                    = BlockNodes<dim>;
    using Number                   = typename Block::Number;
    using Vector                   = typename Block::Vector;
    static constexpr int n_corners = 1 << dim;
    using Corners                  = std::array<Vector, n_corners>;

    /**
     * For parallelepipeds around @p xi (BlockNodes::find) with the half @p
     * edges, in cells.
     */
    void
    set(const Block                    &block,
        const Vector                   &xi,
        const SmallMatrix<dim, Number> &edges);

    /** For hexahedra with the centroids @p xi, likewise. */
    void
    set(const Block                   &block,
        const Vector                  &xi,
        const Hexahedron<dim, Number> &shape);

    /** Prepare take() and give() of MeanFunctions. */
    void
    find_means(const Block &block);

    /** The vector field from @p slot on, at the corners. */
    void
    take_at_corners(const Block  &block,
                    const double *nodes,
                    unsigned int  slot,
                    Corners      &values) const;

    /** From values at the corners to the mean u and the changes u,k. */
    void
    combine(const Corners           &values,
            Vector                  &value,
            std::array<Vector, dim> &change) const;

    /**
     * P2G, the transpose of both: add @p alike times N_i to the slots of the
     * window, and @p along times the changes of N_i along the edges to the
     * forces. With ForceWindow @p alike is not used.
     */
    template <class Window>
    void
    give_with_changes(const Block                             &block,
                      double                                  *nodes,
                      const std::array<Number, Window::width> &alike,
                      const std::array<Vector, dim>           &along) const;

  private:
    /** With corners at x(c, d) along d, in the block. */
    template <class Place>
    void
    set_factors(const Block &block, const Place &place);

    using Lanes = double[Block::n_points];

    // One-dimensional factors (hat functions) of each corner, by direction and
    // node
    alignas(64) Lanes factors[n_corners][dim][Block::longest];
    // share_c, and slope_c . r_k; for parallelepipeds 2^-d and 2^-d s_ck
    alignas(64) Lanes shares[n_corners];
    alignas(64) Lanes along[dim][n_corners];
  };
} // namespace limber

#endif
