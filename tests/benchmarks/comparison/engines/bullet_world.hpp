// SPDX-License-Identifier: Apache-2.0
#pragma once

// Bullet's multibody world with its default configuration.

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyFixedConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <btBulletCollisionCommon.h>
#pragma GCC diagnostic pop

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace cohort::bench {

/// A collision filter: two objects collide if each one's mask includes the other's group.
struct BulletFilter {
  int group = btBroadphaseProxy::DefaultFilter;
  int mask = btBroadphaseProxy::AllFilter;
};

/// A `btMultiBodyDynamicsWorld` and its contents. It keeps Bullet's default settings except for those of a scene:
/// bodies have no damping and never sleep.
class BulletWorld {
 public:
  BulletWorld(const Eigen::Vector3d& gravity, double step) : step_(step) {
    world_.setGravity({gravity.x(), gravity.y(), gravity.z()});
  }

  /// Advances by one fixed step, without Bullet's interpolation.
  void step() { world_.stepSimulation(step_, 0); }

  template <class Shape, class... Arguments>
  Shape& add_shape(Arguments&&... arguments) {
    auto shape = std::make_unique<Shape>(std::forward<Arguments>(arguments)...);
    Shape& added = *shape;
    shapes_.push_back(std::move(shape));
    return added;
  }

  btCollisionObject& add_static(btCollisionShape& shape, const btVector3& centre_W, double friction,
                                BulletFilter filter = {}) {
    return add_collider(std::make_unique<btCollisionObject>(), shape,
                        btTransform(btQuaternion::getIdentity(), centre_W), friction, filter);
  }

  btMultiBody& add_body(int links, double mass, const btVector3& inertia, const btTransform& X_WB) {
    const bool is_fixed = mass == 0.0;
    btMultiBody& body = *bodies_.emplace_back(std::make_unique<btMultiBody>(links, mass, inertia, is_fixed, false));
    body.setBaseWorldTransform(X_WB);
    body.setLinearDamping(0.0);
    body.setAngularDamping(0.0);
    return body;
  }

  /// Call this when all links of the body are set up, before they get colliders.
  void finish(btMultiBody& body) {
    body.finalizeMultiDof();
    world_.addMultiBody(&body);
  }

  /// `link`: index of the link, or -1 for the base.
  btMultiBodyLinkCollider& add_link_collider(btMultiBody& body, int link, btCollisionShape& shape, double friction,
                                             BulletFilter filter = {}) {
    const btTransform X_WL(body.localFrameToWorld(link, btMatrix3x3::getIdentity()),
                           body.localPosToWorld(link, {0, 0, 0}));
    btMultiBodyLinkCollider& collider =
        add_collider(std::make_unique<btMultiBodyLinkCollider>(&body, link), shape, X_WL, friction, filter);
    if (link < 0)
      body.setBaseCollider(&collider);
    else
      body.getLink(link).m_collider = &collider;
    return collider;
  }

  template <class Constraint, class... Arguments>
  Constraint& add_constraint(Arguments&&... arguments) {
    auto constraint = std::make_unique<Constraint>(std::forward<Arguments>(arguments)...);
    Constraint& added = *constraint;
    world_.addMultiBodyConstraint(constraint.get());
    constraints_.push_back(std::move(constraint));
    return added;
  }

  const btCollisionDispatcher& dispatcher() const { return dispatcher_; }

 private:
  // A collider needs its pose before it is added, because Bullet pairs it with all objects nearby.
  template <class Collider>
  Collider& add_collider(std::unique_ptr<Collider> collider, btCollisionShape& shape, const btTransform& X_WC,
                         double friction, BulletFilter filter) {
    Collider& added = *collider;
    added.setCollisionShape(&shape);
    added.setWorldTransform(X_WC);
    added.setFriction(friction);
    world_.addCollisionObject(&added, filter.group, filter.mask);
    colliders_.push_back(std::move(collider));
    return added;
  }

  // Bullet keeps pointers to all of these, so the world is destroyed first.
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btMultiBody>> bodies_;
  std::vector<std::unique_ptr<btCollisionObject>> colliders_;
  std::vector<std::unique_ptr<btMultiBodyConstraint>> constraints_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btMultiBodyConstraintSolver solver_;
  btMultiBodyDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  double step_;
};

/// Returns the friction of each of two colliders whose product is `friction`, because Bullet multiplies them.
inline double each_of_two(double friction) { return std::sqrt(friction); }

}  // namespace cohort::bench
