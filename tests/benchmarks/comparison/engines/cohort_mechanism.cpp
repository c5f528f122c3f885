// SPDX-License-Identifier: Apache-2.0
#include "server/description/world_in_code.hpp"
#include "server/physics/make_world.hpp"
#include "tests/benchmarks/comparison/engines/engines.hpp"

namespace cohort::bench {
namespace {

description::World describe(const Mechanism& mechanism, description::Dynamics dynamics) {
  using namespace description;
  World world;
  world.name = "mechanism";
  world.step = std::chrono::nanoseconds(std::llround(1e9 * mechanism.step));
  world.gravity = mechanism.gravity;
  const Surface surface{mechanism.floor_friction.value_or(0.0)};
  Model model;
  model.name = "mechanism";
  for (const RigidBody& body : mechanism.bodies) {
    const std::string name = "body_" + std::to_string(model.links.size());
    Link link{name, {body.centre_W}, {}, {}};
    link.inertial.mass = body.mass;
    link.inertial.inertia = body.inertia.asDiagonal();
    if (body.box) link.collisions.push_back({"box", {}, Box{*body.box}, surface});
    if (body.hinge_W) {
      Joint joint;
      joint.name = name;
      joint.type = JointType::revolute;
      joint.parent = model.links.empty() ? Joint::world : model.links.size() - 1;
      joint.child = model.links.size();
      joint.X_LJ.position = *body.hinge_W - body.centre_W;
      joint.axis.direction = Eigen::Vector3d::UnitY();
      model.joints.push_back(joint);
    }
    model.links.push_back(link);
  }
  place(world, model, model.name, {});
  if (mechanism.floor_friction) {
    place(world, static_shape("floor", Plane{}, surface), "floor", {});
  }
  world.physics.dynamics = dynamics;
  world.physics.sleeping = false;
  world.physics.lowest = -1e3;
  return world;
}

class CohortMechanism final : public MechanismRun {
 public:
  CohortMechanism(const Mechanism& mechanism, description::Dynamics dynamics)
      : description_(describe(mechanism, dynamics)), world_(physics::make_world(description_, one_)) {
    if (const RigidBody& body = mechanism.bodies.front(); !body.hinge_W)
      world_->set_root_twist(BodyId{0}, {body.angular_velocity_W, Eigen::Vector3d::Zero()});
  }

  void step() override { world_->step(); }
  Eigen::Vector3d position(std::size_t body) const override {
    return world_->link_pose(BodyId{0}, LinkId{body}).position;
  }
  Eigen::Vector3d velocity(std::size_t body) const override {
    return world_->link_twist(BodyId{0}, LinkId{body}).linear_W;
  }
  Eigen::Vector3d angular_velocity(std::size_t body) const override {
    return world_->link_twist(BodyId{0}, LinkId{body}).angular_W;
  }
  Eigen::Matrix3d rotation(std::size_t body) const override {
    return world_->link_pose(BodyId{0}, LinkId{body}).orientation.toRotationMatrix();
  }

 private:
  description::World description_;
  WorkerPool one_{1};
  std::unique_ptr<physics::World> world_;
};

}  // namespace

std::unique_ptr<MechanismRun> make_cohort_mechanism(const Mechanism& mechanism, description::Dynamics dynamics) {
  return std::make_unique<CohortMechanism>(mechanism, dynamics);
}

}  // namespace cohort::bench
