// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_stl_h
#define limber_problem_stl_h

#include <limber/base/input_file.h>
#include <limber/problem/closed_surface.h>
#include <limber/problem/file_placement.h>
#include <limber/problem/from_file.h>

namespace limber
{
  /**
   * The closed surface that an STL file holds, binary or ASCII, in one solid or
   * several; normals are left, as the order of corners tells them. Corners
   * within 1e-6 of the size of the surface are one. Throws InputError with the
   * facet and the line or place of what is wrong: words and lengths that are
   * not STL's, coordinates that are not finite, facets without area, edges of
   * an odd number of facets, facets that go around the other way.
   */
  TriangleMesh
  read_stl_text(const InputFile &file, const FilePlacement<3> &placement);



  /** The region in the closed surface of an STL file; in space only. */
  template <int dim>
  class StlShape : public Shape<dim>, public FromFile
  {
  public:
    // Word, section and help text in the scene, see ShapeList
    static constexpr const char *word = "stl", *section = "STL";
    static constexpr const char *text =
      "within the closed surface of an STL file; only in 3D";

    static void
    declare(Parameters &parameters);

    static std::shared_ptr<const Shape<dim>>
    read(const ShapeSections<dim> &scene);

    StlShape(const ClosedSurface &surface, const std::string &checksum);

    bool
    contains(const dealii::Point<dim> &point) const override;

    std::optional<SignedDistance<dim>>
    signed_distance(const dealii::Point<dim> &point) const override;

    Corners<dim>
    bounding_box() const override;

    std::optional<double>
    exact_volume() const override;

  private:
    const ClosedSurface surface;
  };
} // namespace limber

#endif
