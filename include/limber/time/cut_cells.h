// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_cut_cells_h
#define limber_time_cut_cells_h

#include <limber/time/integrator.h>

#include <array>
#include <vector>

namespace limber
{
  /**
   * Cut cells: cells intersected by the surfaces of rigid obstacles, for
   * liquids with one mean divergence per cell (treatment `cell`, B-bar).
   *
   * The signed distance phi from the obstacles (level set) is interpolated
   * linearly on the simplices of sub-cells, continuously across faces. The
   * region phi > 0 is open. Known are its volume fraction, the means of the
   * monomials in natural coordinates over it (moments), and the facets of the
   * obstacles' surfaces that bound it, with the means of the shape functions
   * over them. As
   *
   *   sum over cells of (int_open grad N_i dV) = - int_surface N_i n dS
   *
   * with n out of the obstacle, a constant pressure in the open part is in
   * equilibrium with the same pressure on the surface, at every node. For the
   * hydrostatic part of the pressure see Cell::hydrostatic.
   *
   * Small-cut cells count as closed: below the open volume fraction
   * least_open(), below least_open_layer() where the surface is normal to an
   * axis (a layer), below least_open_left() where points have left a cell that
   * a moving obstacle closes. The faces of open cells towards closed ones then
   * act as their surfaces. Towards a tip (closed_small_cut) only the part of
   * the face's normal along that of the obstacle counts; other faces keep
   * their normals and so sweep the same volume as the moving obstacle. Nodes of
   * faces that belong to no cut cell are constrained one by one, see
   * ObstacleContact. Theory: doc/theory/obstacles.md.
   */
  template <int dim>
  class CutCells
  {
  public:
    static constexpr unsigned int n_nodes = 1 << dim;
    using Vector                          = dealii::Tensor<1, dim>;

    /** Flat or nearly flat facet of the surface of one obstacle in a cell. */
    struct Surface
    {
      unsigned int                obstacle = 0;
      Vector                      normal; // out of the obstacle, of unit length
      dealii::Point<dim>          place;  // its centroid, m
      double                      area = 0;    // m^(dim-1)
      std::array<double, n_nodes> functions{}; // means of N_i over the facet
      std::array<Vector, n_nodes> normals{};   // int N_i n dS, m^(dim-1)
      std::array<Vector, n_nodes> moments{};   // means of N_i x over it, m
      // With an implicit pressure the facets of a cell with the same number
      // share one surface pressure p_s, at their common centroid x_s; in
      // explicit steps each has its own
      unsigned int piece  = 0;
      double       beyond = 0; // g . (place - x_s), m^2/s^2
    };

    /** A cell with facets of surfaces inside it or in its faces. */
    struct Cell
    {
      std::uint32_t number = 0;
      double        open   = 1; // open volume fraction
      // Means of the monomials (CellMeans) over the open part
      std::array<double, n_nodes> monomials{};
      std::vector<Surface>        surfaces;
      // Nodal forces, over rho, of the hydrostatic pressure rho g . x relative
      // to its means p_c over the open part and p_s over each surface:
      //   int_open g . (x - x_c) grad N_i dV
      //     + sum_s int_s g . (x - x_s) N_i n dS, m^(dim+1)/s^2
      std::array<Vector, n_nodes> hydrostatic{};
      // In cells next to tips (closed_small_cut): nodal forces per unit
      // pressure, m^(dim-1), that move the part of the pressure on the face
      // which acts along the obstacle to the corners that the tip leaves open.
      // There the parts of all faces of a tip cancel; the sum over the nodes of
      // the cell is zero.
      std::array<Vector, n_nodes> beside_tips{};
      bool                        is_beside_tip = false;

      bool
      is_cut() const
      {
        return open < 1;
      }
    };

    explicit CutCells(const RunParts<dim> &parts);

    /** Whether a scene may have cut cells: obstacles, linear shape functions,
     * and a liquid with the treatment `cell`. */
    static bool
    may_be(const RunParts<dim> &parts);

