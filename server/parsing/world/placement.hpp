#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "server/parsing/world/occupancy.hpp"

namespace cohort::parsing {

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

/// Where the instances of a population are put.
struct Placement {
  std::string name;  ///< of the population
  std::uint64_t seed = 1;
  std::uint64_t count = 0;
  Layout layout;
  HeadingKind heading = HeadingKind::random;  ///< of an instance; of a formation as a whole
  Eigen::Vector2d point = Eigen::Vector2d::Zero();
  double yaw = 0.0;    ///< added to the heading [rad]
  double gap = 0.0;    ///< [m]
  double level = 0.0;  ///< static things no higher than this are ground [m]
};

struct Placed {
  std::uint64_t number = 0;  ///< of the place, from 0
  Pose X_WM;
};

/// Poses for instances of a model, upright and with a gap of at least `gap` between the bounding circle of an instance
/// and all that is in its way: everything solid of the occupancy and the bounding circles of the others. The circle is
/// about the model's origin, so the heading does not matter. The lowest point of the model stands on the highest ground
/// under the circle: planes, height maps, and what is static and no higher than `level`; at `level` if there is none.
///
/// Random places are tried again if they are taken, a bounded number of times; given ones are left out. The draws of
/// instance i depend on seed, name and i alone.
std::vector<Placed> place_instances(const Placement& placement, const Model& model, const Occupancy& occupancy);

}  // namespace cohort::parsing
