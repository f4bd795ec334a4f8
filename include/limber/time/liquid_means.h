// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_liquid_means_h
#define limber_time_liquid_means_h

#include <limber/time/cut_cells.h>
#include <limber/time/integrator.h>
#include <limber/time/surroundings.h>

namespace limber
{
  /**
   * The mean divergence of liquids in a cell: of which places it is the mean,
   * and what part of it a liquid takes. Both are written where the sweeps look
   * them up, in the sums of the cell and in MaterialBody::volume_shares, so
   * that strain and force have the same, one as the transpose of the other.
   *
   * Where several liquids share a cell, all have the mean over the points of
   * all of them, weighted by volume; one for each would be more conditions than
   * the nodes of a cell can meet. As pressures are to stay equal, the liquid k
   * of the volume share phi_k and the stiffness kappa_k = -J d(J p)/dJ takes
   *
   *   s_k = (1/kappa_k) / sum_j phi_j/kappa_j,   sum_k phi_k s_k = 1,
   *
   * of the divergence. Those whose pressure is implicit have one in common and
   * need no s_k. Liquids with fields of nodes of their own (contact) share
   * nothing.
   *
   * Where nodes are corners of cells, the mean inside is that over the cell and
   * not over the points in it, and what they fill of it counts as all of it.
   * Means over points do not see that points part from each other where the
   * divergence is above the mean: they would make way without work against the
   * pressure p, as if by a stiffness of - p against deviations of the
   * divergence, and water at rest would be unstable. In a layer at a surface
   * the cell counts as filled from within. What gathers all
   * the same is kept apart by ParticleShifting, and with an implicit pressure
   * by the density control. Where an obstacle cuts a cell (CutCells), its open
   * part takes the place of the cell. Theory: doc/theory/treatments.md.
   */
  template <int dim>
  class LiquidMeans
  {
  public:
    /** Cells that obstacles cut, or null. */
    LiquidMeans(const RunParts<dim> &parts, CutCells<dim> *cut_cells);

    /** Adopt a mesh that has changed. */
    void
    reinit();

    /** At the beginning of a step, when the sums of the cells are complete.
     * Collective. */
    void
    find();

    /** What surrounds the cells of a liquid that is alone in this field of
     * nodes and has means over cells; as find() has found it. */
    const Surroundings<dim> &
    surroundings(unsigned int field) const;

  private:
    using MaterialBody                    = limber::MaterialBody<dim>;
    static constexpr unsigned int n_nodes = 1 << dim;

    /** Liquids that give to the same nodes, and the solids that do. */
    struct Group
    {
      explicit Group(const BackgroundGrid<dim> &grid)
        : surroundings(grid)
      {}

      std::vector<MaterialBody *> liquids, solids;
      bool fills_cells        = false; // whether means over the cell are wanted
      bool is_implicit        = false; // the pressure of the liquids
      unsigned int      field = 0;
      Surroundings<dim> surroundings; // where cells are filled
    };

    /** One of the liquids in a cell. */
    struct Part
    {
      MaterialBody *body;
      double       *sums;   // CellSums
      double        mass;   // kg
      double        volume; // without pressure, m^3
      double        share;  // s_k
    };

    void
    find(const Group &group, std::uint32_t cell);
    void
    mix();
    void
    fill(const Group &group, std::uint32_t cell);
    void
    set_mean(unsigned int direction, double mean);
    void
    fill_open_part(const typename CutCells<dim>::Cell &cut, double share);
    bool
    reaches_surfaces(const typename CutCells<dim>::Cell &cut) const;
    double
    filling(std::uint32_t cell) const;
    bool
    is_covered(const std::uint32_t cell) const
    {
      return cut_cells != nullptr && cut_cells->is_covered(cell);
    }
    bool
    holds(const std::vector<MaterialBody *> &bodies, std::uint32_t cell) const;

    const RunParts<dim>  parts;
    CutCells<dim> *const cut_cells; // or null
    std::vector<Group>   groups;
    std::vector<Part>    in_cell;
  };
} // namespace limber

#endif
