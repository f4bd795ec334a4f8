// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_mesh_shape_h
#define limber_problem_mesh_shape_h

#include <limber/problem/closed_polygon.h>
#include <limber/problem/closed_surface.h>
#include <limber/problem/from_file.h>
#include <limber/problem/mesh_file.h>

#include <type_traits>

namespace limber
{
  /** Boundary edges of a mesh, which belong to one element only. */
  ClosedPolygon
  region_of(const CoarseMesh<2> &mesh);

  /**
   * Boundary faces. One of four corners becomes four triangles around its
   * centre: where its corners are not in one plane, these enclose as much as
   * the bilinear face does.
   */
  ClosedSurface
  region_of(const CoarseMesh<3> &mesh);



  /** The region that the elements of a mesh from a file cover. */
  template <int dim>
  class MeshShape : public Shape<dim>, public FromFile
  {
  public:
    // Word, section and help text in the scene, see ShapeList
    static constexpr const char *word = "mesh", *section = "Mesh";
    static constexpr const char *text =
      "what the elements of a mesh file cover";

    static void
    declare(Parameters &parameters);

    static std::shared_ptr<const Shape<dim>>
    read(const ShapeSections<dim> &scene);

    MeshShape(const CoarseMesh<dim> &mesh, const std::string &checksum);

    bool
    contains(const dealii::Point<dim> &point) const override;

    std::optional<SignedDistance<dim>>
    signed_distance(const dealii::Point<dim> &point) const override;

    Corners<dim>
    bounding_box() const override;

    std::optional<double>
    exact_volume() const override;

  private:
    const std::conditional_t<dim == 2, ClosedPolygon, ClosedSurface> region;
  };
} // namespace limber

#endif
