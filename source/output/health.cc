// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/output/health_checks.h>

#include <algorithm>

namespace limber
{
  namespace
  {
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
    // transfer   Impacts of elastic bodies lose up to 5 % with fmpm.
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
      {"transfer", 0.1, 0.5, judge_transfer},
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
        if (check.judge == judge_transfer && !figures.is_smoothed)
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
