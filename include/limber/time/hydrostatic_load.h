// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_hydrostatic_load_h
#define limber_time_hydrostatic_load_h

#include <limber/state/material_body.h>
#include <limber/time/surroundings.h>

#include <memory>
#include <vector>

namespace limber
{
  template <int dim>
  class CutCells;



  /**
   * The part of the hydrostatic pressure that a constant one leaves out, where
   * cells of several sizes meet, and where obstacles cut them.
   *
   * In a liquid with the mean divergence of a cell the pressure is constant in
   * it. At rest it is p_c + rho g . (x - x_c), and the second part gives the
   * corner a, with signs s_ad = -1, 1, the force
   *
   *   f_ad = int rho g . (x - x_c) dN_a/dx_d dV
   *        = rho V / (12 2^(dim - 2)) sum_(e /= d) s_ad s_ae g_e h_e / h_d,
   *
   * the shape of hourglass motion. Between equal cells it cancels, so that it
   * may as well be left out; at the corners of a fine region, and where its
   * rim meets a side or a surface, leaving it out sets water at rest in motion,
   * by some g/16. So it is added there: at the masters of hanging nodes, from
   * cells with a neighbour across d, of which one cancels the other if they are
   * equal. What a cell at a surface holds counts as filling it from within.
   * Theory: doc/theory/adaptive_grid.md.
   *
   * The same at the corners of cells that obstacles cut (CutCells), where the
   * integral is that over the open part, and the pressure on the surfaces has
   * such a part as well. Theory: doc/theory/obstacles.md.
   */
  template <int dim>
  class HydrostaticLoad
  {
  public:
    using Bodies = std::vector<std::unique_ptr<MaterialBody<dim>>>;

    /** Cells that obstacles cut, or null. */
    HydrostaticLoad(const Problem<dim>        &problem,
                    const BackgroundGrid<dim> &grid,
                    const Bodies              &bodies,
                    CutCells<dim>             *cut_cells);

    /** Whether there may be any: gravity, liquids, and levels or obstacles. */
    bool
    may_be() const
    {
      return !liquids.empty();
    }

    /** Whether there may be any now: levels, or cells that are cut. */
    bool
    any() const;

    /** Adopt a mesh; collective. */
    void
    reinit();

    /** What acts in the step that begins, while the sums of the cells are
     * those of the present places; collective. */
    void
    find(const NodalFields<dim> &nodes);

    /** Add that on a field of nodes, N, to @p forces, dim per node. */
    void
    add(unsigned int field, LazyArray<double> &forces) const;

  private:
    static constexpr unsigned int n_corners = 1 << dim;

    void
    find_cells();
    void
    find(const NodalFields<dim> &nodes, unsigned int field);
    bool
    knows_cut_cells(unsigned int field) const;
    double
    density_within(unsigned int field, std::uint32_t cell, double open) const;
    double
    of_whole_cell(std::uint32_t cell,
                  unsigned int  corner,
                  unsigned int  direction) const;
    bool
    holds_liquid_alone(unsigned int field, std::uint32_t cell) const;

    const Problem<dim>              &problem;
    const BackgroundGrid<dim>       &grid;
    std::vector<MaterialBody<dim> *> liquids, others;
    CutCells<dim> *const             cut_cells;   // or null
    unsigned int                     version = 0; // of these
    Surroundings<dim>                surroundings;
    // Masters of the mesh and corners of cells that are cut; cells of this
    // rank with a corner that is one or hangs on one
    std::vector<std::uint32_t> meeting, cells;
    LazyArray<double>          sums; // by node, N
    RecordExchange             exchange{dim};
    // By field, of the nodes where unequal cells meet
    std::vector<std::vector<dealii::Tensor<1, dim>>> on_nodes;
  };
} // namespace limber

#endif
