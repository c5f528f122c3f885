// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/src/loop_host.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "client_sdk/hosting/controller_host.hpp"

namespace cohort {

void LoopHost::start(const wire::Admit& admit, std::span<const wire::RobotDescription> descriptions) {
  std::set<std::uint32_t> kept;
  if (admit.start_reason == wire::StartReason::more_robots)
    for (const DrivenRobot& robot : robots_) kept.insert(robot.start.robot);
  robots_.clear();
  layouts_.clear();
  for (const wire::AdmittedRobot& admitted : admit.robots)
    robots_.push_back({start_of(admit, admitted, descriptions),
                       {admitted.mode == wire::Mode::lockstep, admitted.period, admitted.phase, admitted.delay}});
  std::ranges::sort(robots_, {}, [](const DrivenRobot& robot) { return robot.start.robot; });
  for (DrivenRobot& robot : robots_)
    if (kept.contains(robot.start.robot)) robot.start.reason = StartReason::going_on;
  for (const DrivenRobot& robot : robots_) {
    Layout& layout = layouts_.emplace_back();
    for (const ChannelInfo& channel : robot.start.observation_channels) layout.observation_size += channel.size;
    for (const ChannelInfo& channel : robot.start.command_channels)
      layout.neutral.insert(layout.neutral.end(), channel.size, channel.neutral);
  }
  hand_over_.offer(LeaseStart{admit.tick, std::chrono::nanoseconds(admit.step_ns), robots_});
}

std::size_t LoopHost::place_of(std::uint32_t robot, std::uint64_t tick) const {
  const auto place =
      std::ranges::lower_bound(robots_, robot, {}, [](const DrivenRobot& each) { return each.start.robot; });
  if (place == robots_.end() || place->start.robot != robot)
    throw ControllerFailure("the frame of tick " + std::to_string(tick) + " has robot " + std::to_string(robot) +
                            ", which this client does not drive");
  return static_cast<std::size_t>(place - robots_.begin());
}

std::span<const double> LoopHost::answer(const wire::Observation& frame) {
  // Compute the size before the loop gets spans into the vector.
  values_.clear();
  std::size_t observed = 0;
  for (const std::uint32_t id : frame.robots) {
    const Layout& layout = layouts_[place_of(id, frame.tick)];
    values_.insert(values_.end(), layout.neutral.begin(), layout.neutral.end());
    observed += layout.observation_size;
  }
  if (observed != frame.values.size())
    throw ControllerFailure("the frame of tick " + std::to_string(frame.tick) + " has " +
                            std::to_string(frame.values.size()) + " values; the descriptions of its robots require " +
                            std::to_string(observed));
  frame_.clear();
  const std::chrono::nanoseconds time(frame.time_ns);
  std::span<const double> values = frame.values;
  std::span<double> commands = values_;
  for (const std::uint32_t id : frame.robots) {
    const std::size_t place = place_of(id, frame.tick);
    const Layout& layout = layouts_[place];
    frame_.push_back({&robots_[place], Observation(frame.tick, time, values.first(layout.observation_size)),
                      Command(commands.first(layout.neutral.size()))});
    values = values.subspan(layout.observation_size);
    commands = commands.subspan(layout.neutral.size());
  }
  hand_over_.offer(Frame{frame.tick, time, frame_});
  return values_;
}

std::vector<RobotState> LoopHost::save() const {
  std::vector<RobotState> states;
  for (const DrivenRobot& robot : robots_) {
    RobotState& saved = states.emplace_back(RobotState{robot.start.robot});
    StateWriter writer;
    hand_over_.offer(SaveState{&robot, &writer});
    if (writer.bytes().size() > largest_state)
      throw SaveFailure("the state of robot '" + robot.start.name + "' has " + std::to_string(writer.bytes().size()) +
                        " bytes; the maximum is " + std::to_string(largest_state));
    if (!writer.is_left_out()) saved.state = {name_, {writer.bytes().begin(), writer.bytes().end()}};
  }
  return states;
}

std::vector<std::string> LoopHost::load(std::span<const RobotState> states) {
  std::set<std::string> useless;  // names of controllers
  for (const auto& [id, state] : states) {
    const auto robot = std::ranges::find(robots_, id, [](const DrivenRobot& each) { return each.start.robot; });
    if (robot == robots_.end() || !state) continue;
    if (state->controller != name_) {
      useless.insert(state->controller);
      continue;
    }
    StateReader reader(state->bytes);
    hand_over_.offer(LoadState{&*robot, &reader});
    if (!reader.rest().empty())
      throw ControllerFailure("robot '" + robot->start.name + "': " + std::to_string(reader.rest().size()) + " of " +
                              std::to_string(state->bytes.size()) + " bytes of its saved state were not read");
  }
  std::vector<std::string> notices;
  for (const std::string& name : useless)
    notices.push_back("the saved state belongs to controller '" + name + "'; '" + name_ +
                      "' cannot load it and starts without state");
  return notices;
}

}  // namespace cohort
