// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "tests/benchmarks/comparison/scenes/bench_scene.hpp"

/// Sections 5.1.3 and 5.1.4 of the thesis: robots at rest among obstacles or sources on a plane with four walls. The
/// thesis gives the numbers; sizes, positions and density are ours.
namespace cohort::bench {

/// The proximity sensors of the thesis (3.2.1): 15 sensors, 24 degrees apart, without one at the gripper. Range and
/// cone are those of the thesis too.
struct ProximityLayout {
  std::size_t sensors = 15;
  double first_bearing = 0.20943951023931953;  // [rad]
  double spacing = 0.41887902047863906;        // [rad]
  double radius = 0.058;                       // distance of the rays' start from the axis [m]
  double height = 0.075;                       // height above the ground [m]
  double range = 0.2;                          // [m]
  double cone = 0.6981317007977318;            // full angle [rad]
};

struct SensingScene {
  Scene scene;                   ///< robots and walls
  std::vector<Placement> boxes;  ///< obstacles
  std::vector<Placement> pillars;
  std::vector<Eigen::Vector3d> sources;  ///< positions of light or sound sources [m]
  std::uint64_t seed = 1;

  ProximityLayout proximity;
  double box_size = 0.1;         ///< along x and y [m]
  double pillar_radius = 0.06;   ///< [m]
  double obstacle_height = 0.2;  ///< [m]
  double light_height = 0.085;   ///< height of a robot's light sensors above the ground [m]
};

/// Returns a scene with 24 obstacles, half of them boxes, for up to 64 robots, and more in proportion for more robots.
/// Each object has a random position in an arena with 0.1 m^2 for each robot, but at least that for 64 robots.
SensingScene among_obstacles(std::uint32_t robots, std::uint64_t seed);
/// Returns the same arena with 24 sources instead of obstacles, for any number of robots. They are 0.05 to 0.25 m above
/// the ground, so that robots hide some of them.
SensingScene among_sources(std::uint32_t robots, std::uint64_t seed);

}  // namespace cohort::bench
