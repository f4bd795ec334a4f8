// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_box_functions_h
#define limber_interpolation_box_functions_h

#include <limber/interpolation/mean_functions.h>

namespace limber
{
  /**
   * The functions of the nodes of a block on boxes along the axes (GIMP;
   * convected.h), points as lanes: for each direction the means over the box of
   * 1 - x, 1 - |x - 1| and x - 1, or zero, and half their change from one end
   * to the other. A function is a product of means, and its change along an
   * axis has the change along that one in place of a mean. Beyond a side of the
   * grid the first and the last go on.
   */
  template <int dim>
  class BoxFunctions : public MeanFunctions<dim>
  {
  public:
    using Block  = BlockNodes<dim>;
    using Number = typename Block::Number;
    using Vector = typename Block::Vector;

    /** On boxes around @p xi (BlockNodes::find) with the edges 2 @p half. */
    void
    set(const Block &block, const Vector &xi, const Vector &half);

    /** All that take() and give() of MeanFunctions need. */
    void
    find_means(const Block &block);

    /**
     * Of the vector field from @p slot on the value at the points, and half its
     * change along each axis from one end of the box to the other.
     */
    void
    take_with_changes(const Block             &block,
                      const double            *nodes,
                      unsigned int             slot,
                      Vector                  &value,
                      std::array<Vector, dim> &change) const;

    /**
     * The transpose: what points give with N_i, by slots of the window, and
     * to the forces with its changes along the axes. With ForceWindow @p alike
     * does not count.
     */
    template <class Window>
    void
    give_with_changes(const Block                             &block,
                      double                                  *nodes,
                      const std::array<Number, Window::width> &alike,
                      const std::array<Vector, dim>           &along) const;

  private:
    using Row = double[Block::longest][Block::n_points];

    alignas(64) Row means[dim];
    alignas(64) Row changes[dim];
  };
} // namespace limber

#endif
