// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_mean_functions_h
#define limber_interpolation_mean_functions_h

#include <limber/interpolation/block_nodes.h>

namespace limber
{
  /** Slots for P2G: mass, force and momentum of nodes. */
  template <int dim>
  using MotionWindow = RecordWindow<dim, NodeLayout<dim>::mass, 1 + 2 * dim>;

  /** The force alone. */
  template <int dim>
  using ForceWindow = RecordWindow<dim, NodeLayout<dim>::force, dim>;

  /** The re-mapped momentum (MUSL). */
  template <int dim>
  using RemapWindow = RecordWindow<dim, NodeLayout<dim>::remapped, dim>;



  /**
   * The means N_i over domains (domain_shape.h) of the functions of the nodes
   * of a block, points as lanes; G2P and P2G with them.
   */
  template <int dim>
  class MeanFunctions
  {
  public:
    using Block                   = BlockNodes<dim>;
    using Number                  = typename Block::Number;
    static constexpr int n_points = Block::n_points;

    /** G2P of n slots of the nodal records from @p slot on. */
    template <int n>
    std::array<Number, n>
    take(const Block &block, const double *nodes, unsigned int slot) const;

    /** P2G: add sum_p N_i(p) given(p) to the slots of a window. */
    template <class Window>
    void
    give(const Block                             &block,
         double                                  *nodes,
         const std::array<Number, Window::width> &given) const;

  protected:
    alignas(64) double mean[Block::n_nodes][n_points];
  };
} // namespace limber

#endif
