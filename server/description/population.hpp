#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "server/description/input_error.hpp"

namespace cohort::description {

/// Places in rows and columns about a centre, the first row at the least y.
struct GridLayout {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< [m]
  double spacing = 1.0;                              ///< [m]
  std::uint64_t columns = 1;
  double yaw = 0.0;  ///< of the rows against the x axis [rad]
};
/// Anywhere in a rectangle with equal probability.
struct UniformLayout {
  Eigen::Vector2d lower = Eigen::Vector2d::Zero();  ///< [m]
  Eigen::Vector2d upper = Eigen::Vector2d::Zero();
};
/// Around a centre, normally distributed along x and y.
struct GaussianLayout {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double deviation = 1.0;  ///< standard deviation [m]
};
/// Evenly around a circle, counter-clockwise.
struct RingLayout {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double radius = 1.0;
  double first_bearing = 0.0;  ///< of the first place, from the x axis [rad]
};
/// Evenly from one point to another, both included.
struct LineLayout {
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  Eigen::Vector2d to = Eigen::Vector2d::Zero();
};
/// Places that are given one by one: x [m], y [m] and heading [rad] in the frame of the formation.
struct FormationLayout {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  std::vector<Eigen::Vector3d> members;
};
using Layout = std::variant<GridLayout, UniformLayout, GaussianLayout, RingLayout, LineLayout, FormationLayout>;

enum class HeadingKind {
  random,
  fixed,
  towards,  ///< a point
  away,     ///< from a point
  along,    ///< the ring, counter-clockwise, or the line
};

/// Instances of one model whose places the seed of the run decides (`server/placement`).
struct Population {
  std::string name;
  std::size_t model = 0;   ///< index into World::models
  std::size_t bodies = 1;  ///< of each instance; their models follow each other from `model` on
  std::uint64_t count = 0;
  std::uint64_t seed_offset = 0;  ///< added to the seed of the run
  bool may_be_fewer = false;      ///< than `count`, if there is no room
  Layout layout;
  HeadingKind heading = HeadingKind::random;  ///< of an instance; of a formation as a whole
  Eigen::Vector2d point = Eigen::Vector2d::Zero();
  double yaw = 0.0;           ///< added to the heading [rad]
  double gap = 0.0;           ///< [m]
  double level = 0.0;         ///< static things no higher than this are ground [m]
  Problem place{};            ///< where a file has it, without a message
  Problem placement_place{};  ///< where a file says how it is placed, without a message

  // What it has in the world.
  std::size_t first = 0;               ///< index into World::instances of the first body of its first instance
  std::vector<std::uint64_t> numbers;  ///< of its instances, ascending; place i of the layout has number i
};

}  // namespace cohort::description
