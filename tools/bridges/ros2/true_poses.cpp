// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ros2/true_poses.hpp"

#include <algorithm>
#include <cohort/control.hpp>

namespace cohort::ros2 {

TruePoses::TruePoses(const ClientOptions& client)
    : client_(client), observer_({client.server, client.domain, client.secure, client.name}) {}
TruePoses::~TruePoses() = default;

void TruePoses::forget() { state_.reset(); }

// The server sends the poses of a tick before the frame of the tick.
bool TruePoses::has(std::uint64_t tick) {
  constexpr std::chrono::milliseconds at_most{100};
  while (!state_ || state_->tick != tick) {
    std::optional<WorldState> next = observer_.next(at_most);
    if (!next) return false;
    state_ = std::move(next);
  }
  return true;
}

WorldPose TruePoses::pose(std::uint32_t robot, const std::string& name, std::uint64_t tick) {
  if (has(tick)) {
    const auto found = std::ranges::lower_bound(state_->robots, robot, {}, &ObservedPose::robot);
    if (found != state_->robots.end() && found->robot == robot) return found->pose;
  }
  if (!control_)
    control_ = std::make_unique<Control>(
        ControlOptions{client_.server, client_.domain, client_.secure, client_.name, std::chrono::seconds(10)});
  return control_->entity_state(name).pose;
}

}  // namespace cohort::ros2
