// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/materials/law_list.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/words.h>

#include <algorithm>
#include <cmath>
#include <limits>

/** @file The locking treatment of a body, its stabilisation and histories. */
namespace limber
{
  void
  declare_treatment(Parameters &parameters)
  {
    declare_word(parameters,
                 "Locking treatment",
                 "auto",
                 locking_words(),
                 "What keeps a nearly incompressible material from locking: "
                 "'cell' takes the mean strain of a cell for the volume, as "
                 "B-bar and F-bar do, 'node' that around nodes; see "
                 "doc/theory.");
    declare_word(parameters,
                 "Hourglass response",
                 "auto",
                 hourglass_words(),
                 "With the treatment 'assumed strain': how the normal "
                 "strains follow a motion that bends the cell.");
    parameters.declare(
      "Hourglass control",
      "auto",
      admissible::non_negative_number("0.2").or_word("auto"),
      "chi, dimensionless: viscous resistance chi c m / h to motions of a "
      "cell that averaged strain does not see (m its mass, c the wave "
      "speed) and that differs among neighbouring cells, as smooth motion "
      "does not; 'auto' is 0.2 where averages leave such motions without "
      "resistance, else 0.");
    parameters.renamed("Chequerboard control", "Checkerboard control");
    parameters.declare(
      "Checkerboard control",
      "auto",
      admissible::non_negative_number("0.5").or_word("auto"),
      "Dimensionless: rate, times h / c, at which a pressure per cell that "
      "alternates from cell to cell (checkerboard), and so moves nothing, is "
      "evened out without a change of volume; 'auto' is 0.5 for liquids "
      "with averages, else 0. In semi-implicit steps the share of the compact Laplacian in "
      "the equations of the pressure; 'auto' is 0.1.");
    parameters.declare(
      "Particle shifting",
      "auto",
      admissible::non_negative_number("2").or_word("auto"),
      "C, dimensionless: points of a liquid that have gathered move apart by "
      "C s h^2 times the gradient of what nodes hold beyond their room, and "
      "towards free surfaces where that is even, each time the fastest point "
      "has moved by s cells, and what cells hold evens out; 'auto' is 2 for "
      "liquids with 'cell' and linear functions, or 'cell' or 'node' and "
      "quadratic ones, and 0 for all others.");
    parameters.declare(
      "Density control",
      "auto",
      admissible::number_from_to(0, 1, "0.2").or_word("auto"),
      "Dimensionless: of what nodes hold beyond the room around them (1.02 of "
      "it in semi-implicit steps), the share that is pushed apart while the "
      "fastest point moves by 0.4 cells; 'auto' is 0.2 for liquids "
      "that have their nodes for themselves (in semi-implicit steps: no solid "
      "in the scene) and do not fill the box (in semi-implicit steps: or have "
      "weight), else 0.");
    declare_word(parameters,
                 "History",
                 "auto",
                 volume_history_words(),
                 "With a treatment that averages the volumetric strain: what "
                 "happens to its scatter among the points of a cell.");
    declare_word(parameters,
                 "Deviatoric history",
                 "keep",
                 history_words(),
                 "With a treatment that averages shear strain, or all of the "
                 "deviatoric strain: the same for these components.");
    parameters.declare("Relaxation time",
                       "0",
                       admissible::non_negative_number("0.01"),
                       "Time constant tau, s, for histories that 'relax'.");
    parameters.declare("Split stretched points",
                       "false",
                       admissible::flag(),
                       "Whether points longer than 2/3 of a cell along some "
                       "direction become two, so that a solid that is "
                       "stretched far does not come apart on the grid "
                       "(numerical fracture).");
  }



  namespace
  {
    /**
     * Whether a treatment leaves hourglass (zero-energy) modes: all of them
     * where every strain is averaged, or where what is not averaged has no
     * stiffness at rest (fluids); in 3d also the torsion of a cell where shear
     * is averaged.
     */
    template <int dim>
    bool
    needs_hourglass_control(const Treatment treatment, const bool fluid)
    {
      const TreatmentRow &row = treatment_of(treatment);
      if (treatment == Treatment::none)
        return false;
      return fluid || (dim == 2 ? row.weak_in_2d : row.weak_in_3d);
    }



    /**
     * Ratio of bulk to shear modulus (Poisson's ratio 0.475) up to which
     * splines need no locking treatment; from there on 'auto' takes means
     * around nodes, which make softer solids too soft.
     */
    constexpr double large_moduli_ratio = 20;



    /** Level of the coarsest cells that a body may have at the start. */
    template <int dim>
    unsigned int
    coarsest_level(const Body<dim> &body, const GridDescription<dim> &grid)
    {
      const Corners<dim> of_body = body.shape->bounding_box();
      unsigned int       result  = 0;
      for (const Refinement<dim> &refinement : grid.refinements)
        {
          const auto &names = refinement.bodies;
          bool        covers =
            refinement.where.empty() &&
            (refinement.criterion == RefinementCriterion::region ||
             (refinement.criterion == RefinementCriterion::body &&
              std::find(names.begin(), names.end(), body.name) != names.end()));
          for (unsigned int d = 0; d < dim; ++d)
            covers = covers && refinement.box.first[d] <= of_body.first[d] &&
                     of_body.second[d] <= refinement.box.second[d];
          if (covers)
            result = std::max(result, refinement.level);
        }
      return result;
    }



