// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_file_shapes_h
#define limber_problem_file_shapes_h

#include <limber/problem/image.h>
#include <limber/problem/mesh_shape.h>
#include <limber/problem/point_list.h>
#include <limber/problem/polygon.h>
#include <limber/problem/shapes.h>
#include <limber/problem/stl.h>

namespace limber
{
  /**
   * The shapes that come from files. Each has an entry 'File', whose path is
   * relative to the folder of the scene; see ShapeList for all others.
   */
  template <int dim>
  using FileShapeList = std::tuple<PolygonShape<dim>,
                                   StlShape<dim>,
                                   MeshShape<dim>,
                                   ImageShape<dim>,
                                   PointListShape<dim>>;



  /** A union of which some parts come from files. */
  template <int dim>
  class UnionFromFiles : public UnionShape<dim>, public FromFile
  {
  public:
    UnionFromFiles(const std::vector<std::shared_ptr<const Shape<dim>>> &parts,
                   const std::string &checksums)
      : UnionShape<dim>(parts)
      , FromFile(checksums)
    {}
  };
} // namespace limber

#endif
