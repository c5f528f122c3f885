// SPDX-License-Identifier: Apache-2.0
#include "server/serving/world_state_broadcast.hpp"

namespace cohort::session {

void WorldStateBroadcast::publish(const Simulation& simulation, std::uint32_t run) {
  constexpr std::chrono::milliseconds count_interval{100};
  const Clock::time_point now = Clock::now();
  if (now - observers_counted_at_ > count_interval) {
    observers_counted_at_ = now;
    is_observed_ = writer_.matched() > 0;
  }
  if (!is_observed_) return;
  poses_.clear();
  present_.clear();
  for (std::uint32_t robot = 0; robot < simulation.robot_count(); ++robot) {
    if (!simulation.is_present(robot)) continue;
    present_.push_back(robot);
    const Pose X_WL = simulation.robot_pose(robot);
    const auto& p = X_WL.position;
    const auto& q = X_WL.orientation;
    poses_.insert(poses_.end(), {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()});
  }
  writer_.write({run, simulation.tick(), simulation.time().count(), simulation.state_hash(), present_, poses_});
}

}  // namespace cohort::session
