// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "tests/benchmarks/comparison/scenes/bench_scene.hpp"
#include "tests/benchmarks/comparison/scenes/driving.hpp"
#include "tests/benchmarks/comparison/scenes/mechanics.hpp"

namespace cohort::bench {

/// Two bodies that touched during the last step: two robots, or a robot and `wall`. Contacts with the ground do not
/// count.
struct Touch {
  static constexpr std::uint32_t wall = 0xffffffffu;

  std::uint32_t robot = 0;
  std::uint32_t other = wall;
};

/// A scene in one physics engine.
class Engine {
 public:
  Engine() = default;
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;
  virtual ~Engine() = default;

  virtual void set_command(std::uint32_t robot, const Command& command) = 0;
  /// Advances by one step of the scene. Throws std::runtime_error if the engine fails.
  virtual void step() = 0;
  virtual Eigen::Vector3d turret_centre(std::uint32_t robot) const = 0;  ///< in the world [m]
  /// Returns the touching pairs, once for each contact point.
  virtual std::vector<Touch> touches() const = 0;
};

}  // namespace cohort::bench
