#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "server/geometry/scene/scene.hpp"

namespace cohort::geometry {

/// A solid seen from above: a circle or a rectangle that holds it, from its lowest to its highest point, and an upright
/// cylinder within it. So a question about a segment is often answered without asking the solid itself.
struct Outline {
  Eigen::Vector2d centre_W = Eigen::Vector2d::Zero();
  Eigen::Vector2d axis_W = Eigen::Vector2d::UnitX();  ///< unit vector along the rectangle's first edge
  Eigen::Vector2d half = Eigen::Vector2d::Zero();     ///< half the edges of the rectangle; zero of a circle [m]
  double radius = 0.0;                                ///< of the circle; of a rectangle, to its corners [m]
  double lowest = 0.0;                                ///< z_W, may be -infinite
  double highest = 0.0;
  double inner_radius = -1.0;  ///< of the cylinder around the centre that lies within; < 0 if none is known
  double inner_lowest = 0.0;
  double inner_highest = 0.0;

  bool is_round() const { return half.x() == 0.0 && half.y() == 0.0; }
};

/// Of a solid and its world bounds. A circle if the solid is round about an axis that is upright or leans by less than
/// 14 degrees, else a rectangle, of a mesh that along the world's axes. None for a plane, and for what has no end to
/// any side. The outer bounds may be too small by rounding, some 1e-9 of their size.
std::optional<Outline> outline_of(const Solid& solid, const Bounds& bounds);

/// The outlines of all that is in a scene at one tick, made once for all who look. Const, and callable from any thread.
class Outlines {
 public:
  static constexpr std::uint32_t none = 0xffffffffu;

  struct Item {
    std::optional<Outline> outline;
    std::uint32_t solid = 0;
    BodyId body;
  };

  /// After `Scene::update`; for as long as nothing moves, comes or goes.
  explicit Outlines(const Scene& scene);

  const Scene& scene() const { return *scene_; }
  /// In the order of the solids; without those that were removed from the scene.
  const std::vector<Item>& items() const { return items_; }

  /// Calls `visit(item)` for all items that may reach within `range` of a point, and for some others, in an order that
  /// depends on the scene and the arguments alone.
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
  std::vector<std::uint32_t> item_of_;  // of each solid, or `none`
  double width_ = 1.0;                  // of most that moves [m]
};

}  // namespace cohort::geometry
