// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "server/description/world.hpp"

namespace cohort::physics {

/// The air and the water of a world.
struct Media {
  explicit Media(const description::World& world) : air(world.air), water(world.water), gravity(world.gravity) {}

  struct Medium {
    double density = 0.0;        ///< [kg/m^3]
    Eigen::Vector3d velocity_W;  ///< [m/s]
  };

  bool has_water_at(const Eigen::Vector3d& p_W) const { return water && p_W.z() < water->level; }
  /// Returns the medium at a point. The velocity of air is zero if `feels_wind` is false.
  Medium at(const Eigen::Vector3d& p_W, bool feels_wind) const {
    if (has_water_at(p_W)) return {water->density, water->current};
    return {air.density, feels_wind ? air.wind : Eigen::Vector3d(Eigen::Vector3d::Zero())};
  }

  description::Air air;
  std::optional<description::Water> water;
  Eigen::Vector3d gravity;  ///< [m/s^2]
};

}  // namespace cohort::physics
