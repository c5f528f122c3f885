// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "server/recording/replay.hpp"

namespace cohort::view {

/// Returns where the robots of a recording are at a time [s], with the tick and the state hash.
inline nlohmann::json robots_at(const std::filesystem::path& file, double seconds) {
  const recording::Recording recording(file);
  recording::Replay replay(recording, 1);
  EXPECT_TRUE(replay.seek(std::chrono::nanoseconds(std::llround(seconds * 1e9))));
  const Simulation& simulation = replay.simulation();
  nlohmann::json robots = nlohmann::json::array();
  for (std::uint32_t robot = 0; robot < simulation.robot_count(); ++robot) {
    const Pose X_WL = simulation.robot_pose(robot);
    const Eigen::Vector3d forward = X_WL.orientation * Eigen::Vector3d::UnitX();
    robots.push_back({{"name", simulation.robot_name(robot)},
                      {"x", X_WL.position.x()},
                      {"y", X_WL.position.y()},
                      {"heading", std::atan2(forward.y(), forward.x())}});
  }
  std::array<char, 17> hash{};
  std::snprintf(hash.data(), hash.size(), "%016llx", static_cast<unsigned long long>(simulation.state_hash()));
  return {{"time", seconds}, {"tick", simulation.tick()}, {"hash", hash.data()}, {"robots", robots}};
}

}  // namespace cohort::view