    /** Cells across the box around a body, where it is thinnest. */
    template <int dim>
    double
    cells_across(const Body<dim> &body, const GridDescription<dim> &grid)
    {
      const Corners<dim> box    = body.shape->bounding_box();
      double             result = std::numeric_limits<double>::max();
      for (unsigned int d = 0; d < dim; ++d)
        result =
          std::min(result, (box.second[d] - box.first[d]) / grid.edge(d));
      return result * (1u << coarsest_level(body, grid));
    }



    /** The longest edge of a cell over the shortest. */
    template <int dim>
    double
    aspect_ratio(const GridDescription<dim> &grid)
    {
      double shortest = grid.edge(0), longest = grid.edge(0);
      for (unsigned int d = 1; d < dim; ++d)
        {
          shortest = std::min(shortest, grid.edge(d));
          longest  = std::max(longest, grid.edge(d));
        }
      return longest / shortest;
    }



    /** Notes that a slender plastic body of few cells is too stiff below its
     * yield stress, by 0.45 over the square of the cells across. */
    template <int dim>
    void
    note_stiff_bending(const Body<dim> &body, Problem<dim> &problem)
    {
      const double across = cells_across(body, problem.grid);
      if (!body.is_plastic || !body.keeps_surface || across > 4 ||
          body.treatment != Treatment::assumed_strain)
        return;
      problem.notes.push_back(
        "Body " + in_quotes(body.name) + ": with " + brief(across) +
        " cells across it bends about " +
        brief(std::min(50., std::round(45 / (across * across)))) +
        " % too little below its yield stress. More cells help; 'Hourglass "
        "response = bending' bends as it should until it yields, and hardens "
        "afterwards.");
    }



    /** Locking treatment of the word 'auto'; says in the log what and why. */
    template <int dim>
    Treatment
    automatic_treatment(const Body<dim> &body,
                        const bool       fluid,
                        Problem<dim>    &problem)
    {
      const bool   linear = problem.grid.kernel == KernelKind::linear;
      const Moduli moduli = moduli_of(body.law, body.material);
      const bool   soft   = moduli.bulk <= large_moduli_ratio * moduli.shear;
      const bool   newton = is_solved_by_newton(problem.method.integration);
      // The mean volume of a cell says nothing of the pressure of a bent one:
      // bodies one square cell thick bend by two thirds too much, on cells four
      // times as long by a fifth too little. In three dimensions 'cell' is
      // nearer with two cells already (doc/theory/initial_frame.md).
      constexpr double fewest_cells         = dim == 2 ? 2.9 : 1.5;
      constexpr double largest_aspect_ratio = 1.25;
      const bool       few = cells_across(body, problem.grid) < fewest_cells;
      // equations with 'cell' are solved with any number of flat cells
      const bool bends =
        few || (!(newton && dim == 3) &&
                aspect_ratio(problem.grid) > largest_aspect_ratio);
      struct Choice
      {
        Treatment   kind;
        const char *reason;
      };
      const Choice choice =
        fluid ?
          Choice{Treatment::cell,
                 "'cell', as a liquid resists volume changes only."} :
        !soft && linear && bends ?
          Choice{Treatment::assumed_strain,
                 "'assumed strain', as bodies of few or flat cells bend far "
                 "too easily, or not enough, with 'cell'."} :
        !soft && linear && newton ?
          Choice{Treatment::cell,
                 "'cell', which does not lock in volume, and whose pressures "
                 "are solved for as well where the system is large."} :
        !linear && soft ?
          Choice{Treatment::none,
                 "'none', as smooth functions do not lock at this "
                 "Poisson's ratio."} :
        !soft && !linear && body.frame == Frame::initial &&
            cells_across(body, problem.grid) < 1.5 ?
          Choice{Treatment::none,
                 "'none', as a body one cell thick bends far too easily with "
                 "'cell'."} :
        !soft && body.frame == Frame::initial ?
          Choice{Treatment::cell,
                 "'cell', which does not lock in volume, and nothing "
                 "crosses cells."} :
        !linear ? Choice{Treatment::node,
                         "'node', which does not lock in volume and does not "
                         "jump where points cross cells."} :
                  Choice{Treatment::assumed_strain,
                         "'assumed strain', which neither locks in volume nor "
                         "in bending and leaves no motion of a cell without "
                         "resistance."};
      problem.notes.push_back("Body " + in_quotes(body.name) +
                              ": locking treatment 'auto' is " + choice.reason);
      return choice.kind;
    }



