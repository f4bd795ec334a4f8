// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/output/files.h>
#include <limber/output/json.h>
#include <limber/output/summary.h>

namespace limber
{
  namespace
  {
    json::Value
    check_to_json(const CheckResult &check)
    {
      return json::object({{"name", json::string(check.name)},
                           {"observable", json::string(check.observable)},
                           {"value", json::number(check.value)},
                           {"reference", json::number(check.reference)},
                           {"tolerance", json::number(check.tolerance)},
                           {"passed", json::boolean(check.passed)}});
    }



    json::Value
    health_to_json(const HealthLine &line)
    {
      return json::object({{"name", json::string(line.name)},
                           {"verdict", json::string(name_of(line.verdict))},
                           {"value", json::number(line.value)},
                           {"text", json::string(line.text)},
                           {"entry", json::string(line.entry)}});
    }
  } // namespace



  std::string
  to_json(const Summary &summary)
  {
    json::Members verbs, memory, adaptation;
    for (const auto &[name, value] : summary.adaptation)
      adaptation.emplace_back(name, json::number(value));
    for (const auto &[name, share] : summary.verbs)
      verbs.emplace_back(name, json::number(share));
    for (const auto &[name, share] : summary.memory)
      memory.emplace_back(name, json::number(share));
    std::vector<json::Value> checks, health, warnings;
    for (const CheckResult &check : summary.checks)
      checks.push_back(check_to_json(check));
    for (const HealthLine &line : summary.health)
      health.push_back(health_to_json(line));
    for (const std::string &warning : summary.warnings)
      warnings.push_back(json::string(warning));

    return json::object(
             {{"verdict", json::string(summary.verdict)},
              {"message", json::string(summary.message)},
              {"failure", json::string(summary.failure)},
              {"suspected", json::string(summary.suspected)},
              {"steps", json::integer(summary.steps)},
              {"points", json::integer(summary.points)},
              {"lost_points", json::integer(summary.lost_points)},
              {"points_put_back", json::integer(summary.put_back)},
              {"ranks", json::integer(summary.ranks)},
              {"end_time", json::number(summary.end_time)},
              {"wall_seconds", json::number(summary.wall_seconds)},
              {"cpu_seconds", json::number(summary.cpu_seconds)},
              {"ns_per_point_step", json::number(summary.ns_per_point_step)},
              {"memory_bytes", json::number(summary.memory_bytes)},
              {"bytes_per_point", json::number(summary.bytes_per_point)},
              {"energy_drift", json::number(summary.energy_drift)},
              {"momentum_error", json::number(summary.momentum_error)},
              {"verbs", json::object(verbs)},
              {"memory", json::object(memory)},
              {"adaptation", json::object(adaptation)},
              {"checks", json::array(checks)},
              {"health", json::array(health)},
              {"warnings", json::array(warnings)}})
             .text +
           "\n";
  }



  void
  write_summary(const std::string &folder, const Summary &summary)
  {
    write_whole_file(folder + "/summary.json", to_json(summary));
  }
} // namespace limber
