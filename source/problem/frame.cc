// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/materials/law_list.h>
#include <limber/materials/linear_elastic.h>
#include <limber/materials/neo_hookean.h>
#include <limber/problem/body_at_sides.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/words.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace limber
{
  namespace
  {
    // Impact energy per volume over Young's modulus up to which 'auto' is the
    // initial frame: a disc with 0.13 from its fall bounces there, with 1.3 its
    // points invert.
    constexpr double max_impact_energy_ratio = 0.3;



    /** Why a choice is refused, and the remedy. */
    struct Hindrance
    {
      std::string cause;
      std::string remedy; // what to set, besides leaving the choice
      bool        goes_in_current = true; // the current frame takes it
    };

    /**
     * Which entry excludes the initial frame (total Lagrangian); empty: none.
     */
    std::optional<Hindrance>
    obstacle_to_initial_frame(const Section &section, const Section &root)
    {
      const auto &law = read_word(section, "Material", law_words());
      if (!law.is_elastic && !law.is_plastic)
        return Hindrance{"is for solids, which the material " +
                           in_quotes(section.text("Material")) + " is not",
                         ", or the material of a solid, for instance 'neo "
                         "hookean'"};
      if (law.is_elastic && !section.is_empty("Initial stress"))
        return Hindrance{"has a stress that follows from the deformation "
                         "alone, so that no 'Initial stress' can be",
                         ", or leave 'Initial stress' empty"};
      const Treatment treatment =
        read_word(section, "Locking treatment", locking_words());
      if (!treatment_of(treatment).in_initial_frame)
        return Hindrance{
          "has no locking treatment " +
            in_quotes(section.text("Locking treatment")),
          ", or 'Locking treatment = assumed strain', 'cell' or 'none'"};
      if (is_switched_on(section, "Hourglass control"))
        return Hindrance{"leaves no motion of a cell without resistance, so "
                         "that 'Hourglass control' has nothing to do",
                         ", or 'Hourglass control = 0'"};
      if (is_switched_on(section, "Checkerboard control"))
        return Hindrance{"has no checkerboard control",
                         ", or 'Checkerboard control = 0'"};
      for (const std::string history : {"History", "Deviatoric history"})
        if (read_word(section, history, volume_history_words()) !=
            HistoryTreatment::keep)
          return Hindrance{"has no histories that could scatter: the stress "
                           "follows from the deformation",
                           ", or '" + history + " = keep'"};
      const Section method = root.subsection("Method");
      if (read_word(method, "Stress update", stress_update_words()) ==
          StressUpdateOrder::usf)
        return Hindrance{"does not go with 'Method/Stress update = usf'",
                         ", or 'Stress update = musl'"};
      const auto kernel = read_word(method, "Kernel", kernel_words());
      if (has_domains(kernel))
        return Hindrance{"has no points with domains, as none moves through "
                         "its cells",
                         ", or 'Method/Kernel = linear', 'quadratic' or "
                         "'auto'"};
      if (kernel == KernelKind::ddmp)
        return Hindrance{"has no gradients that come from the nodes, as none "
                         "jumps where no point crosses",
                         ", or 'Method/Kernel = linear', 'quadratic' or "
                         "'auto'"};
      if (is_spline(kernel) && treatment == Treatment::assumed_strain)
        return Hindrance{"has an assumed strain with linear functions only",
                         "'Method/Kernel = linear', or 'Locking treatment "
                         "= cell' or 'none'",
                         false};
      return {};
    }



    /**
     * Why several bodies cannot use the initial frame: there a body does not
     * detect contact with another one. In steps by Newton's method bodies that
     * form one piece can.
     */
    template <int dim>
    std::optional<Hindrance>
    obstacle_to_one_piece(const Section &root, const Problem<dim> &problem)
    {
      if (problem.bodies.size() == 1)
        return {};
      if (!is_solved_by_newton(problem.method.integration))
        return Hindrance{"is for a scene of one body: it would not notice that "
                         "it meets another one",
                         ""};
      if (!root.subsection("Contact").list("Pairs").empty())
        return Hindrance{"is not for bodies that meet ('Contact/Pairs')", ""};
      for (const auto &body : problem.bodies)
        {
          const Section section = root.subsection("Body " + body.name);
          if (body.frame == Frame::current ||
              obstacle_to_initial_frame(section, root))
            return Hindrance{"is for all bodies or for none, and body " +
                               in_quotes(body.name) + " has the current one",
                             ""};
        }
      if (!are_one_piece(problem))
        return Hindrance{"is for bodies that are one piece: it would not "
                         "notice that they meet later",
                         ""};
      return {};
    }



    /**
     * Impact energy per volume of a neo-Hookean body, over Young's modulus: of
     * the fall to the sides of the box, and of the initial velocity, sampled on
     * a lattice.
     */
    template <int dim>
    double
    impact_energy_ratio(const Body<dim> &body, const Problem<dim> &problem)
    {
      constexpr unsigned int n    = 8; // along each edge
      const Corners<dim>     box  = body.shape->bounding_box();
      double                 fall = 0; // times gravity, m^2/s^2
      for (unsigned int d = 0; d < dim; ++d)
        {
          const double g = problem.loads.gravity[d];
          fall += std::abs(g) * (g < 0 ? box.first[d] - problem.grid.lower[d] :
                                         problem.grid.upper[d] - box.second[d]);
        }
      double fastest = 0;
      for (unsigned int i = 0; i < dealii::Utilities::pow(n, dim); ++i)
        {
          dealii::Point<dim> place;
          for (unsigned int d = 0, rest = i; d < dim; ++d, rest /= n)
            place[d] = box.first[d] +
                       (rest % n + 0.5) / n * (box.second[d] - box.first[d]);
          if (!body.initial_velocity.empty())
            fastest =
              std::max(fastest, body.initial_velocity.vector(place, 0).norm());
        }
      const double stiffness = body.material[1];
      static_assert(NeoHookean::parameters[1].name ==
                    law_parameters::young_modulus.name);
      return body.density() * (fall + 0.5 * fastest * fastest) / stiffness;
    }



    /**
     * Whether 'auto' may choose the initial frame for a body that hits sides:
     * contact acts at its surface (choose_side_contact()), it cannot fold onto
     * itself, its law admits finite rotations, and the impact is too weak to
     * invert cells in the initial frame.
     */
    template <int dim>
    bool
    may_bounce(const Section      &root,
               const Body<dim>    &body,
               const Problem<dim> &problem)
    {
      if (problem.bodies.size() != 1 || body.law != NeoHookean::name ||
          problem.method.integration != TimeIntegration::explicit_steps ||
          filters_velocity(problem.method.transfer) ||
          problem.loads.body_force || !root.list("Obstacles").empty() ||
          !root.subsection("Loads").list("Face loads").empty() ||
          !is_compact(*body.shape))
        return false;
      for (unsigned int side = 0; side < 2 * dim; ++side)
        {
          const Side<dim> &wall = problem.sides[side];
          // With friction a body would roll on its outermost points, which keep
          // their places in the surface: on a gentle slope it stands still.
          if (wall.friction > 0)
            return false;
          if (wall.held != HeldComponents::none && !wall.one_sided &&
              (wall.held == HeldComponents::all || !wall.velocity.empty() ||
               has_face_in(side, body, problem.grid)))
            return false;
        }
      return impact_energy_ratio(body, problem) < max_impact_energy_ratio;
    }



    /** Whether a body has faces in all sides of the box, all of which hold it:
     * it cannot go anywhere. */
    template <int dim>
    bool
    fills_the_box(const Body<dim> &body, const Problem<dim> &problem)
    {
      for (unsigned int side = 0; side < 2 * dim; ++side)
        if (problem.sides[side].held == HeldComponents::none ||
            problem.sides[side].one_sided ||
            !has_face_in(side, body, problem.grid))
          return false;
      return true;
    }



    /**
     * Which contact may occur that the initial frame would not detect; empty if
     * the body is held or if there is nothing to meet. A side along which it
     * may slide is also one from which it may lift.
     */
    template <int dim>
    std::string
    what_it_may_meet(const Section      &root,
                     const Body<dim>    &body,
                     const Problem<dim> &problem)
    {
      if (!root.list("Obstacles").empty())
        return "it may roll on an obstacle, or fold onto itself";
      bool walls = false;
      for (unsigned int side = 0; side < 2 * dim; ++side)
        {
          const Side<dim> &wall = problem.sides[side];
          walls                 = walls || wall.held != HeldComponents::none;
          if (wall.one_sided && has_face_in(side, body, problem.grid))
            return "it may slide and lift from the side " +
                   in_quotes(side_names(dim)[side]);
        }
      const bool held = std::any_of(problem.bodies.begin(),
                                    problem.bodies.end(),
                                    [&](const auto &any) {
                                      return is_held(any, problem) ||
                                             fills_the_box(any, problem);
                                    });
      return held || !walls ||
                 stays_clear(
                   !root.subsection("Loads").list("Face loads").empty(),
                   body,
                   problem) ?
               "" :
               "it may meet a side, as none holds it, not all are 'free', and "
               "it is not at rest clear of them";
    }



    /**
     * Whether plastic flow may distort the cells of the initial frame too much;
     * quasi-static equilibria do not flow that far.
     */
    template <int dim>
    bool
    may_flow_far(const Body<dim> &body, const TimeIntegration integration)
    {
      return body.is_plastic && integration != TimeIntegration::quasi_static &&
             !(is_solved_by_newton(integration) && body.keeps_surface);
    }



    /**
     * Whether the law is for small strains and, with the deformation gradient
     * since the start, takes the rotation of the body for a strain.
     */
    template <int dim>
    bool
    turns_too_far(const Body<dim> &body, const double end_time)
    {
      return body.law == LinearElastic::name &&
             initial_rotation(body, end_time) > small_rotation;
    }



    /**
     * Why the initial frame does not go with the cells of several sizes that a
     * scene asks for; empty if it does. Treatments average over cells there,
     * not in time, so that another mesh would mean another energy.
     */
    template <int dim>
    std::optional<Hindrance>
    misfit_of_levels(const GridDescription<dim> &grid)
    {
      for (const Refinement<dim> &refinement : grid.refinements)
        {
          const bool meets =
            refinement.criterion == RefinementCriterion::obstacle ||
            refinement.criterion == RefinementCriterion::contact;
          if (meets || refinement.changes_mesh_at_rest())
            return Hindrance{"needs cells that stay as they are, and "
                             "'Grid/Refine " +
                               refinement.name + "' " +
                               (meets ? "follows what the body meets" :
                                        "changes them during the run"),
                             ", or 'Criterion = region' without t there"};
        }
      return std::nullopt;
    }



    /** A refinement at certain places, which move with the material in the
     * initial frame, while no side holds a body; empty if there is none. */
    template <int dim>
    std::string
    region_to_pass(const Problem<dim> &problem)
    {
      if (std::any_of(problem.bodies.begin(),
                      problem.bodies.end(),
                      [&](const auto &any) { return is_held(any, problem); }))
        return "";
      for (const Refinement<dim> &refinement : problem.grid.refinements)
        if (refinement.criterion == RefinementCriterion::region)
          return refinement.name;
      return "";
    }



    template <int dim>
    void
    choose_frame(const Section                  &root,
                 const std::optional<Hindrance> &obstacle_of_all,
                 Body<dim>                      &body,
                 Problem<dim>                   &problem)
    {
      const Section section  = root.subsection("Body " + body.name);
      auto          obstacle = obstacle_to_initial_frame(section, root);
      if (!obstacle)
        obstacle = obstacle_of_all;
      if (!obstacle)
        obstacle = misfit_of_levels(problem.grid);
      if (body.frame == Frame::initial && obstacle)
        throw InputError(
          "The frame 'initial' in " + section.where("Frame") + " " +
          obstacle->cause + ". Set " +
          (obstacle->goes_in_current ? "'Frame = current'" : "") +
          obstacle->remedy + ".");
      if (body.frame != Frame::automatic)
        return;

      std::string meeting; // of any body of the piece
      for (const auto &part : problem.bodies)
        if (meeting.empty())
          meeting = may_flow_far(part, problem.method.integration) ?
                      "it may flow far" :
                    turns_too_far(part, problem.end_time) ?
                      "its law is for small rotations, and it turns" :
                      what_it_may_meet(root, part, problem);
      bool bounces = !meeting.empty() && may_bounce(root, body, problem);
      if (const auto region = region_to_pass(problem); !region.empty())
        {
          meeting = "it may pass the cells of 'Grid/Refine " + region + "'";
          bounces = false;
        }
      body.frame = !obstacle && (meeting.empty() || bounces) ? Frame::initial :
                                                               Frame::current;
      if (!body.is_liquid)
        problem.notes.push_back(
          "Body " + in_quotes(body.name) + ": frame 'auto' is " +
          (body.frame == Frame::initial ?
             "'initial', in which nothing crosses cells: it is one solid, " +
               std::string(bounces ?
                             "compact, which feels the sides at its surface." :
                             "held or without walls to meet.") :
           obstacle ? "'current', as 'initial' " + obstacle->cause + "." :
                      "'current', as " + meeting + "."));
    }



    // Bodies share the shape functions of their nodes, hence one frame.
    template <int dim>
    void
    check_frames(const Problem<dim> &problem)
    {
      for (const auto &body : problem.bodies)
        for (const auto &other : problem.bodies)
          if (body.frame == Frame::initial && other.frame == Frame::current)
            throw InputError(
              "The frame 'initial' in 'Body " + body.name +
              "/Frame' is for all bodies or for none, and body " +
              in_quotes(other.name) + " has the current one. Set 'Body " +
              other.name + "/Frame = initial' as well, or 'Body " + body.name +
              "/Frame = current'.");
    }



  } // namespace



  template <int dim>
  void
  choose_frames(const Section &root, Problem<dim> &problem)
  {
    const auto obstacle_of_all = obstacle_to_one_piece(root, problem);
    for (auto &body : problem.bodies)
      choose_frame(root, obstacle_of_all, body, problem);
    check_frames(problem);
  }



  template void
  choose_frames(const Section &, Problem<2> &);
  template void
  choose_frames(const Section &, Problem<3> &);
} // namespace limber
