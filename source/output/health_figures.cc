// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/text.h>
#include <limber/materials/linear_elastic.h>
#include <limber/materials/plastic_strain.h>
#include <limber/output/health_figures.h>
#include <limber/points/shape_volume.h>
#include <limber/points/single_point.h>
#include <limber/problem/filter_bound.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace limber
{
  namespace
  {
    using dealii::Utilities::MPI::max;
    using dealii::Utilities::MPI::sum;



    template <int dim>
    bool
    boxes_meet(const Shape<dim> &one, const Shape<dim> &other)
    {
      const Corners<dim> a = one.bounding_box(), b = other.bounding_box();
      for (unsigned int d = 0; d < dim; ++d)
        if (a.second[d] <= b.first[d] || b.second[d] <= a.first[d])
          return false;
      return true;
    }



    template <int dim>
    std::string
    centre_of(const dealii::Tensor<1, dim> &moment, const double volume)
    {
      std::vector<std::string> numbers;
      for (unsigned int d = 0; d < dim; ++d)
        numbers.push_back(brief(moment[d] / volume));
      return join(numbers, ", ");
    }



    /** Weight times depth of the points of a body: twice the energy that its
     * levels could release. Collective. */
    template <int dim>
    double
    weight_times_depth(const PointView<dim>         &points,
                       const dealii::Tensor<1, dim> &gravity,
                       const MPI_Comm                ranks)
    {
      double mass  = 0;
      double above = std::numeric_limits<double>::lowest(), below = above;
      for (std::size_t p = 0; p < points.size; ++p)
        {
          double fallen = 0; // along gravity, times its size
          for (unsigned int d = 0; d < dim; ++d)
            fallen += gravity[d] * points.position[d][p];
          mass += points.mass[p];
          below = std::max(below, fallen);
          above = std::max(above, -fallen);
        }
      mass = sum(mass, ranks);
      return mass > 0 ? mass * (max(below, ranks) + max(above, ranks)) : 0;
    }



    /** Keep the largest overlap of a body with another one. */
    template <int dim>
    void
    look_at_overlap(const State<dim> &start,
                    const std::size_t a,
                    const std::size_t b,
                    BodyFigures      &body)
    {
      const Body<dim> &own   = start.problem.bodies[a],
                      &other = start.problem.bodies[b];
      if (!boxes_meet(*own.shape, *other.shape))
        return;
      const VolumeInside<dim> here =
        volume_inside<dim>(start.bodies[a]->points.view(),
                           own.density(),
                           *other.shape);
      const double volume = sum(here.volume, start.grid.communicator);
      const auto   moment = sum(here.moment, start.grid.communicator);
      if (volume <= body.overlap * body.volume)
        return;
      body.overlap       = volume / body.volume;
      body.overlaps_with = other.name;
      body.overlap_place = centre_of<dim>(moment, volume);
    }



    /**
     * Angle by which the points of a body have rotated since the start, rms by
     * mass: in the plane that of the polar decomposition of F, in space by tan
     * = |axial(F)| / (tr F - 1), which is exact for pure rotations.
     */
    template <int dim>
    double
    rotation_of(const PointView<dim> &points, const MPI_Comm ranks)
    {
      double squares = 0, mass = 0;
      for (std::size_t p = 0; p < points.size; ++p)
        {
          double axial = 0, trace = 2 - dim;
          for (unsigned int d = 0; d < dim; ++d)
            {
              trace += points.deformation[d * dim + d][p];
              for (unsigned int e = 0; e < d; ++e)
                axial = std::hypot(axial,
                                   points.deformation[d * dim + e][p] -
                                     points.deformation[e * dim + d][p]);
            }
          const double angle = std::atan2(axial, trace);
          squares += points.mass[p] * angle * angle;
          mass += points.mass[p];
        }
      mass = sum(mass, ranks);
      return mass > 0 ? std::sqrt(sum(squares, ranks) / mass) : 0;
    }
  } // namespace



  template <int dim>
  void
  look_at_seeding(const State<dim> &start, std::vector<BodyFigures> &bodies)
  {
    for (std::size_t b = 0; b < bodies.size(); ++b)
      {
        const Body<dim>     &description = start.problem.bodies[b];
        const auto          &own         = *start.bodies[b];
        const PointView<dim> points      = own.points.view();
        BodyFigures         &body        = bodies[b];
        std::vector<double>  ratio(points.size, 1.);
        // the density of a law for small strain is that of the start
        if (description.law != LinearElastic::name)
          own.stress->volume_ratio(points, ratio.data());
        double volume = 0;
        for (std::size_t p = 0; p < points.size; ++p)
          volume += points.mass[p] * ratio[p] / description.density();
        body.volume       = sum(volume, start.grid.communicator);
        body.points       = own.points.n_global();
        body.shape_volume = shape_volume(*description.shape);
        // all ranks, as it is collective
        const double potential =
          weight_times_depth<dim>(points,
                                  start.problem.loads.gravity,
                                  start.grid.communicator);
        if (body.is_liquid)
          body.potential = potential;
      }
    for (std::size_t a = 0; a < bodies.size(); ++a)
      for (std::size_t b = 0; b < bodies.size(); ++b)
        if (a != b)
          look_at_overlap(start, a, b, bodies[a]);
  }



  /** Elastic share of the strain of each point, which alone creeps: all of it,
   * except in soil, where most of the strain is plastic in a flow. */
  template <int dim>
  class ElasticShare
  {
  public:
    explicit ElasticShare(const MaterialBody<dim> &body)
      : body(body)
    {
      if (body.description.keeps_surface)
        return;
      if (const auto variable =
            plastic_strain_of(body.description.law, body.description.material))
        plastic_strain = body.variable(*variable);
    }

    /** Of point @p p with the strain @p energy. The elastic strain is that of a
     * wave with this energy, half the mass times (c strain)^2. */
    double
    operator()(const std::size_t p, const double energy) const
    {
      if (plastic_strain == nullptr || !(plastic_strain[p] > 0))
        return 1;
      const PointView<dim> point   = only(body.points.view(), p);
      const double         elastic = std::sqrt(
        2 * energy / (point.mass[0] * body.stress->wave_speed_squared(point)));
      return elastic / (elastic + plastic_strain[p]);
    }

  private:
    const MaterialBody<dim> &body;
    const double            *plastic_strain = nullptr;
  };



  // Crossings are weighted by strain energy: those of points without stress, as
  // at the tip of a beam, cause no creep.
  template <int dim>
  void
  look_at_crossings(const State<dim> &state, std::vector<BodyFigures> &bodies)
  {
    for (std::size_t b = 0; b < bodies.size(); ++b)
      {
        const auto          &own    = *state.bodies[b];
        const PointView<dim> points = own.points.view();
        if (points.crossings == nullptr)
          continue;
        const ElasticShare<dim> elastic_share(own);
        double                  all = 0, most = 0;
        // energy; energy times crossings, times these and the elastic share;
        // energy in tension
        std::array<double, 4> strained{};
        for (std::size_t p = 0; p < points.size; ++p)
          {
            const double energy =
              own.stress->summarize(only(points, p)).strain_energy;
            all += points.crossings[p];
            most = std::max(most, points.crossings[p]);
            strained[0] += energy;
            strained[1] += energy * points.crossings[p];
            if (points.crossings[p] > 0)
              strained[2] +=
                energy * points.crossings[p] * elastic_share(p, energy);
            if (points.pressure[p] < 0)
              strained[3] += energy;
          }
        const MPI_Comm ranks  = state.grid.communicator;
        const double   n      = sum(double(points.size), ranks);
        const double   energy = sum(strained[0], ranks);
        BodyFigures   &body   = bodies[b];
        body.crossings        = n > 0 ? sum(all, ranks) / n : 0;
        body.most_crossings   = max(most, ranks);
        const double weighted = sum(strained[1], ranks);
        body.crossings_under_strain =
          energy > 0 ? weighted / energy : body.crossings;
        if (weighted > 0)
          body.elastic_share = sum(strained[2], ranks) / weighted;
        const double in_tension = sum(strained[3], ranks);
        body.share_in_tension   = energy > 0 ? in_tension / energy : 0;
      }
  }



  template <int dim>
  Health<dim>::Health(const State<dim> &start)
  {
    for (const Body<dim> &body : start.problem.bodies)
      {
        BodyFigures figures;
        figures.name          = body.name;
        figures.is_liquid     = body.is_liquid;
        figures.is_plastic    = body.is_plastic;
        figures.keeps_surface = body.keeps_surface;
        figures.is_split      = body.splits_stretched_points;
        figures.is_shifted    = body.particle_shifting > 0;
        figures.kernel        = start.problem.grid.kernel;
        figures.points_per_edge =
          *std::min_element(body.points_per_cell_edge.begin(),
                            body.points_per_cell_edge.end());
        figures.stays_in_cells = body.frame == Frame::initial;
        figures.stays_upright =
          figures.stays_in_cells && body.law == LinearElastic::name;
        figures.is_cut = body.placement == Placement::cut ||
                         body.placement == Placement::fitted ||
                         body.placement == Placement::gauss;
        at_start.push_back(figures);
      }
    look_at_seeding(start, at_start);
    look_at_cells(start, at_start);
    for (BodyFigures &body : at_start)
      body.gaps_at_start = body.gaps;
  }



  template <int dim>
  HealthFigures
  Health<dim>::look(const State<dim>        &state,
                    const Totals<dim>       &totals,
                    const BalanceState<dim> &balance) const
  {
    HealthFigures figures;
    figures.bodies       = at_start;
    figures.dim          = dim;
    figures.energy_scale = balance.energy_scale;
    figures.inner_scale  = balance.inner_scale;
    figures.kinetic      = totals.all.kinetic_energy;
    figures.drift        = balance.inner_scale > 0 ?
                             totals.unexplained_energy / balance.inner_scale :
                             0;
    figures.transfer     = totals.removed_by_transfer;
    figures.viscous      = totals.dissipated;
    figures.is_semi_implicit =
      state.problem.method.integration == TimeIntegration::semi_implicit;
    figures.lost_by_steps = totals.lost_by_steps;
    figures.is_smoothed   = filters_velocity(state.problem.method.transfer) ||
                          state.problem.method.transfer == Transfer::pic;
    // The first steps of a body that starts from rest all turn its velocity;
    // and what is at rest moves by round-off.
    constexpr double at_rest = 1e-8;
    figures.is_implicit =
      state.problem.method.integration == TimeIntegration::implicit_steps &&
      state.step > 3 &&
      totals.kinetic_action > at_rest * balance.energy_scale * state.time;
    figures.kinetic_action    = totals.kinetic_action;
    figures.action_of_changes = totals.action_of_changes;
    figures.history           = totals.removed_with_history;
    figures.plastic           = totals.plastic_work;
    figures.friction          = totals.friction_heat;
    figures.contact           = totals.contact_loss;
    figures.adaptation        = totals.removed_by_adaptation;
    figures.sides             = totals.boundary_work;
    figures.loads             = totals.load_work;
    figures.may_hit =
      !state.problem.obstacles.empty() ||
      std::any_of(state.problem.sides.begin(),
                  state.problem.sides.end(),
                  [](const Side<dim> &side) { return side.may_be_hit; }) ||
      std::any_of(state.problem.contacts.begin(),
                  state.problem.contacts.end(),
                  [](const ContactPair &pair) {
                    return pair.law == ContactLaw::separate;
                  });
    figures.points          = totals.points;
    figures.put_back        = totals.put_back;
    figures.put_back_way    = totals.put_back_way;
    figures.against_splines = state.problem.grid.against_splines;
    figures.has_levels      = state.problem.grid.levels > 0;
    figures.takes_apic =
      state.problem.contacts.empty() && !has_domains(state.problem.grid.kernel);
    figures.with_apic = entries_of_filter(state.problem.method);
    figures.knows_domains =
      state.problem.method.integration == TimeIntegration::explicit_steps;
    if (state.problem.method.time_step > 0 ||
        is_solved_by_newton(state.problem.method.integration))
      figures.step_entry = "Method/Time step";

    const auto unseen = unseen_energy(state);
    for (std::size_t b = 0; b < unseen.size(); ++b)
      {
        const auto summary =
          state.bodies[b]->stress->summarize(state.bodies[b]->points.view());
        BodyFigures &body  = figures.bodies[b];
        body.unseen_energy = unseen[b];
        body.strain_energy = totals.bodies[b].strain_energy;
        body.smallest_volume =
          -max(-summary.smallest_volume, state.grid.communicator);
        body.largest_volume =
          max(summary.largest_volume, state.grid.communicator);
      }
    look_at_crossings(state, figures.bodies);
    for (std::size_t b = 0; b < figures.bodies.size(); ++b)
      if (figures.bodies[b].stays_upright)
        figures.bodies[b].rotation =
          rotation_of(state.bodies[b]->points.view(), state.grid.communicator);
    look_at_cells(state, figures.bodies);
    figures.obstacles = look_at_obstacles(state);
    figures.put_out   = totals.put_out;
    return figures;
  }



  template void
  look_at_seeding(const State<2> &, std::vector<BodyFigures> &);
  template void
  look_at_seeding(const State<3> &, std::vector<BodyFigures> &);
  template void
  look_at_crossings(const State<2> &, std::vector<BodyFigures> &);
  template void
  look_at_crossings(const State<3> &, std::vector<BodyFigures> &);
  template class Health<2>;
  template class Health<3>;
} // namespace limber
