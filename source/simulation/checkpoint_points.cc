// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/text.h>
#include <limber/simulation/checkpoint_points.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace limber
{
  namespace
  {
    // Number of points that are read at once.
    constexpr std::size_t portion = 1 << 18;

    // Tolerance of a place in its cell for round-off, over the edges of the
    // cell.
    constexpr double tolerance = 1e-6;



    /** How many of the finest cells there can be along an axis. */
    template <int dim>
    std::uint64_t
    finest_cells(const BackgroundGrid<dim> &grid, const int d)
    {
      return std::uint64_t(grid.description.cells[d])
             << grid.description.levels;
    }



    /**
     * The place of a cell, or of its first corner, in the lattice of the finest
     * cells, x fastest.
     */
    template <int dim>
    std::uint64_t
    place_in_lattice(const BackgroundGrid<dim> &grid, const std::uint32_t cell)
    {
      const CellGeometry<dim> &geometry = grid.geometry[cell];
      std::uint64_t            result   = 0;
      for (int d = dim - 1; d >= 0; --d)
        result =
          result * finest_cells(grid, d) +
          std::lround((geometry.origin[d] - grid.description.lower[d]) *
                      geometry.inverse_edge[d] *
                      (1u << (grid.description.levels - grid.level_of(cell))));
      return result;
    }



    template <int dim>
    std::uint64_t
    size_of_lattice(const BackgroundGrid<dim> &grid)
    {
      std::uint64_t result = 1;
      for (int d = 0; d < dim; ++d)
        result *= finest_cells(grid, d);
      return result;
    }



    /** The local number of the cell at this place, if this rank owns it. */
    template <int dim>
    std::uint32_t
    owned_cell_at(const BackgroundGrid<dim> &grid, std::uint64_t place)
    {
      const GridDescription<dim> &box = grid.description;
      std::array<double, dim>     centre;
      for (int d = 0; d < dim; ++d)
        {
          const std::uint64_t n = finest_cells(grid, d);
          centre[d]             = box.lower[d] +
                      (box.upper[d] - box.lower[d]) * (place % n + 0.5) / n;
          place /= n;
        }
      const std::uint32_t cell = grid.bins.cell_at(centre);
      return cell < grid.n_owned_cells() ? cell : invalid_cell;
    }



    /** "body 0/mass" */
    std::string
    array_name(const unsigned int body, const std::string &field)
    {
      return "body " + std::to_string(body) + "/" + field;
    }



    /** The points of a portion that belong to this rank. */
    struct OwnPoints
    {
      std::vector<std::size_t>   place; // in the portion
      std::vector<std::uint32_t> cell;
    };



    /** Reads the points of a body in portions and validates all of them. */
    template <int dim>
    class PointReader
    {
    public:
      PointReader(const ArrayFile           &file,
                  const BackgroundGrid<dim> &grid,
                  const unsigned int         body,
                  const std::size_t          n_at_start,
                  MaterialPoints<dim>       &points)
        : file(file)
        , grid(grid)
        , body(body)
        , n_at_start(n_at_start)
        , points(points)
        , n(file.size(array_name(body, "cell")))
      {}

      std::size_t
      read()
      {
        check_lengths();
        std::size_t n_own = 0;
        for (std::size_t begin = 0; begin < n; begin += portion)
          n_own += find_own(begin).cell.size();
        points.clear();
        points.reserve(n_own);
        for (std::size_t begin = 0; begin < n; begin += portion)
          take(begin, find_own(begin));
        return n;
      }

    private:
      [[noreturn]] void
      refuse(const std::string &field, const std::string &what) const
      {
        throw DamagedFile(file.name(),
                          "has " + what + " in the array " +
                            in_quotes(array_name(body, field)));
      }

      std::size_t
      size_of_portion(const std::size_t begin) const
      {
        return std::min(portion, n - begin);
      }

      void
      check_lengths() const
      {
        if (n > n_at_start)
          refuse("cell", "more points than there were at the start");
        for (const std::string &name : point_array_names(body, points))
          if (file.size(name) != n)
            throw DamagedFile(file.name(),
                              "has an array " + in_quotes(name) +
                                " of another length than the others");
      }

      OwnPoints
      find_own(const std::size_t begin) const
      {
        std::vector<std::uint64_t> places(size_of_portion(begin));
        file.read(array_name(body, "cell"),
                  begin,
                  places.data(),
                  places.size());
        const std::uint64_t n_places = size_of_lattice(grid);
        OwnPoints           result;
        for (std::size_t p = 0; p < places.size(); ++p)
          {
            if (places[p] >= n_places)
              refuse("cell", "places beyond the grid");
            const std::uint32_t cell = owned_cell_at(grid, places[p]);
            if (cell == invalid_cell)
              continue;
            result.place.push_back(p);
            result.cell.push_back(cell);
          }
        return result;
      }

      template <typename T>
      std::vector<T>
      pick(const std::string &field,
           const std::size_t  begin,
           const OwnPoints   &own) const
      {
        std::vector<T> all(size_of_portion(begin)), result;
        file.read(array_name(body, field), begin, all.data(), all.size());
        result.reserve(own.place.size());
        for (const std::size_t place : own.place)
          result.push_back(all[place]);
        return result;
      }

      void
      take(const std::size_t begin, const OwnPoints &own)
      {
        if (own.cell.empty())
          return;
        const auto                       names = points.field_names();
        std::vector<std::vector<double>> fields;
        for (const std::string &name : names)
          {
            fields.push_back(pick<double>(name, begin, own));
            for (const double value : fields.back())
              if (!std::isfinite(value))
                refuse(name, "values that are not finite");
          }
        const auto ids = pick<std::uint64_t>("id", begin, own);
        for (const std::uint64_t id : ids)
          if (id >= n_at_start)
            refuse("id", "numbers beyond those of the start");
        check_places(own.cell, fields);
        // Masses come behind positions and velocities, see MaterialPoints
        for (const double mass : fields[2 * dim])
          if (!(mass > 0))
            refuse(names[2 * dim], "values that are not positive");
        std::vector<char> size_classes;
        if (points.has_size_classes())
          size_classes = pick<char>("size class", begin, own);
        for (const char level : size_classes)
          if (level < 0 || unsigned(level) > grid.description.levels)
            refuse("size class", "levels that the grid does not have");
        points.append(own.cell, ids, fields, size_classes);
      }

      void
      check_places(const std::vector<std::uint32_t>       &cells,
                   const std::vector<std::vector<double>> &fields) const
      {
        const unsigned int along_x = points.place_field();
        for (std::size_t p = 0; p < cells.size(); ++p)
          {
            const CellGeometry<dim> &cell = grid.geometry[cells[p]];
            for (unsigned int d = 0; d < dim; ++d)
              {
                const double xi = (fields[along_x + d][p] - cell.origin[d]) *
                                  cell.inverse_edge[d];
                if (xi < -tolerance || xi > 1 + tolerance)
                  refuse("cell", "cells that do not hold their points");
              }
          }
      }

      const ArrayFile           &file;
      const BackgroundGrid<dim> &grid;
      const unsigned int         body;
      const std::size_t          n_at_start;
      MaterialPoints<dim>       &points;
      const std::size_t          n;
    };
  } // namespace



  template <int dim>
  std::vector<std::string>
  point_array_names(const unsigned int body, const MaterialPoints<dim> &points)
  {
    std::vector<std::string> result = {array_name(body, "cell"),
                                       array_name(body, "id")};
    if (points.has_size_classes())
      result.push_back(array_name(body, "size class"));
    for (const std::string &field : points.field_names())
      result.push_back(array_name(body, field));
    return result;
  }



  template <int dim>
  void
  write_points(GatheredFile              &file,
               const BackgroundGrid<dim> &grid,
               const unsigned int         body,
               const MaterialPoints<dim> &points)
  {
    const PointView<dim>       view = points.view();
    std::vector<std::uint64_t> cells(view.size);
    for (std::size_t p = 0; p < view.size; ++p)
      cells[p] = place_in_lattice(grid, view.cell[p]);
    file.write(array_name(body, "cell"), cells.data(), view.size);
    file.write(array_name(body, "id"), points.all_ids().data(), view.size);
    if (points.has_size_classes())
      file.write(array_name(body, "size class"),
                 points.all_size_classes().data(),
                 view.size);
    const auto names = points.field_names();
    for (unsigned int f = 0; f < names.size(); ++f)
      file.write(array_name(body, names[f]), points.field(f).data(), view.size);
  }



  template <int dim>
  std::size_t
  read_points(const ArrayFile           &file,
              const BackgroundGrid<dim> &grid,
              const unsigned int         body,
              const std::size_t          n_at_start,
              MaterialPoints<dim>       &points)
  {
    return PointReader<dim>(file, grid, body, n_at_start, points).read();
  }



#define INSTANTIATE(dim)                                          \
  template std::vector<std::string> point_array_names(            \
    unsigned int, const MaterialPoints<dim> &);                   \
  template void        write_points(GatheredFile &,               \
                                    const BackgroundGrid<dim> &,  \
                                    unsigned int,                 \
                                    const MaterialPoints<dim> &); \
  template std::size_t read_points(const ArrayFile &,             \
                                   const BackgroundGrid<dim> &,   \
                                   unsigned int,                  \
                                   std::size_t,                   \
                                   MaterialPoints<dim> &);

  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace limber
