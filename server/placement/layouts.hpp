#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "server/core/random.hpp"
#include "server/description/population.hpp"
#include "server/placement/placement.hpp"

namespace cohort::placement {

/// A rectangle.
struct Region {
  Eigen::Vector2d lower = Eigen::Vector2d::Zero();  ///< [m]
  Eigen::Vector2d upper = Eigen::Vector2d::Zero();
};

/// Returns whether positions are drawn one by one, as often as needed, instead of all at once.
bool is_drawn(const Layout& layout);

/// Returns the position of an attempt to place an instance, in a layout whose positions are drawn. Each attempt has its
/// own draws.
Eigen::Vector2d drawn_point(const Layout& layout, const RandomStream& random, std::uint64_t instance,
                            std::uint32_t attempt);
/// Returns the heading of an attempt to place an instance at a point.
double drawn_heading(const Population& population, const RandomStream& random, std::uint64_t instance,
                     std::uint32_t attempt, const Eigen::Vector2d& point);

/// Returns the positions of a layout that lists them: x [m], y [m] and heading [rad].
std::vector<Eigen::Vector3d> given_places(const Population& population, const RandomStream& random);

/// Returns a rectangle that contains all positions, for any seed.
Region region_of(const Population& population);

}  // namespace cohort::placement
