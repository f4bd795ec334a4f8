// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_point_list_h
#define limber_problem_point_list_h

#include <limber/base/input_file.h>
#include <limber/problem/file_placement.h>
#include <limber/problem/from_file.h>
#include <limber/problem/shape.h>

#include <cstdint>
#include <map>
#include <unordered_map>
#include <vector>

namespace limber
{
  /** A table of numbers: columns of equal length by their names. */
  struct PointTable
  {
    std::map<std::string, std::vector<double>> columns;
    std::vector<std::size_t> lines; // of a text, where each row stands
    std::size_t              n = 0; // rows

    /** "line 7" of a text, "point 6" of arrays. */
    std::string
    row_name(std::size_t row) const;
  };

  /**
   * The columns of a point list: a text with the names in its first line and
   * commas, semicolons or tabs between numbers, or an HDF5 file with an array
   * of each name. Others than x, y, (z,) volume, mass, velocity x, ... are left
   * out. Throws InputError with what is missing, misspelt or not finite, and
   * where.
   */
  PointTable
  read_point_table(const InputFile &file, unsigned int dim);



  /** A point of a list. */
  template <int dim>
  struct ListedPoint
  {
    dealii::Point<dim>     place;
    double                 volume = 0; // m^dim, in the reference state
    double                 mass   = 0; // kg; 0: that of the volume
    dealii::Tensor<1, dim> velocity;   // m/s
  };



  /**
   * Points from a file, each with its own volume or mass. As a region it is the
   * union of the boxes of these volumes around the points; it has no surface
   * for what needs one.
   */
  template <int dim>
  class PointListShape : public Shape<dim>, public FromFile
  {
  public:
    // Word, section and help text in the scene, see ShapeList
    static constexpr const char *word = "point list", *section = "Point list";
    static constexpr const char *text =
      "points with their own volume or mass, from CSV or HDF5";

    static void
    declare(Parameters &parameters);

    static std::shared_ptr<const Shape<dim>>
    read(const ShapeSections<dim> &scene);

    PointListShape(const std::vector<ListedPoint<dim>> &points,
                   const std::string                   &checksum);

    bool
    contains(const dealii::Point<dim> &point) const override;

    /** Around the points, not their boxes. */
    Corners<dim>
    bounding_box() const override;

    std::optional<double>
    exact_volume() const override;

    const std::vector<ListedPoint<dim>> points;

  private:
    std::array<long, dim>
    bin_of(const dealii::Point<dim> &place) const;

    static std::uint64_t
    key(const std::array<long, dim> &bin);

    Corners<dim>                                          box;
    double                                                volume   = 0;
    double                                                bin_edge = 1;
    std::unordered_multimap<std::uint64_t, std::uint32_t> bins;
  };
} // namespace limber

#endif
