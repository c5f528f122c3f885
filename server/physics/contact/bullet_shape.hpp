// SPDX-License-Identifier: Apache-2.0
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

  /// Returns Bullet's shape. The shape of a convex mesh is made by the first call. This takes milliseconds for
  /// thousands of vertices, and most meshes of robots never need it.
  btCollisionShape* get() const;
  /// Returns the origin of Bullet's frame of the shape in the frame of `geometry::Shape`. Bullet puts the origin of a
  /// height map at the middle of its heights.
  const Eigen::Vector3d& offset() const { return offset_; }
  /// Returns the margin by which Bullet underestimates distances to all shapes except spheres [m]. Only surface meshes
  /// and height maps have one; without it, Bullet would find a contact only once the surface is reached.
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