    /** Whether the liquids of a nodal field take cut cells into account. */
    bool
    knows(const unsigned int field) const
    {
      return knowing[field];
    }

    /** Open volume fraction below which a cell counts as closed. */
    double
    least_open() const
    {
      return least_share;
    }

    /** The same where the surface is normal to an axis, so that faces of cells
     * can replace it. Larger with an explicit pressure: the surface would hold
     * back too much of the water that passes the corner of a thin layer. */
    double
    least_open_layer() const
    {
      return least_of_layer;
    }

    /** The same for a cell that a moving obstacle closes and that holds no more
     * points: about the extent of a point's material, half its edge, in cells.
     */
    static constexpr double
    least_open_left()
    {
      return 0.3;
    }

    /** Factor on the dilation of a cell that limits the stiffness of small-cut
     * cells to what the explicit step (CFL) admits: open / (C^2 / 4) where the
     * open fraction is below C^2 / 4, with the Courant number C, else 1. */
    double
    softness(const std::uint32_t number) const
    {
      const Cell *const of_cell = cell(number);
      return of_cell && of_cell->open < stiff_share ?
               of_cell->open / stiff_share :
               1;
    }

    /** Adopt a mesh at a time; collective. */
    void
    reinit(double time);

    /** Update cut cells for obstacles that move, to the start of a step;
     * collective. */
    void
    find(double time);

    const std::vector<Cell> &
    all() const
    {
      return cells;
    }

    /** Whether any obstacle changes its place. */
    bool
    in_motion() const
    {
      return moves;
    }

    /** Whether any rank has a cell that is cut. */
    bool
    any() const
    {
      return any_cut;
    }

    /** Changes whenever the cut cells have been updated, for caches. */
    unsigned int
    version() const
    {
      return times_found;
    }

    /** The record of a cell of the grid; null where it has none. */
    const Cell *
    cell(const std::uint32_t number) const
    {
      const std::uint32_t kind = kinds[number];
      return kind >= first_cut ? &cells[kind - first_cut] : nullptr;
    }

    /** Whether a cell is inside obstacles, or counts as closed. */
    bool
    is_covered(const std::uint32_t number) const
    {
      return kinds[number] == covered || is_closed(number);
    }

    /** Whether a cell is cut but its open fraction counts as closed. */
    bool
    is_closed(const std::uint32_t number) const
    {
      return kinds[number] == closed || kinds[number] == closed_small_cut;
    }

    /** Whether material in a cell can exert a pressure: not in cells inside
     * obstacles, nor in tips. */
    bool
    has_room(const std::uint32_t number) const
    {
      return kinds[number] != covered && kinds[number] != closed_small_cut;
    }

    /** By vertex, bit mask of the covered cells around it, see is_covered():
     * the sum of 2^k over those of which it is the corner k. */
    const double *
    covered_corners() const
    {
      return at_covered.data();
    }

    /** Whether a node is a corner of a cell that is cut. */
    bool
    is_cut(const std::uint32_t node) const
    {
      return at_cut[node] > 0;
    }

    /** By vertex, the integral of N_i over the volume outside obstacles, m^dim.
     */
    const double *
    open_nodal_volumes() const
    {
      return open_volumes.data();
    }

    /** Whether a surface shares a node with a cut cell: always true for those
     * inside one, not for those in faces towards closed cells. */
    bool
    meets_cut(const Cell &cell, const Surface &surface) const
    {
      for (unsigned int a = 0; a < n_nodes; ++a)
        if (surface.functions[a] > 0 &&
            is_cut(parts.grid.geometry[cell.number].node[a] /
                   NodeLayout<dim>::stride))
          return true;
      return false;
    }

    /** Whether the liquid of a field reaches the surfaces in a cell: a flag
     * that other classes set and read here; find() clears it. */
    char &
    wets(const std::uint32_t cell, const unsigned int field)
    {
      return wet[(kinds[cell] - first_cut) * knowing.size() + field];
    }

