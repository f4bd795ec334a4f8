// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_cut_cells_h
#define limber_time_cut_cells_h

#include <limber/time/integrator.h>

#include <array>
#include <vector>

namespace limber
{
  /**
   * The cells that the surfaces of obstacles run across, for liquids with one
   * mean divergence in a cell.
   *
   * Between the corners of parts of a cell the distance phi from the obstacles
   * is taken as linear on simplices, the same on either side of a face. What
   * has phi > 0 is open. Of it are known its share of the volume, the means of
   * the monomials in natural coordinates, and the pieces of surface that bound
   * it with the means of the functions of the nodes over them. As
   *
   *   sum over cells of (int_open grad N_i dV) = - int_surface N_i n dS
   *
   * with n out of the obstacle, a constant pressure in the open part is borne
   * by the same pressure on the surface, at every node. What a pressure that
   * grows with the depth adds to that is known as well, see Cell::hydrostatic.
   *
   * A cell that is open by less than least_open() counts as closed, a layer
   * across an axis by less than least_open_layer(), one that points have left
   * before a moving obstacle by less than least_open_left(). Faces towards such
   * cells are surfaces of others that are cut, with the part of their normals
   * along that of the obstacle before a tip at rest, else with their own, so
   * that they sweep the volume that the obstacle does; nodes of faces that no
   * cut cell has are held one by one, see ObstacleContact. Theory:
   * doc/theory/obstacles.md.
   */
  template <int dim>
  class CutCells
  {
  public:
    static constexpr unsigned int n_nodes = 1 << dim;
    using Vector                          = dealii::Tensor<1, dim>;

    /** A piece of surface in a cell: nearly flat, of one obstacle. */
    struct Surface
    {
      unsigned int                obstacle = 0;
      Vector                      normal; // out of the obstacle, of unit length
      dealii::Point<dim>          place;  // its centroid, m
      double                      area = 0;    // m^(dim-1)
      std::array<double, n_nodes> functions{}; // means of N_i over it
      std::array<Vector, n_nodes> normals{};   // int N_i n dS, m^(dim-1)
      std::array<Vector, n_nodes> moments{};   // means of N_i x over it, m
      // Those of a cell with the same number have one pressure p_s, at their
      // centroid x_s: each its own in explicit steps
      unsigned int piece  = 0;
      double       beyond = 0; // g . (place - x_s), m^2/s^2
    };

    /** A cell with surfaces across it or in its faces. */
    struct Cell
    {
      std::uint32_t number = 0;
      double        open   = 1; // share of its volume
      // Means of the monomials (CellMeans) over the open part
      std::array<double, n_nodes> monomials{};
      std::vector<Surface>        surfaces;
      // What the pressure rho g . x has beyond its means p_c over the open part
      // and p_s over each surface does to the nodes, without rho:
      //   int_open g . (x - x_c) grad N_i dV
      //     + sum_s int_s g . (x - x_s) N_i n dS, m^(dim+1)/s^2
      std::array<Vector, n_nodes> hydrostatic{};
      // Before tips that count as closed: what puts the part of the pressure
      // that acts along the surface there, over the pressure, into the corners
      // that the tip leaves open, m^(dim-1). There that on all of its faces
      // cancels; the sum over the nodes is zero.
      std::array<Vector, n_nodes> beside_tips{};
      bool                        is_beside_tip = false;

      bool
      is_cut() const
      {
        return open < 1;
      }
    };

    explicit CutCells(const RunParts<dim> &parts);

    /** Whether a scene may have any: liquids with obstacles on vertices. */
    static bool
    may_be(const RunParts<dim> &parts);

    /** Whether the liquids of a field of nodes know of them. */
    bool
    knows(const unsigned int field) const
    {
      return knowing[field];
    }

    /** Share of a cell: where less is open it counts as closed. */
    double
    least_open() const
    {
      return least_share;
    }

    /** The same where the surface lies across an axis, so that the faces of
     * cells do for it: more with an explicit pressure, as water that passes the
     * corner of a thin layer is held too much. */
    double
    least_open_layer() const
    {
      return least_of_layer;
    }

