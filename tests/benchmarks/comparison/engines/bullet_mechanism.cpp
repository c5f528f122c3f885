// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/comparison/engines/bullet_world.hpp"
#include "tests/benchmarks/comparison/engines/engines.hpp"

namespace cohort::bench {
namespace {

constexpr int base = -1;

btVector3 bullet_vector(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
Eigen::Vector3d eigen_vector(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

// A mechanism in Bullet. A free body is the base of its btMultiBody; the bodies of a chain are links of a base that is
// fixed at the origin.
class BulletMechanism final : public MechanismRun {
 public:
  explicit BulletMechanism(const Mechanism& mechanism) : world_(mechanism.gravity, mechanism.step) {
    const double friction = each_of_two(mechanism.floor_friction.value_or(0.0));
    if (mechanism.floor_friction)
      world_.add_static(world_.add_shape<btStaticPlaneShape>(btVector3(0, 0, 1), 0.0), {0, 0, 0}, friction);
    body_ = mechanism.bodies.front().hinge_W ? &add_chain(mechanism) : &add_free(mechanism.bodies.front());
    for (std::size_t i = 0; i < mechanism.bodies.size(); ++i)
      if (const auto& box = mechanism.bodies[i].box)
        world_.add_link_collider(*body_, link_of(i), world_.add_shape<btBoxShape>(bullet_vector(0.5 * *box)), friction);
  }

  void step() override { world_.step(); }
  Eigen::Vector3d position(std::size_t body) const override {
    return eigen_vector(body_->localPosToWorld(link_of(body), {0, 0, 0}));
  }
  Eigen::Vector3d velocity(std::size_t body) const override { return velocities(body).linear_W; }
  Eigen::Vector3d angular_velocity(std::size_t body) const override { return velocities(body).angular_W; }
  Eigen::Matrix3d rotation(std::size_t body) const override {
    Eigen::Matrix3d R_WB;
    for (int axis = 0; axis < 3; ++axis) R_WB.col(axis) = in_world(body, bullet_vector(Eigen::Vector3d::Unit(axis)));
    return R_WB;
  }

 private:
  struct Velocities {
    Eigen::Vector3d angular_W, linear_W;
  };

  btMultiBody& add_free(const RigidBody& free) {
    const btTransform X_WB(btQuaternion::getIdentity(), bullet_vector(free.centre_W));
    btMultiBody& body = world_.add_body(0, free.mass, bullet_vector(free.inertia), X_WB);
    world_.finish(body);
    body.setBaseOmega(bullet_vector(free.angular_velocity_W));
    return body;
  }

  btMultiBody& add_chain(const Mechanism& mechanism) {
    const auto links = static_cast<int>(mechanism.bodies.size());
    btMultiBody& chain = world_.add_body(links, 0.0, {0, 0, 0}, btTransform::getIdentity());
    Eigen::Vector3d parent_W = Eigen::Vector3d::Zero();
    for (int link = 0; link < links; ++link) {
      const RigidBody& body = mechanism.bodies[static_cast<std::size_t>(link)];
      chain.setupRevolute(link, body.mass, bullet_vector(body.inertia), link - 1, btQuaternion::getIdentity(),
                          {0, 1, 0}, bullet_vector(*body.hinge_W - parent_W),
                          bullet_vector(body.centre_W - *body.hinge_W), true);
      parent_W = body.centre_W;
    }
    world_.finish(chain);
    return chain;
  }

  int link_of(std::size_t body) const { return body_->getNumLinks() == 0 ? base : static_cast<int>(body); }

  Eigen::Vector3d in_world(std::size_t body, const btVector3& direction_B) const {
    return eigen_vector(body_->localDirToWorld(link_of(body), direction_B));
  }

  // Returns the velocities of a body's centre of mass. Bullet returns those of all links at once, the base first, each
  // in its own axes.
  Velocities velocities(std::size_t body) const {
    std::vector<btVector3> angular(static_cast<std::size_t>(body_->getNumLinks()) + 1);
    std::vector<btVector3> linear(angular.size());
    body_->compTreeLinkVelocities(angular.data(), linear.data());
    const std::size_t at = body_->getNumLinks() == 0 ? 0 : body + 1;
    return {in_world(body, angular[at]), in_world(body, linear[at])};
  }

  BulletWorld world_;
  btMultiBody* body_ = nullptr;
};

}  // namespace

std::unique_ptr<MechanismRun> make_bullet_mechanism(const Mechanism& mechanism) {
  return std::make_unique<BulletMechanism>(mechanism);
}

}  // namespace cohort::bench
