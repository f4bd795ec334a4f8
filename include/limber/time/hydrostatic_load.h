// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_hydrostatic_load_h
#define limber_time_hydrostatic_load_h

#include <limber/state/material_body.h>
#include <limber/time/surroundings.h>

#include <memory>
#include <vector>

namespace limber
{
  /**
   * The part of the hydrostatic pressure that a constant one leaves out, where
   * cells of several sizes meet.
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
   */
  template <int dim>
  class HydrostaticLoad
  {
  public:
    using Bodies = std::vector<std::unique_ptr<MaterialBody<dim>>>;

    HydrostaticLoad(const Problem<dim>        &problem,
                    const BackgroundGrid<dim> &grid,
                    const Bodies              &bodies);

    /** Whether there may be any: gravity, levels, and liquids. */
    bool
    any() const
    {
      return !liquids.empty();
    }

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
    find(const NodalFields<dim> &nodes, unsigned int field);
    double
    weight_within(unsigned int field, std::uint32_t cell) const;
    double
    shape(unsigned int corner, unsigned int direction) const;
    bool
    holds_liquid_alone(unsigned int field, std::uint32_t cell) const;

    const Problem<dim>              &problem;
    const BackgroundGrid<dim>       &grid;
    std::vector<MaterialBody<dim> *> liquids, others;
    Surroundings<dim>                surroundings;
    // Cells of this rank with a corner that is, or hangs on, a master
    std::vector<std::uint32_t> cells;
    LazyArray<double>          sums; // by node, N
    RecordExchange             exchange{dim};
    // By field, of the masters of the mesh
    std::vector<std::vector<dealii::Tensor<1, dim>>> on_masters;
  };
} // namespace limber

#endif
