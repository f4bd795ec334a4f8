// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_fem_solid_model_h
#define limber_fem_solid_model_h

#include <deal.II/base/quadrature_lib.h>

#include <deal.II/dofs/dof_handler.h>

#include <deal.II/fe/fe_system.h>

#include <deal.II/lac/affine_constraints.h>

#include <limber/fem/fitted_mesh.h>
#include <limber/fem/held_nodes.h>
#include <limber/fem/linear_solver.h>
#include <limber/fem/solid_element.h>

#include <array>
#include <memory>
#include <utility>
#include <vector>

namespace limber
{
  /**
   * Finite element model of the body of a scene: mesh, degrees of freedom,
   * masses, forces and their derivative, and Dirichlet conditions by the sides
   * of the box. Nodal vectors have the displacements of all nodes of this
   * rank's elements (ghosted); forces are complete for those it owns. Member
   * functions are collective unless they return what is known already or ask
   * for one cell.
   */
  template <int dim>
  class SolidModel
  {
  public:
    using Matrix = dealii::TrilinosWrappers::SparseMatrix;

    /** Throws InputError for what the reference cannot do. */
    SolidModel(const Problem<dim> &problem, MPI_Comm communicator);

    /** With a mesh of one's own. */
    SolidModel(const Problem<dim> &problem, std::unique_ptr<Mesh<dim>> mesh);

    ~SolidModel();

    NodalVector
    make_vector() const;

    /** The nodes held by the sides of the box (Dirichlet conditions). */
    const HeldNodes<dim> &
    held() const
    {
      return *held_nodes;
    }

    /** Initial velocity, m/s; zero where the sides prescribe another one. */
    NodalVector
    initial_velocity() const;

    /** Internal forces, N; false where an element is inverted. */
    bool
    internal_forces(const NodalVector &displacement, NodalVector &forces) const;

    /** Weight of the masses, N, constant. */
    const NodalVector &
    gravity() const
    {
      return weight;
    }

    /** Body force formulas, at present or initial places, and loads on faces,
     * N. */
    void
    loads(const NodalVector &displacement,
          const double       time,
          NodalVector       &forces) const;

    /** Where each load on faces acts: areas in the order of the scene,
     * m^(dim-1). Collective. */
    std::vector<double>
    loaded_areas() const;

    /** Whether there are any but gravity. */
    bool
    has_loads() const
    {
      return problem.loads.body_force || !problem.loads.faces.empty();
    }

    /**
     * Tangent stiffness + @p mass_factor M, with one on the diagonal of held
     * components; false where an element is inverted. @p former: as that of
     * SolidElement::compute().
     */
    bool
    assemble(const NodalVector &displacement,
             const double       mass_factor,
             Matrix            &matrix,
             const NodalVector *former = nullptr) const;

    /**
     * Updates the history variables to @p displacement, at which the internal
     * forces have been computed; nothing if elastic. Returns the plastic work,
     * J.
     */
    double
    accept(const NodalVector &displacement);

    /** The states of the material at @p places of a cell, see SolidElement. */
    std::vector<MaterialState>
    states(const typename dealii::DoFHandler<dim>::active_cell_iterator &cell,
           const dealii::FEValues<dim>                                  &values,
           const dealii::FEValues<dim>                                  &places,
           const NodalVector &displacement) const;

    /** A matrix with the sparsity pattern of the stiffness. */
    void
    reinit(Matrix &matrix) const;

    /** Consistent mass matrix, kg; all components, also held ones. */
    const Matrix &
    mass_matrix() const
    {
      return *masses;
    }

    /** Lumped masses, its row sums, kg. */
    const NodalVector &
    nodal_masses() const
    {
      return lumped;
    }

    /** Shape functions of a cell at @p places, as the element wants them. */
    dealii::FEValues<dim>
    shape_values(const dealii::Quadrature<dim> &places) const;

    /** Components of @p vector in a cell, in the numbering of the cell. */
    std::vector<double>
    values_of(
      const typename dealii::DoFHandler<dim>::active_cell_iterator &cell,
      const NodalVector &vector) const;

    /** Rigid motions, the near null space for LinearSolver. */
    std::vector<double>
    rigid_motions() const;

    /** Call with place and degrees of freedom of each node of this rank. */
    template <class Function>
    void
    for_each_owned_node(const Function &function) const
    {
      for (const auto &node : nodes)
        function(node.first, node.second);
    }

    /** Ranks may hold the degrees of freedom of a node in any order. */
    using NodeDofs = std::array<dealii::types::global_dof_index,
                                static_cast<std::size_t>(dim)>;

    const Problem<dim>                            &problem;
    const MPI_Comm                                 communicator;
    const std::unique_ptr<Mesh<dim>>               mesh;
    const unsigned int                             degree;
    const std::unique_ptr<const SolidElement<dim>> element;
    const dealii::FESystem<dim>                    fe;
    const dealii::QGauss<dim>                      quadrature;
    dealii::DoFHandler<dim>                        dof_handler;
    double                                         smallest_edge = 0; // m

  private:
    /** A face on which a load acts, and where on it. */
    struct LoadedFace
    {
      typename dealii::DoFHandler<dim>::active_cell_iterator cell;
      unsigned int                                           face, load;
      dealii::Quadrature<dim - 1>                            places;
    };

    void
    check_scene() const;
    void
    number();
    void
    assemble_masses();
    void
    begin_memory();
    std::size_t
    memory_of(
      const typename dealii::DoFHandler<dim>::active_cell_iterator &cell) const;
    void
    find_loaded_faces();
    dealii::Tensor<1, dim>
    face_traction(const FaceLoad<dim>             &load,
                  const dealii::FEFaceValues<dim> &faces,
                  const unsigned int               q,
                  const std::vector<double>       &u,
                  const double                     time) const;

    dealii::IndexSet                                     relevant;
    dealii::AffineConstraints<double>                    none;
    std::unique_ptr<const HeldNodes<dim>>                held_nodes;
    std::vector<std::pair<dealii::Point<dim>, NodeDofs>> nodes; // owned
    std::vector<LoadedFace>                              loaded_faces;
    std::unique_ptr<Matrix>                              masses;
    NodalVector                                          lumped, weight;
    // of the quadrature points, cell by cell
    std::vector<double> memory;
  };



  /** Up to this size a factorisation is faster than the iteration. */
  template <int dim>
  bool
  is_small(const SolidModel<dim> &model)
  {
    return model.dof_handler.n_dofs() <= (dim == 2 ? 60000 : 12000);
  }
} // namespace limber

#endif
