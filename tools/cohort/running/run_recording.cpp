#include "tools/cohort/running/run_recording.hpp"

#include "server/description/select_robots.hpp"
#include "tools/cohort/cli/wording.hpp"

namespace cohort::tool {

void set_recorded(description::Experiment& experiment, const RecordOptions& options) {
  description::Recorded& recorded = experiment.recorded;
  recorded.pose_rate = options.pose_rate.value_or(recorded.pose_rate);
  recorded.joint_rate = options.joint_rate.value_or(recorded.joint_rate);
  recorded.observation_rate = options.observation_rate.value_or(recorded.observation_rate);
  if (options.snapshot_interval) recorded.snapshot_interval = nanoseconds(*options.snapshot_interval);
  if (options.robots.empty()) return;
  recorded.observed = description::select_robots(experiment.world, options.robots);
  recorded.selectors = options.robots;
}

}  // namespace cohort::tool
