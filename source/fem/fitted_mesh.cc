// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/fe/fe_q.h>

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_in.h>
#include <deal.II/grid/grid_tools.h>

#include <limber/base/exceptions.h>
#include <limber/fem/fitted_mesh.h>

#include <cmath>
#include <fstream>

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



    /** As many elements along each edge as make them about square. */
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



    template <int dim>
    std::unique_ptr<Mesh<dim>>
    read_mesh(const std::string &path, MPI_Comm communicator)
    {
      auto mesh = std::make_unique<Mesh<dim>>(communicator);
      try
        {
          dealii::GridIn<dim>(*mesh).read(path);
        }
      catch (const dealii::ExceptionBase &failure)
        {
          std::ostringstream reason;
          failure.print_info(reason);
          throw FileError("The mesh '" + path +
                          "' of 'Reference/Mesh file' cannot be read. "
                          "Usually the path is wrong, the ending does not "
                          "name the format, or there are triangles or "
                          "tetrahedra in it. deal.II says: " +
                          reason.str());
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
    std::unique_ptr<Mesh<dim>> mesh;
    if (!request.mesh_file.empty())
      mesh = read_mesh<dim>(request.mesh_file, communicator);
    else if (const auto box =
               dynamic_cast<const BoxShape<dim> *>(body.shape.get()))
      {
        BlockCorners<dim> corners;
        for (unsigned int v = 0; v < corners.size(); ++v)
          for (unsigned int d = 0; d < dim; ++d)
            corners[v][d] = (v >> d) % 2 == 0 ? box->lower[d] : box->upper[d];
        auto elements = square_elements<dim>(corners, request.over_depth);
        if (!request.elements.empty())
          std::copy(request.elements.begin(),
                    request.elements.end(),
                    elements.begin());
        mesh = make_block_mesh<dim>(corners, elements, communicator);
      }
    else
      throw InputError("The body '" + body.name +
                       "' is not a box, and no mesh is known that fits it. "
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
