// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/materials/law_list.h>
#include <limber/materials/linear_elastic.h>
#include <limber/materials/neo_hookean.h>
#include <limber/problem/ball.h>
#include <limber/problem/block.h>
#include <limber/problem/body_at_sides.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/words.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace limber
{
  namespace
  {
    // Longest over shortest edge, beyond which a body may fold onto itself in
    // an impact (self-contact).
    constexpr double slender = 4;

    // Rotation, rad, up to which a small-strain law in the initial frame is
    // accurate enough: it takes half the square of the angle for a strain.
    constexpr double small_rotation = 0.1;

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

    bool
    is_set(const Section &section, const std::string &control)
    {
      return section.text(control) != "auto" && section.number(control) > 0;
    }



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
      if (is_set(section, "Hourglass control"))
        return Hindrance{"leaves no motion of a cell without resistance, so "
                         "that 'Hourglass control' has nothing to do",
                         ", or 'Hourglass control = 0'"};
      if (is_set(section, "Checkerboard control"))
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



    /** An entry of a body that is incompatible with the kernel. */
    struct Misfit
    {
      std::string entry, reason, remedy;
    };

    std::optional<Misfit>
    misfit_of_splines(const Section &section)
    {
      if (read_word(section, "Locking treatment", locking_words()) ==
          Treatment::assumed_strain)
        return Misfit{"Locking treatment",
                      "splines have no hourglass modes to which it could give "
                      "a strain",
                      "'Locking treatment = node'"};
      if (is_set(section, "Hourglass control"))
        return Misfit{"Hourglass control",
                      "splines have no hourglass modes",
                      "'Hourglass control = 0'"};
      return {};
    }



    std::optional<Misfit>
    misfit_of_domains(const Section &section)
    {
      if (!treatment_of(
             read_word(section, "Locking treatment", locking_words()))
             .with_domains)
        return Misfit{"Locking treatment",
                      "domains reach over several cells",
                      "'Locking treatment = cell', 'node' or 'none'"};
      if (is_set(section, "Hourglass control"))
        return Misfit{"Hourglass control",
                      "domains that reach over several cells resist",
                      "'Hourglass control = 0'"};
      if (is_set(section, "Checkerboard control"))
        return Misfit{"Checkerboard control",
                      "it is for kernels whose points see one cell",
                      "'Checkerboard control = 0'"};
      if (read_word(section, "History", volume_history_words()) !=
          HistoryTreatment::keep)
        return Misfit{"History",
                      "points with domains keep their own",
                      "'History = keep'"};
      return {};
    }



    std::optional<Misfit>
    misfit_of_dual_domain(const Section &section)
    {
      if (!treatment_of(
             read_word(section, "Locking treatment", locking_words()))
             .with_domains)
        return Misfit{"Locking treatment",
                      "its gradients come from several cells",
                      "'Locking treatment = cell', 'node' or 'none'"};
      if (is_set(section, "Hourglass control"))
        return Misfit{"Hourglass control",
                      "no motion of a cell is without resistance",
                      "'Hourglass control = 0'"};
      if (is_set(section, "Checkerboard control"))
        return Misfit{"Checkerboard control",
                      "it is for kernels whose points see one cell",
                      "'Checkerboard control = 0'"};
      if (read_word(section, "History", volume_history_words()) !=
          HistoryTreatment::keep)
        return Misfit{"History", "points keep their own", "'History = keep'"};
      return {};
    }



    /**
     * The first entry in the section of a body that is incompatible with the
     * kernel.
     */
    std::optional<Misfit>
    misfit(const KernelKind kernel, const Section &section, const bool liquid)
    {
      if (is_spline(kernel))
        return misfit_of_splines(section);
      if (kernel == KernelKind::ddmp && !liquid)
        return misfit_of_dual_domain(section);
      if (has_domains(kernel) && !liquid)
        return misfit_of_domains(section);
      return {};
    }



    /**
     * Whether self-contact is excluded: a ball, or a box or block that is not
     * slender.
     */
    template <int dim>
    bool
    is_compact(const Shape<dim> &shape)
    {
      const auto *block = dynamic_cast<const BlockShape<dim> *>(&shape);
      if (block == nullptr)
        return dynamic_cast<const BallShape<dim> *>(&shape) != nullptr;
      using Info     = dealii::GeometryInfo<dim>;
      double longest = 0, shortest = std::numeric_limits<double>::max();
      for (unsigned int line = 0; line < Info::lines_per_cell; ++line)
        {
          const double edge =
            block->vertices[Info::line_to_cell_vertices(line, 0)].distance(
              block->vertices[Info::line_to_cell_vertices(line, 1)]);
          longest  = std::max(longest, edge);
          shortest = std::min(shortest, edge);
        }
      return longest <= slender * shortest;
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



    template <int dim>
    bool
    any_in_current_frame(const Problem<dim> &problem)
    {
      return std::any_of(problem.bodies.begin(),
                         problem.bodies.end(),
                         [](const auto &body) {
                           return body.frame == Frame::current;
                         });
    }



    /**
     * Why 'Kernel = auto' does not take splines here, whatever solids would
     * gain; empty if it may.
     */
    template <int dim>
    std::string
    against_splines(const Section &root, const Problem<dim> &problem)
    {
      if (problem.method.integration == TimeIntegration::semi_implicit)
        return "the time integration is made for linear functions";
      if (is_solved_by_newton(problem.method.integration) &&
          any_in_current_frame(problem))
        return "the time integration knows splines in the initial frame alone";
      if (problem.grid.levels > 0)
        return "splines need cells of one size ('Grid/Levels')";
      for (const auto &body : problem.bodies)
        {
          const Section section = root.subsection("Body " + body.name);
          if (const auto found = misfit_of_splines(section))
            return found->reason + " (" + section.where(found->entry) + ")";
        }
      for (const auto &body : problem.bodies)
        if (body.is_plastic && !body.keeps_surface)
          return "material that flows without end, like body " +
                 in_quotes(body.name) + ", keeps no strain that could creep";
      // With splines and FLIP liquids lose volume, so that floating bodies
      // sink; only affine transfers (APIC, AFLIP) conserve it.
      const std::string transfer = root.subsection("Method").text("Transfer");
      if (transfer != "apic" && transfer != "aflip")
        for (const auto &body : problem.bodies)
          if (body.is_liquid)
            return "with splines liquids, like body " + in_quotes(body.name) +
                   ", lose volume";
      return "";
    }



    /**
     * Whether points with domains serve a scene on cells of several sizes: of
     * solids that keep their connection, where linear functions creep. They go
     * neither with joined points nor with pairs in contact.
     */
    template <int dim>
    bool
    takes_domains(const Section &root, const Problem<dim> &problem)
    {
      return problem.method.integration == TimeIntegration::explicit_steps &&
             !root.subsection("Grid").flag("Join points") &&
             root.subsection("Contact").list("Pairs").empty() &&
             !is_affine(read_word(root.subsection("Method"),
                                  "Transfer",
                                  transfer_words())) &&
             std::all_of(problem.bodies.begin(),
                         problem.bodies.end(),
                         [&](const auto &body) {
                           return !body.is_liquid &&
                                  (!body.is_plastic || body.keeps_surface) &&
                                  !misfit_of_domains(
                                    root.subsection("Body " + body.name));
                         });
    }



    template <int dim>
    void
    choose_kernel(const Section &root, Problem<dim> &problem)
    {
      const auto say = [&](const std::string &choice) {
        problem.notes.push_back("Kernel 'auto' is " + choice + ".");
      };
      problem.grid.kernel = KernelKind::linear;
      if (problem.grid.levels > 0 && any_in_current_frame(problem) &&
          takes_domains(root, problem))
        {
          problem.grid.kernel = KernelKind::cpdi;
          return say("'cpdi', as solids creep with linear functions when their "
                     "points cross cells, and splines need cells of one size");
        }
      if (!problem.grid.against_splines.empty())
        return say("'linear', as " + problem.grid.against_splines);
      for (const auto &body : problem.bodies)
        if (!body.is_liquid && body.frame == Frame::current)
          {
            problem.grid.kernel = KernelKind::quadratic;
            return say("'quadratic', as solids like body " +
                       in_quotes(body.name) +
                       " creep with linear functions when their points cross "
                       "cells");
          }
      // Linear functions represent bending along the axes of the grid only: a
      // strip two cells thick that runs across the cells is 20 % too stiff,
      // with splines right to 0.3 %. But with splines the spin of a free body
      // excites vibrations.
      const bool may_spin =
        !root.subsection("Loads").list("Face loads").empty();
      for (const auto &body : problem.bodies)
        if (!body.is_liquid && !is_upright(*body.shape) &&
            root.list("Obstacles").empty() &&
            (is_held(body, problem) ||
             (!may_spin && !is_compact(*body.shape) &&
              initial_rotation(body, problem.end_time) < small_rotation)))
          {
            problem.grid.kernel = KernelKind::quadratic;
            return say("'quadratic', as linear functions are too stiff where "
                       "bodies bend across the cells, as " +
                       in_quotes(body.name) + " may");
          }
      say("'linear', as no solid crosses cells");
    }
  } // namespace



  template <int dim>
  void
  choose_frames_and_kernel(const Section &root, Problem<dim> &problem)
  {
    const auto obstacle_of_all = obstacle_to_one_piece(root, problem);
    for (auto &body : problem.bodies)
      choose_frame(root, obstacle_of_all, body, problem);
    check_frames(problem);

    const Section method         = root.subsection("Method");
    problem.grid.kernel          = read_word(method, "Kernel", kernel_words());
    problem.grid.against_splines = against_splines(root, problem);
    if (problem.grid.kernel == KernelKind::automatic)
      choose_kernel(root, problem);
    for (const auto &body : problem.bodies)
      {
        const Section section = root.subsection("Body " + body.name);
        if (const auto found =
              misfit(problem.grid.kernel, section, body.is_liquid))
          throw InputError(
            "The entry " + in_quotes(section.text(found->entry)) + " in " +
            section.where(found->entry) +
            " does not go with 'Method/Kernel = " + method.text("Kernel") +
            "': " + found->reason + ". Set " + found->remedy +
            ", or 'Kernel = linear'.");
      }
    warn_of_solid_motion(problem);
    if (has_domains(problem.grid.kernel) &&
        is_affine(read_word(method, "Transfer", transfer_words())))
      throw InputError("The transfer " + in_quotes(method.text("Transfer")) +
                       " in " + method.where("Transfer") +
                       " does not go with 'Kernel = " + method.text("Kernel") +
                       "', which has no moments "
                       "for it. Set 'Transfer = flip' or 'fmpm', or 'Kernel = "
                       "quadratic'.");
  }



  template void
  choose_frames_and_kernel(const Section &, Problem<2> &);
  template void
  choose_frames_and_kernel(const Section &, Problem<3> &);
} // namespace limber
