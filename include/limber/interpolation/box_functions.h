// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_box_functions_h
#define limber_interpolation_box_functions_h

#include <limber/interpolation/mean_functions.h>

namespace limber
{
  /**
   * GIMP functions of the nodes of a block on axis-parallel boxes
   * (domain_shape.h), points as lanes: for each direction the mean over the box
   * of 1 - x, 1 - |x - 1| and x - 1, or zero, and half the difference of that
   * function between the ends of the box. N_i is a product of means; for its
   * change along an axis that factor is replaced by the half difference. Beyond
   * a side of the grid the first and the last function are continued linearly.
   */
  template <int dim>
  class BoxFunctions : public MeanFunctions<dim>
  {
  public:
    using Block  = BlockNodes<dim>;
    using Number = typename Block::Number;
    using Vector = typename Block::Vector;

    /** For boxes around @p xi (BlockNodes::find) with the edges 2 @p half. */
    void
    set(const Block &block, const Vector &xi, const Vector &half);

    /** Prepare take() and give() of MeanFunctions. */
    void
    find_means(const Block &block);

    /**
     * G2P of the vector field from @p slot on: its value at the points, and
     * half its difference along each axis between the ends of the box.
     */
    void
    take_with_changes(const Block             &block,
                      const double            *nodes,
                      unsigned int             slot,
                      Vector                  &value,
                      std::array<Vector, dim> &change) const;

    /**
     * P2G, the transpose: add @p alike times N_i to the slots of the window,
     * and @p along times the changes of N_i along the axes to the forces. With
     * ForceWindow @p alike is not used.
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
