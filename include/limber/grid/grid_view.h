// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_grid_view_h
#define limber_grid_grid_view_h

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

/**
 * @file What the sweeps see of the background grid: plain arrays, no deal.II.
 * BackgroundGrid and NodalFields fill them; every sweep reads and writes the
 * grid through them and through nothing else, so that hanging nodes and ranks
 * remain a matter of NodalFields alone.
 */
namespace limber
{
  inline constexpr std::uint32_t invalid_cell = 0xffffffffu;

  /**
   * The record of a node. Fields that are never needed at a time share their
   * place, but each has its own name. Two dimensions are padded to one cache
   * line.
   */
  template <int dim>
  struct NodeLayout
  {
    // Sums over points, until nodes are advanced
    static constexpr unsigned int mass     = 0;       // kg
    static constexpr unsigned int force    = 1;       // N
    static constexpr unsigned int momentum = 1 + dim; // kg m/s
    // Momentum that points give back with their new velocities, kg m/s
    static constexpr unsigned int remapped = 1 + 2 * dim;
    static constexpr unsigned int stride   = dim == 2 ? 8 : 10;

    // Of advanced nodes: change of the velocity in the step, new one, m/s
    static constexpr unsigned int increment = force;
    static constexpr unsigned int velocity  = momentum;
    // Of the beginning of the step, once the increment has been taken, m/s
    static constexpr unsigned int former_velocity = force;
    // Of the middle of the step, once the increment has been taken, and that
    // with which points move: the new one or the middle one, m/s
    static constexpr unsigned int middle_velocity = force;
    static constexpr unsigned int moving_velocity = momentum;
    // Formed of a momentum to strain the points: of that which they bring,
    // before there are forces, or of that which they give back, m/s
    static constexpr unsigned int strain_velocity = remapped;
    // Between these two
    static constexpr unsigned int hourglass_force = remapped; // N
    // Of implicit pressures, once the other forces have become increments, N
    static constexpr unsigned int pressure_force = remapped;
  };



  /** A rectangular cell: its first corner, 1 / edges, records of its nodes. */
  template <int dim>
  struct CellGeometry
  {
    std::array<double, dim>             origin;       // m
    std::array<double, dim>             inverse_edge; // 1/m
    std::array<std::uint32_t, 1 << dim> node; // offset of the node's record
  };



  /**
   * The nodes of the splines that do not vanish in a cell, as offsets of their
   * records; the first direction runs fastest. Where there is none, beyond a
   * side, that of the node in the side, and the function is zero.
   */
  template <int dim, int degree>
  struct SplineCell
  {
    static constexpr int n = degree + 1; // along a direction

    std::array<std::uint32_t, dim == 2 ? n * n : n * n * n> node;
    // Of each direction: factors of the first and the last function, others
    // where the cell ends at a side of the grid (SplineFactors).
    std::array<double, dim> lower, upper;
  };



  /**
   * From a place to the cell that holds it: a table over equal bins, the cells
   * of the lattice of the scene. Where a bin is divided into finer cells, the
   * table leads to a block of places, as fine as the finest cell. Places
   * outside the table give invalid_cell.
   */
  template <int dim>
  struct BinView
  {
    // An entry from this one on, but for invalid_cell, is a block.
    static constexpr std::uint32_t first_block = 0x80000000u;

    std::array<double, dim>       lower{};
    std::array<double, dim>       inverse_edge{};
    std::array<std::int64_t, dim> n{};
    const std::uint32_t          *table = nullptr;
    bool one_per_cell = false; // whether each bin is a cell of its own
    // Blocks one after the other, of so many places along each edge
    const std::uint32_t *blocks   = nullptr;
    std::int64_t         per_edge = 1;
    // Where each bin is a cell and points have domains, offsets of the records
    // of the nodes of all bins, one more along each direction; `no_node` where
    // there is none. Four can be read from each place. Else null
    static constexpr std::uint32_t no_node = 0xffffffffu;
    const std::uint32_t           *nodes   = nullptr;

    std::uint32_t
    cell_at(const std::array<double, dim> &x) const
    {
      std::int64_t index = 0;
      for (int d = dim - 1; d >= 0; --d)
        {
          const double bin = std::floor((x[d] - lower[d]) * inverse_edge[d]);
          if (!(bin >= 0 && bin < static_cast<double>(n[d])))
            return invalid_cell;
          index = index * n[d] + static_cast<std::int64_t>(bin);
        }
      return cell_in(table[index], x);
    }

    /**
     * The same; a place beyond the box counts in the side next to it, and one
     * that is no number in the lower one.
     */
    std::uint32_t
    nearest_cell(const std::array<double, dim> &x) const
    {
      std::int64_t index = 0;
      for (int d = dim - 1; d >= 0; --d)
        {
          const double bin  = (x[d] - lower[d]) * inverse_edge[d];
          const double last = static_cast<double>(n[d] - 1);
          index             = index * n[d] +
                  static_cast<std::int64_t>(std::min(std::max(0., bin), last));
        }
      return cell_in(table[index], x);
    }

    /** Where the box ends, m. */
    double
    upper(const int d) const
    {
      return lower[d] + n[d] / inverse_edge[d];
    }

  private:
    std::uint32_t
    cell_in(const std::uint32_t entry, const std::array<double, dim> &x) const
    {
      if (entry < first_block || entry == invalid_cell)
        return entry;
      std::int64_t index = entry - first_block;
      for (int d = dim - 1; d >= 0; --d)
        {
          const double bin   = (x[d] - lower[d]) * inverse_edge[d];
          const double first = std::min(std::max(0., std::floor(bin)),
                                        static_cast<double>(n[d] - 1));
          const double place = (bin - first) * static_cast<double>(per_edge);
          const double last  = static_cast<double>(per_edge - 1);
          index              = index * per_edge + static_cast<std::int64_t>(
                                       std::min(std::max(0., place), last));
        }
      return blocks[index];
    }
  };



