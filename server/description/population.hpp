// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "server/description/input_error.hpp"

namespace cohort::description {

/// Positions in rows and columns around a centre; the first row has the smallest y.
struct GridLayout {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< [m]
  double spacing = 1.0;                              ///< [m]
  std::uint64_t columns = 1;
  double yaw = 0.0;  ///< angle of the rows from the x axis [rad]
};
/// Uniformly distributed positions in a rectangle.
struct UniformLayout {
  Eigen::Vector2d lower = Eigen::Vector2d::Zero();  ///< [m]
  Eigen::Vector2d upper = Eigen::Vector2d::Zero();
};
/// Positions that are normally distributed around a centre along x and y.
struct GaussianLayout {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double deviation = 1.0;  ///< standard deviation [m]
};
/// Evenly spaced positions on a circle, counter-clockwise.
struct RingLayout {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double radius = 1.0;
  double first_bearing = 0.0;  ///< bearing of the first position, from the x axis [rad]
};
/// Evenly spaced positions on a line, including both ends.
struct LineLayout {
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  Eigen::Vector2d to = Eigen::Vector2d::Zero();
};
/// Positions that are listed one by one: x [m], y [m] and heading [rad] in the frame of the formation.
struct FormationLayout {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  std::vector<Eigen::Vector3d> members;
};
using Layout = std::variant<GridLayout, UniformLayout, GaussianLayout, RingLayout, LineLayout, FormationLayout>;

enum class HeadingKind {
  random,
  fixed,
  towards,  ///< towards a point
  away,     ///< away from a point
  along,    ///< along the ring, counter-clockwise, or the line
};

/// Instances of one model, placed by the seed of the run (`server/placement`).
struct Population {
  std::string name;
  std::size_t model = 0;   ///< index into World::models
  std::size_t bodies = 1;  ///< in each instance; their models are consecutive from `model` on
  std::uint64_t count = 0;
  std::uint64_t seed_offset = 0;  ///< added to the seed of the run
  bool may_be_fewer = false;      ///< fewer than `count`, if there is not enough room
  Layout layout;
  HeadingKind heading = HeadingKind::random;  ///< for each instance, or for a whole formation
  Eigen::Vector2d point = Eigen::Vector2d::Zero();
  double yaw = 0.0;           ///< added to the heading [rad]
  double gap = 0.0;           ///< minimum distance to obstacles and other instances [m]
  double level = 0.0;         ///< static objects up to this height are ground [m]
  Problem place{};            ///< position in the file, without a message
  Problem placement_place{};  ///< position of the placement in the file, without a message

  // The instances of the population in the world:
  std::size_t first = 0;               ///< index into World::instances of the first body of its first instance
  std::vector<std::uint64_t> numbers;  ///< numbers of its instances, ascending; position i of the layout has number i
};

}  // namespace cohort::description
