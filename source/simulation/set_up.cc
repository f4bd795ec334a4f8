// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/adaptation/criteria.h>
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/interpolation/basis.h>
#include <limber/materials/law_list.h>
#include <limber/points/seeding.h>
#include <limber/problem/farthest_place.h>
#include <limber/problem/read_parts.h>
#include <limber/simulation/initial_state.h>
#include <limber/simulation/set_up.h>
#include <limber/transfer/meeting_bodies.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  namespace
  {
    /**
     * Affine velocity (APIC) C = grad v of a point at the start: difference
     * quotients of the formula over @p half_edge (m) to either side, as a point
     * stands for that much material; one-sided where the formula is undefined
     * on the other side.
     */
    template <int dim>
    void
    set_affine_velocity(const Formula<dim>       &velocity,
                        const dealii::Point<dim> &place,
                        const double              half_edge,
                        const PointView<dim>     &points,
                        const std::size_t         p)
    {
      for (int e = 0; e < dim; ++e)
        {
          dealii::Point<dim> below = place, above = place;
          below[e] -= half_edge;
          above[e] += half_edge;
          if (!velocity.is_finite(below, 0))
            below = place;
          if (!velocity.is_finite(above, 0))
            above = place;
          const double distance = above[e] - below[e];
          if (!(distance > 0))
            continue;
          const auto change =
            velocity.vector(above, 0) - velocity.vector(below, 0);
          for (int d = 0; d < dim; ++d)
            points.affine[d * dim + e][p] = change[d] / distance;
        }
    }



    template <int dim>
    void
    set_initial_state(const InitialState<dim> &initial, MaterialBody<dim> &body)
    {
      const PointView<dim> points   = body.points.view();
      const Formula<dim>  &velocity = body.description.initial_velocity;
      for (std::size_t p = 0; p < points.size; ++p)
        {
          dealii::Point<dim> place;
          for (int d = 0; d < dim; ++d)
            place[d] = points.position[d][p];
          if (!body.stress->initialise(points, p, initial.at(place)))
            initial.refuse(place);
          if (velocity.empty())
            continue;
          const auto v = velocity.vector(place, 0);
          for (int d = 0; d < dim; ++d)
            points.velocity[d][p] += v[d]; // to that of a point list
          if (points.affine[0] != nullptr)
            set_affine_velocity(velocity,
                                place,
                                half_edge_of<dim>(points.mass[p] /
                                                  body.description.density()),
                                points,
                                p);
        }
    }
  } // namespace



  namespace
  {
    template <int dim>
    using Bodies = std::vector<std::unique_ptr<MaterialBody<dim>>>;



    /** Form of the points' domains with a kernel. */
    DomainForm
    domain_form(const KernelKind kernel)
    {
      switch (kernel)
        {
          case KernelKind::gimp:
            return DomainForm::box;
          case KernelKind::cpgimp:
            return DomainForm::stretched_box;
          case KernelKind::cpdi:
            return DomainForm::parallelepiped;
          case KernelKind::cpdi2:
            return DomainForm::hexahedron;
          default:
            return DomainForm::none;
        }
    }



    /** Whether there is contact at points, so that the extent of their material
     * matters. */
    template <int dim>
    bool
    presses_at_points(const Problem<dim> &problem)
    {
      return problem.has_rigid_contact() ||
             std::any_of(problem.contacts.begin(),
                         problem.contacts.end(),
                         [](const ContactPair &pair) {
                           return pair.law == ContactLaw::separate;
                         });
    }



    /** The body without points. */
    template <int dim>
    std::unique_ptr<MaterialBody<dim>>
    make_body(const Problem<dim>        &problem,
              const Body<dim>           &body,
              const BackgroundGrid<dim> &grid)
    {
      // Liquids have linear functions: they would shear domains without end,
      // and checkerboard control is for linear functions.
      const KernelKind kernel =
        is_for_solids(problem.grid.kernel) && body.is_liquid ?
          KernelKind::linear :
          problem.grid.kernel;
      auto        stress = make_stress_update<dim>(body.law,
                                            body.material,
                                            body.treatment,
                                            body.hourglass,
                                            body.frame,
                                            kernel);
      PointLayout layout;
      layout.deviator   = stress->has_deviator();
      layout.n_history  = stress->n_history();
      layout.volumetric = stress->volumetric();
      layout.affine     = is_affine(problem.method.transfer);
      layout.acceleration =
        problem.method.integration == TimeIntegration::implicit_steps &&
        problem.method.spectral_radius < 1;
      layout.crossings = !body.is_liquid && body.frame == Frame::current;
      layout.reach     = presses_at_points(problem) && !body.is_liquid;
      layout.stretch =
        layout.reach && body.is_plastic && body.frame == Frame::current;
      layout.domains       = domain_form(kernel);
      layout.initial_frame = body.frame == Frame::initial;
      layout.size_class    = grid.has_levels();
      layout.edges     = body.splits_stretched_points && !has_domains(kernel);
      layout.reference = problem.keeps_initial_places();
      return std::unique_ptr<MaterialBody<dim>>(
        new MaterialBody<dim>{body,
                              std::move(stress),
                              MaterialPoints<dim>(grid, layout),
                              std::nullopt,
                              std::nullopt,
                              std::nullopt});
    }



    /** Whether a place is in a side of the box that holds the material of a
     * body, behind which it as good as continues. One that meets its surface
     * (side_contact.h) is none. */
    template <int dim>
    bool
    is_in_held_side(const Problem<dim>       &problem,
                    const Body<dim>          &body,
                    const dealii::Point<dim> &place)
    {
      for (unsigned int side = 0; side < 2 * dim; ++side)
        {
          const unsigned int d = side / 2;
          const double       plane =
            side % 2 == 0 ? problem.grid.lower[d] : problem.grid.upper[d];
          if (problem.sides[side].held != HeldComponents::none &&
              !(problem.sides[side].meets_surfaces && body.meets_sides) &&
              std::abs(place[d] - plane) < 1e-6 * problem.grid.edge(d))
            return true;
        }
      return false;
    }



    /** Where a place is below the surface of a shape. */
    struct Depth
    {
      double value;  // m
      double normal; // largest component of the normal of the surface
    };



    /**
     * The depth below the surface outside of held sides, which are the nearest
     * here: by rays along the axes. Of lengths l they see a plane with a normal
     * proportional to 1 / l at the depth (sum of 1 / l^2)^(-1/2); but one in a
     * corner sees two planes, and a ray along that normal is longer.
     */
    template <int dim>
    Depth
    depth_beside_sides(const Problem<dim>       &problem,
                       const Body<dim>          &body,
                       const dealii::Point<dim> &place,
                       const double              stride)
    {
      dealii::Tensor<1, dim> normal;
      Depth                  result{1e300, 1};
      for (int d = 0; d < dim; ++d)
        for (const double sign : {-1., 1.})
          {
            dealii::Tensor<1, dim> along;
            along[d]            = sign;
            const double length = way_out(*body.shape, place, along, stride);
            if (is_in_held_side<dim>(problem, body, place + length * along))
              continue;
            result.value = std::min(result.value, length);
            if (1 > std::abs(normal[d]) * length)
              normal[d] = sign / length;
          }
      if (!(normal.norm() > 0))
        return result;
      normal /= normal.norm();
      const double length = way_out(*body.shape, place, normal, stride);
      if (length < result.value)
        {
          result = {length, 0};
          for (int d = 0; d < dim; ++d)
            result.normal = std::max(result.normal, std::abs(normal[d]));
        }
      return result;
    }



    // Depth below the surface of points that are the last in a row of their
    // lattice: so far their material reaches.
    template <int dim>
    void
    set_reach(const Problem<dim>                                      &problem,
              const Body<dim>                                         &body,
              const std::function<double(const dealii::Point<dim> &)> &density,
              MaterialPoints<dim>                                     &points)
    {
      const PointView<dim> view = points.view();
      if (view.reach == nullptr)
        return;
      for (std::size_t p = 0; p < view.size; ++p)
        {
          dealii::Point<dim> place;
          for (int d = 0; d < dim; ++d)
            place[d] = view.position[d][p];
          const double half_edge =
            half_edge_of<dim>(view.mass[p] / density(place));
          view.reach[p] = 0;
          for (unsigned int k = 0; k < view.stretch.size(); ++k)
            if (view.keeps_stretch())
              view.stretch[k][p] = k < dim ? 1 : 0;
          if (const auto surface = body.shape->signed_distance(place))
            {
              Depth depth{-surface->value, 0};
              for (int d = 0; d < dim; ++d)
                depth.normal =
                  std::max(depth.normal, std::abs(surface->normal[d]));
              if (is_in_held_side<dim>(problem,
                                       body,
                                       place + depth.value * surface->normal))
                depth = depth_beside_sides(problem, body, place, half_edge);
              if (depth.value > 0 && depth.value < 2 * half_edge * depth.normal)
                view.reach[p] = depth.value;
            }
        }
    }



    // Edges of a point with 'cut', whose volume is smaller than that of the
    // spacing, or of a point of a 'fitted' lattice, from its volume.
    template <int dim>
    void
    set_edges(const GridDescription<dim>                              &box,
              const Body<dim>                                         &body,
              const std::function<double(const dealii::Point<dim> &)> &density,
              MaterialPoints<dim>                                     &points)
    {
      const PointView<dim> view = points.view();
      if (view.edge[0] == nullptr)
        return;
      std::array<double, dim> spacing;
      double                  room = 1;
      for (int d = 0; d < dim; ++d)
        {
          spacing[d] = box.edge(d) / body.points_per_cell_edge[d];
          room *= spacing[d];
        }
      for (std::size_t p = 0; p < view.size; ++p)
        {
          dealii::Point<dim> place;
          for (int d = 0; d < dim; ++d)
            place[d] = view.position[d][p];
          const double size =
            std::pow(view.mass[p] / density(place) / room, 1. / dim);
          for (int d = 0; d < dim; ++d)
            view.edge[d][p] = size * spacing[d];
        }
    }



    template <int dim>
    void
    fill_with_points(const Problem<dim>        &problem,
                     const BackgroundGrid<dim> &grid,
                     const InitialState<dim>   &initial,
                     MaterialBody<dim>         &body)
    {
      const auto density = [&](const dealii::Point<dim> &place) {
        return body.description.density() /
               body.stress->volume_ratio_at(initial.at(place));
      };
      seed<dim>(body.description, grid, density, body.points);
      set_initial_state(initial, body);
      set_reach<dim>(problem, body.description, density, body.points);
      set_edges<dim>(problem.grid, body.description, density, body.points);

      if (body.points.n_global() == 0)
        throw InputError("The body '" + body.description.name +
                         "' holds no material point: no place that "
                         "'Points per cell edge' puts into the cells lies "
                         "in its shape. In 'Body " +
                         body.description.name +
                         "', enlarge the shape, or set 'Points per cell "
                         "edge' to 4, or refine 'Grid/Cells'.");
    }



    /** In a cell wider than the body the surface is not resolved, and the
     * body's weight on the grid depends on where the cell lies. */
    template <int dim>
    void
    refuse_thin_body(const BackgroundGrid<dim> &grid,
                     const MaterialBody<dim>   &body)
    {
      const PointView<dim> points = body.points.view();
      const Corners<dim>   box    = body.description.shape->bounding_box();
      for (unsigned int d = 0; d < dim; ++d)
        {
          double widest = 0;
          for (std::size_t p = 0; p < points.size; ++p)
            widest =
              std::max(widest,
                       1 / grid.geometry[points.cell[p]].inverse_edge[d]);
          widest = dealii::Utilities::MPI::max(widest, grid.communicator);
          const double extent = box.second[d] - box.first[d];
          if (extent < (1 - 1e-6) * widest &&
              widest > 1.5 * grid.description.finest_edge(d))
            throw InputError(
              "Body " + in_quotes(body.description.name) + " is " +
              brief(extent) + " m thin along " + std::string(1, "xyz"[d]) +
              ", thinner than the cells of " + brief(widest) +
              " m that hold part of it. Usually the finer cells of "
              "'Grid/Refine' do not cover it. Enlarge the refinement, or set "
              "more 'Grid/Cells'.");
        }
    }



    // An iteration: points are seeded to fit the cells, and refinement criteria
    // may look at points; each change of the mesh refines cells by one level.
    template <int dim>
    void
    seed_on_wanted_mesh(const Problem<dim>  &problem,
                        BackgroundGrid<dim> &grid,
                        Bodies<dim>         &bodies)
    {
      typename InitialState<dim>::OfAllBodies initial;
      for (const auto &body : bodies)
        initial.push_back(std::make_unique<InitialState<dim>>(
          problem, body->description, *body->stress, initial));
      for (;;)
        {
          for (std::size_t b = 0; b < bodies.size(); ++b)
            fill_with_points(problem, grid, *initial[b], *bodies[b]);
          if (!grid.has_levels())
            return;
          // Refined cells stay refined, so that the iteration ends.
          const RefinedCells<dim> present = grid.divided_cells();
          RefinedCells<dim> wanted = wanted_mesh(problem, grid, bodies, 0);
          wanted.join(present);
          if (wanted == present)
            break;
          for (auto &body : bodies)
            body->points.clear();
          change_mesh(grid, bodies, wanted);
        }
      for (const auto &body : bodies)
        refuse_thin_body(grid, *body);
    }
    /** Whether a place is in a shape, by more than a margin along each axis. */
    template <int dim>
    bool
    is_well_inside(const Shape<dim>         &shape,
                   const dealii::Point<dim> &place,
                   const double              margin)
    {
      if (!shape.contains(place))
        return false;
      for (int d = 0; d < dim; ++d)
        for (const double way : {-margin, margin})
          {
            dealii::Point<dim> next = place;
            next[d] += way;
            if (!shape.contains(next))
              return false;
          }
      return true;
    }



    /**
     * Refuses overlaps, which contact would push apart violently; points in a
     * common face of two bodies are in neither. Bodies that share their nodes
     * may overlap a little: health tells how much.
     */
    template <int dim>
    void
    refuse_overlaps(const BackgroundGrid<dim> &grid, const Bodies<dim> &bodies)
    {
      const double margin = 1e-3 * grid.smallest_edge;
      for (const auto &one : bodies)
        for (const auto &other : bodies)
          {
            const Body<dim> &body   = one->description,
                            &second = other->description;
            if (body.nodal_field == second.nodal_field)
              continue;
            double               n = 0;
            dealii::Point<dim>   places;
            const PointView<dim> points = one->points.view();
            for (std::size_t p = 0; p < points.size; ++p)
              {
                dealii::Point<dim> place;
                for (int d = 0; d < dim; ++d)
                  place[d] = points.position[d][p];
                if (!is_well_inside<dim>(*second.shape, place, margin))
                  continue;
                n += 1;
                places += place;
              }
            n = dealii::Utilities::MPI::sum(n, grid.communicator);
            const dealii::Tensor<1, dim> sum =
              dealii::Utilities::MPI::sum(dealii::Tensor<1, dim>(places),
                                          grid.communicator);
            if (n > 0)
              throw InputError(
                "Bodies " + in_quotes(body.name) + " and " +
                in_quotes(second.name) + " overlap at the start: " + brief(n) +
                " points of the first lie in the second, around " +
                brief<dim>(dealii::Point<dim>(sum / n)) +
                " m, and a contact would throw them apart. Usually one is "
                "misplaced. Move 'Body " +
                body.name + "' or 'Body " + second.name + "'.");
          }
    }
  } // namespace



  template <int dim>
  std::vector<std::unique_ptr<MaterialBody<dim>>>
  set_up_bodies(const Problem<dim> &problem, BackgroundGrid<dim> &grid)
  {
    Bodies<dim> bodies;
    for (const Body<dim> &body : problem.bodies)
      bodies.push_back(make_body(problem, body, grid));
    seed_on_wanted_mesh(problem, grid, bodies);
    refuse_overlaps(grid, bodies);

    if (dealii::Utilities::MPI::n_mpi_processes(grid.communicator) > 1)
      balance(grid, bodies);
    const unsigned int sums_of_cell =
      with_basis(grid.view(), [](const auto basis) {
        return std::decay_t<decltype(basis)>::n_nodes;
      });
    for (auto &body : bodies)
      {
        const Treatment kind = body->stress->treatment().kind;
        if (is_for_solids(problem.grid.kernel) && !body->description.is_liquid)
          {
            if (averages_volume_in_cells(kind))
              body->cell_averages.emplace(grid.n_cells());
          }
        else if (needs_cell_means(kind) ||
                 body->description.hourglass_control > 0)
          body->cell_sums.emplace(grid, sums_of_cell);
        if (body->description.deviatoric_history != HistoryTreatment::keep)
          body->deviator_sums.emplace(grid);
        if (averages_around_nodes(kind))
          body->nodal_means.emplace(grid.vertices);
        if (body->description.implicit_pressure)
          body->implicit.emplace(grid.n_cells());
        else if (body->description.checkerboard_control > 0 ||
                 body->description.density_control > 0)
          body->cell_shift.reinit(grid.n_cells());
      }
    return bodies;
  }



  template std::vector<std::unique_ptr<MaterialBody<2>>>
  set_up_bodies(const Problem<2> &, BackgroundGrid<2> &);
  template std::vector<std::unique_ptr<MaterialBody<3>>>
  set_up_bodies(const Problem<3> &, BackgroundGrid<3> &);
} // namespace limber
