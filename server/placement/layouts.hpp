// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "server/core/random.hpp"
#include "server/description/population.hpp"
#include "server/placement/placement.hpp"

namespace cohort::placement {

/// An axis-aligned rectangle in the xy plane of the world.
struct Region {
  Eigen::Vector2d lower = Eigen::Vector2d::Zero();  ///< [m]
  Eigen::Vector2d upper = Eigen::Vector2d::Zero();
};

/// Returns true if the layout draws random positions one by one, and false if it lists them.
bool is_drawn(const Layout& layout);

/// Returns the position [m] of an attempt to place an instance, for a layout that draws random positions. Each attempt
/// has its own random numbers.
Eigen::Vector2d drawn_point(const Layout& layout, const RandomStream& random, std::uint64_t instance,
                            std::uint32_t attempt);
/// Returns the heading [rad] of an attempt to place an instance at a point.
double drawn_heading(const Population& population, const RandomStream& random, std::uint64_t instance,
                     std::uint32_t attempt, const Eigen::Vector2d& point);

/// Returns the positions of a layout that lists them: x [m], y [m] and heading [rad].
std::vector<Eigen::Vector3d> given_places(const Population& population, const RandomStream& random);

/// Returns a rectangle that contains all positions that the population can have, for any seed.
Region region_of(const Population& population);

}  // namespace cohort::placement