  private:
    enum Kind : std::uint32_t
    {
      open,
      covered,          // inside obstacles
      closed,           // open part may hold points; its faces are walls
      closed_small_cut, // tip: its faces stand for the obstacle behind them
      first_cut
    };

    struct Simplex
    {
      std::array<dealii::Point<dim>, dim + 1> corners;  // natural coordinates
      std::array<double, dim + 1>             distance; // signed, m
    };

    using Places = std::vector<ObstaclePlace<dim>>;

    // Sub-cells along an edge of a cell, and the signed distances of their
    // corners from the obstacles, m, x fastest
    static constexpr unsigned int n_parts = dim == 2 ? 4 : 2;
    static constexpr unsigned int n_corners =
      (n_parts + 1) * (n_parts + 1) * (dim == 2 ? 1 : n_parts + 1);
    using Distances = std::array<double, n_corners>;
    using Shares    = std::array<double, n_nodes>;

    void
    find_cells(const Places &places);
    void
    find_open_volumes();
    void
    find_holding();
    void
    sum_over_ranks(LazyArray<double> &of_nodes);
    void
    find_distance_at_rest(const Places &places);
    bool
    is_as_before(std::uint32_t cell, const Places &places);
    void
    look_at(std::uint32_t cell, const Places &places);

    bool
    is_layer(std::uint32_t cell, const Distances &distances) const;
    void
    find_surfaces(Cell            &cell,
                  const Distances &distances,
                  const Places    &places) const;
    Distances
    distances_in(std::uint32_t cell, const Places &places) const;
    Shares
    open_corners(unsigned int     direction,
                 unsigned int     end,
                 const Distances &distances) const;
    template <class Work>
    void
    for_each_open_simplex(const Distances &distances, const Work &work) const;
    double
    diagonal(std::uint32_t cell) const;
    template <class Work>
    void
    divide(const Simplex &simplex, const Work &work) const;
    void
    add_volume(const Simplex &simplex, Cell &cell) const;
    void
    finish_volume(Cell &cell) const;
    void
    find_pieces(Cell &cell) const;
    void
    add_surface(const Simplex &simplex,
                unsigned int   opposite,
                const Shares  *at_tip,
                const Places  &places,
                Cell          &cell) const;
    std::uint32_t
    neighbour(std::uint32_t cell,
              unsigned int  direction,
              unsigned int  end) const;
    double
    way_since_found(const Places &places) const;
    double
    courant_number() const;

    const RunParts<dim>        parts;
    std::vector<char>          knowing; // by field
    std::vector<Cell>          cells;
    std::vector<std::uint32_t> kinds;                            // by cell
    LazyArray<double>          at_cut, at_covered, open_volumes; // by node
    RecordExchange             exchange{1};
    std::vector<char>          wet; // by cell, field
    // Signed distances of cell centres, m, from obstacles at rest; from moving
    // ones, reduced towards 0 by their motion since the distance was computed
    std::vector<double> distance_at_rest, distance;
    Places              former;
    bool                moves = false;
    // Mass of the points of all ranks by cell, kg; empty while it is not known
    // yet, or if no obstacle moves
    std::vector<double> holding;
    // By cell, whether moving obstacles were too far away to affect it or its
    // neighbours when cut cells were last updated
    std::vector<char> is_untouched;
    // Of the cells that are cut anew in this update, in their order
    std::vector<Distances>  distances_of_cells;
    const bool              is_implicit; // the pressure
    static constexpr double least_share    = 0.01;
    double                  least_of_layer = least_share;
    // Open fraction below which a cell is too stiff for the step: C^2 / 4, with
    // the Courant number C; 0 if the pressure is implicit
    double       stiff_share = 0;
    bool         any_cut     = false;
    unsigned int times_found = 0;
  };
} // namespace limber

#endif
