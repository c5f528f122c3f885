// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/comparison/scenes/ray_field.hpp"

#include <cmath>
#include <numbers>

#include "server/geometry/scene/ray_fan.hpp"
#include "tests/benchmarks/comparison/scenes/bench_scene.hpp"

namespace cohort::bench {
namespace {

constexpr std::size_t rays_a_robot = 24;
constexpr double range = 0.2;       // [m]
constexpr double least_gap = 0.01;  // minimum gap between two robots [m]
constexpr CylinderBody turret = Robot{}.turret;

}  // namespace

RayField::RayField(std::uint32_t robots, double spacing, std::uint64_t seed) {
  for (const Placement& at : in_cells(robots, spacing, 0.5 * (spacing - least_gap) - turret.radius, seed)) {
    const auto body = static_cast<std::uint32_t>(poses_.size());
    poses_.push_back({{at.x, at.y, turret.z}, Eigen::Quaterniond(Eigen::AngleAxisd(at.yaw, Eigen::Vector3d::UnitZ()))});
    scene_.add({description::Cylinder{turret.radius, turret.height}, {}, BodyId{body}, true, poses_.back()});
  }
  scene_.build();
  for (std::size_t ray = 0; ray < rays_a_robot; ++ray) {
    const double bearing = 2.0 * std::numbers::pi * static_cast<double>(ray) / rays_a_robot;
    directions_.emplace_back(std::cos(bearing), std::sin(bearing), 0.0);
  }
}

void RayField::move_all() {
  for (std::uint32_t i = 0; i < poses_.size(); ++i) scene_.set_pose(i, poses_[i]);
  scene_.update();
}

std::size_t RayField::cast() const {
  std::size_t hits = 0;
  for (std::uint32_t i = 0; i < poses_.size(); ++i) {
    const Pose& X_WS = poses_[i];
    const geometry::Bounds disc = geometry::bounds_of_disc(X_WS, turret.radius + range);
    const geometry::RayFan fan(scene_, X_WS.position, disc, BodyId{i});
    for (const Eigen::Vector3d& direction : directions_) {
      const Eigen::Vector3d direction_W = X_WS.orientation * direction;
      const Eigen::Vector3d origin_W = X_WS.position + turret.radius * direction_W;
      if (fan.cast(origin_W, direction_W, range)) ++hits;
    }
  }
  return hits;
}

double RayField::rays() const { return static_cast<double>(poses_.size() * rays_a_robot); }

}  // namespace cohort::bench
