// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_grid_view_h
#define limber_grid_grid_view_h

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

/**
 * @file The background grid as the sweeps see it: plain arrays, no deal.II.
 * BackgroundGrid and NodalFields fill them; every sweep accesses the grid
 * through them alone, so that hanging nodes and ranks are dealt with in
 * NodalFields only.
 */
namespace limber
{
  inline constexpr std::uint32_t invalid_cell = 0xffffffffu;

  /**
   * The slots of a nodal record. Quantities that are never needed at the same
   * time share a slot under different names. In two dimensions a record is
   * padded to one cache line.
   */
  template <int dim>
  struct NodeLayout
  {
    // Sums of P2G, until nodes are advanced
    static constexpr unsigned int mass     = 0;       // kg
    static constexpr unsigned int force    = 1;       // N
    static constexpr unsigned int momentum = 1 + dim; // kg m/s
    // Momentum that points map back after G2P (MUSL), kg m/s
    static constexpr unsigned int remapped = 1 + 2 * dim;
    static constexpr unsigned int stride   = dim == 2 ? 8 : 10;

    // After advance_nodes: velocity increment of the step, new velocity, m/s
    static constexpr unsigned int increment = force;
    static constexpr unsigned int velocity  = momentum;
    // Velocity at the start of the step, once the increment has been used, m/s
    static constexpr unsigned int former_velocity = force;
    // Mid-step velocity, once the increment has been used, and the velocity
    // that moves points: the new or the mid-step one, m/s
    static constexpr unsigned int middle_velocity = force;
    static constexpr unsigned int moving_velocity = momentum;
    // Velocity that strains points: from the momentum of P2G, before there are
    // forces (USF), or from the re-mapped one (MUSL), m/s
    static constexpr unsigned int strain_velocity = remapped;
    // Hourglass forces, between these two
    static constexpr unsigned int hourglass_force = remapped; // N
    // Force of the implicit pressure, after the other forces were applied, N
    static constexpr unsigned int pressure_force = remapped;
  };



  /**
   * A rectangular cell: lower corner, 1 / edges, record offsets of its nodes.
   */
  template <int dim>
  struct CellGeometry
  {
    std::array<double, dim>             origin;       // m
    std::array<double, dim>             inverse_edge; // 1/m
    std::array<std::uint32_t, 1 << dim> node; // offset of the node's record
  };



  /**
   * The nodes whose splines do not vanish in a cell, as offsets of their
   * records; the first direction runs fastest. Where a node would lie beyond a
   * side of the grid, the node in the side stands for it, with a zero function.
   */
  template <int dim, int degree>
  struct SplineCell
  {
    static constexpr int n = degree + 1; // along a direction

    std::array<std::uint32_t, dim == 2 ? n * n : n * n * n> node;
    // Per direction: factors of the first and the last function, which differ
    // in cells at a side of the grid (SplineFactors).
    std::array<double, dim> lower, upper;
  };



  /**
   * Point location: the cell that contains a position, from a table of equal
   * bins, the coarsest lattice of the scene. If a bin is refined, its entry
   * refers to a block of sub-bins of the size of the finest cell. Positions
   * outside the table give invalid_cell.
   */
  template <int dim>
  struct BinView
  {
    // Entries >= this, except invalid_cell, refer to a block.
    static constexpr std::uint32_t first_block = 0x80000000u;

    std::array<double, dim>       lower{};
    std::array<double, dim>       inverse_edge{};
    std::array<std::int64_t, dim> n{};
    const std::uint32_t          *table = nullptr;
    bool one_per_cell = false; // whether each bin is a cell of its own
    // Blocks one after the other, with per_edge sub-bins along each edge
    const std::uint32_t *blocks   = nullptr;
    std::int64_t         per_edge = 1;
    // If each bin is a cell and points have domains: record offsets of the
    // nodes of the lattice of bins, n + 1 along each direction, `no_node` where
    // there is none, padded such that four can be read from any entry; else
    // null
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
     * The same, but a position outside the box is clamped to the nearest side,
     * and NaN to the lower one.
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

    /** Upper end of the box, m. */
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
   * The record of a node of the dual domain method (dual_domain.h): the rows of
   * a tensor (first the mean velocity gradient around the node, 1/s; then its
   * dual, the volume times stress that points have mapped, J); the nodal
   * volume, m^3; the force that follows from the stress, N.
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



  /** Make the table BinView::nodes. */
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



  /** What sweeps read and write of the grid. */
  template <int dim>
  struct GridView
  {
    const CellGeometry<dim> *cells = nullptr;
    double                  *nodes = nullptr;
    BinView<dim>             bins;
    // By cell, if the kernel is a spline of that degree; else null
    const SplineCell<dim, 2> *quadratics = nullptr;
    const SplineCell<dim, 3> *cubics     = nullptr;
    // Records of DualDomainLayout, if the kernel is 'ddmp'; else null
    double *dual_domain = nullptr;

    // Empty cells that a point has entered; their nodes must become active.
    std::uint8_t               *occupied = nullptr; // per cell
    std::vector<std::uint32_t> *entered  = nullptr;
    // Set when a point has left the cells that this rank knows, or has entered
    // a ghost cell (cell number >= n_owned_cells).
    bool         *left          = nullptr;
    bool         *is_in_ghosts  = nullptr;
    std::uint32_t n_owned_cells = invalid_cell;
  };



  /**
   * Sums over the points of one body in each cell, for the Hu-Washizu means
   * (DGQ0): the mass, its moments with the monomials of the basis (xi, eta, xi
   * eta, zeta, ... of linear functions) except the last, whose slot holds the
   * sum of m times the volumetric variable.
   *
   * The sweep that moves the points also gathers the sums at their new
   * positions, so that the present ones are complete when a step begins.
   * Records are not set to zero in between: each cell stores the turn of its
   * last sums, and the first contribution of a new turn overwrites the old
   * values.
   */
  template <int dim>
  struct CellSums
  {
    static constexpr unsigned int mass = 0;

    const double  *now     = nullptr;  // of the present positions, complete
    double        *next    = nullptr;  // of the positions after the step
    std::uint32_t *turn_of = nullptr;  // last turn with sums in a cell
    std::uint32_t  turn    = 0;        // the turn of the next sums
    unsigned int   stride  = 1 << dim; // as many as a cell has nodes

    /** The slot of the sum of m times the volumetric variable. */
    unsigned int
    volumetric() const
    {
      return stride - 1;
    }

    /** Whether the next sums of a cell have been started in this turn. */
    bool
    is_open(const std::uint32_t cell) const
    {
      return turn_of[cell] == turn;
    }

    /** The next sums of a cell, zeroed first if necessary. */
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

    /** The present mass in a cell; only before the next sums are gathered. */
    double
    present_mass(const std::uint32_t cell) const
    {
      return turn_of[cell] + 1 == turn ?
               now[std::size_t(cell) * stride + mass] :
               0;
    }
  };



  /**
   * The record of a cell for the mean of the deviatoric strain e of one body:
   * sums of m and of m e by components (n_deviator).
   */
  template <int dim>
  struct DeviatorSums
  {
    static constexpr unsigned int mass   = 0;
    static constexpr unsigned int strain = 1;
    static constexpr unsigned int stride = 1 << dim;
  };



  /**
   * The record of a node for the lumped projection of a quantity q of one body:
   * sums of m N_i and m N_i q over its points. finish() replaces the second by
   * the mean.
   */
  struct NodalMeanLayout
  {
    static constexpr unsigned int mass   = 0;
    static constexpr unsigned int value  = 1;
    static constexpr unsigned int stride = 2;
  };
} // namespace limber

#endif