    /** The same of a cell that a moving obstacle closes and the last points
     * have left: about what their material reaches beyond them, half an edge.
     */
    static constexpr double
    least_open_left()
    {
      return 0.3;
    }

    /** What the pressure in a cell answers its dilation with, over that in any
     * other: less where so little is open that it would be too stiff for the
     * step, as if C^2 / 4 were open. */
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

    /** Follow the obstacles to the beginning of a step; collective. */
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

    /** Another one whenever the cells have been found anew. */
    unsigned int
    version() const
    {
      return times_found;
    }

    /** That of a cell of the grid; null where it has none. */
    const Cell *
    cell(const std::uint32_t number) const
    {
      const std::uint32_t kind = kinds[number];
      return kind >= first_cut ? &cells[kind - first_cut] : nullptr;
    }

    /** Whether obstacles take all of a cell, or all but a rest. */
    bool
    is_covered(const std::uint32_t number) const
    {
      return kinds[number] == covered || is_closed(number);
    }

    /** Whether they leave a rest that counts as closed. */
    bool
    is_closed(const std::uint32_t number) const
    {
      return kinds[number] == closed || kinds[number] == closed_to_a_rest;
    }

    /** Whether what is in a cell, if anything, has room to press on anything.
     */
    bool
    has_room(const std::uint32_t number) const
    {
      return kinds[number] != covered && kinds[number] != closed_to_a_rest;
    }

    /** By vertex, of which cells that obstacles take it is a corner: the sum
     * of 2^k, it being their corner k. */
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

    /** By vertex, the integral of N_i over what obstacles leave open, m^dim. */
    const double *
    rooms() const
    {
      return open_rooms.data();
    }

    /** Whether a surface ends at a cell that is cut, as those across one do;
     * others in faces of cells need not. */
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

    /** Whether the liquid of a field reaches the surfaces in a cell, a record
     * that others keep here. */
    char &
    wets(const std::uint32_t cell, const unsigned int field)
    {
      return wet[(kinds[cell] - first_cut) * knowing.size() + field];
    }

  private:
    enum Kind : std::uint32_t
    {
      open,
      covered,
      closed,           // but for what may hold points; with walls for faces
      closed_to_a_rest, // a tip, its faces stand for the obstacle behind
      first_cut
    };

    struct Simplex
    {
      std::array<dealii::Point<dim>, dim + 1> corners;  // natural coordinates
      std::array<double, dim + 1>             distance; // m
    };

    using Places = std::vector<ObstaclePlace<dim>>;

    // Parts of a cell along an edge, and the distances of their corners from
    // the obstacles, m, x fastest
    static constexpr unsigned int n_parts = dim == 2 ? 4 : 2;
    static constexpr unsigned int n_corners =
      (n_parts + 1) * (n_parts + 1) * (dim == 2 ? 1 : n_parts + 1);
    using Distances = std::array<double, n_corners>;
    using Shares    = std::array<double, n_nodes>;

    void
    find_cells(const Places &places);
    void
    find_rooms();
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
    std::vector<std::uint32_t> kinds;                          // by cell
    LazyArray<double>          at_cut, at_covered, open_rooms; // by node
    RecordExchange             exchange{1};
    std::vector<char>          wet; // by cell, field
    // Of the middles of cells from what is at rest, m; and from what moves,
    // less what it has moved by since
    std::vector<double> distance_at_rest, distance;
    Places              former;
    bool                moves = false;
    // By cell: positive where it holds points of any rank; empty where that is
    // not known yet, or nothing moves
    std::vector<double> holding;
    // By cell, whether what moves was too far off to do anything to it or to
    // those around when cells were last found
    std::vector<char> is_untouched;
    // Of the cells that are being found anew, in their order
    std::vector<Distances>  distances_of_cells;
    const bool              is_implicit; // the pressure
    static constexpr double least_share    = 0.01;
    double                  least_of_layer = least_share;
    // Below it a cell is too stiff for the step: C^2 / 4, with the Courant
    // number C; 0 where the pressure is implicit
    double       stiff_share = 0;
    bool         any_cut     = false;
    unsigned int times_found = 0;
  };
} // namespace limber

#endif
