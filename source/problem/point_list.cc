// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/point_list.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/words.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  using dealii::Point;



  template <int dim>
  PointListShape<dim>::PointListShape(
    const std::vector<ListedPoint<dim>> &points,
    const std::string                   &checksum)
    : FromFile(checksum)
    , points(points)
    , box(points.front().place, points.front().place)
  {
    double largest = 0;
    for (const ListedPoint<dim> &point : points)
      {
        volume += point.volume;
        largest = std::max(largest, point.volume);
        for (unsigned int d = 0; d < dim; ++d)
          {
            box.first[d]  = std::min(box.first[d], point.place[d]);
            box.second[d] = std::max(box.second[d], point.place[d]);
          }
      }
    // The box of a point then lies in its bin and the ones next to it.
    bin_edge = std::pow(largest, 1. / dim);
    bins.reserve(points.size());
    for (std::size_t p = 0; p < points.size(); ++p)
      bins.emplace(key(bin_of(points[p].place)), p);
  }



  template <int dim>
  std::array<long, dim>
  PointListShape<dim>::bin_of(const Point<dim> &place) const
  {
    std::array<long, dim> bin;
    for (unsigned int d = 0; d < dim; ++d)
      bin[d] = std::floor((place[d] - box.first[d]) / bin_edge);
    return bin;
  }



  template <int dim>
  std::uint64_t
  PointListShape<dim>::key(const std::array<long, dim> &bin)
  {
    std::uint64_t result = 0;
    for (const long i : bin)
      result = (result ^ std::uint64_t(i)) * 0x9e3779b97f4a7c15u;
    return result;
  }



  template <int dim>
  bool
  PointListShape<dim>::contains(const Point<dim> &place) const
  {
    // Boxes that touch need not do so exactly in floating point.
    constexpr double            touching = 0.5 * (1 + 1e-9);
    const std::array<long, dim> bin      = bin_of(place);
    constexpr unsigned int      n        = dim == 2 ? 9 : 27;
    for (unsigned int i = 0; i < n; ++i)
      {
        std::array<long, dim> other = bin;
        for (unsigned int d = 0, rest = i; d < dim; ++d, rest /= 3)
          other[d] += long(rest % 3) - 1;
        const auto [begin, end] = bins.equal_range(key(other));
        for (auto found = begin; found != end; ++found)
          {
            const ListedPoint<dim> &point = points[found->second];
            const double half = touching * std::pow(point.volume, 1. / dim);
            bool         near = true;
            for (unsigned int d = 0; d < dim; ++d)
              near &= std::abs(place[d] - point.place[d]) <= half;
            if (near)
              return true;
          }
      }
    return false;
  }



  template <int dim>
  Corners<dim>
  PointListShape<dim>::bounding_box() const
  {
    return box;
  }



  template <int dim>
  std::optional<double>
  PointListShape<dim>::exact_volume() const
  {
    return volume;
  }



  template <int dim>
  void
  PointListShape<dim>::declare(Parameters &parameters)
  {
    parameters.declare("File",
                       "",
                       admissible::text("path of a CSV or HDF5 file",
                                        "points.csv"),
                       "Columns x, y (, z), m, either volume, m^dim, or mass, "
                       "kg, and perhaps velocity x and so on, m/s, to which "
                       "'Initial velocity' is added. Relative to the folder "
                       "of the scene.");
    declare_file_placement<dim>(parameters);
  }



  namespace
  {
    /** Density of the body that has the list. */
    double
    density_of(const Section &body)
    {
      const LawDescription law = read_word(body, "Material", law_words());
      return body.subsection(law.section()).number(law.parameters.front().name);
    }



    template <int dim>
    void
    check_inside_grid(const InputFile    &file,
                      const PointTable   &table,
                      const std::size_t   row,
                      const Point<dim>   &place,
                      const Corners<dim> &grid)
    {
      for (unsigned int d = 0; d < dim; ++d)
        if (place[d] < grid.first[d] || place[d] > grid.second[d])
          throw InputError("The point in " + table.row_name(row) +
                           " of the point list " + file.name() +
                           " is beyond the grid, at " + to_text(place) +
                           ". The grid ranges from " + to_text(grid.first) +
                           " to " + to_text(grid.second) +
                           ". Enlarge it, or correct 'Scale' or "
                           "'Translation'.");
    }
  } // namespace



  template <int dim>
  std::shared_ptr<const Shape<dim>>
  PointListShape<dim>::read(const ShapeSections<dim> &scene)
  {
    const Section &details = scene.details;
    if (!scene.owner.has_entry("Material"))
      throw InputError("A point list is asked for as a part of a union, in " +
                       scene.owner.where("Shape") +
                       ", where its points would be lost: a union is a "
                       "region. Give the list a body of its own.");
    const InputFile file =
      read_input_file(details.required_text("File"), details.where("File"));
    const PointTable table     = read_point_table(file, dim);
    const auto       placement = read_file_placement<dim>(details);
    const bool       by_mass   = table.columns.count("mass") > 0;
    const bool       moves     = table.columns.count("velocity x") > 0;
    const auto      &size      = table.columns.at(by_mass ? "mass" : "volume");
    const double     density   = by_mass ? density_of(scene.owner) : 1;

    std::vector<ListedPoint<dim>> points(table.n);
    for (std::size_t row = 0; row < table.n; ++row)
      {
        ListedPoint<dim> &point = points[row];
        for (unsigned int d = 0; d < dim; ++d)
          {
            const std::string axis(1, "xyz"[d]);
            point.place[d] = table.columns.at(axis)[row];
            if (moves)
              point.velocity[d] = table.columns.at("velocity " + axis)[row];
          }
        point.place    = placement(point.place);
        point.velocity = placement.rotation * point.velocity;
        point.mass     = by_mass ? size[row] : 0;
        point.volume   = by_mass ? size[row] / density :
                                   size[row] * std::pow(placement.scale, dim);
        check_inside_grid(file, table, row, point.place, scene.grid);
      }
    return std::make_shared<PointListShape<dim>>(points, file.checksum());
  }



  template class PointListShape<2>;
  template class PointListShape<3>;
} // namespace limber