    /** A history other than 'keep' needs a mean that it tends to. */
    template <int dim>
    void
    check_histories(const Section   &section,
                    const bool       fluid,
                    const Body<dim> &body)
    {
      const auto refuse = [&](const std::string &entry,
                              const std::string &reason,
                              const std::string &remedy) {
        throw InputError("The history " + in_quotes(section.text(entry)) +
                         " in " + section.where(entry) + " " + reason +
                         ". Set " + remedy + ".");
      };
      const std::string treatment =
        "the locking treatment " + in_quotes(section.text("Locking treatment"));

      if (body.history != HistoryTreatment::keep)
        {
          if (body.treatment == Treatment::none)
            refuse("History",
                   "needs the mean of a cell, which " + treatment +
                     " does not form",
                   "'Locking treatment = cell' or 'History = keep'");
          if (averages_around_nodes(body.treatment))
            refuse("History",
                   "does not go with " + treatment +
                     ": means around nodes that replace histories spread "
                     "over the body",
                   "'History = keep'");
        }
      if (body.deviatoric_history != HistoryTreatment::keep)
        {
          if (fluid)
            refuse("Deviatoric history",
                   "is for solids: a fluid keeps no deviatoric strain",
                   "'Deviatoric history = keep'");
          if (!averages_shear_in_cells(body.treatment))
            refuse("Deviatoric history",
                   "needs the mean shear of a cell, which " + treatment +
                     " does not form",
                   "'Locking treatment = cell shear' or 'Deviatoric history = "
                   "keep'");
        }
    }



    template <int dim>
    void
    read_histories(const Section &section, const bool fluid, Body<dim> &body)
    {
      body.history = read_word(section, "History", volume_history_words());
      body.deviatoric_history =
        read_word(section, "Deviatoric history", history_words());
      body.relaxation_time         = section.number("Relaxation time");
      body.splits_stretched_points = section.flag("Split stretched points");

      const bool relaxes = body.history == HistoryTreatment::relax ||
                           body.deviatoric_history == HistoryTreatment::relax;
      if (relaxes && body.relaxation_time == 0)
        throw InputError("The history 'relax' has the relaxation time 0 in " +
                         section.where("Relaxation time") +
                         ". Usually the entry was forgotten. Give a time, for "
                         "instance 0.01, or use 'replace'.");
      if (!relaxes && body.relaxation_time > 0)
        throw InputError("The time " + section.text("Relaxation time") +
                         " in " + section.where("Relaxation time") +
                         " has no effect with the history " +
                         in_quotes(section.text("History")) +
                         ". Usually that was not changed along with it. Set "
                         "'History = relax'.");
      check_histories(section, fluid, body);
    }
  } // namespace



  template <int dim>
  void
  read_treatment(const Section &section, Body<dim> &body, Problem<dim> &problem)
  {
    const bool fluid = body.is_liquid;
    body.treatment   = read_word(section, "Locking treatment", locking_words());
    if (body.treatment == Treatment::automatic)
      body.treatment = automatic_treatment(body, fluid, problem);
    body.hourglass =
      read_word(section, "Hourglass response", hourglass_words());
    // With elastic coefficients hourglass forces would keep growing, like
    // hardening, while the material flows plastically.
    if (body.hourglass == HourglassResponse::automatic)
      {
        body.hourglass = body.is_plastic ? HourglassResponse::incompressible :
                                           HourglassResponse::bending;
        note_stiff_bending(body, problem);
      }
    body.hourglass_control =
      section.text("Hourglass control") != "auto" ?
        section.number("Hourglass control") :
      problem.grid.kernel == KernelKind::linear &&
          needs_hourglass_control<dim>(body.treatment, fluid) ?
        0.2 :
        0;
    if (body.hourglass_control > 0 && body.treatment == Treatment::none)
      throw InputError(
        "The hourglass control " + section.text("Hourglass control") + " in " +
        section.where("Hourglass control") +
        " has nothing to control with the locking treatment 'none', which "
        "averages nothing. Set 'Hourglass control = 0', or another 'Locking "
        "treatment'.");
    body.checkerboard_control =
      section.text("Checkerboard control") != "auto" ?
        section.number("Checkerboard control") :
      fluid && averages_volume_in_cells(body.treatment) ? 0.5 :
                                                          0;
    if (body.checkerboard_control > 0 &&
        !averages_volume_in_cells(body.treatment))
      throw InputError(
        "The checkerboard control " + section.text("Checkerboard control") +
        " in " + section.where("Checkerboard control") +
        " has nothing to control with the locking treatment " +
        in_quotes(section.text("Locking treatment")) +
        ", which has no single pressure per cell. Set 'Checkerboard control "
        "= 0', or 'Locking treatment = cell'.");
    read_histories(section, fluid, body);
  }



  template void
  read_treatment(const Section &, Body<2> &, Problem<2> &);
  template void
  read_treatment(const Section &, Body<3> &, Problem<3> &);
} // namespace limber
