// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace cohort::test {

/// A minimal planar simulation for controllers of obstacle avoidance: discs that drive among discs within four walls.
/// Robots have the s-bot's dimensions, proximity sensors and tracks, whose speed follows its target with a first-order
/// lag.
class FlatArena {
 public:
  static constexpr double robot_radius = 0.058;  // [m]
  static constexpr double track_distance = 0.08;
  static constexpr double sensor_range = 0.2;
  static constexpr double step = 0.01;      // [s]
  static constexpr double track_lag = 0.1;  // time constant [s]
  static constexpr std::size_t sensor_count = 15;

  struct Disc {
    double x, y, radius;
  };
  struct Robot {
    double x, y, heading;
    double left = 0.0, right = 0.0;  // track speeds [m/s]
    bool touches = false;
  };

  explicit FlatArena(double its_half_size) : half_size(its_half_size) {}

  bool is_free(double x, double y, double radius) const {
    const auto apart = [&](double other_x, double other_y, double other_radius) {
      return std::hypot(other_x - x, other_y - y) > other_radius + radius;
    };
    return std::max(std::abs(x), std::abs(y)) + radius < half_size &&
           std::all_of(obstacles.begin(), obstacles.end(), [&](auto& o) { return apart(o.x, o.y, o.radius); }) &&
           std::all_of(robots.begin(), robots.end(), [&](auto& r) { return apart(r.x, r.y, robot_radius); });
  }

  /// Returns the readings of a robot, from one ray for each sensor: 1 at contact, falling linearly to 0 at the range.
  std::array<double, sensor_count> readings(std::size_t robot) const {
    std::array<double, sensor_count> result{};
    for (std::size_t i = 0; i < sensor_count; ++i) {
      const double bearing = robots[robot].heading + (12.0 + 24.0 * static_cast<double>(i)) * std::numbers::pi / 180.0;
      result[i] = 1.0 - std::min(free_way(robot, std::cos(bearing), std::sin(bearing)), sensor_range) / sensor_range;
    }
    return result;
  }

  void drive(std::size_t robot, double left, double right) {
    Robot& r = robots[robot];
    r.left += (left - r.left) * step / track_lag;
    r.right += (right - r.right) * step / track_lag;
    r.heading += (r.right - r.left) / track_distance * step;
    r.x += (r.left + r.right) / 2.0 * std::cos(r.heading) * step;
    r.y += (r.left + r.right) / 2.0 * std::sin(r.heading) * step;
  }

  /// Separates overlapping robots and obstacles, and records which robots touch something.
  void separate() {
    for (Robot& r : robots) r.touches = false;
    for (std::size_t i = 0; i < robots.size(); ++i) {
      Robot& r = robots[i];
      for (std::size_t j = i + 1; j < robots.size(); ++j) {
        if (push_out(r, robots[j].x, robots[j].y, 2.0 * robot_radius)) robots[j].touches = true;
      }
      for (const Disc& obstacle : obstacles) push_out(r, obstacle.x, obstacle.y, obstacle.radius + robot_radius);
      const double limit = half_size - robot_radius;
      if (std::max(std::abs(r.x), std::abs(r.y)) > limit) r.touches = true;
      r.x = std::clamp(r.x, -limit, limit);
      r.y = std::clamp(r.y, -limit, limit);
    }
  }

  double half_size;  // [m]
  std::vector<Disc> obstacles;
  std::vector<Robot> robots;

 private:
  // Returns the distance from the robot's rim to the nearest obstacle in this direction [m].
  double free_way(std::size_t robot, double dx, double dy) const {
    const double x = robots[robot].x;
    const double y = robots[robot].y;
    double way = std::min((std::copysign(half_size, dx) - x) / dx, (std::copysign(half_size, dy) - y) / dy);
    const auto meet = [&](double other_x, double other_y, double radius) {
      const double along = (other_x - x) * dx + (other_y - y) * dy;
      const double across = (other_x - x) * dy - (other_y - y) * dx;
      if (along > 0.0 && std::abs(across) < radius) {
        way = std::min(way, along - std::sqrt(radius * radius - across * across));
      }
    };
    for (const Disc& obstacle : obstacles) meet(obstacle.x, obstacle.y, obstacle.radius);
    for (std::size_t i = 0; i < robots.size(); ++i) {
      if (i != robot) meet(robots[i].x, robots[i].y, robot_radius);
    }
    return std::max(way - robot_radius, 0.0);
  }

  static bool push_out(Robot& r, double x, double y, double distance) {
    const double now = std::hypot(r.x - x, r.y - y);
    if (now >= distance) return false;
    r.touches = true;
    r.x += (r.x - x) / now * (distance - now);
    r.y += (r.y - y) / now * (distance - now);
    return true;
  }
};

}  // namespace cohort::test
