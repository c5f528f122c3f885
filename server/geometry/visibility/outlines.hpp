// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "server/geometry/scene/scene.hpp"

namespace cohort::geometry {

/// The outline of a solid seen from above: a circle or a rectangle that holds it, from its lowest to its highest point,
/// and an upright cylinder within it. A query about a segment is often decided by these alone.
struct Outline {
  Eigen::Vector2d centre_W = Eigen::Vector2d::Zero();
  Eigen::Vector2d axis_W = Eigen::Vector2d::UnitX();  ///< unit vector along the rectangle's first edge
  Eigen::Vector2d half = Eigen::Vector2d::Zero();     ///< half the edges of the rectangle; zero for a circle [m]
  double radius = 0.0;                                ///< radius of the circle; distance of the rectangle's corners [m]
  double lowest = 0.0;                                ///< z_W, may be -infinite
  double highest = 0.0;
  double inner_radius = -1.0;  ///< radius of the cylinder within, around the centre; < 0 if none is known
  double inner_lowest = 0.0;
  double inner_highest = 0.0;

  bool is_round() const { return half.x() == 0.0 && half.y() == 0.0; }
};

/// Returns the outline of a solid with its world bounds. It is a circle if the solid is round about an axis that is
/// upright or tilted by less than 14 degrees, otherwise a rectangle. The rectangle of a mesh is aligned with the
/// world's axes. Planes and other horizontally unbounded solids have none. The outer bounds may be too small by
/// rounding, about 1e-9 of their size.
std::optional<Outline> outline_of(const Solid& solid, const Bounds& bounds);

/// The outlines of all solids of a scene at one tick, made once for all sensors. Const, and callable from any thread.
class Outlines {
 public:
  static constexpr std::uint32_t none = 0xffffffffu;

  struct Item {
    std::optional<Outline> outline;
    std::uint32_t solid = 0;
    BodyId body;
  };

  /// Builds the outlines; call it after `Scene::update`. Valid as long as no solid moves or is added or removed.
  explicit Outlines(const Scene& scene);

  const Scene& scene() const { return *scene_; }
  /// Returns the items in the order of the solids, without those that were removed from the scene.
  const std::vector<Item>& items() const { return items_; }

  /// Calls `visit(item)` for all items that may reach within `range` of a point, and for some others. The order depends
  /// only on the scene and the arguments.
  template <class Visit>
  void for_each_near(const Eigen::Vector3d& point_W, double range, Visit&& visit) const {
    if (!is_grid_faster(range)) {
      for (const Item& item : items_) visit(item);
      return;
    }
    constexpr double rounding = 1e-6;
    const Bounds near = Bounds{point_W, point_W}.grown_by(range + rounding);
    scene_->for_each_overlap(near, [&](std::uint32_t solid) { visit(items_[item_of_[solid]]); });
  }

 private:
  bool is_grid_faster(double range) const;

  const Scene* scene_;
  std::vector<Item> items_;
  std::vector<std::uint32_t> item_of_;  // by solid, or `none`
  double width_ = 1.0;                  // median width of moving solids [m]
};

}  // namespace cohort::geometry
