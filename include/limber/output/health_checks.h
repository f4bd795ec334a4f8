// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_health_checks_h
#define limber_output_health_checks_h

#include <limber/base/text.h>
#include <limber/output/health.h>

#include <cmath>

/**
 * @file The checks behind the health report, by the names of their lines: of
 * energy and time (health_of_energy.cc), of creep (health_of_creep.cc), of
 * points, cells and bodies (health_of_points.cc).
 */
namespace limber
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



  inline std::string
  percent(const double share)
  {
    return brief(100 * share) + " %";
  }



  inline std::string
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



  HealthLine
  judge_unseen(const HealthFigures &figures, const HealthCheck &check);
  HealthLine
  judge_energy(const HealthFigures &figures, const HealthCheck &check);
  HealthLine
  judge_impacts(const HealthFigures &figures, const HealthCheck &check);
  HealthLine
  judge_put_back(const HealthFigures &figures, const HealthCheck &check);
  HealthLine
  judge_mass(const HealthFigures &figures, const HealthCheck &check);
  HealthLine
  judge_overlap(const HealthFigures &figures, const HealthCheck &check);
  HealthLine
  judge_crossings(const HealthFigures &figures, const HealthCheck &check);
  HealthLine
  judge_gaps(const HealthFigures &figures, const HealthCheck &check);
  HealthLine
  judge_points(const HealthFigures &figures, const HealthCheck &check);
  HealthLine
  judge_volume(const HealthFigures &figures, const HealthCheck &check);
  HealthLine
  judge_clumping(const HealthFigures &figures, const HealthCheck &check);
  HealthLine
  judge_obstacles(const HealthFigures &figures, const HealthCheck &check);
  HealthLine
  judge_dissipation(const HealthFigures &figures, const HealthCheck &check);
  HealthLine
  judge_steps(const HealthFigures &figures, const HealthCheck &check);
  HealthLine
  judge_transfer(const HealthFigures &figures, const HealthCheck &check);
  HealthLine
  judge_rotation(const HealthFigures &figures, const HealthCheck &check);
} // namespace limber

#endif
