// SPDX-License-Identifier: Apache-2.0
#pragma once

// Bullet's headers, and conversions between Eigen's types and Bullet's. Private to server/physics.

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <LinearMath/btConvexHullComputer.h>
#include <btBulletCollisionCommon.h>
#pragma GCC diagnostic pop

#include "server/core/pose.hpp"

namespace cohort::physics {

inline btVector3 to_bullet(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
inline btQuaternion to_bullet(const Eigen::Quaterniond& q) { return {q.x(), q.y(), q.z(), q.w()}; }
inline btTransform to_bullet(const Pose& pose) {
  return btTransform(to_bullet(pose.orientation), to_bullet(pose.position));
}

inline Eigen::Vector3d to_eigen(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
inline Eigen::Quaterniond to_eigen(const btQuaternion& q) { return {q.w(), q.x(), q.y(), q.z()}; }
inline Eigen::Matrix3d to_eigen(const btMatrix3x3& m) {
  Eigen::Matrix3d rows;
  rows << m[0].x(), m[0].y(), m[0].z(), m[1].x(), m[1].y(), m[1].z(), m[2].x(), m[2].y(), m[2].z();
  return rows;
}

}  // namespace cohort::physics
