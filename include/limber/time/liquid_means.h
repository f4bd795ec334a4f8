// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_liquid_means_h
#define limber_time_liquid_means_h

#include <limber/time/cut_cells.h>
#include <limber/time/integrator.h>
#include <limber/time/surroundings.h>

namespace limber
{
  /**
   * The mean divergence of liquids in a cell (treatment `cell`, B-bar): over
   * which region the mean is taken, and which share of it each liquid takes.
   * Both are written to the sums of the cell and to
   * MaterialBody::volume_shares, from which all sweeps read them, so that
   * strain and force stay transposes of each other.
   *
   * If several liquids share a cell, all have the mean over the points of all
   * of them, weighted by volume; a mean for each would be more constraints than
   * the nodes of a cell can satisfy (locking). For pressures to stay equal, the
   * liquid k with the volume fraction phi_k and the stiffness
   * kappa_k = -J d(J p)/dJ takes
   *
   *   s_k = (1/kappa_k) / sum_j phi_j/kappa_j,   sum_k phi_k s_k = 1,
   *
   * of the divergence. Liquids with an implicit pressure have one in common and
   * need no s_k. Liquids with nodal fields of their own (contact) do not
   * interact.
   *
   * With linear functions, inside a liquid the mean is taken over the cell
   * instead of the points in it, which count as filling it. Means over points
   * do not notice that points move apart where the divergence is above the
   * mean: they would do so without work against the pressure p, like a negative
   * stiffness - p against deviations of the divergence, and water at rest would
   * be unstable. In a layer at a surface the cell counts as filled from the
   * inside. Clumping that remains is treated by ParticleShifting, and with an
   * implicit pressure by the density control. In cut cells (CutCells) the open
   * part takes the place of the cell. Theory: doc/theory/treatments.md.
   */
  template <int dim>
  class LiquidMeans
  {
  public:
    /** @p cut_cells may be null. */
    LiquidMeans(const RunParts<dim> &parts, CutCells<dim> *cut_cells);

    /** Adopt a mesh that has changed. */
    void
    reinit();

    /** At the beginning of a step, when the sums of the cells are complete.
     * Collective. */
    void
    find();

    /** Which cells around those of a liquid are filled, as of the last find();
     * for a liquid that is alone in this nodal field and has means over cells.
     */
    const Surroundings<dim> &
    surroundings(unsigned int field) const;

  private:
    using MaterialBody                    = limber::MaterialBody<dim>;
    static constexpr unsigned int n_nodes = 1 << dim;

    /** Liquids and solids that share a nodal field. */
    struct Group
    {
      explicit Group(const BackgroundGrid<dim> &grid)
        : surroundings(grid)
      {}

      std::vector<MaterialBody *> liquids, solids;
      bool fills_cells        = false; // whether the mean is that over the cell
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
      double        volume; // reference volume, m^dim
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
