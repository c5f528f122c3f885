#pragma once

#include <memory>

#include "server/geometry/shapes/shapes.hpp"

class btCollisionShape;

namespace cohort::physics {

/// A shape as Bullet represents it. Immutable; may be shared between solids and threads.
class BulletShape {
 public:
  explicit BulletShape(const geometry::Shape& shape);
  ~BulletShape();
  BulletShape(const BulletShape&) = delete;
  BulletShape& operator=(const BulletShape&) = delete;

  /// Returns Bullet's shape. That of a convex mesh is made by the first call: it takes milliseconds for thousands of
  /// vertices, and most meshes of robots never come near anything that needs it.
  btCollisionShape* get() const;
  /// Returns the origin of Bullet's frame of the shape in the frame of `geometry::Shape`. Bullet puts the origin of a
  /// height map at the middle of its heights.
  const Eigen::Vector3d& offset() const { return offset_; }
  /// Returns the distance by which Bullet finds all shapes except spheres nearer than they are [m]. Surface meshes and
  /// height maps have such a skin; without it, Bullet would find a contact only once the surface is reached.
  double skin() const { return skin_; }
  /// Returns geometry::half_thickness_of the shape [m].
  double half_thickness() const { return half_thickness_; }

 private:
  struct Data;
  std::unique_ptr<Data> data_;
  Eigen::Vector3d offset_ = Eigen::Vector3d::Zero();
  double half_thickness_;
  double skin_ = 0.0;
};

}  // namespace cohort::physics
