// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_pulled_back_force_h
#define limber_transfer_pulled_back_force_h

#include <limber/interpolation/pulled_back_stress.h>
#include <limber/transfer/add_to_nodes.h>
#include <limber/transfer/give_to_splines.h>

namespace limber
{
  /**
   * Total Lagrangian P2G of forces f_i = - sum V P grad_X N_i for the points of
   * a batch, a pack at a time.
   */
  template <class Basis>
  class PulledBackForce;



  template <int dim>
  class PulledBackForce<Linear<dim>>
  {
  public:
    __attribute__((always_inline))
    PulledBackForce(const GridView<dim> &grid, const std::uint32_t cell)
      : grid(grid)
      , cell(grid.cells[cell])
      , stress(this->cell)
    {}

    /** Add V P (J, zero in idle lanes) at natural coordinates xi. */
    template <class Lanes>
    __attribute__((always_inline)) void
    add(const SmallMatrix<dim, PointPack<dim>> &VP,
        const std::array<PointPack<dim>, dim>  &xi,
        const Lanes &)
    {
      stress.add(VP, xi);
    }

    __attribute__((always_inline)) void
    add_to_nodes() const
    {
      limber::add_to_nodes<dim, NodeLayout<dim>::force>(cell,
                                                        stress.forces(),
                                                        grid.nodes);
    }

  private:
    const GridView<dim>     &grid;
    const CellGeometry<dim> &cell;
    StressOnNodes<dim>       stress;
  };



  template <int dim, int degree>
  class PulledBackForce<Spline<dim, degree>>
  {
    using Basis = Spline<dim, degree>;

  public:
    __attribute__((always_inline))
    PulledBackForce(const GridView<dim> &grid, const std::uint32_t cell)
      : grid(grid)
      , cell(grid.cells[cell])
      , nodes(Basis::nodes_of(grid, cell))
    {
      of_batch.clear();
    }

    template <class Lanes>
    __attribute__((always_inline)) void
    add(const SmallMatrix<dim, PointPack<dim>> &VP,
        const std::array<PointPack<dim>, dim>  &xi,
        const Lanes                            &lanes)
    {
      // only their stress is used
      give_pack<Basis, Given<false, false, true>>(
        PointView<dim>(), cell, nodes, lanes, xi, 0, VP, false, of_batch);
    }

    __attribute__((always_inline)) void
    add_to_nodes() const
    {
      of_batch.add_to_nodes(nodes, grid.nodes);
    }

  private:
    using Sums = SplineSums<Basis, NodeLayout<dim>::force, dim>;

    const GridView<dim>        &grid;
    const CellGeometry<dim>    &cell;
    const typename Basis::Cell &nodes;
    Sums                        of_batch;
  };
} // namespace limber

#endif
