// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <limber/base/exceptions.h>
#include <limber/base/records_of_ranks.h>
#include <limber/base/text.h>
#include <limber/fem/fitted_mesh.h>
#include <limber/problem/mesh_file.h>
#include <limber/problem/size_estimate.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>

namespace limber
{
  namespace
  {
    /** Refine all cells, if need be in several goes. */
    template <int dim>
    void
    refine(Mesh<dim> &mesh, const unsigned int times)
    {
      if (times > 0)
        mesh.refine_global(times);
    }



    /** Numbers of elements along the edges that make these about square. */
    template <int dim>
    std::array<unsigned int, dim>
    square_elements(const BlockCorners<dim> &corners,
                    const unsigned int       over_depth)
    {
      // mean length of the edges in each natural direction
      std::array<double, dim> length{};
      for (unsigned int d = 0; d < dim; ++d)
        for (unsigned int v = 0; v < corners.size(); ++v)
          if ((v >> d) % 2 == 0)
            length[d] +=
              corners[v].distance(corners[v | (1u << d)]) * 2 / corners.size();
      const double depth = *std::min_element(length.begin(), length.end());
      std::array<unsigned int, dim> result{};
      for (unsigned int d = 0; d < dim; ++d)
        result[d] =
          static_cast<unsigned int>(std::round(length[d] / depth * over_depth));
      return result;
    }



    /** Corners of a body that has such, in deal.II's order. */
    template <int dim>
    std::optional<BlockCorners<dim>>
    corners_of(const Shape<dim> &shape)
    {
      const auto block = dynamic_cast<const BlockShape<dim> *>(&shape);
      return block == nullptr ? std::nullopt :
                                std::make_optional(block->vertices);
    }



    /** Distance of a place from the plane of a face of a block, m. */
    template <int dim>
    double
    distance_from_face(const BlockCorners<dim>  &corners,
                       const unsigned int        face,
                       const dealii::Point<dim> &place)
    {
      // three corners of the face, in the plane two
      std::vector<dealii::Point<dim>> on_face;
      for (unsigned int v = 0; v < corners.size(); ++v)
        if ((v >> (face / 2)) % 2 == face % 2)
          on_face.push_back(corners[v]);
      dealii::Tensor<1, dim> normal;
      if constexpr (dim == 2)
        normal = dealii::cross_product_2d(on_face[1] - on_face[0]);
      else
        normal = dealii::cross_product_3d(on_face[1] - on_face[0],
                                          on_face[2] - on_face[0]);
      return std::abs((place - on_face[0]) * normal) / normal.norm();
    }



    /**
     * Boundary identifiers as the faces of the body; 2 dim: on none of them.
     */
    template <int dim>
    void
    mark_faces(const std::optional<BlockCorners<dim>> &corners, Mesh<dim> &mesh)
    {
      for (const auto &cell : mesh.active_cell_iterators())
        for (const unsigned int f : cell->face_indices())
          if (cell->face(f)->at_boundary())
            {
              const auto   face      = cell->face(f);
              const double tolerance = 1e-6 * face->diameter();
              face->set_all_boundary_ids(2 * dim);
              for (unsigned int g = 0; corners && g < 2 * dim; ++g)
                {
                  bool in_face = true;
                  for (unsigned int v = 0; v < face->n_vertices(); ++v)
                    in_face &=
                      distance_from_face<dim>(*corners, g, face->vertex(v)) <
                      tolerance;
                  if (in_face)
                    face->set_all_boundary_ids(g);
                }
            }
    }



    /** On all ranks, as one of them has read it. */
    std::string
    mesh_text(const std::string &path, const MPI_Comm communicator)
    {
      std::ostringstream text;
      if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
        text << std::ifstream(path).rdbuf();
      const std::string result = broadcast_text(text.str(), communicator);
      if (result.empty())
        throw FileError("The mesh " + in_quotes(path) +
                        " of 'Reference/Mesh file' cannot be read or is empty. "
                        "Usually the path is wrong or relative to another "
                        "folder. Give an existing file, for instance "
                        "'panel.msh'.");
      return result;
    }



