// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tests/support/process.hpp"

namespace cohort::test {

/// An experiment in which s-bots on a plane avoid each other. `team` has more keys of their only team in the form `,
/// KEY: VALUE`, such as `, mode: free`.
class FieldOfRobots {
 public:
  explicit FieldOfRobots(int robots, double duration, const std::string& team = "",
                         const std::string& controller = "obstacle_avoidance") {
    write_file(folder_ / "world.yaml", R"(world:
  name: field
  gravity: [0, 0, -9.81]
  model: {name: ground, static: true, link: {name: body, collision: {name: floor, geometry: {plane: {normal: [0, 0, 1], size: [9, 9]}}}}}
  cohort:population:
    name: swarm
    uri: model://sbot
    count: )" + std::to_string(robots) + "\n    placement: {grid: {spacing: 0.25}}\n");
    write_file(folder_ / "experiment.yaml",
               "world: world.yaml\nduration: " + std::to_string(duration) +
                   "\nteams:\n  - {name: swarm, robots: swarm/*, controller: " + controller + team + "}\n");
  }

  std::string file() const { return (folder_ / "experiment.yaml").string(); }
  std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }
  /// Returns the `summary.json` that `serve` writes here.
  nlohmann::json summary() const { return read_json(folder_ / "summary.json"); }
  std::vector<std::string> serve(const ReservedDomain& domain, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> command = {
        cohort_program(), "serve", file(), "--domain", domain.text(), "--summary", (folder_ / "summary.json").string()};
    command.insert(command.end(), more.begin(), more.end());
    return command;
  }
  static std::vector<std::string> host(const ReservedDomain& domain, const std::string& robots,
                                       const std::string& controller = "obstacle_avoidance") {
    return {cohort_program(), "host", controller, "--robots", robots, "--domain", domain.text()};
  }

 private:
  ScratchFolder folder_;
};

/// Returns the events of a kind in a summary.
inline std::vector<nlohmann::json> events_of(const nlohmann::json& summary, const std::string& kind) {
  std::vector<nlohmann::json> events;
  for (const auto& event : summary["events"])
    if (event["kind"] == kind) events.push_back(event);
  return events;
}

}  // namespace cohort::test
