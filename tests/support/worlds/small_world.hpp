// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "server/physics/make_world.hpp"
#include "server/physics/world/driven_power.hpp"
#include "tests/support/robots.hpp"

namespace cohort::test {

/// A world that a test builds and then steps. Bodies must be added before the first step.
class SmallWorld {
 public:
  explicit SmallWorld(description::World its_description = world_with_floor(), unsigned threads = 1)
      : description(std::move(its_description)), workers_(threads) {}

  BodyId add(const description::Model& model, const Pose& X_WM) {
    return BodyId{place(description, model, model.name + "_" + std::to_string(description.instances.size()), X_WM)};
  }
  physics::World& world() {
    if (!world_) world_ = physics::make_world(description, workers_);
    return *world_;
  }
  void run(double seconds) {
    const double step = std::chrono::duration<double>(description.step).count();
    for (auto steps = std::lround(seconds / step); steps > 0; --steps) world().step();
  }
  /// Sets the track speeds of a robot made by `tracked_robot`.
  void drive(BodyId body, double left, double right) {
    world().set_device_target(body, DeviceId{0}, 0, left);
    world().set_device_target(body, DeviceId{0}, 1, right);
  }
  double driven_power(BodyId body) {
    return physics::driven_power(world(), body, description.models[world().model_of(body)]);
  }
  Eigen::Vector3d position(BodyId body, std::size_t link = 0) { return world().link_pose(body, LinkId{link}).position; }
  Eigen::Vector3d velocity(BodyId body, std::size_t link = 0) {
    return world().link_twist(body, LinkId{link}).linear_W;
  }
  Eigen::Vector3d up(BodyId body) { return world().link_pose(body, LinkId{0}).orientation * Eigen::Vector3d::UnitZ(); }

  description::World description;

 private:
  WorkerPool workers_;
  std::unique_ptr<physics::World> world_;
};

/// Energy and momentum of all links of a body, about the world's origin.
struct WholeMotion {
  double kinetic_energy = 0.0;    ///< [J]
  double potential_energy = 0.0;  ///< gravitational, 0 at z = 0 [J]
  Eigen::Vector3d momentum = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_momentum = Eigen::Vector3d::Zero();
};
inline WholeMotion whole_motion(SmallWorld& small, BodyId body) {
  WholeMotion sum;
  const description::Model& model = small.description.models[small.world().model_of(body)];
  for (std::size_t link = 0; link < model.links.size(); ++link) {
    const Pose X_WL = small.world().link_pose(body, LinkId{link});
    const physics::Twist twist = small.world().link_twist(body, LinkId{link});
    const description::Inertial& inertial = model.links[link].inertial;
    const Eigen::Vector3d arm = X_WL.orientation * inertial.X_LI.position;
    const Eigen::Vector3d v = twist.linear_W + twist.angular_W.cross(arm);
    const Eigen::Matrix3d R = (X_WL.orientation * inertial.X_LI.orientation).toRotationMatrix();
    const Eigen::Vector3d spin = R * inertial.inertia * R.transpose() * twist.angular_W;
    sum.kinetic_energy += 0.5 * inertial.mass * v.squaredNorm() + 0.5 * spin.dot(twist.angular_W);
    sum.potential_energy += inertial.mass * g * (X_WL.position + arm).z();
    sum.momentum += inertial.mass * v;
    sum.angular_momentum += spin + inertial.mass * (X_WL.position + arm).cross(v);
  }
  return sum;
}

/// Returns a hash of the state of every body, and of all contacts and connections.
inline std::uint64_t hash_of(const physics::World& world) {
  StateHash hash;
  for (std::uint32_t body = 0; body < world.body_count(); ++body) world.hash_body(BodyId{body}, hash);
  world.hash_contacts(hash);
  return hash.value();
}
inline std::uint64_t hash_of(const physics::World& world, std::span<const BodyId> bodies) {
  StateHash hash;
  for (const BodyId body : bodies) world.hash_body(body, hash);
  return hash.value();
}

/// Restores a snapshot of `world` in `restored`, a new world of the same description.
inline void restore_from(const physics::World& world, physics::World& restored) {
  SnapshotWriter writer;
  world.save(writer);
  SnapshotReader reader(writer.bytes());
  restored.restore(reader);
  EXPECT_TRUE(reader.is_at_end());
}

/// Returns the mass and inertia of a solid box about its centre.
inline description::Inertial solid_box(double mass, const Eigen::Vector3d& size) {
  const Eigen::Vector3d squares = size.cwiseProduct(size);
  description::Inertial inertial;
  inertial.mass = mass;
  inertial.inertia =
      (mass / 12.0 * Eigen::Vector3d(squares.y() + squares.z(), squares.x() + squares.z(), squares.x() + squares.y()))
          .asDiagonal();
  return inertial;
}

/// Returns a joint between two links of a model, or between the world and a link, about or along `axis`. `place` is its
/// position in the child link [m].
inline description::Joint joint_of(const std::string& name, description::JointType type, std::size_t parent,
                                   std::size_t child, const Eigen::Vector3d& axis,
                                   const Eigen::Vector3d& place = Eigen::Vector3d::Zero()) {
  description::Joint joint;
  joint.name = name;
  joint.type = type;
  joint.parent = parent;
  joint.child = child;
  joint.axis.direction = axis;
  joint.X_LJ.position = place;
  return joint;
}

using description::solid_sphere;

/// Returns a box as a convex mesh.
inline description::Mesh box_mesh(const Eigen::Vector3d& size) {
  auto mesh = std::make_shared<description::TriangleMesh>();
  for (int i = 0; i < 8; ++i)
    mesh->vertices.push_back(
        0.5 * size.cwiseProduct(Eigen::Vector3d((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1)));
  mesh->triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                     {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return {mesh, true};
}

/// Returns a model of one link with one collision at its centre of mass.
inline description::Model loose(const std::string& name, const description::Shape& shape,
                                const description::Inertial& inertial, description::Surface surface = {}) {
  description::Model model;
  model.name = name;
  model.links.push_back({"link", {}, inertial, {{"collision", {}, shape, surface}}});
  return model;
}

inline Pose turned(double x, double y, double z, const Eigen::Vector3d& axis, double angle) {
  return {{x, y, z}, Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis.normalized()))};
}

}  // namespace cohort::test