    template <int dim>
    std::unique_ptr<Mesh<dim>>
    read_mesh(const Problem<dim> &problem, MPI_Comm communicator)
    {
      const std::string &path = problem.reference.mesh_file;
      CoarseMesh<dim>    coarse =
        read_mesh_text<dim>(mesh_text(path, communicator),
                            {path, "'Reference/Mesh file'"});
      check_size(problem,
                 Task::reference,
                 this_machine(communicator),
                 coarse.cells.size());
      auto mesh = std::make_unique<Mesh<dim>>(communicator);
      try
        {
          dealii::GridTools::consistently_order_cells(coarse.cells);
          mesh->create_triangulation(coarse.vertices,
                                     coarse.cells,
                                     dealii::SubCellData());
        }
      catch (const dealii::ExceptionBase &failure)
        {
          std::ostringstream reason;
          failure.print_info(reason);
          throw InputError("The elements of the mesh " + in_quotes(path) +
                           " of 'Reference/Mesh file' do not fit together. "
                           "Usually they fold into a strip with one side. "
                           "deal.II says: " +
                           printable(trimmed(reason.str())));
        }
      return mesh;
    }
  } // namespace



  template <int dim>
  std::unique_ptr<Mesh<dim>>
  make_block_mesh(const BlockCorners<dim>             &corners,
                  const std::array<unsigned int, dim> &elements,
                  MPI_Comm                             communicator)
  {
    // Every rank holds the whole coarse mesh, so that should be small.
    std::vector<unsigned int> coarse(elements.begin(), elements.end());
    unsigned int              levels = 0;
    while (std::all_of(coarse.begin(), coarse.end(), [](const unsigned int n) {
      return n % 2 == 0;
    }))
      {
        ++levels;
        for (unsigned int &n : coarse)
          n /= 2;
      }

    auto               mesh = std::make_unique<Mesh<dim>>(communicator);
    dealii::Point<dim> zero, one;
    for (unsigned int d = 0; d < dim; ++d)
      one[d] = 1;
    dealii::GridGenerator::subdivided_hyper_rectangle(
      *mesh, coarse, zero, one, true);
    dealii::GridTools::transform(
      [&](const dealii::Point<dim> &xi) {
        dealii::Point<dim> place;
        for (unsigned int v = 0; v < corners.size(); ++v)
          place += dealii::GeometryInfo<dim>::d_linear_shape_function(xi, v) *
                   corners[v];
        return place;
      },
      *mesh);
    refine(*mesh, levels);
    return mesh;
  }



  template <int dim>
  std::unique_ptr<Mesh<dim>>
  make_fitted_mesh(const Problem<dim> &problem, MPI_Comm communicator)
  {
    const ReferenceRequest    &request = problem.reference;
    const Body<dim>           &body    = problem.bodies.front();
    const auto                 corners = corners_of<dim>(*body.shape);
    std::unique_ptr<Mesh<dim>> mesh;
    if (!request.mesh_file.empty())
      {
        mesh = read_mesh<dim>(problem, communicator);
        mark_faces<dim>(corners, *mesh);
      }
    else if (corners)
      {
        auto elements = square_elements<dim>(*corners, request.over_depth);
        if (!request.elements.empty())
          std::copy(request.elements.begin(),
                    request.elements.end(),
                    elements.begin());
        mesh = make_block_mesh<dim>(*corners, elements, communicator);
      }
    else
      throw InputError(
        "The body " + in_quotes(body.name) +
        " is neither a box nor a block, and no mesh is known that fits "
        "it. "
        "Make one of quadrilaterals or hexahedra, for instance "
        "with Gmsh, and name it in section 'Reference', entry "
        "'Mesh file'.");
    refine(*mesh, request.refinements);
    return mesh;
  }



  template std::unique_ptr<Mesh<2>>
  make_block_mesh<2>(const BlockCorners<2> &,
                     const std::array<unsigned int, 2> &,
                     MPI_Comm);
  template std::unique_ptr<Mesh<3>>
  make_block_mesh<3>(const BlockCorners<3> &,
                     const std::array<unsigned int, 3> &,
                     MPI_Comm);
  template std::unique_ptr<Mesh<2>>
  make_fitted_mesh(const Problem<2> &, MPI_Comm);
  template std::unique_ptr<Mesh<3>>
  make_fitted_mesh(const Problem<3> &, MPI_Comm);
} // namespace limber
