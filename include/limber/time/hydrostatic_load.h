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
   * Correction of gravity (well-balancing): nodal forces of the linear part of
   * the hydrostatic pressure in a cell, which a constant cell pressure leaves
   * out; at surfaces, where cells of several sizes meet, and in cut cells.
   *
   * With one mean divergence per cell (treatment `cell`) the pressure of a
   * liquid is constant in the cell. At rest it is p_c + rho g . (x - x_c), and
   * the second part exerts on the corner a, with signs s_ad = -1, 1, the force
   *
   *   f_ad = int rho g . (x - x_c) dN_a/dx_d dV
   *        = rho V / (12 2^(dim - 2)) sum_(e /= d) s_ad s_ae g_e h_e / h_d,
   *
   * with the pattern of an hourglass mode. Between equal cells it cancels, so
   * that it may be left out. At each step of a surface that is not level, at
   * the corners of a fine region, and where the rim of this meets a side or a
   * surface, leaving it out accelerates water at rest by some g/3 and g/16. So
   * it is added there: at corners of cells at a surface and at the masters of
   * hanging nodes, from cells with a neighbour across d, which cancel each
   * other if they are equal. A partly filled cell at a surface counts as filled
   * from the inside. In free fall there is no pressure: along a surface the
   * force fades with the pressures around the nodes. Theory:
   * doc/theory/adaptive_grid.md.
   *
   * The same at the corners of cut cells (CutCells), with the integral over the
   * open part and that over the surfaces. Theory: doc/theory/obstacles.md.
   */
  template <int dim>
  class HydrostaticLoad
  {
  public:
    using Bodies = std::vector<std::unique_ptr<MaterialBody<dim>>>;

    /** @p cut_cells may be null. */
    HydrostaticLoad(const Problem<dim>        &problem,
                    const BackgroundGrid<dim> &grid,
                    const Bodies              &bodies,
                    CutCells<dim>             *cut_cells);

    /** Whether the scene may need this load: gravity and liquids. */
    bool
    any() const
    {
      return !liquids.empty();
    }

    /** Adopt a mesh; collective. */
    void
    reinit();

    /** Find the forces for the step that begins, while the sums of the cells
     * are those of the present places; collective. */
    void
    find(const NodalFields<dim> &nodes);

    /** Add the forces on a nodal field, N, whose masses are known by now, to
     * @p forces, dim per node. */
    void
    add(const NodalFields<dim> &nodes,
        unsigned int            field,
        LazyArray<double>      &forces) const;

  private:
    static constexpr unsigned int n_corners = 1 << dim;

    void
    find_uneven_nodes();
    void
    find(const NodalFields<dim> &nodes, unsigned int field);
    bool
    knows_cut_cells(unsigned int field) const;
    bool
    is_level(unsigned int direction, unsigned int end) const;
    double
    density_within(unsigned int field, std::uint32_t cell, double open) const;
    double
    pressure_over_density(unsigned int field, std::uint32_t cell) const;
    double
    pressure_over_weight(unsigned int field, std::uint32_t cell) const;
    void
    find_pressures(const NodalFields<dim> &nodes, unsigned int field);
    double
    borne_share(std::uint32_t cell) const;
    void
    mark_nodes(const NodalFields<dim> &nodes);

    bool
    has_marked_node(const std::uint32_t cell) const
    {
      for (unsigned int a = 0; a < n_corners; ++a)
        if (is_marked(surroundings.node_of(cell, a)))
          return true;
      return false;
    }

    bool
    is_marked(const std::uint32_t node) const
    {
      return is_uneven[node] || at_surface[node] > 0;
    }

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
    // By node: whether it is a master, a hanging node or a corner of a cut
    // cell; of how many cells at a surface it is a corner
    std::vector<unsigned char> is_uneven;
    LazyArray<double>          at_surface;
    std::vector<std::uint32_t> marked_cells; // with liquid and nothing else
    LazyArray<double>          sums;         // by node, N
    LazyArray<double>          pressures; // by node, over the weight of a cell
    RecordExchange             exchange{dim}, exchange_of_one{1};

    /** Nodes that are loaded, and by what, N. */
    struct OfField
    {
      std::vector<std::uint32_t>          nodes;
      std::vector<dealii::Tensor<1, dim>> forces;
    };
    std::vector<OfField> of_fields;
  };
} // namespace limber

#endif
