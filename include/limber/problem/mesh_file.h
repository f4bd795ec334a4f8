// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_mesh_file_h
#define limber_problem_mesh_file_h

#include <deal.II/base/point.h>

#include <deal.II/grid/tria_description.h>

#include <string>
#include <vector>

/** @file Meshes of quadrilaterals or hexahedra from files of other programs. */
namespace limber
{
  /** Positions of the nodes, and elements by these, in deal.II's order. */
  template <int dim>
  struct CoarseMesh
  {
    std::vector<dealii::Point<dim>>    vertices;
    std::vector<dealii::CellData<dim>> cells;
  };



  /**
   * The corners of each face of an element of so many nodes, whose numbers run
   * around the face as seen from outside: of triangles and quadrilaterals, or
   * of tetrahedra and hexahedra.
   */
  template <int dim>
  const std::vector<std::vector<unsigned int>> &
  faces_of_element(std::size_t n_nodes);



  /** What a mesh file may hold, and how messages call it. */
  struct MeshRequest
  {
    std::string path;              // its ending tells the format
    std::string entry;             // that names it, "'Reference/Mesh file'"
    bool        simplices = false; // triangles and tetrahedra as well
  };

  /**
   * The mesh in a text of format msh (Gmsh's 2 and 4.1, ASCII), inp (AVS UCD)
   * or vtk (legacy, ASCII). Elements of lower dimension are left out. Each
   * count, node and element is checked before it is used; throws InputError
   * with line and number of the first that is wrong: another shape of element,
   * nodes that are missing, given twice or not finite, elements that are
   * twisted, flat or given twice, faces of more than two elements.
   */
  template <int dim>
  CoarseMesh<dim>
  read_mesh_text(const std::string &text, const MeshRequest &request);
} // namespace limber

#endif
