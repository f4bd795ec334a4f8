// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_fem_held_nodes_h
#define limber_fem_held_nodes_h

#include <deal.II/dofs/dof_handler.h>

#include <deal.II/lac/affine_constraints.h>

#include <limber/fem/linear_solver.h>
#include <limber/problem/problem.h>

#include <array>
#include <vector>

namespace limber
{
  /**
   * Dirichlet conditions: the displacement components of nodes that the sides
   * of the box hold, the normal one at a slip side, all at others. A side holds
   * the nodes of those faces of the body that lie in it at the start. Functions
   * change the held components that this rank owns, and leave ghosts and all
   * others as they are.
   */
  template <int dim>
  class HeldNodes
  {
  public:
    /**
     * Of vectors numbered by @p dof_handler. Throws InputError where the body
     * touches a side with friction.
     */
    HeldNodes(const Problem<dim>            &problem,
              const dealii::DoFHandler<dim> &dof_handler);

    /** Prescribed values at @p time, s, after a step from @p former_time:
     * displacements, m, velocities, m/s, and accelerations, m/s^2. */
    void
    prescribe(const double       former_time,
              const NodalVector &former_displacement,
              const double       time,
              NodalVector       &displacement,
              NodalVector       &velocity,
              NodalVector       &acceleration) const;

    /** Prescribed velocities alone, m/s. */
    void
    prescribe_velocity(const double time, NodalVector &velocity) const;

    /** Sets held components to zero. */
    void
    clear(NodalVector &vector) const;

    /** Copies held components from another vector. */
    void
    replace(NodalVector &vector, const NodalVector &from) const;

    /** Inertia of held components, N: nodal masses, kg, times accelerations,
     * m/s^2; zero elsewhere. */
    NodalVector
    inertia(const NodalVector &masses, const NodalVector &acceleration) const;

    /** Reaction forces, N, by side of the box. Collective. */
    std::array<dealii::Tensor<1, dim>, 2 * dim>
    sum_over_sides(const NodalVector &forces) const;

    /** Homogeneous constraints, for the rows and columns of a matrix. */
    const dealii::AffineConstraints<double> &
    constraints() const
    {
      return lines;
    }

  private:
    struct Held
    {
      dealii::types::global_dof_index dof;
      unsigned int                    side, component;
      dealii::Point<dim>              place;
    };

    void
    find(const dealii::DoFHandler<dim> &dof_handler);
    unsigned int
    sides_with(
      const typename dealii::DoFHandler<dim>::face_iterator &face) const;
    double
    prescribed_velocity(const Held &held, const double time) const;

    const Problem<dim>               &problem;
    const MPI_Comm                    communicator;
    std::vector<Held>                 all; // of the cells that this rank sees
    dealii::AffineConstraints<double> lines;
  };
} // namespace limber

#endif
