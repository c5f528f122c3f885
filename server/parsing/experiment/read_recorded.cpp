// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/experiment/read_recorded.hpp"

#include <stdexcept>

#include "server/description/experiment.hpp"
#include "server/description/select_robots.hpp"
#include "server/parsing/keys/experiment_keys.hpp"
#include "server/parsing/yaml/yaml_document.hpp"

namespace cohort::parsing {

void read_recorded(const ScheduleEntry& entry, const World& world, Recorded& recorded) {
  if (entry.values().has("poses")) recorded.pose_rate = entry.values().real("poses");
  if (entry.values().has("joints")) recorded.joint_rate = entry.values().real("joints");
  if (entry.values().has("observations")) recorded.observation_rate = entry.values().real("observations");
  recorded.snapshot_interval = entry.time("snapshots").value_or(recorded.snapshot_interval);
  if (!entry.is_written("robots")) return;
  recorded.selectors = entry.values().texts("robots");
  recorded.observed.clear();
  try {
    recorded.observed = select_robots(world, recorded.selectors);
  } catch (const std::invalid_argument& error) {
    entry.problem("robots", error.what());
  }
}

Recorded read_recorded(const std::string& text, const Experiment& experiment) {
  Recorded recorded = experiment.recorded;
  const std::filesystem::path place = "record";
  const YamlDocument document = parse_yaml(text);
  if (document.error) throw InputError({{place, document.error->line, "", document.error->message}});
  std::vector<Problem> problems;
  const YamlReport report(place, problems);
  read_recorded(ScheduleEntry(*document.root, "record", experiment_part("record", "experiment"), report),
                experiment.world, recorded);
  if (!problems.empty()) throw InputError(std::move(problems));
  return recorded;
}

}  // namespace cohort::parsing
