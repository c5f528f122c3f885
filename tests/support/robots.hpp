// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/figures/tracked_robot.hpp"

/// Small worlds described in code, for tests of physics, sensing and simulation.
namespace cohort::test {

inline constexpr double g = 9.81;  // [m/s^2]

using description::at;
using description::place;
using description::solid_cylinder;
using description::static_shape;

inline constexpr std::size_t turret = 1;  // the link of `tracked_robot`

/// Returns a robot with tracks, a motorised turret, encoders and a ring of 15 proximity sensors.
inline description::Model tracked_robot(double noise = 0.0) {
  using namespace description;
  Model model = figures::tracked_robot();
  model.name = "tracked_robot";
  model.devices.push_back(VelocityMotor{"turret", 0, 1.5, 0.3});
  model.devices.push_back(JointEncoder{"turret", 0});
  model.devices.push_back(TreelEncoder{"treel", 0});
  ProximityRing ring{"proximity", 1, {{0, 0, 0.02}}, 15, 0.20943951023931953, 0.41887902047863906, 0.058, 0.2};
  if (noise > 0.0) {
    ring.readout.noises.emplace_back();
    ring.readout.noises[0].deviation = noise;
  }
  model.devices.push_back(ring);
  return model;
}

/// Adds a wheel to the first link of a model that drives along x. Returns the index of its joint.
inline std::size_t add_wheel(description::Model& model, const Eigen::Vector3d& p_MW, double radius, double width,
                             double mass) {
  description::Joint joint;
  joint.name = "wheel_" + std::to_string(model.links.size());
  joint.type = description::JointType::revolute;
  joint.parent = 0;
  joint.child = model.links.size();
  joint.axis.direction = Eigen::Vector3d::UnitZ();  // axis of the lying wheel: y of the model
  const Eigen::Quaterniond lying(Eigen::AngleAxisd(-M_PI / 2, Eigen::Vector3d::UnitX()));
  model.links.push_back({joint.name,
                         {p_MW, lying},
                         solid_cylinder(mass, radius, width, 0.0),
                         {{"tyre", {}, description::Cylinder{radius, width}, {0.9, 0}}}});
  model.joints.push_back(joint);
  return model.joints.size() - 1;
}

inline constexpr std::size_t first_reading = 6;  // index of the ring's readings in the observation of `tracked_robot`

inline description::World empty_world(std::chrono::nanoseconds step = std::chrono::milliseconds(10)) {
  description::World world;
  world.name = "empty";
  world.step = step;
  return world;
}

inline description::World world_with_floor(double friction = 1.0) {
  description::World world;
  world.name = "test";
  place(world, static_shape("floor", description::Plane{}, {friction, 0.0}), "floor", {});
  return world;
}

}  // namespace cohort::test
