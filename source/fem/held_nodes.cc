// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/quadrature_lib.h>

#include <deal.II/dofs/dof_tools.h>

#include <deal.II/fe/fe_values.h>

#include <limber/base/exceptions.h>
#include <limber/fem/held_nodes.h>

#include <cmath>
#include <map>

namespace limber
{
  namespace
  {
    // Places closer than this, relative to the box, are one.
    constexpr double same_place = 1e-9;



    template <int dim>
    const char *
    side_name(const unsigned int side)
    {
      constexpr const char *names[] = {
        "left", "right", "bottom", "top", "back", "front"};
      return names[side];
    }
  } // namespace



  template <int dim>
  HeldNodes<dim>::HeldNodes(const Problem<dim>            &problem,
                            const dealii::DoFHandler<dim> &dof_handler)
    : problem(problem)
    , communicator(dof_handler.get_communicator())
    , lines(dealii::DoFTools::extract_locally_relevant_dofs(dof_handler))
  {
    find(dof_handler);
  }



  // A node belongs to each side of the box in which a face of the body lies
  // that contains the node.
  template <int dim>
  void
  HeldNodes<dim>::find(const dealii::DoFHandler<dim> &dof_handler)
  {
    const auto                   &fe = dof_handler.get_fe();
    const dealii::Quadrature<dim> places(
      fe.base_element(0).get_unit_support_points());
    dealii::FEValues<dim> values(fe, places, dealii::update_quadrature_points);

    struct Node
    {
      unsigned int       sides = 0, component; // a set, bits
      dealii::Point<dim> place;
    };
    std::map<dealii::types::global_dof_index, Node> found;
    std::vector<dealii::types::global_dof_index>    dofs(fe.dofs_per_cell);
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (!cell->is_artificial() && cell->at_boundary())
        for (const unsigned int f : cell->face_indices())
          if (const unsigned int sides = sides_with(cell->face(f)); sides != 0)
            {
              values.reinit(cell);
              cell->get_dof_indices(dofs);
              for (unsigned int i = 0; i < dofs.size(); ++i)
                if (fe.has_support_on_face(i, f))
                  {
                    const auto [component, node] =
                      fe.system_to_component_index(i);
                    Node &entry = found[dofs[i]];
                    entry.sides |= sides;
                    entry.component = component;
                    entry.place     = values.quadrature_point(node);
                  }
            }
    for (const auto &[dof, node] : found)
      for (const HeldComponent &held :
           held_components(problem.sides, node.sides))
        if (held.component == node.component)
          {
            // where two sides prescribe a component, the later one counts
            const bool is_new = all.empty() || all.back().dof != dof;
            if (is_new)
              {
                all.push_back({dof, held.side, held.component, node.place});
                lines.add_line(dof);
              }
            all.back().side = held.side;
          }
    lines.close();
  }



  // The set (bits) of the sides of the box that a face of the body lies in.
  template <int dim>
  unsigned int
  HeldNodes<dim>::sides_with(
    const typename dealii::DoFHandler<dim>::face_iterator &face) const
  {
    const auto  &grid      = problem.grid;
    const double tolerance = same_place * grid.lower.distance(grid.upper);
    unsigned int result    = 0;
    for (unsigned int side = 0; face->at_boundary() && side < 2 * dim; ++side)
      {
        const unsigned int normal = side / 2;
        const double       plane =
          side % 2 == 0 ? grid.lower[normal] : grid.upper[normal];
        bool in_plane = problem.sides[side].held != HeldComponents::none;
        for (unsigned int v = 0; in_plane && v < face->n_vertices(); ++v)
          in_plane = std::abs(face->vertex(v)[normal] - plane) < tolerance;
        if (in_plane && problem.sides[side].one_sided)
          throw InputError(std::string("The body touches the side '") +
                           side_name<dim>(side) + "', which is '" +
                           problem.sides[side].word +
                           "' in section 'Boundaries'; the finite element "
                           "reference knows no friction. Set that side to slip "
                           "or no slip.");
        if (in_plane)
          result |= 1 << side;
      }
    return result;
  }



  template <int dim>
  double
  HeldNodes<dim>::prescribed_velocity(const Held &held, const double time) const
  {
    return problem.sides[held.side].prescribed_velocity(held.place,
                                                        time,
                                                        held.component);
  }



  template <int dim>
  void
  HeldNodes<dim>::prescribe(const double       former_time,
                            const NodalVector &former_displacement,
                            const double       time,
                            NodalVector       &displacement,
                            NodalVector       &velocity,
                            NodalVector       &acceleration) const
  {
    // A velocity may jump at the end of a step, as in if(t < 1, v, 0), so the
    // displacement is from points within the step.
    static const dealii::QGauss<1> rule(3);
    const double                   step = time - former_time;
    for (const Held &h : all)
      if (displacement.in_local_range(h.dof))
        {
          displacement[h.dof] = former_displacement[h.dof];
          for (unsigned int q = 0; q < rule.size(); ++q)
            displacement[h.dof] +=
              step * rule.weight(q) *
              prescribed_velocity(h, former_time + step * rule.point(q)[0]);

          // acceleration from the parabola through three velocities
          const double before = prescribed_velocity(h, former_time);
          const double middle = prescribed_velocity(h, former_time + step / 2);
          const double after  = prescribed_velocity(h, time);
          velocity[h.dof]     = after;
          acceleration[h.dof] = (before - 4 * middle + 3 * after) / step;
        }
  }



  template <int dim>
  void
  HeldNodes<dim>::prescribe_velocity(const double time,
                                     NodalVector &velocity) const
  {
    for (const Held &h : all)
      if (velocity.in_local_range(h.dof))
        velocity[h.dof] = prescribed_velocity(h, time);
  }



  template <int dim>
  void
  HeldNodes<dim>::clear(NodalVector &vector) const
  {
    for (const Held &h : all)
      if (vector.in_local_range(h.dof))
        vector[h.dof] = 0;
  }



  template <int dim>
  void
  HeldNodes<dim>::replace(NodalVector &vector, const NodalVector &from) const
  {
    for (const Held &h : all)
      if (vector.in_local_range(h.dof))
        vector[h.dof] = from[h.dof];
  }



  template <int dim>
  NodalVector
  HeldNodes<dim>::inertia(const NodalVector &masses,
                          const NodalVector &acceleration) const
  {
    NodalVector result(masses.get_partitioner());
    for (const Held &h : all)
      if (result.in_local_range(h.dof))
        result[h.dof] = masses[h.dof] * acceleration[h.dof];
    return result;
  }



  template <int dim>
  std::array<dealii::Tensor<1, dim>, 2 * dim>
  HeldNodes<dim>::sum_over_sides(const NodalVector &forces) const
  {
    std::array<dealii::Tensor<1, dim>, 2 * dim> result;
    for (const Held &h : all)
      if (forces.in_local_range(h.dof))
        result[h.side][h.component] += forces[h.dof];
    for (auto &force : result)
      force = dealii::Utilities::MPI::sum(force, communicator);
    return result;
  }



  template class HeldNodes<2>;
  template class HeldNodes<3>;
} // namespace limber
