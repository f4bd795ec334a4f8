// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/body_at_sides.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/words.h>

#include <algorithm>

namespace limber
{
  bool
  is_switched_on(const Section &section, const std::string &control)
  {
    return section.text(control) != "auto" && section.number(control) > 0;
  }



  namespace
  {
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
      if (is_switched_on(section, "Hourglass control"))
        return Misfit{"Hourglass control",
                      "splines have no hourglass modes",
                      "'Hourglass control = 0'"};
      return {};
    }



    /** Why kernels whose points see several cells do not take an entry. */
    struct Reasons
    {
      std::string treatment, hourglass, history;
    };

    std::optional<Misfit>
    misfit_beyond_cells(const Section &section, const Reasons &reasons)
    {
      if (!treatment_of(
             read_word(section, "Locking treatment", locking_words()))
             .with_domains)
        return Misfit{"Locking treatment",
                      reasons.treatment,
                      "'Locking treatment = cell', 'node' or 'none'"};
      if (is_switched_on(section, "Hourglass control"))
        return Misfit{"Hourglass control",
                      reasons.hourglass,
                      "'Hourglass control = 0'"};
      if (is_switched_on(section, "Checkerboard control"))
        return Misfit{"Checkerboard control",
                      "it is for kernels whose points see one cell",
                      "'Checkerboard control = 0'"};
      if (read_word(section, "History", volume_history_words()) !=
          HistoryTreatment::keep)
        return Misfit{"History", reasons.history, "'History = keep'"};
      return {};
    }



    std::optional<Misfit>
    misfit_of_domains(const Section &section)
    {
      return misfit_beyond_cells(section,
                                 {"domains reach over several cells",
                                  "domains that reach over several cells "
                                  "resist",
                                  "points with domains keep their own"});
    }



    std::optional<Misfit>
    misfit_of_dual_domain(const Section &section)
    {
      return misfit_beyond_cells(section,
                                 {"its gradients come from several cells",
                                  "no motion of a cell is without resistance",
                                  "points keep their own"});
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
    find_kernel(const Section &root, Problem<dim> &problem)
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
  choose_kernel(const Section &root, Problem<dim> &problem)
  {
    const Section method         = root.subsection("Method");
    problem.grid.kernel          = read_word(method, "Kernel", kernel_words());
    problem.grid.against_splines = against_splines(root, problem);
    if (problem.grid.kernel == KernelKind::automatic)
      find_kernel(root, problem);
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
  choose_kernel(const Section &, Problem<2> &);
  template void
  choose_kernel(const Section &, Problem<3> &);
} // namespace limber
