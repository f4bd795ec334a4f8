// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/numbers.h>

#include <limber/base/text.h>
#include <limber/output/health.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace limber
{
  namespace
  {
    struct HealthCheck;
    using Judge = HealthLine (*)(const HealthFigures &, const HealthCheck &);

    /**
     * A line of the table: up to which size a value is good, or not yet bad.
     */
    struct HealthCheck
    {
      const char *name;
      double      look, bad;
      Judge       judge;

      Verdict
      verdict(const double value) const
      {
        if (!(std::abs(value) <= bad)) // bad for NaN as well
          return Verdict::bad;
        return std::abs(value) <= look ? Verdict::good : Verdict::look;
      }
    };



    std::string
    percent(const double share)
    {
      return brief(100 * share) + " %";
    }



    std::string
    of_body(const BodyFigures &body, const std::string &entry)
    {
      return "Body " + body.name + "/" + entry;
    }



    /** The body for which @p value is largest in size; there is one. */
    template <class Value>
    const BodyFigures &
    worst(const HealthFigures &figures, const Value &value)
    {
      const BodyFigures *found = &figures.bodies.front();
      for (const BodyFigures &body : figures.bodies)
        if (!(std::abs(value(body)) <= std::abs(value(*found))))
          found = &body;
      return *found;
    }



    // Unseen motion below this share of the energy scale of the run does not
    // affect its result: for instance the last motion of a body that has come
    // to rest.
    constexpr double negligible = 0.01;



    HealthLine
    judge_unseen(const HealthFigures &figures, const HealthCheck &check)
    {
      const auto energy = [](const BodyFigures &b) { return b.unseen_energy; };
      double     all    = 0;
      for (const BodyFigures &body : figures.bodies)
        all += body.unseen_energy;
      HealthLine line;
      line.value = figures.kinetic > 0 ? all / figures.kinetic : all;
      line.text  = brief(all) + " J of " + brief(figures.kinetic) +
                  " J kinetic energy are motion of points against each other "
                  "that the nodes do not see (null space)";
      line.entry = "Method/Blend time";
      if (all <= negligible * figures.energy_scale)
        return line;
      line.verdict = check.verdict(line.value);
      if (line.verdict != Verdict::good)
        line.text += ", most in body '" + worst(figures, energy).name +
                     "'; set 'Blend time' to the shortest time of interest, as "
                     "that of an impact";
      return line;
    }



    HealthLine
    judge_energy(const HealthFigures &figures, const HealthCheck &check)
    {
      HealthLine line;
      line.value   = figures.drift;
      line.verdict = check.verdict(line.value);
      line.text    = "the balance of energy leaves " +
                  brief(figures.drift * figures.energy_scale) + " J, " +
                  percent(figures.drift) + " of the largest energy, " +
                  brief(figures.energy_scale) + " J";
      if (line.verdict != Verdict::good)
        line.text +=
          "; on record are " + brief(figures.loads) + " J from loads, " +
          brief(figures.sides) +
          " J from sides and obstacles, and as taken out " +
          brief(figures.viscous - figures.lost_by_steps) +
          " J by viscosity and damping, " +
          (figures.is_semi_implicit ?
             brief(figures.lost_by_steps) + " J by semi-implicit steps, " :
             "") +
          brief(figures.transfer) + " J by the transfer, " +
          brief(figures.history) + " J with histories" +
          (figures.plastic > 0 ?
             ", " + brief(figures.plastic) + " J by plastic flow" :
             "") +
          (figures.friction > 0 ?
             ", " + brief(figures.friction) + " J by friction" :
             "") +
          (figures.contact > 0 ? ", " + brief(figures.contact) +
                                   " J where bodies or sides are hit" :
                                 "") +
          (figures.adaptation != 0 ?
             ", " + brief(figures.adaptation) +
               " J where points were joined or divided" :
             "");
      line.entry = figures.step_entry;
      return line;
    }



    // Bounds for energy created in contact: scenes with a reference have up to
    // 0.4 %.
    constexpr HealthCheck created_bounds{"impacts", 0.005, 0.02, nullptr};



    // Energy that elastic solids lose in contact is an error, as is energy that
    // any solid gains; liquids that land on a floor, and plastic flow, lose it
    // physically. Where nothing can be hit the loss is at a clamp, of a body
    // whose points cross cells (creep), which has a line of its own.
    HealthLine
    judge_impacts(const HealthFigures &figures, const HealthCheck &check)
    {
      bool is_solid = true, is_elastic = true, crosses_cells = false;
      for (const BodyFigures &body : figures.bodies)
        {
          crosses_cells |= !body.stays_in_cells;
          is_solid &= !body.is_liquid;
          is_elastic &= !body.is_liquid && !body.is_plastic;
        }
      HealthLine line;
      line.entry = "Grid/Cells";
      // where something creeps within the friction, heat and loss are two
      // shares of nothing
      const double lost    = figures.contact < 0 ?
                               std::min(0., figures.contact + figures.friction) :
                               figures.contact;
      const bool   created = lost < 0;
      const bool counts = figures.may_hit && (created ? is_solid : is_elastic);
      if (counts && figures.energy_scale > 0)
        line.value = lost / figures.energy_scale;
      line.verdict = created ? created_bounds.verdict(line.value) :
                               check.verdict(line.value);
      line.text =
        counts ?
          percent(std::abs(line.value)) + " of the energy scale was " +
            (created ? "created where bodies" : "lost where elastic bodies") +
            " hit each other, obstacles or sides" :
          "no elastic bodies that may hit something";
      if (line.verdict == Verdict::good)
        return line;
      const bool is_uneven =
        std::any_of(figures.bodies.begin(),
                    figures.bodies.end(),
                    [](const BodyFigures &body) { return !body.is_cut; });
      if (created)
        line.text += std::string(", and contact should create none. Take "
                                 "smaller cells") +
                     (is_uneven ? ", or 'Placement = cut'" : "") +
                     "; smaller steps do not help";
      else
        line.text +=
          ": each impact loses that of a layer up to one cell thick. Take "
          "smaller cells" +
          std::string(crosses_cells ? ", or a smaller 'Courant number'" : "");
      return line;
    }



    HealthLine
    judge_put_back(const HealthFigures &figures, const HealthCheck &check)
    {
      HealthLine line;
      line.value   = figures.points > 0 ? figures.put_back / figures.points : 0;
      line.verdict = check.verdict(line.value);
      line.text    = figures.put_back > 0 ?
                       "points were put back " + brief(figures.put_back) +
                      " times that had gone beyond closed sides, by " +
                      brief(figures.put_back_way / figures.put_back) +
                      " cells on average" :
                       "no point went beyond a closed side";
      if (line.verdict != Verdict::good)
        line.text += ": nodes of hardly any mass at the side move too fast; "
                     "take shorter steps";
      line.entry = figures.step_entry;
      return line;
    }



    HealthLine
    judge_mass(const HealthFigures &figures, const HealthCheck &check)
    {
      const auto error = [](const BodyFigures &b) {
        return b.shape_volume > 0 ? b.volume / b.shape_volume - 1 : 0;
      };
      const BodyFigures &body = worst(figures, error);
      HealthLine         line;
      line.value   = error(body);
      line.verdict = check.verdict(line.value);
      line.text    = "the points of body '" + body.name + "' fill " +
                  percent(1 + line.value) + " of its shape";
      line.entry =
        of_body(body, body.is_cut ? "Points per cell edge" : "Placement");
      if (line.verdict != Verdict::good)
        line.text += body.is_cut ?
                       ": it is too thin for the parts of cells that points "
                       "stand for; take more points per cell edge" :
                       ", and so of its mass and load: places in cells are in "
                       "or out as a whole; set 'cut', or 'fitted' for a box "
                       "or block";
      return line;
    }



    HealthLine
    judge_overlap(const HealthFigures &figures, const HealthCheck &check)
    {
      const BodyFigures &body =
        worst(figures, [](const BodyFigures &b) { return b.overlap; });
      HealthLine line;
      line.value   = body.overlap;
      line.verdict = check.verdict(line.value);
      line.entry   = of_body(body, "Shape");
      line.text    = body.overlap > 0 ?
                       percent(body.overlap) + " of body '" + body.name +
                      "' lay in body '" + body.overlaps_with +
                      "' at the start, around (" + body.overlap_place +
                      "): there are two masses in one place" :
                       "no body lay in another one at the start";
      return line;
    }



    /**
     * By which share linear functions soften a bar under tension when its
     * points enter their first cells: cells then hold different numbers of
     * them, and those with few stretch. Bars of 12 to 48 cells in tension with
     * 2, 3 and 4 points along an edge stretched by 75, 30 and 20 % more per
     * cell entered; under pressure, where points go back, by some per cent. In
     * bending it cancels.
     */
    double
    softening_in_tension(const BodyFigures &body)
    {
      constexpr double tension_alone = 0.9; // share of the strain energy
      return body.kernel == KernelKind::linear &&
                 body.share_in_tension > tension_alone ?
               3. / (body.points_per_edge * body.points_per_edge) *
                 std::min(1., body.crossings) * body.elastic_share :
               0;
    }



    /** Estimated creep as a share of the strain, plastic and elastic. */
    double
    expected_creep(const BodyFigures &body)
    {
      return body.is_liquid ?
               0 :
               std::max(softening_in_tension(body),
                        creep_per_crossing(body) * body.crossings_under_strain *
                          body.elastic_share);
    }



    struct Remedy
    {
      std::string entry, text;
    };



    Remedy
    remedy_for_creep(const BodyFigures &body, const HealthFigures &figures)
    {
      const std::string frame =
        body.is_plastic ? "" :
                          "; in 'Frame = initial', for a body that is alone, "
                          "nothing creeps";
      if (body.kernel == KernelKind::linear && !figures.against_splines.empty())
        return {of_body(body, "Points per cell edge"),
                std::string("More points per cell edge creep somewhat less") +
                  (figures.knows_domains ? ", 'Kernel = cpdi' by far less" :
                                           "") +
                  "; 'quadratic' is not possible, as " +
                  figures.against_splines + frame};
      if (body.kernel == KernelKind::linear)
        return {body.is_plastic ? "Method/Kernel" : of_body(body, "Frame"),
                "'Method/Kernel = quadratic' with three points per cell edge "
                "creeps less by far" +
                  frame};
      if (body.points_per_edge >= 3 && body.kernel == KernelKind::quadratic)
        return {"Method/Kernel", "'Method/Kernel = cubic' creeps less" + frame};
      return {of_body(body, "Points per cell edge"),
              (body.points_per_edge < 3 ? "Three" : "More") +
                std::string(" points per cell edge creep less")};
    }



    // Creep needs strain. Of a plastic body most energy is dissipated, so that
    // is subtracted from the scale.
    bool
    is_strained(const BodyFigures &body, const HealthFigures &figures)
    {
      constexpr double rigid = 1e-3;
      return !(body.strain_energy <=
               rigid * (figures.energy_scale - figures.plastic));
    }



    // In metal under tension creep is plastic flow: its work is accounted for,
    // so no energy is missing. What flows without end keeps no strain that
    // would creep.
    bool
    flows_in_tension(const BodyFigures &body)
    {
      return body.is_plastic && body.keeps_surface &&
             body.share_in_tension > 0.5;
    }



    HealthLine
    judge_crossings(const HealthFigures &figures, const HealthCheck &check)
    {
      const auto creep = [&](const BodyFigures &body) {
        return is_strained(body, figures) ? expected_creep(body) : 0;
      };
      const BodyFigures &body = worst(figures, creep);
      HealthLine         line;
      line.value   = creep(body);
      line.verdict = check.verdict(line.value);
      // Creep takes work of loads, which is missing from the energy balance or
      // lost at the sides that hold the body; if both are right the creep is
      // harmless, as in oscillations about zero, where it cancels.
      constexpr double balance_holds = 0.01;
      const bool       softens       = line.value <= softening_in_tension(body);
      if (line.verdict == Verdict::bad && !flows_in_tension(body) && !softens &&
          std::abs(figures.drift) <= balance_holds &&
          figures.contact <= balance_holds * figures.energy_scale)
        line.verdict = Verdict::look;
      const Remedy remedy = remedy_for_creep(body, figures);
      line.entry          = remedy.entry;
      line.text           = "a point of body '" + body.name + "' has entered " +
                  brief(body.crossings) + " cells on average, " +
                  brief(body.crossings_under_strain) +
                  " where it is strained, at most " +
                  brief(body.most_crossings);
      if (line.verdict != Verdict::good)
        line.text +=
          (softens ? "; under tension this adds about " + percent(line.value) +
                       " to its strain. " :
                     "; each makes about " + percent(creep_per_crossing(body)) +
                       " of the strain permanent. ") +
          remedy.text;
      return line;
    }



    /** Cells that have lost all points (numerical fracture), as a share of the
     * occupied cells. */
    double
    share_of_gaps(const BodyFigures &body)
    {
      const double opened = double(body.gaps) - double(body.gaps_at_start);
      return body.is_liquid || body.cells == 0 ?
               0 :
               std::max(0., opened) / body.cells;
    }



    HealthLine
    judge_gaps(const HealthFigures &figures, const HealthCheck &check)
    {
      const BodyFigures &body = worst(figures, share_of_gaps);
      HealthLine         line;
      line.value   = share_of_gaps(body);
      line.verdict = check.verdict(line.value);
      line.entry =
        of_body(body,
                body.is_plastic || body.is_split ? "Points per cell edge" :
                                                   "Split stretched points");
      line.text =
        line.value > 0 ?
          "body '" + body.name + "' has come apart on the grid: " +
            std::to_string(body.gaps - body.gaps_at_start) +
            " empty cells have opened between its " +
            std::to_string(body.cells) +
            ". Points that stand further apart than a cell do not hold "
            "together" :
          "no cell within a solid has lost its points";
      return line;
    }



    double
    share_of_single(const BodyFigures &body)
    {
      return body.inner_cells == 0 ?
               0 :
               double(body.single_cells) / body.inner_cells;
    }



    HealthLine
    judge_points(const HealthFigures &figures, const HealthCheck &check)
    {
      const BodyFigures &body = worst(figures, share_of_single);
      HealthLine         line;
      line.value   = share_of_single(body);
      line.verdict = check.verdict(line.value);
      line.text    = std::to_string(body.single_cells) + " of " +
                  std::to_string(body.inner_cells) + " inner cells of body '" +
                  body.name + "' hold one point alone";

      const BodyFigures &smallest =
        *std::min_element(figures.bodies.begin(),
                          figures.bodies.end(),
                          [](const BodyFigures &a, const BodyFigures &b) {
                            return a.points < b.points;
                          });
      // A body of four points across hardly resolves more than its rigid
      // motion.
      const unsigned long few = figures.dim == 2 ? 16 : 64;
      if (line.verdict == Verdict::good && smallest.points < few)
        {
          line.verdict = Verdict::look;
          line.text    = "body '" + smallest.name + "' has only " +
                      std::to_string(smallest.points) +
                      " points, too few for more than its motion as a whole";
          line.entry = of_body(smallest, "Points per cell edge");
        }
      else
        line.entry = of_body(body, "Points per cell edge");
      return line;
    }



    /** Largest |log J| of the points of a body. */
    double
    change_of_volume(const BodyFigures &body)
    {
      if (!(body.smallest_volume > 0))
        return std::numeric_limits<double>::infinity();
      return std::max(-std::log(body.smallest_volume),
                      std::log(body.largest_volume));
    }



    HealthLine
    judge_volume(const HealthFigures &figures, const HealthCheck &check)
    {
      const BodyFigures &body = worst(figures, change_of_volume);
      HealthLine         line;
      line.value   = change_of_volume(body);
      line.verdict = check.verdict(line.value);
      line.text    = "the points of body '" + body.name + "' have " +
                  brief(body.smallest_volume) + " to " +
                  brief(body.largest_volume) + " times their first volume";
      line.entry = "Grid/Cells";
      return line;
    }



    HealthLine
    judge_clumping(const HealthFigures &figures, const HealthCheck &check)
    {
      const BodyFigures &body = worst(figures, [](const BodyFigures &b) {
        return b.is_liquid ? b.filling : 0;
      });
      HealthLine         line;
      line.value           = std::max(0., body.filling - 1);
      line.verdict         = check.verdict(line.value);
      const bool may_shift = body.kernel == KernelKind::linear ||
                             body.kernel == KernelKind::quadratic;
      line.entry =
        may_shift ? of_body(body, "Particle shifting") : "Method/Kernel";
      line.text = "points in inner cells of liquid '" + body.name +
                  "' stand for " + brief(body.filling) + " times their volume";
      if (line.verdict != Verdict::good)
        line.text +=
          ": they clump, so that it takes less room than it should. " +
          std::string(!may_shift ?
                        "With 'linear' or 'quadratic' functions 'Particle "
                        "shifting' keeps the volume" :
                      figures.is_semi_implicit ?
                        "Three points per cell edge or smaller cells keep it "
                        "better" :
                      !body.is_shifted ?
                        "Set 'Particle shifting = auto' and 'Locking treatment "
                        "= cell'" :
                      body.kernel == KernelKind::linear ?
                        "Three points per cell edge, smaller cells or "
                        "'Time integration = semi-implicit' keep it better" :
                        "Three points per cell edge, smaller cells or "
                        "'Transfer = apic' keep it better");
      return line;
    }



    HealthLine
    judge_obstacles(const HealthFigures &figures, const HealthCheck &check)
    {
      const ObstacleFigures &deepest =
        *std::max_element(figures.obstacles.begin(),
                          figures.obstacles.end(),
                          [](const auto &a, const auto &b) {
                            return a.depth < b.depth;
                          });
      unsigned long inside = 0;
      for (const ObstacleFigures &obstacle : figures.obstacles)
        inside += obstacle.points_inside;
      HealthLine line;
      line.value   = deepest.depth;
      line.verdict = check.verdict(line.value);
      line.text    = inside > 0 ?
                       std::to_string(inside) +
                      " points are inside obstacles, the deepest by " +
                      brief(deepest.depth) + " of a cell in '" + deepest.name +
                      "'" :
                       "no point is inside an obstacle";
      if (figures.put_out > 0)
        line.text += "; " + brief(figures.put_out) +
                     " times points were put out onto a surface";
      line.entry = "Grid/Cells";
      return line;
    }



    // Liquids without sound (semi-implicit steps) lose energy in impacts, where
    // otherwise sound would carry it away, and at a surface some in short
    // waves. Energy that volume corrections gave to points ends there as well,
    // and is no loss.
    HealthLine
    judge_dissipation(const HealthFigures &figures, const HealthCheck &check)
    {
      const double lost = figures.lost_by_steps + std::min(0., figures.history);
      HealthLine   line;
      line.value =
        figures.energy_scale > 0 ? std::abs(lost) / figures.energy_scale : 0;
      line.verdict = check.verdict(line.value);
      line.text    = percent(line.value) + " of the largest energy was " +
                  (lost < 0 ? "created" : "lost") +
                  " by semi-implicit steps, not by viscosity";
      const bool has_liquids =
        std::any_of(figures.bodies.begin(),
                    figures.bodies.end(),
                    [](const auto &body) { return body.is_liquid; });
      if (line.verdict != Verdict::good)
        line.text += lost < 0 ?
                       ", as points spread anew again and again. More points "
                       "per cell edge or smaller cells create less" :
                       std::string(": where ") +
                         (has_liquids ? "liquids" : "bodies") +
                         " hit something, or in short waves. Smaller cells "
                         "lose less";
      line.entry = "Grid/Cells";
      return line;
    }



    // In a vibration whose phase advances by a in a step, the change of
    // velocity is 2 sin(a/2) times its amplitude. The trapezoidal rule has
    // tan(a/2) where half the exact phase should be.
    HealthLine
    judge_steps(const HealthFigures &figures, const HealthCheck &check)
    {
      HealthLine   line;
      const double ratio =
        figures.kinetic_action > 0 ?
          std::sqrt(figures.action_of_changes / figures.kinetic_action) :
          0;
      const double half = std::asin(std::min(1., ratio / 2)); // of the phase
      line.value        = half > 0 ? 1 - half / std::tan(half) : 0;
      line.verdict      = check.verdict(line.value);
      line.entry        = figures.step_entry;
      line.text         = half > 0 ? "a period of the motion has " +
                               brief(dealii::numbers::PI / half) +
                               " steps (mean, weighted by kinetic energy)" :
                                     "the motion is steady";
      if (line.verdict != Verdict::good)
        line.text += ", so frequencies are about " + percent(line.value) +
                     " too low and shorter waves are damped. Twenty keep them "
                     "to 1 %";
      return line;
    }



    HealthLine
    judge_rotation(const HealthFigures &figures, const HealthCheck &check)
    {
      const BodyFigures &body =
        worst(figures, [](const BodyFigures &one) { return one.rotation; });
      HealthLine line;
      line.value   = body.rotation;
      line.verdict = check.verdict(line.value);
      line.entry   = of_body(body, "Material");
      line.text    = "the points of body '" + body.name + "' have turned by " +
                  brief(body.rotation) + " rad (rms)";
      if (line.verdict != Verdict::good)
        line.text += ", which in 'linear elastic' is a strain of about " +
                     percent(0.5 * body.rotation * body.rotation) +
                     ". Set 'Material = neo hookean'";
      return line;
    }



    // The one list of checks, in the order of their lines. Bounds:
    // unseen     A tenth of the energy is a twentieth of the speed; above three
    //            tenths, energies and heights are dominated by noise.
    // energy     Scenes with a reference keep 1 %; above 5 % amplitudes and
    //            deflections have errors of that size.
    // impacts    Elastic scenes with a reference lose up to 3 %; bounds for
    //            energy that is created: see created_bounds.
    // put back   Scenes with a reference have none.
    // mass       A frequency has half of this error; with 'cut' it is < 1 %.
    // overlap    Rounding of surfaces to whole parts of cells is some 0.1 %.
    // crossings  Error of deflections, see creep_per_crossing().
    // gaps       One cell in a hundred may be a crack that is meant.
    // points     The gradient from one point alone has no rotation.
    // volume     Laws are measured for ratios of about 1/3 to 3; e^2.3 = 10.
    // clumping   Error of the level of a liquid; scenes with a reference have
    //            up to 2 %.
    // dissipation Dam breaks lose 1 to 4 %, a drop that falls flat 14 %.
    // steps      Error of a frequency, as for the other errors.
    // rotation   Small-strain laws take its square for twice a strain.
    // obstacles  Flow past a convex surface cuts its corners by less; points
    //            half a cell inside have gone through the surface.
    constexpr HealthCheck checks[] = {
      {"unseen", 0.1, 0.3, judge_unseen},
      {"energy", 0.01, 0.05, judge_energy},
      {"impacts", 0.03, 0.1, judge_impacts},
      {"put back", 0.001, 0.1, judge_put_back},
      {"mass", 0.02, 0.05, judge_mass},
      {"overlap", 0.005, 0.05, judge_overlap},
      {"crossings", 0.02, 0.1, judge_crossings},
      {"gaps", 0.01, 0.05, judge_gaps},
      {"points", 0.1, 0.5, judge_points},
      {"volume", 1.1, 2.3, judge_volume},
      {"clumping", 0.03, 0.1, judge_clumping},
      {"dissipation", 0.1, 0.5, judge_dissipation},
      {"steps", 0.02, 0.1, judge_steps},
      {"rotation", 0.1, 0.3, judge_rotation},
      {"obstacles", 0.1, 0.5, judge_obstacles},
    };
  } // namespace



  const char *
  name_of(const Verdict verdict)
  {
    switch (verdict)
      {
        case Verdict::good:
          return "good";
        case Verdict::look:
          return "look";
        case Verdict::bad:
          return "bad";
      }
    return "";
  }



  double
  creep_per_crossing(const BodyFigures &body)
  {
    // From the bar of tests/unit/time/creep.cc: 1e-5 with any stress update;
    // bars at 45 degrees creep more, see creep.prm of prm/studies.
    if (body.kernel == KernelKind::cpdi || body.kernel == KernelKind::cpdi2)
      return body.points_per_edge < 3 ? 4e-4 : 2e-4;
    // Splines and boxes (GIMP): from prm/verification/slow_cantilever.prm, the
    // excess of the sag over that in the initial frame per cell crossing; with
    // boxes from the bar above where it creeps more, as it does if 3 x 3 boxes
    // follow the stretch.
    if (body.kernel == KernelKind::gimp)
      return body.points_per_edge < 3 ? 4.3e-3 : 1.1e-3;
    if (body.kernel == KernelKind::cpgimp)
      return body.points_per_edge < 3 ? 4.3e-3 : 2.8e-3;
    if (body.kernel == KernelKind::quadratic)
      return body.points_per_edge < 3 ? 4e-3 : 5e-4;
    // In the same scene 1e-4 and none; bars under tension creep more, see
    // creep.prm of prm/studies.
    if (body.kernel == KernelKind::cubic)
      return body.points_per_edge < 3 ? 5e-4 : 2e-4;
    // From the bar again. Bodies in bending are too soft from the start, which
    // is no creep.
    if (body.kernel == KernelKind::ddmp)
      return body.points_per_edge < 3 ? 1.2e-2 : 2.7e-3;
    // Linear functions: from tests/runs/health/slow_cantilever.prm with 2, 3
    // and 4 points along an edge, whose sag beyond 0.498 m is 1.5, 1.2 and 1.0
    // % per cell crossing. Bent strips that are merely carried through the grid
    // creep by half of that, bars under tension by 4 to 23 %.
    return 0.021 / std::sqrt(body.points_per_edge);
  }



  std::vector<HealthLine>
  judge(const HealthFigures &figures)
  {
    std::vector<HealthLine> lines;
    for (const HealthCheck &check : checks)
      {
        if (check.judge == judge_obstacles && figures.obstacles.empty())
          continue;
        if (check.judge == judge_rotation &&
            std::none_of(figures.bodies.begin(),
                         figures.bodies.end(),
                         [](const auto &body) { return body.stays_upright; }))
          continue;
        if (check.judge == judge_dissipation && !figures.is_semi_implicit)
          continue;
        if (check.judge == judge_steps && !figures.is_implicit)
          continue;
        if (check.judge == judge_clumping &&
            std::none_of(figures.bodies.begin(),
                         figures.bodies.end(),
                         [](const auto &body) { return body.is_liquid; }))
          continue;
        lines.push_back(check.judge(figures, check));
        lines.back().name = check.name;
      }
    return lines;
  }



  std::string
  health_text(const std::vector<HealthLine> &lines)
  {
    std::vector<std::string> good;
    std::string              rest;
    for (const HealthLine &line : lines)
      if (line.verdict == Verdict::good)
        good.push_back(line.name);
      else
        rest += "  health " + std::string(name_of(line.verdict)) + ": " +
                line.name + ": " + line.text + ". Entry: '" + line.entry +
                "'.\n";
    return (good.empty() ? "" : "  health good: " + join(good, ", ") + "\n") +
           rest;
  }
} // namespace limber
