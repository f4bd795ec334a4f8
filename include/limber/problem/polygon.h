// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_polygon_h
#define limber_problem_polygon_h

#include <limber/base/input_file.h>
#include <limber/problem/closed_polygon.h>
#include <limber/problem/file_placement.h>
#include <limber/problem/from_file.h>

namespace limber
{
  /**
   * The closed lines of a text: a vertex in a line, two numbers between commas,
   * semicolons or blanks; a blank line ends a loop, which closes by itself; '#'
   * begins a remark, and the first line may name the columns. Throws
   * InputError with the line of what is wrong: other words, one or three
   * numbers, a loop of less than three vertices, edges that cross, no area.
   */
  ClosedPolygon
  read_polygon_text(const InputFile &file, const FilePlacement<2> &placement);



  /** A polygon from a file, in space extruded along an axis. */
  template <int dim>
  class PolygonShape : public Shape<dim>, public FromFile
  {
  public:
    // Word, section and help text in the scene, see ShapeList
    static constexpr const char *word = "polygon", *section = "Polygon";
    static constexpr const char *text =
      "closed polygon with holes, from a file of vertices";

    static void
    declare(Parameters &parameters);

    static std::shared_ptr<const Shape<dim>>
    read(const ShapeSections<dim> &scene);

    /** In space along @p axis, m; the others are those of the file. */
    PolygonShape(const ClosedPolygon &polygon,
                 const std::string   &checksum,
                 unsigned int         axis  = dim,
                 double               lower = 0,
                 double               upper = 1);

    bool
    contains(const dealii::Point<dim> &point) const override;

    std::optional<SignedDistance<dim>>
    signed_distance(const dealii::Point<dim> &point) const override;

    Corners<dim>
    bounding_box() const override;

    std::optional<double>
    exact_volume() const override;

  private:
    const ClosedPolygon polygon;
    const unsigned int  axis;
    const double        lower, upper;
  };
} // namespace limber

#endif
