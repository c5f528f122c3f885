// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/comparison/lockstep/lockstep_world.hpp"

#include <cmath>
#include <limits>
#include <numeric>

#include "server/description/world_in_code.hpp"
#include "tests/benchmarks/comparison/engines/cohort_scene.hpp"

namespace cohort::bench {
namespace {

constexpr double apart = 10.0;            // [m]
constexpr double height = 0.1;            // height above the ground [m]
constexpr std::size_t camera_spots = 10;  // maximum number of spots, of six values each

// Returns the size of a message: encapsulation, the fixed members, then two sequences. They contain ids of 4 bytes, and
// values of 8 bytes that are aligned to 8.
std::size_t message_bytes(std::size_t fixed_members, std::size_t robots, std::size_t values) {
  constexpr std::size_t encapsulation = 4;
  constexpr std::size_t length = 4;
  const std::size_t up_to_values = fixed_members + length + 4 * robots + length;
  return encapsulation + (up_to_values + 7) / 8 * 8 + 8 * values;
}

description::Model idle_robot() {
  description::Model model;
  model.name = "idle";
  model.links.push_back({"link", {}, {}, {}});
  description::OmnidirectionalCamera camera;
  camera.name = "camera";
  camera.range = 0.1;
  camera.capacity = camera_spots;
  model.devices.emplace_back(camera);
  for (std::size_t i = 0; i < idle_command_size; ++i)
    model.devices.emplace_back(description::UserAction{"action_" + std::to_string(i)});
  return model;
}

}  // namespace

description::Experiment idle_robots(std::uint32_t robots, std::uint32_t delay) {
  description::Experiment experiment;
  experiment.name = "lockstep";
  experiment.duration = std::chrono::nanoseconds(std::numeric_limits<std::int64_t>::max());  // runs until it is stopped
  description::World& world = experiment.world;
  world.name = "lockstep";
  world.physics.fidelity = description::Fidelity::planar;
  place_static(world, description::Plane{}, 1.0, {});
  world.models.push_back(idle_robot());
  const auto side = static_cast<std::uint32_t>(std::ceil(std::sqrt(robots)));
  for (std::uint32_t robot = 0; robot < robots; ++robot) {
    const std::uint32_t row = robot / side;
    place(world, world.models.size() - 1, "robot_" + std::to_string(robot),
          Pose{{apart * (robot % side), apart * row, height}});
  }
  description::Team team;
  team.name = "robots";
  team.robots.resize(robots);
  std::iota(team.robots.begin(), team.robots.end(), 0u);
  team.policy.delay = delay;
  experiment.teams.push_back(team);
  return experiment;
}

std::size_t observation_bytes(std::size_t robots) { return message_bytes(40, robots, idle_observation_size * robots); }

std::size_t command_bytes(std::size_t robots) { return message_bytes(32, robots, idle_command_size * robots); }

}  // namespace cohort::bench
