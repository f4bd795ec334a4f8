// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_numbered_nodes_h
#define limber_time_numbered_nodes_h

#include <deal.II/base/point.h>

#include <limber/time/integrator.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace limber
{
  /**
   * The nodes of all cells that hold points, on whatever rank, numbered in the
   * order of their places in the lattice (the first direction runs fastest):
   * the same on every rank and for any number of ranks. For linear functions
   * and cells of one size. What is summed over ranks is the same on all of
   * them, to the last bit.
   */
  template <int dim>
  class NumberedNodes
  {
  public:
    using Corners = std::array<std::uint32_t, 1 << dim>;

    explicit NumberedNodes(const RunParts<dim> &parts);

    /** Find them anew; points must be sorted. Collective. */
    void
    update();

    std::size_t
    size() const
    {
      return keys.size();
    }

    /** On this rank's grid, by number; invalid_cell where it has no points
     * around a node. */
    const std::vector<std::uint32_t> &
    on_grid() const
    {
      return local;
    }

    /** Whether this rank speaks for a node: the first that has points around
     * it, and so knows the sums over all points. */
    bool
    owns(const std::size_t number) const
    {
      return speakers[number] == this_rank;
    }

    /** In m, by number. */
    const std::vector<dealii::Point<dim>> &
    places() const
    {
      return of_lattice;
    }

    /** Sides of the box in which a node lies, as bits. */
    std::uint8_t
    sides(std::size_t number) const;

    /** Of all cells with points, in the order of the lattice. */
    const std::vector<Corners> &
    cells() const
    {
      return corners;
    }

    /** Of a cell of this rank's grid in which it has points. */
    Corners
    numbers_in(std::uint32_t cell) const;

    /** One step along a direction from a cell with points. */
    struct Neighbour
    {
      bool                       in_box;
      std::optional<std::size_t> cell; // with points
    };
    Neighbour
    neighbour(std::size_t cell, unsigned int direction, int step) const;

    /** Of a cell, m. */
    double
    edge(const unsigned int direction) const
    {
      return edges[direction];
    }

    /** Replace values by their sums over all ranks. Collective. */
    void
    sum(double *values, std::size_t n) const;
    void
    sum(std::vector<double> &values) const
    {
      sum(values.data(), values.size());
    }

    bool
    is_parallel() const
    {
      return parallel;
    }

  private:
    // Place in the lattice as one number
    using Key = std::uint64_t;

    Key
    key_of(const std::uint32_t cell, const unsigned int corner) const;
    std::array<unsigned int, dim>
    place_in_lattice(Key key) const;
    std::vector<Key>
    united(std::vector<Key> own) const;
    std::uint32_t
    number_of(Key key) const;

    const RunParts<dim>             parts;
    const bool                      parallel;
    dealii::Point<dim>              edges;
    std::array<Key, dim>            strides;         // of keys
    std::vector<Key>                keys, cell_keys; // sorted
    std::vector<std::uint32_t>      local, number_of_local;
    std::vector<int>                speakers; // ranks, by number
    int                             this_rank = 0;
    std::vector<dealii::Point<dim>> of_lattice;
    std::vector<Corners>            corners;
  };
} // namespace limber

#endif
