// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "server/description/world.hpp"
#include "tests/benchmarks/comparison/scenes/bench_scene.hpp"

/// Scenes as worlds of Cohort.
namespace cohort::bench {

/// Indices in a robot's model.
inline constexpr std::size_t turret_link = 1;
inline constexpr std::size_t turret_joint = 0;
inline constexpr std::size_t left_wheel_joint = 1;
inline constexpr std::size_t right_wheel_joint = 2;
inline constexpr std::size_t treel_drive = 0;

/// Returns the world of a scene. The plane is body 0; the walls follow, then the robots, which all have the last model.
description::World describe(const Scene& scene, description::Dynamics dynamics = description::Dynamics::bullet);

void place_static(description::World& world, const description::Shape& shape, double friction, const Pose& X_WM);

}  // namespace cohort::bench