  /**
   * The record of a node of the dual domain method (dual_domain.h): rows of a
   * tensor, the mean velocity gradient around the node, 1/s, or what meets it,
   * the volume times stress that points have given, J; around which volume,
   * m^3; the force that follows from the stress, N.
   */
  template <int dim>
  struct DualDomainLayout
  {
    static constexpr unsigned int volume = dim == 2 ? 4 : 11;
    static constexpr unsigned int force  = dim == 2 ? 5 : 12;
    static constexpr unsigned int stride = dim == 2 ? 8 : 16;

    static constexpr unsigned int
    tensor(const int d, const int e)
    {
      return (dim == 2 ? 2 : 4) * d + e;
    }
  };



  /** The table BinView::nodes. */
  template <int dim>
  std::vector<std::uint32_t>
  nodes_of_bins(const BinView<dim>                   &bins,
                const std::vector<CellGeometry<dim>> &cells)
  {
    std::int64_t n_bins = 1, n_nodes = 1;
    for (int d = 0; d < dim; ++d)
      {
        n_bins *= bins.n[d];
        n_nodes *= bins.n[d] + 1;
      }
    std::vector<std::uint32_t> result(n_nodes + 3, BinView<dim>::no_node);
    for (std::int64_t bin = 0; bin < n_bins; ++bin)
      if (bins.table[bin] != invalid_cell)
        for (int i = 0; i < 1 << dim; ++i)
          {
            std::int64_t place = 0, stride = 1, rest = bin;
            for (int d = 0; d < dim; ++d, stride *= bins.n[d - 1] + 1)
              {
                place += stride * (rest % bins.n[d] + (i >> d & 1));
                rest /= bins.n[d];
              }
            result[place] = cells[bins.table[bin]].node[i];
          }
    return result;
  }



  template <int dim>
  struct GridView
  {
    const CellGeometry<dim> *cells = nullptr;
    double                  *nodes = nullptr;
    BinView<dim>             bins;
    // By cell, where the functions of the nodes are such splines; else null
    const SplineCell<dim, 2> *quadratics = nullptr;
    const SplineCell<dim, 3> *cubics     = nullptr;
    // Records of DualDomainLayout, where gradients partly come from them
    double *dual_domain = nullptr;

    // Cells that a point has entered and that were empty before; their nodes
    // have to join the active ones.
    std::uint8_t               *occupied = nullptr; // per cell
    std::vector<std::uint32_t> *entered  = nullptr;
    // Set when a point has gone where this rank knows no cell, or into a cell
    // of another rank: those from this number on.
    bool         *left          = nullptr;
    bool         *is_in_ghosts  = nullptr;
    std::uint32_t n_owned_cells = invalid_cell;
  };



  /**
   * Sums over the points of one body in each cell, from which the Hu-Washizu
   * averages (DGQ0) follow: the mass, its moments with the monomials of the
   * basis (xi, eta, xi eta, zeta, ... of linear functions) but the last one,
   * and in the slot of that the sum of m times the volumetric variable.
   *
   * Whoever moves the points gathers the sums of their new places, so that
   * those of the present places are complete when a step begins. Nobody sets
   * records to zero in between: each cell knows the turn in which it got its
   * last sums, and the first to come in a new turn overwrites what is old.
   */
  template <int dim>
  struct CellSums
  {
    static constexpr unsigned int mass = 0;

    const double  *now     = nullptr;  // of the present places, complete
    double        *next    = nullptr;  // of the places after the step
    std::uint32_t *turn_of = nullptr;  // last in which a cell got sums
    std::uint32_t  turn    = 0;        // in which the next sums are gathered
    unsigned int   stride  = 1 << dim; // as many as a cell has nodes

    /** The slot of the sum of m times the volumetric variable. */
    unsigned int
    volumetric() const
    {
      return stride - 1;
    }

    /** Whether the next sums of a cell are what this turn has gathered. */
    bool
    is_open(const std::uint32_t cell) const
    {
      return turn_of[cell] == turn;
    }

    /** The next sums of a cell, to be added to. */
    double *
    open(const std::uint32_t cell) const
    {
      double *const record = next + std::size_t(cell) * stride;
      if (!is_open(cell))
        {
          turn_of[cell] = turn;
          std::fill_n(record, stride, 0.);
        }
      return record;
    }

    /** The present mass in a cell, before next sums are gathered. */
    double
    present_mass(const std::uint32_t cell) const
    {
      return turn_of[cell] + 1 == turn ?
               now[std::size_t(cell) * stride + mass] :
               0;
    }
  };



  /**
   * The record of a cell in sums for the mean of the deviatoric strain e of one
   * body: the mass, and m e by components (n_deviator).
   */
  template <int dim>
  struct DeviatorSums
  {
    static constexpr unsigned int mass   = 0;
    static constexpr unsigned int strain = 1;
    static constexpr unsigned int stride = 1 << dim;
  };



  /**
   * The record of a node in the projection on nodes of a quantity q of one
   * body: sums of m N_i and m N_i q over its points. When they are complete,
   * the mean takes the place of the second.
   */
  struct NodalMeanLayout
  {
    static constexpr unsigned int mass   = 0;
    static constexpr unsigned int value  = 1;
    static constexpr unsigned int stride = 2;
  };
} // namespace limber

#endif
