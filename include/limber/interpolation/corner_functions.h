// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_corner_functions_h
#define limber_interpolation_corner_functions_h

#include <limber/interpolation/domain_shape.h>
#include <limber/interpolation/mean_functions.h>

namespace limber
{
  /**
   * The functions of the nodes of a block on domains that see them at their
   * corners (CPDI, CPDI2; convected.h), points as lanes. What points take is
   * interpolated to their corners first, and what they give goes by way of
   * these.
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

    /** On parallelepipeds around @p xi (BlockNodes::find) with the half
     * @p edges, in cells. */
    void
    set(const Block                    &block,
        const Vector                   &xi,
        const SmallMatrix<dim, Number> &edges);

    /** On hexahedra with the centroids @p xi, likewise. */
    void
    set(const Block                   &block,
        const Vector                  &xi,
        const Hexahedron<dim, Number> &shape);

    /** All that take() and give() of MeanFunctions need. */
    void
    find_means(const Block &block);

    /** The vector field from @p slot on at the corners. */
    void
    take_at_corners(const Block  &block,
                    const double *nodes,
                    unsigned int  slot,
                    Corners      &values) const;

    /** From values at the corners those at the points, u, and their u,k. */
    void
    combine(const Corners           &values,
            Vector                  &value,
            std::array<Vector, dim> &change) const;

    /**
     * The transpose of both: what points give with N_i, by slots of the
     * window, and to the forces with its changes along the edges. With
     * ForceWindow @p alike does not count.
     */
    template <class Window>
    void
    give_with_changes(const Block                             &block,
                      double                                  *nodes,
                      const std::array<Number, Window::width> &alike,
                      const std::array<Vector, dim>           &along) const;

  private:
    /** The corners are at x(c, d) along d, in the block. */
    template <class Place>
    void
    set_factors(const Block &block, const Place &place);

    using Lanes = double[Block::n_points];

    // Of each corner and direction, of the nodes along it; 1 - x and so on
    alignas(64) Lanes factors[n_corners][dim][Block::longest];
    // share_c, and slope_c . r_k; of parallelepipeds 2^-d and 2^-d s_ck
    alignas(64) Lanes shares[n_corners];
    alignas(64) Lanes along[dim][n_corners];
  };
} // namespace limber

#endif
