// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/numbers.h>

#include <limber/output/health_checks.h>

#include <algorithm>

namespace limber
{
  namespace
  {
    // Unseen motion below this share of the energy scale of the run does not
    // affect its result: for instance the last motion of a body that has come
    // to rest.
    constexpr double negligible = 0.01;
  } // namespace



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
                brief(figures.drift * figures.inner_scale) + " J, " +
                percent(figures.drift) + " of the largest inner energy, " +
                brief(figures.inner_scale) + " J";
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
        (figures.contact > 0 ?
           ", " + brief(figures.contact) + " J where bodies or sides are hit" :
           "") +
        (figures.adaptation != 0 ? ", " + brief(figures.adaptation) +
                                     " J where points were joined or divided" :
                                   "");
    line.entry = figures.step_entry;
    return line;
  }



  namespace
  {
    // Bounds for energy created in contact: scenes with a reference have up to
    // 0.4 %.
    constexpr HealthCheck created_bounds{"impacts", 0.005, 0.02, nullptr};
  } // namespace



  // Energy that elastic solids lose in contact is an error, as is energy that
  // any solid gains; liquids that land on a floor, and plastic flow, lose it
  // physically. Where nothing can be hit the loss is at a clamp, which stops
  // what runs against it in each step.
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
    const bool   counts  = created ? is_solid : is_elastic;
    if (counts && figures.inner_scale > 0)
      line.value = lost / figures.inner_scale;
    line.verdict =
      created ? created_bounds.verdict(line.value) : check.verdict(line.value);
    line.text =
      counts ?
        percent(std::abs(line.value)) + " of the energy scale was " +
          (created ? "created where bodies " : "lost where elastic bodies ") +
          (figures.may_hit ? "hit each other, obstacles or sides" :
                             "are held by sides") :
        "no elastic bodies that may lose energy in impacts";
    if (line.verdict == Verdict::good)
      return line;
    if (!created && !figures.may_hit)
      {
        line.entry = figures.step_entry;
        line.text +=
          std::string(", as these stop in each step what moves at them: ") +
          (figures.has_levels ?
             "cells that stay as they are lose less, as do shorter steps" :
             "shorter steps lose less; in 'Frame = initial', for a body that "
             "is alone, nothing is lost");
        return line;
      }
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
        std::string(crosses_cells ? ", or a smaller 'Courant number'" : "") +
        // what chatters as it slides is no impact, and finer cells chatter more
        (figures.friction > figures.contact ?
           "; where bodies slide, a 'Blend time' that damps their chatter" :
           "");
    return line;
  }



  namespace
  {
    // Of weight times depth: energy of low waves, which is the least scale of
    // the loss of a liquid, as one at rest has hardly any energy of its own.
    // A wave from wall to wall with the amplitude a in a depth d has (a/d)^2
    // / 6, so one of d / 25 that dies is still told. Water at rest on slopes
    // lost 1e-6 to 1.6e-4 in four seconds, and where it came to move, or
    // stirred itself, 1e-3 to 2e-2.
    constexpr double low_waves = 2e-3;
  } // namespace



  // Liquids without sound (semi-implicit steps) lose energy in impacts, where
  // otherwise sound would carry it away, and at a surface some in short
  // waves. Energy that volume corrections gave to points ends there as well,
  // and is no loss.
  HealthLine
  judge_dissipation(const HealthFigures &figures, const HealthCheck &check)
  {
    const double lost = figures.lost_by_steps + std::min(0., figures.history);
    double       of_waves = 0;
    for (const BodyFigures &body : figures.bodies)
      of_waves += low_waves * body.potential;
    const double scale = std::max(figures.energy_scale, of_waves);
    HealthLine   line;
    line.value   = scale > 0 ? std::abs(lost) / scale : 0;
    line.verdict = check.verdict(line.value);
    line.text    = percent(line.value) + " of " +
                (figures.energy_scale < of_waves ?
                   "the energy of low waves, " + brief(of_waves) + " J," :
                   std::string("the largest energy")) +
                " was " + (lost < 0 ? "created" : "lost") +
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



  // What turns loses some of its angular momentum in each filtered step, and
  // the more in a time the shorter steps are.
  HealthLine
  judge_transfer(const HealthFigures &figures, const HealthCheck &check)
  {
    HealthLine line;
    line.value   = figures.energy_scale > 0 ?
                     std::max(0., figures.transfer) / figures.energy_scale :
                     0;
    line.verdict = check.verdict(line.value);
    line.text    = percent(line.value) +
                " of the largest energy was removed by the transfer between "
                "points and grid";
    if (line.verdict != Verdict::good)
      line.text +=
        ", from what turns and from short waves. " +
        (figures.takes_apic ?
           "'Transfer = apic'" + figures.with_apic + ", or 'Frame = initial'," :
           std::string("'Frame = initial'")) +
        " keeps rotation, a longer 'Transfer period' loses less, shorter steps "
        "lose more";
    line.entry = "Method/Transfer";
    return line;
  }
} // namespace limber
