// SPDX-License-Identifier: Apache-2.0
#include "tests/conformance/robots.hpp"

#include <algorithm>
#include <span>
#include <stdexcept>
#include <utility>

namespace cohort::conformance {
namespace {

std::vector<ChannelInfo> channels_of(const std::vector<message::Channel>& described) {
  std::vector<ChannelInfo> channels;
  std::uint32_t offset = 0;
  for (const message::Channel& channel : described) {
    channels.push_back(
        {channel.name(), channel.unit(), offset, channel.size(), channel.lower(), channel.upper(), channel.neutral()});
    offset += channel.size();
  }
  return channels;
}

std::size_t size_of(const std::vector<ChannelInfo>& channels) {
  return channels.empty() ? 0 : channels.back().offset + channels.back().size;
}

StartReason reason_of(std::uint32_t number) {
  switch (number) {
    case 0: return StartReason::first;
    case 1: return StartReason::takeover;
    case 2: return StartReason::reset;
    case 3:
    case 4: return StartReason::restored;
    default: throw std::runtime_error("start_reason " + std::to_string(number) + " is not in the protocol");
  }
}

Start start_of(const message::Admit& admit, const message::AdmittedRobot& robot,
               const message::RobotDescription& description) {
  Start start;
  start.robot = robot.robot();
  start.name = robot.name();
  start.model = description.model();
  const message::Team& team = admit.teams().at(robot.team());
  start.team = team.name();
  start.controller = team.controller();
  std::vector<Parameter> parameters;
  for (const message::Parameter& parameter : team.parameters()) {
    parameters.push_back({parameter.name(), parameter.values()});
  }
  start.parameters = Parameters(std::move(parameters));
  start.reason = reason_of(admit.start_reason());
  start.tick = admit.tick();
  start.seed = robot.seed();
  start.step = std::chrono::nanoseconds(admit.step_ns());
  start.period = robot.period();
  start.observation_channels = channels_of(description.observation());
  start.command_channels = channels_of(description.command());
  return start;
}

}  // namespace

void Robots::start(const message::Admit& admit,
                   const std::map<std::uint32_t, message::RobotDescription>& descriptions) {
  auto before = std::exchange(robots_, {});
  for (const message::AdmittedRobot& admitted : admit.robots()) {
    const Start start = start_of(admit, admitted, descriptions.at(admitted.description()));
    Robot robot{plugin_.create(), size_of(start.observation_channels), {}};
    const bool controllers_stay = start.reason == StartReason::reset || start.reason == StartReason::restored;
    if (const auto known = before.find(admitted.robot()); controllers_stay && known != before.end()) {
      robot.controller = std::move(known->second.controller);
    }
    for (const ChannelInfo& channel : start.command_channels) {
      robot.neutral.insert(robot.neutral.end(), channel.size, channel.neutral);
    }
    robot.controller->start(start);
    start.parameters.check_all_were_asked_for();
    robots_.emplace(admitted.robot(), std::move(robot));
  }
}

std::vector<RobotState> Robots::save() const {
  std::vector<RobotState> states;
  for (const auto& [id, robot] : robots_) {
    StateWriter writer;
    robot.controller->save(writer);
    RobotState& state = states.emplace_back(RobotState{id, !writer.is_left_out()});
    if (!state.is_saved) continue;
    state.name = plugin_.name();
    state.bytes.assign(writer.bytes().begin(), writer.bytes().end());
  }
  return states;
}

void Robots::load(const std::vector<RobotState>& states) {
  for (const RobotState& state : states) {
    if (!state.is_saved) continue;
    if (state.name != plugin_.name()) throw std::runtime_error("the state is of '" + state.name + "'");
    StateReader reader(state.bytes);
    robots_.at(state.robot).controller->load(reader);
    if (!reader.rest().empty()) throw std::runtime_error("a controller left a part of its state unread");
  }
}

message::Command Robots::answer(const message::Observation& frame) {
  message::Command answer;
  answer.client(frame.client());
  answer.run(frame.run());
  answer.resent(frame.resent());
  answer.epoch(frame.epoch());
  answer.tick(frame.tick());
  answer.robots(frame.robots());
  std::span<const double> unread = frame.values();
  for (const std::uint32_t id : frame.robots()) {
    Robot& robot = robots_.at(id);
    if (unread.size() < robot.observation_size) throw std::runtime_error("a frame has too few values");
    std::vector<double> values = robot.neutral;
    Command command(values);
    robot.controller->step(
        Observation(frame.tick(), std::chrono::nanoseconds(frame.time_ns()), unread.first(robot.observation_size)),
        command);
    unread = unread.subspan(robot.observation_size);
    answer.values().insert(answer.values().end(), values.begin(), values.end());
  }
  if (!unread.empty()) throw std::runtime_error("a frame has too many values");
  return answer;
}

}  // namespace cohort::conformance
