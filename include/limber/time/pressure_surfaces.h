// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_pressure_surfaces_h
#define limber_time_pressure_surfaces_h

#include <limber/time/corners_of_nodes.h>
#include <limber/time/cut_cells.h>

#include <array>
#include <vector>

namespace limber
{
  /**
   * The pieces of the surfaces of obstacles in cells of a liquid whose pressure
   * is implicit, numbered: one unknown q, the pressure on the surface, for each
   * (see ImplicitPressure). With the surfaces s of a piece
   * (CutCells::Surface::piece), their areas
   * S_s, normals n_s out of the obstacle and means <N_i>_s it has the entries
   *
   *   A_i = sum_s S_s <N_i>_s n_s,
   *
   * so that q pushes the nodes of its cell with A^T q, and A v is the volume
   * that leaves the surface in a second.
   *
   * Pieces of a rank are those of its cells; it knows those of the cells that
   * it shares with others as well.
   */
  template <int dim>
  class PressureSurfaces
  {
  public:
    static constexpr unsigned int  n_nodes = 1 << dim; // of a cell
    static constexpr std::uint32_t none    = 0xffffffffu;

    struct Piece
    {
      std::uint32_t cell  = 0;
      unsigned int  place = 0; // Surface::piece, on the owner
      std::uint32_t row   = 0; // of all ranks
      // By node and component, m^(dim-1)
      std::array<double, n_nodes * dim> entries{};

      // In this step
      bool   is_wet   = false;
      double leaving  = 0; // A v_o, least A v, m^dim/s
      double pressure = 0; // over the scale while the equations are solved
      double scale    = 1;
    };

    PressureSurfaces(const RunParts<dim> &parts, CutCells<dim> *cut_cells);

    /** Adopt a mesh that has changed, and the cells that follow its nodes. */
    void
    reinit(const CornersOfNodes<dim> &corners);

    /** Whether cut cells have changed since the pieces were set up. */
    bool
    are_old() const
    {
      return cut_cells != nullptr && version != cut_cells->version();
    }

    /** Set up the pieces in cells of this rank for which is_asked(cell). */
    template <class IsAsked>
    void
    choose(const IsAsked &is_asked)
    {
      clear();
      if (cut_cells == nullptr)
        return;
      version = cut_cells->version();
      for (const auto &cell : cut_cells->all())
        if (cell.number < parts.grid.n_owned_cells() && is_asked(cell.number))
          add(cell);
      n_own = pieces.size();
    }

    /** Number the rows of this rank's pieces from here on, and get the pieces
     * of shared cells from their owners. Collective. */
    void
    number(std::uint32_t first_row);

    /** Begin a step: no piece is wet, i.e. has a pressure. */
    void
    dry();

    /** Give a surface in a cell a pressure in this step: the mean normal
     * velocity on it is to be at least this, m/s. */
    void
    wet(std::uint32_t cell, unsigned int surface, double least);

    /** Index of the piece that a surface of a cell belongs to; or none. */
    std::uint32_t
    piece_of(std::uint32_t cell, unsigned int surface) const;

    /** After all wet(): exchange between ranks which pieces are wet.
     * Collective. */
    void
    finish_wetting();

    /** Copy a member from the owners of pieces to all ranks that know them. */
    void
    share(double Piece::*member);

    /** Whether there are any, on any rank. */
    bool
    any() const
    {
      return most_in_cell > 0;
    }

    std::uint32_t
    n_of_rank() const
    {
      return n_own;
    }

    /** Area of a surface in a cell, m^(dim-1). */
    double
    area_of(const std::uint32_t cell, const unsigned int surface) const
    {
      return cut_cells->cell(cell)->surfaces[surface].area;
    }

    const CutCells<dim> *
    cells() const
    {
      return cut_cells;
    }

    /** Call work(index) for the pieces in a cell. */
    template <class Work>
    void
    for_each_in(const std::uint32_t cell, const Work &work) const
    {
      for (std::uint32_t k = first_of[cell] - 1;
           k < pieces.size() && pieces[k].cell == cell;
           ++k)
        work(k);
    }

    std::vector<Piece> pieces; // own ones first

  private:
    using Cell = typename CutCells<dim>::Cell;

    void
    clear();
    void
    add(const Cell &cell);
    void
    learn_of_neighbours();
    double *
    told_in(std::uint32_t cell);
    unsigned int
    place_of(std::size_t piece) const;
    template <class Get, class Set>
    void
    exchange(const Get &get, const Set &set);

    const RunParts<dim>      parts;
    CutCells<dim> *const     cut_cells; // or null
    unsigned int             version      = 0;
    std::uint32_t            n_own        = 0;
    unsigned int             most_in_cell = 0; // of all ranks
    std::size_t              n_known      = 0; // cells, far ones too
    LazyArray<std::uint32_t> first_of; // by cell, 1 + its first piece, or 0
    // Exchange buffer by cell: a number for each piece in it, and their entries
    LazyArray<double>             told;
    std::optional<RecordExchange> between_ranks;
    std::optional<ExchangePlan>   shared_cells;
  };
} // namespace limber

#endif
