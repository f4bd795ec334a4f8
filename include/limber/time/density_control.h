// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_density_control_h
#define limber_time_density_control_h

#include <limber/time/liquid_means.h>
#include <limber/time/node_rooms.h>

namespace limber
{
  /**
   * What keeps the volume of liquids in explicit steps. Their pressure follows
   * the volume ratios J of points, which do not know how much room the points
   * have in fact: while these move through cells the two drift apart, evenly
   * over many cells, and the liquid sinks. So the J of the points in a cell
   * tends to what the nodes of the cell tell,
   *
   *   J -= C s mean(e_i),   e_i = J_c m_i / (rho R_i) - 1,
   *
   * with the mass of a node, its room R_i (NodeRooms) and the mean J_c of the
   * cell: where points stand closer than they should the pressure rises and
   * drives them apart, along the whole way to the surface, as fast as sound. C
   * is the body's 'Density control' and s the way of the fastest point in the
   * step over the longest that semi-implicit steps take, 0.4 cells; their
   * control, in PressureSystem, is the same source. Nodes next to
   * cells at a surface, where R_i is not known to be filled, and nodes with
   * other bodies do not count. (If an excess alone counted at surfaces, noise
   * would be rectified: it gave dam breaks with four points in a cell 1 % more
   * energy than there was.) The energy that this takes or gives is on record
   * as removed with histories.
   *
   * For bodies that are alone in their field of nodes, with linear functions,
   * means over cells and cells of one size. Theory: doc/theory/treatments.md.
   */
  template <int dim>
  class DensityControl
  {
  public:
    /** Cells that obstacles cut, or null. */
    DensityControl(const RunParts<dim>    &parts,
                   const LiquidMeans<dim> &means,
                   const CutCells<dim>    *cut_cells);

    /** Adopt a mesh; collective. */
    void
    reinit();

    /** Add what J gets in a step to MaterialBody::cell_shift. The means of
     * liquids are found, and nodes have the complete mass of the points; the
     * fastest of these moves by @p way cells. Collective. */
    void
    act(double way);

  private:
    using MaterialBody                      = limber::MaterialBody<dim>;
    static constexpr unsigned int n_corners = 1 << dim;

    void
    find_excess(MaterialBody &body);
    void
    find_shifts(MaterialBody &body, double share) const;
    bool
    is_shared(unsigned int field, std::uint32_t node) const;

    const RunParts<dim>         parts;
    std::vector<MaterialBody *> liquids;
    const LiquidMeans<dim>     &means;
    NodeRooms<dim>              rooms;
    // By vertex: how many cells at a surface it is next to, and then m / (rho
    // R), what it holds without pressure over its room; zero: not known
    LazyArray<double> at_surface, filling;
    RecordExchange    exchange{1};
  };
} // namespace limber

#endif
