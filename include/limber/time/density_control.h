// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_density_control_h
#define limber_time_density_control_h

#include <limber/time/liquid_means.h>
#include <limber/time/nodal_volumes.h>

namespace limber
{
  /**
   * Volume conservation (density correction) of liquids in explicit steps.
   * Their pressure follows the volume ratios J of points, which drift away from
   * the volume that the points in fact occupy as they move through cells,
   * evenly over many cells, and the liquid sinks. So the J of the points in a
   * cell is relaxed towards the volume at the nodes of the cell,
   *
   *   J -= C s mean(e_i),   e_i = J_c m_i / (rho R_i) - 1,
   *
   * with the mass of a node, its available volume R_i (NodalVolumes) and the
   * mean J_c of the cell: where points are too dense the pressure rises and
   * drives them apart, through to the surface, at the speed of sound. C is the
   * body's 'Density control' and s the displacement of the fastest point in the
   * step over the largest of semi-implicit steps, 0.4 cells; their control, in
   * PressureSystem, has the same source term. Nodes next to cells at a surface,
   * where R_i may not be filled, and nodes with other bodies do not count. (If
   * only an excess counted at surfaces, noise would be rectified: dam breaks
   * with four points in a cell gained 1 % of energy.) The energy that this
   * takes or gives is recorded as removed with histories.
   *
   * For bodies that are alone in their field of nodes, with linear functions,
   * means over cells and cells of one size. Theory: doc/theory/treatments.md.
   */
  template <int dim>
  class DensityControl
  {
  public:
    /** @p cut_cells may be null. */
    DensityControl(const RunParts<dim>    &parts,
                   const LiquidMeans<dim> &means,
                   const CutCells<dim>    *cut_cells);

    /** Adopt a mesh; collective. */
    void
    reinit();

    /** Add the change of J in a step to MaterialBody::cell_shift. LiquidMeans
     * are up to date, and nodes have the complete mass of the points; the
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
    NodalVolumes<dim>           nodal_volumes;
    // By vertex: how many cells at a surface it is next to; m / (rho R), its
    // stress-free volume over the available one, 0 where that is not known
    LazyArray<double> at_surface, filling;
    RecordExchange    exchange{1};
  };
} // namespace limber

#endif
