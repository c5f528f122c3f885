// SPDX-License-Identifier: Apache-2.0
#include "server/run/roster.hpp"

#include <algorithm>

#include "server/core/hash.hpp"
#include "server/core/random.hpp"
#include "server/run/model_tree.hpp"

namespace cohort::session {
namespace {

std::vector<wire::Channel> to_wire(const std::vector<Channel>& channels) {
  std::vector<wire::Channel> result;
  result.reserve(channels.size());
  for (const Channel& c : channels) result.push_back({c.name, c.unit, c.size, c.lower, c.upper, c.neutral});
  return result;
}

wire::Team to_wire(const description::Team& team) {
  wire::Team result{team.name, team.controller, {}};
  for (const description::Parameter& parameter : team.parameters)
    result.parameters.push_back({parameter.name, parameter.values});
  return result;
}

void add(StateHash& hash, std::string_view text) {
  hash.add(std::uint64_t{text.size()});
  for (const char each : text) hash.add(std::uint64_t{static_cast<unsigned char>(each)});
}

void add(StateHash& hash, const std::vector<wire::Channel>& channels) {
  hash.add(std::uint64_t{channels.size()});
  for (const wire::Channel& channel : channels) {
    add(hash, channel.name);
    add(hash, channel.unit);
    hash.add(std::uint64_t{channel.size});
    for (const double value : {channel.lower, channel.upper, channel.neutral}) hash.add(value);
  }
}

void add(StateHash& hash, const Vector3& vector) {
  for (const double value : {vector.x, vector.y, vector.z}) hash.add(value);
}

void add(StateHash& hash, const FramePose& pose) {
  add(hash, pose.position);
  const Quaternion& q = pose.orientation;
  for (const double value : {q.x, q.y, q.z, q.w}) hash.add(value);
}

void add(StateHash& hash, const JointInfo& joint) {
  add(hash, joint.name);
  for (const std::uint32_t value : {static_cast<std::uint32_t>(joint.type), joint.parent, joint.child})
    hash.add(std::uint64_t{value});
  add(hash, joint.pose);
  add(hash, joint.frame);
  hash.add(std::uint64_t{joint.axes.size()});
  for (const AxisInfo& axis : joint.axes) {
    add(hash, axis.direction);
    for (const double value : {axis.lower, axis.upper, axis.max_velocity, axis.max_effort}) hash.add(value);
  }
  hash.add(joint.thread_pitch);
  hash.add(std::uint64_t{joint.devices.size()});
  for (const std::string& device : joint.devices) add(hash, device);
}

void add(StateHash& hash, const KinematicTree& tree) {
  hash.add(std::uint64_t{tree.links.size()});
  for (const LinkInfo& link : tree.links) {
    add(hash, link.name);
    hash.add(link.mass);
    add(hash, link.center_of_mass);
  }
  hash.add(std::uint64_t{tree.joints.size()});
  for (const JointInfo& joint : tree.joints) add(hash, joint);
  hash.add(std::uint64_t{tree.sensors.size()});
  for (const SensorInfo& sensor : tree.sensors) {
    add(hash, sensor.name);
    hash.add(std::uint64_t{sensor.link});
    add(hash, sensor.pose);
  }
}

}  // namespace

std::uint32_t number_of(const wire::RobotDescription& kind) {
  StateHash hash;
  add(hash, kind.model);
  add(hash, kind.observation);
  add(hash, kind.command);
  add(hash, kind.tree);
  return static_cast<std::uint32_t>(hash.value());
}

std::vector<wire::RobotDescription> describe_kinds(const Simulation& simulation) {
  std::vector<wire::RobotDescription> descriptions;
  for (const RobotKind& kind : simulation.kinds())
    descriptions.push_back({static_cast<std::uint32_t>(descriptions.size()), kind.model, to_wire(kind.observation),
                            to_wire(kind.command), tree_of(simulation.description().models[kind.index])});
  return descriptions;
}

void admit_robots(wire::Admit& admit, const description::Experiment& experiment, const Simulation& simulation,
                  std::span<const std::uint32_t> robots) {
  admit.robots.clear();
  admit.teams.clear();
  for (const std::uint32_t robot : robots) {
    const std::string& name = simulation.robot_name(robot);
    const description::Policy& policy = simulation.policy(robot);
    admit.robots.push_back({robot, name, 0, simulation.kind_of(robot),
                            RandomStream(experiment.seed, name, "controller").bits(0, 0), policy.period, policy.phase,
                            policy.delay,
                            policy.mode == description::Mode::free ? wire::Mode::free : wire::Mode::lockstep});
  }
  for (const description::Team& team : experiment.teams) {
    const auto index = static_cast<std::uint32_t>(admit.teams.size());
    bool is_named = false;
    for (wire::AdmittedRobot& robot : admit.robots) {
      if (!std::ranges::binary_search(team.robots, robot.robot)) continue;
      robot.team = index;
      is_named = true;
    }
    if (is_named) admit.teams.push_back(to_wire(team));
  }
}

}  // namespace cohort::session
