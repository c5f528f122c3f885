#pragma once

#include "server/description/world.hpp"

/// Small worlds, described in code: what the tests of physics, sensing and simulation stand on.
namespace cohort::test {

inline constexpr double g = 9.81;  // [m/s^2]

inline description::Inertial solid_cylinder(double mass, double radius, double length, double z) {
  const double across = mass * (3.0 * radius * radius + length * length) / 12.0;
  const double along = mass * radius * radius / 2.0;
  description::Inertial inertial;
  inertial.mass = mass;
  inertial.X_LI.position.z() = z;
  inertial.inertia = Eigen::Vector3d(across, across, along).asDiagonal();
  return inertial;
}

inline constexpr std::size_t turret = 1;  // the link of `tracked_robot`

/// A robot with tracks, a turret on a motor, encoders and a ring of 15 proximity sensors.
inline description::Model tracked_robot(double noise = 0.0) {
  using namespace description;
  Model model;
  model.name = "tracked_robot";
  model.links.push_back({"chassis",
                         {},
                         solid_cylinder(0.4, 0.05, 0.05, 0.033),
                         {{"hull", {{0, 0, 0.034}}, Cylinder{0.05, 0.04}, {0.3, 0}}}});
  model.links.push_back({"turret",
                         {{0, 0, 0.055}},
                         solid_cylinder(0.3, 0.058, 0.04, 0.02),
                         {{"shell", {{0, 0, 0.02}}, Cylinder{0.058, 0.04}, {0.3, 0}}}});
  Joint joint;
  joint.name = "turret_joint";
  joint.type = JointType::revolute;
  joint.parent = 0;
  joint.child = 1;
  model.joints.push_back(joint);
  model.devices.push_back(TreelDrive{"treel", 0, 0.04, 0.04, 0.0, 0.022, 0.02, 0.2, 0.8});
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

/// A wheel on the first link of a model that drives along x; returns its joint.
inline std::size_t add_wheel(description::Model& model, const Eigen::Vector3d& p_MW, double radius, double width,
                             double mass) {
  description::Joint joint;
  joint.name = "wheel_" + std::to_string(model.links.size());
  joint.type = description::JointType::revolute;
  joint.parent = 0;
  joint.child = model.links.size();
  joint.axis.direction = Eigen::Vector3d::UnitZ();  // of the lying wheel: y of the model
  const Eigen::Quaterniond lying(Eigen::AngleAxisd(-M_PI / 2, Eigen::Vector3d::UnitX()));
  model.links.push_back({joint.name,
                         {p_MW, lying},
                         solid_cylinder(mass, radius, width, 0.0),
                         {{"tyre", {}, description::Cylinder{radius, width}, {0.9, 0}}}});
  model.joints.push_back(joint);
  return model.joints.size() - 1;
}

inline constexpr std::size_t first_reading = 6;  // of the ring, in the observation of `tracked_robot`

inline description::Model static_shape(const std::string& name, const description::Shape& shape,
                                       description::Surface surface = {1.0, 0.0}) {
  description::Model model;
  model.name = name;
  model.is_static = true;
  model.links.push_back({"link", {}, {}, {{"collision", {}, shape, surface}}});
  return model;
}

inline Pose at(double x, double y, double z, double yaw = 0.0) {
  return {{x, y, z}, Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()))};
}

/// Adds a copy of `model` under `name` and returns its index among the instances, which is its body.
inline std::uint32_t place(description::World& world, const description::Model& model, const std::string& name,
                           const Pose& X_WM) {
  const auto body = static_cast<std::uint32_t>(world.instances.size());
  if (model.is_robot()) world.robots.push_back(body);
  world.instances.push_back({name, world.models.size(), X_WM});
  world.models.push_back(model);
  return body;
}

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
