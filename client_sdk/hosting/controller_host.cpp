// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/hosting/controller_host.hpp"

#include <algorithm>
#include <exception>
#include <set>
#include <string>
#include <utility>

#include "client_sdk/hosting/controller_call.hpp"

namespace cohort {
namespace {

// Runs a controller's code. Turns any exception into a failure that names the robot, the function and the reason.
template <class Failure = ControllerFailure, class Call>
decltype(auto) guarded(const Callee& callee, const std::string& robot, const char* function, std::uint64_t tick,
                       Call call) {
  const auto failure = [&](const std::string& why) {
    return Failure("the controller of robot '" + robot + "' failed in " + function + " at tick " +
                   std::to_string(tick) + ": " + why);
  };
  const ControllerCall under_way(callee, function, tick);
  try {
    return call();
  } catch (const LeaveRun&) {
    throw;
  } catch (const std::exception& error) {
    throw failure(error.what());
  } catch (...) {
    throw failure("the exception is not a std::exception");
  }
}

std::vector<ChannelInfo> layout_of(const std::vector<wire::Channel>& channels) {
  std::vector<ChannelInfo> layout;
  std::uint32_t offset = 0;
  for (const wire::Channel& channel : channels) {
    layout.push_back({channel.name, channel.unit, offset, channel.size, channel.lower, channel.upper, channel.neutral});
    offset += channel.size;
  }
  return layout;
}

std::size_t size_of(const std::vector<ChannelInfo>& channels) {
  return channels.empty() ? 0 : std::size_t{channels.back().offset} + channels.back().size;
}

StartReason reason_of(wire::StartReason reason) {
  switch (reason) {
    case wire::StartReason::first:
    case wire::StartReason::more_robots: return StartReason::first;
    case wire::StartReason::takeover: return StartReason::takeover;
    case wire::StartReason::reset: return StartReason::reset;
    case wire::StartReason::restored:
    case wire::StartReason::restored_with_state: return StartReason::restored;
  }
  throw ControllerFailure("the server sent a start reason that this version does not support");
}

const wire::Team* team_of(const wire::Admit& admit, const wire::AdmittedRobot& robot) {
  if (admit.teams.empty()) return nullptr;
  if (robot.team < admit.teams.size()) return &admit.teams[robot.team];
  throw ControllerFailure("the server sent no description of the team of robot '" + robot.name + "'");
}

}  // namespace

ControllerKind kind_of(const Plugin& plugin) {
  return {plugin.name,
          [plugin] { return OwnedController(plugin.create(), plugin.destroy); },
          plugin.abi >= Plugin::first_abi_with_state,
          {}};
}

std::unique_ptr<FrameHandler> make_handler(const ControllerKind& kind) {
  if (kind.create_for_all) return kind.create_for_all();
  return std::make_unique<ControllerHost>(kind);
}

Start start_of(const wire::Admit& admit, const wire::AdmittedRobot& robot,
               std::span<const wire::RobotDescription> descriptions) {
  const auto description = std::find_if(descriptions.begin(), descriptions.end(), [&](const auto& candidate) {
    return candidate.description == robot.description;
  });
  if (description == descriptions.end()) {
    throw ControllerFailure("the server sent no description of robot '" + robot.name + "'");
  }
  Start start;
  start.robot = robot.robot;
  start.name = robot.name;
  start.model = description->model;
  if (const wire::Team* const team = team_of(admit, robot)) {
    start.team = team->name;
    start.controller = team->controller;
    std::vector<Parameter> parameters;
    for (const wire::Parameter& parameter : team->parameters) parameters.push_back({parameter.name, parameter.values});
    start.parameters = Parameters(std::move(parameters));
  }
  start.reason = reason_of(admit.start_reason);
  start.tick = admit.tick;
  start.seed = robot.seed;
  start.step = std::chrono::nanoseconds(admit.step_ns);
  start.period = robot.period;
  start.observation_channels = layout_of(description->observation);
  start.command_channels = layout_of(description->command);
  start.tree = description->tree;
  return start;
}

struct ControllerHost::Robot {
  std::uint32_t id = 0;
  std::string name;
  std::unique_ptr<const Callee> callee;
  OwnedController controller;
  std::size_t observation_size = 0;
  std::vector<double> neutral;
  std::uint64_t tick = 0;  // tick of its start or its last step
};

ControllerHost::ControllerHost(ControllerKind kind) : kind_(std::move(kind)) {}
ControllerHost::~ControllerHost() { drop_controllers(); }

void ControllerHost::drop_controllers() {
  for (Robot& robot : robots_) {
    if (robot.controller == nullptr) continue;  // the robot's controller has moved to another entry
    const ControllerCall under_way(*robot.callee, "its destructor", robot.tick);
    robot.controller.reset();
  }
  robots_.clear();
}

// Tries the robot after the last one found first, because frames have robots in order.
ControllerHost::Robot* ControllerHost::find(std::uint32_t id) {
  if (next_ >= robots_.size()) next_ = 0;
  if (next_ < robots_.size() && robots_[next_].id == id) return &robots_[next_++];
  const auto place = std::lower_bound(robots_.begin(), robots_.end(), id,
                                      [](const Robot& robot, std::uint32_t wanted) { return robot.id < wanted; });
  if (place == robots_.end() || place->id != id) return nullptr;
  next_ = static_cast<std::size_t>(place - robots_.begin()) + 1;
  return &*place;
}

void ControllerHost::start(const wire::Admit& admit, std::span<const wire::RobotDescription> descriptions) {
  const StartReason reason = reason_of(admit.start_reason);
  const bool same_controllers = reason == StartReason::reset || reason == StartReason::restored;
  if (!same_controllers) drop_controllers();
  std::vector<Robot> robots;
  for (const wire::AdmittedRobot& admitted : admit.robots) {
    const Start start = start_of(admit, admitted, descriptions);
    auto callee = std::make_unique<const Callee>(start.controller.empty() ? kind_.name : start.controller,
                                                 admitted.name, start.team);
    Robot* before = find(admitted.robot);
    OwnedController controller = before != nullptr
                                     ? std::move(before->controller)
                                     : guarded(*callee, admitted.name, "its constructor", admit.tick, kind_.create);
    guarded(*callee, admitted.name, "start", admit.tick, [&] {
      controller->start(start);
      start.parameters.check_all_were_asked_for();
    });
    std::vector<double> neutral;
    for (const ChannelInfo& channel : start.command_channels) {
      neutral.insert(neutral.end(), channel.size, channel.neutral);
    }
    robots.push_back({admitted.robot, admitted.name, std::move(callee), std::move(controller),
                      size_of(start.observation_channels), std::move(neutral), admit.tick});
  }
  std::sort(robots.begin(), robots.end(), [](const Robot& a, const Robot& b) { return a.id < b.id; });
  drop_controllers();
  robots_ = std::move(robots);
}

std::span<const double> ControllerHost::answer(const wire::Observation& frame) {
  // Compute the size before any controller runs, because they get spans into the vector.
  std::size_t observed = 0;
  std::size_t commanded = 0;
  for (const std::uint32_t id : frame.robots) {
    const Robot* robot = find(id);
    if (robot == nullptr) {
      throw ControllerFailure("the frame of tick " + std::to_string(frame.tick) + " has robot " + std::to_string(id) +
                              ", which this process does not drive");
    }
    observed += robot->observation_size;
    commanded += robot->neutral.size();
  }
  if (observed != frame.values.size()) {
    throw ControllerFailure("the frame of tick " + std::to_string(frame.tick) + " has " +
                            std::to_string(frame.values.size()) + " values; the descriptions of its robots require " +
                            std::to_string(observed));
  }
  values_.resize(commanded);
  std::size_t read = 0;
  std::size_t written = 0;
  for (const std::uint32_t id : frame.robots) {
    Robot& robot = *find(id);
    const Observation observation(frame.tick, std::chrono::nanoseconds(frame.time_ns),
                                  frame.values.subspan(read, robot.observation_size));
    const std::span<double> values(values_.data() + written, robot.neutral.size());
    std::copy(robot.neutral.begin(), robot.neutral.end(), values.begin());
    Command command(values);
    robot.tick = frame.tick;
    guarded(*robot.callee, robot.name, "step", frame.tick, [&] { robot.controller->step(observation, command); });
    read += robot.observation_size;
    written += robot.neutral.size();
  }
  return values_;
}

std::vector<RobotState> ControllerHost::save() const {
  std::vector<RobotState> states;
  for (const Robot& robot : robots_) {
    RobotState& saved = states.emplace_back(RobotState{robot.id});
    if (!kind_.has_state) continue;
    StateWriter writer;
    guarded<SaveFailure>(*robot.callee, robot.name, "save", robot.tick, [&] {
      robot.controller->save(writer);
      if (writer.bytes().size() > largest_state)
        throw StateError("its state has " + std::to_string(writer.bytes().size()) + " bytes; the maximum is " +
                         std::to_string(largest_state));
    });
    if (!writer.is_left_out()) saved.state = {kind_.name, {writer.bytes().begin(), writer.bytes().end()}};
  }
  return states;
}

std::vector<std::string> ControllerHost::load(std::span<const RobotState> states) {
  std::set<std::string> useless;  // names of controller kinds
  for (const auto& [id, state] : states) {
    Robot* const robot = find(id);
    if (robot == nullptr || !state) continue;
    if (!kind_.has_state || state->controller != kind_.name) {
      useless.insert(state->controller);
      continue;
    }
    guarded(*robot->callee, robot->name, "load", robot->tick, [&] {
      StateReader reader(state->bytes);
      robot->controller->load(reader);
      if (!reader.rest().empty())
        throw StateError("load did not read " + std::to_string(reader.rest().size()) + " of " +
                         std::to_string(state->bytes.size()) + " bytes of its state");
    });
  }
  std::vector<std::string> notices;
  for (const std::string& kind : useless)
    notices.push_back("the saved state belongs to controller '" + kind + "'; '" + kind_.name +
                      "' cannot load it and starts without state");
  return notices;
}

}  // namespace cohort
