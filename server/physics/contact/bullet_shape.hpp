#pragma once

#include <memory>

#include "server/geometry/shapes/shapes.hpp"

class btCollisionShape;

namespace cohort::physics {

/// A shape as Bullet takes it. Constant; may be shared between solids.
class BulletShape {
 public:
  explicit BulletShape(const geometry::Shape& shape);
  ~BulletShape();
  BulletShape(const BulletShape&) = delete;
  BulletShape& operator=(const BulletShape&) = delete;

  btCollisionShape* get() const;
  /// Bullet's frame of the shape in ours: it puts the middle of a height map's heights at the origin.
  const Eigen::Vector3d& offset() const { return offset_; }
  /// By how much Bullet finds others nearer than they are, but for spheres [m]: meshes that are surfaces and height
  /// maps have a skin, or it would find them only once they are reached.
  double skin() const;
  /// As geometry::half_thickness_of [m].
  double half_thickness() const { return half_thickness_; }

 private:
  struct Data;
  std::unique_ptr<Data> data_;
  Eigen::Vector3d offset_ = Eigen::Vector3d::Zero();
  double half_thickness_;
};

}  // namespace cohort::physics
