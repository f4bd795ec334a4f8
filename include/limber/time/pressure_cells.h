// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_pressure_cells_h
#define limber_time_pressure_cells_h

#include <limber/time/corners_of_nodes.h>
#include <limber/time/integrator.h>
#include <limber/time/pressure_surfaces.h>

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

namespace limber
{
  /**
   * The unknowns of the implicit pressure: one for each cell of each medium,
   * numbered with those of a rank together and in the order of ranks. All
   * liquids are one medium, with one pressure in a cell; each solid is one.
   * Empty cells near the material have unknowns too, so that the sparsity
   * pattern serves for some steps. The rows of a rank end with those of the
   * pieces of surface of obstacles in the cells of the liquids
   * (PressureSurfaces).
   */
  template <int dim>
  class PressureCells
  {
  public:
    static constexpr unsigned int n_nodes = 1 << dim; // of a cell

    /** Offsets in the record of a cell of a medium, which ranks exchange. */
    struct Record
    {
      static constexpr unsigned int number = 0; // of the unknown, from 1 on
      static constexpr unsigned int volume = 1; // reference volume V, m^3
      static constexpr unsigned int moment = 2; // sum of V J p, J
      // gamma V^2/m, m^6/kg, gamma being the mean checkerboard control
      static constexpr unsigned int pattern = 3;
      static constexpr unsigned int rows    = 4; // B by nodes, m^2 or m
      static constexpr unsigned int stride  = rows + n_nodes * dim;
    };

    /** Offsets in the results, pressure (Pa) and dilation Theta, which all
     * ranks get that have points in a cell. */
    struct Result
    {
      static constexpr unsigned int pressure = 0, dilation = 1;
      static constexpr unsigned int scale  = dilation; // while it is solved
      static constexpr unsigned int stride = 2;
    };

    /** Bodies with a common implicit pressure in a cell: the liquids, or a
     * solid. */
    struct Medium
    {
      std::vector<MaterialBody<dim> *> bodies;
      LazyArray<double>                records; // by cell, far ones too
      // By node and place around it: 1 + the cell of the medium there, or 0.
      // The node is corner k of the cell at place k.
      LazyArray<std::uint32_t> around;
      LazyArray<double>        results; // by cell, far ones too
      // Owned, in the order of their rows; and the first of these rows, counted
      // on this rank
      std::vector<std::uint32_t> cells;
      std::uint32_t              first = 0;

      bool
      is_liquid() const
      {
        return bodies.front()->description.is_liquid;
      }

      /** Call work(body, mass) for the bodies in a cell of this rank. */
      template <class Work>
      void
      for_each_in(const std::uint32_t cell, const Work &work) const
      {
        for (MaterialBody<dim> *const body : bodies)
          if (const double mass = body->cell_sums->present_mass(cell); mass > 0)
            work(*body, mass);
      }

      bool
      is_in(const std::uint32_t cell) const
      {
        return std::any_of(bodies.begin(), bodies.end(), [&](auto *const body) {
          return body->cell_sums->present_mass(cell) > 0;
        });
      }

      double *
      record(const std::uint32_t cell)
      {
        return records.data() + std::size_t(cell) * Record::stride;
      }
      const double *
      record(const std::uint32_t cell) const
      {
        return records.data() + std::size_t(cell) * Record::stride;
      }
      double *
      result(const std::uint32_t cell)
      {
        return results.data() + std::size_t(cell) * Result::stride;
      }
      const double *
      result(const std::uint32_t cell) const
      {
        return results.data() + std::size_t(cell) * Result::stride;
      }
      const std::uint32_t *
      cells_around(const std::uint32_t node) const
      {
        return around.data() + std::size_t(node) * n_nodes;
      }
      /** Whether the medium is in all cells around a node. */
      bool
      is_inside(const std::uint32_t node) const
      {
        const std::uint32_t *const cells = cells_around(node);
        return std::all_of(cells, cells + n_nodes, [](const std::uint32_t c) {
          return c > 0;
        });
      }
    };

    PressureCells(const RunParts<dim> &parts, CutCells<dim> *cut_cells);

    /** Adopt a mesh that has changed. Collective. */
    void
    reinit();

    /**
     * Find volumes, B and pressures of the cells, on their owners and the ranks
     * around. Returns whether the unknowns have been renumbered. Collective.
     */
    bool
    update();

    /** Copy a slot of the results from the owners of cells to all ranks that
     * hold them. Collective. */
    void
    share(Medium &medium, unsigned int slot);

    /** Call work(place, cell) for the (2 n + 1)^dim cells around and including
     * this, as far as this rank knows them. */
    template <class Work>
    void
    for_each_near(std::uint32_t cell, int n, const Work &work) const;

    /** Call work(cell) for the owned cells of a medium and all cells that ranks
     * share. */
    template <class Work>
    void
    for_each_known(const Medium &medium, const Work &work) const
    {
      std::for_each(medium.cells.begin(), medium.cells.end(), work);
      for (const auto &neighbour : parts.grid.shared_cells.neighbours)
        std::for_each(neighbour.records.begin(), neighbour.records.end(), work);
    }

    std::uint32_t
    node_of(const std::uint32_t cell, const unsigned int corner) const
    {
      return parts.grid.geometry[cell].node[corner] / NodeLayout<dim>::stride;
    }

    /** The first row of a surface, counted on this rank. */
    std::uint32_t
    first_of_surfaces() const
    {
      return n - surfaces.n_of_rank();
    }

    std::vector<Medium>   media;
    PressureSurfaces<dim> surfaces;
    CornersOfNodes<dim>   corners;   // where cells have several sizes
    std::uint32_t         n     = 0; // unknowns of this rank
    std::uint32_t         first = 0; // of them among those of all ranks
    std::uint32_t         n_all = 0; // of all ranks

  private:
    template <class Work>
    void
    for_each_of_others(const Work &work) const;
    void
    gather(Medium &medium);
    bool
    knows_all_cells() const;
    void
    choose_cells();
    void
    exchange(Medium &medium);
    void
    look_around(Medium &medium);

    const RunParts<dim>         parts;
    std::optional<ExchangePlan> shared_cells;
    RecordExchange              records_exchange{Record::stride};
    RecordExchange              result_exchange{Result::stride};
    bool                        has_cells = false; // of the present mesh
  };



  template <int dim>
  template <class Work>
  void
  PressureCells<dim>::for_each_near(const std::uint32_t cell,
                                    const int           n,
                                    const Work         &work) const
  {
    const CellGeometry<dim> &geometry = parts.grid.geometry[cell];
    const unsigned int       width    = 2 * n + 1,
                       all = dim == 2 ? width * width : width * width * width;
    for (unsigned int place = 0; place < all; ++place)
      {
        std::array<double, dim> x;
        for (unsigned int d = 0, rest = place; d < dim; ++d, rest /= width)
          x[d] = geometry.origin[d] +
                 (0.5 + int(rest % width) - n) / geometry.inverse_edge[d];
        if (const auto near = parts.grid.bins.cell_at(x); near != invalid_cell)
          work(place, near);
      }
  }
} // namespace limber

#endif
