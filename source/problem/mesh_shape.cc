// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/input_file.h>
#include <limber/problem/file_placement.h>
#include <limber/problem/mesh_shape.h>
#include <limber/problem/read_parts.h>

#include <algorithm>
#include <map>

namespace limber
{
  using dealii::Point;



  namespace
  {
    using MeshFace = std::vector<unsigned int>;

    /** Boundary faces, which belong to one element only, in its orientation. */
    template <int dim>
    std::vector<MeshFace>
    outer_faces(const CoarseMesh<dim> &mesh)
    {
      struct Met
      {
        MeshFace     face;
        unsigned int times = 0;
      };
      std::map<MeshFace, Met> met; // by sorted corners
      for (const auto &cell : mesh.cells)
        for (const MeshFace &corners :
             faces_of_element<dim>(cell.vertices.size()))
          {
            MeshFace face;
            for (const unsigned int corner : corners)
              face.push_back(cell.vertices[corner]);
            MeshFace sorted = face;
            std::sort(sorted.begin(), sorted.end());
            Met &entry = met[sorted];
            entry.face = face;
            ++entry.times;
          }
      std::vector<MeshFace> result;
      for (const auto &[sorted, entry] : met)
        if (entry.times == 1)
          result.push_back(entry.face);
      return result;
    }
  } // namespace



  ClosedPolygon
  region_of(const CoarseMesh<2> &mesh)
  {
    std::vector<ClosedPolygon::Edge> edges;
    for (const MeshFace &face : outer_faces(mesh))
      edges.push_back({{mesh.vertices[face[0]], mesh.vertices[face[1]]}});
    return ClosedPolygon(edges);
  }



  ClosedSurface
  region_of(const CoarseMesh<3> &mesh)
  {
    TriangleMesh surface;
    surface.corners = mesh.vertices;
    for (const MeshFace &face : outer_faces(mesh))
      {
        if (face.size() == 3)
          {
            surface.facets.push_back({{face[0], face[1], face[2]}});
            continue;
          }
        Point<3> centre;
        for (const unsigned int corner : face)
          centre += 0.25 * mesh.vertices[corner];
        const unsigned int number = surface.corners.size();
        surface.corners.push_back(centre);
        for (unsigned int i = 0; i < 4; ++i)
          surface.facets.push_back({{face[i], face[(i + 1) % 4], number}});
      }
    return ClosedSurface(surface);
  }



  template <int dim>
  MeshShape<dim>::MeshShape(const CoarseMesh<dim> &mesh,
                            const std::string     &checksum)
    : FromFile(checksum)
    , region(region_of(mesh))
  {}



  template <int dim>
  bool
  MeshShape<dim>::contains(const Point<dim> &point) const
  {
    return region.contains(point);
  }



  template <int dim>
  Corners<dim>
  MeshShape<dim>::bounding_box() const
  {
    return region.bounding_box();
  }



  template <int dim>
  std::optional<double>
  MeshShape<dim>::exact_volume() const
  {
    if constexpr (dim == 2)
      return region.area();
    else
      return region.volume();
  }



  template <int dim>
  std::optional<SignedDistance<dim>>
  MeshShape<dim>::signed_distance(const Point<dim> &point) const
  {
    return region.signed_distance(point);
  }



  template <int dim>
  void
  MeshShape<dim>::declare(Parameters &parameters)
  {
    parameters.declare("File",
                       "",
                       admissible::text("path of a mesh file", "panel.msh"),
                       "Mesh of elements of order 1: msh (Gmsh 2 or 4.1, "
                       "ASCII), inp (UCD) or vtk (legacy, ASCII), by ending. "
                       "Relative to the folder of the scene.");
    declare_file_placement<dim>(parameters);
  }



  template <int dim>
  std::shared_ptr<const Shape<dim>>
  MeshShape<dim>::read(const ShapeSections<dim> &scene)
  {
    const Section  &details = scene.details;
    const InputFile file =
      read_input_file(details.required_text("File"), details.where("File"));
    CoarseMesh<dim> mesh =
      read_mesh_text<dim>(file.bytes, {file.path, "'Mesh/File'", true});
    const auto placement = read_file_placement<dim>(details);
    for (Point<dim> &vertex : mesh.vertices)
      vertex = placement(vertex);
    return std::make_shared<MeshShape<dim>>(mesh, file.checksum());
  }



  template class MeshShape<2>;
  template class MeshShape<3>;
} // namespace limber
