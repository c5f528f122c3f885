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

/// Returns whether places are drawn one by one, as often as needed, rather than given all at once.
bool is_drawn(const Layout& layout);

/// Where an instance is tried, in a layout whose places are drawn. Each attempt has draws of its own.
Eigen::Vector2d drawn_point(const Layout& layout, const RandomStream& random, std::uint64_t instance,
                            std::uint32_t attempt);
/// The heading of an instance that is tried at a point.
double drawn_heading(const Population& population, const RandomStream& random, std::uint64_t instance,
                     std::uint32_t attempt, const Eigen::Vector2d& point);

/// The places of a layout that gives them: x [m], y [m] and heading [rad].
std::vector<Eigen::Vector3d> given_places(const Population& population, const RandomStream& random);

/// Returns a rectangle that holds all places, whatever the seed.
Region region_of(const Population& population);

}  // namespace cohort::placement
