// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "server/description/world.hpp"

/// Helpers for worlds that are built in code instead of read from files, for benchmarks, figures and tests.
namespace cohort::description {

inline Pose at(double x, double y, double z, double yaw = 0.0) {
  return {{x, y, z}, Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()))};
}

/// Returns the inertia of an upright cylinder; `z` is the height of its centre in the link.
inline Inertial solid_cylinder(double mass, double radius, double length, double z) {
  const double across = mass * (3.0 * radius * radius + length * length) / 12.0;
  const double along = mass * radius * radius / 2.0;
  Inertial inertial;
  inertial.mass = mass;
  inertial.X_LI.position.z() = z;
  inertial.inertia = Eigen::Vector3d(across, across, along).asDiagonal();
  return inertial;
}

inline Inertial solid_sphere(double mass, double radius) {
  Inertial inertial;
  inertial.mass = mass;
  inertial.inertia = 0.4 * mass * radius * radius * Eigen::Matrix3d::Identity();
  return inertial;
}

/// Returns a static model of one link with these collisions, of which there may be none for a model with only emitters.
inline Model static_model(std::string name, std::vector<Collision> collisions = {}) {
  Model model;
  model.name = std::move(name);
  model.is_static = true;
  model.links.push_back({"link", {}, {}, std::move(collisions)});
  return model;
}

inline Model static_shape(std::string name, const Shape& shape, const Surface& surface = {}) {
  return static_model(std::move(name), {{"collision", {}, shape, surface}});
}

/// Adds an instance; returns its index, which is that of its body.
inline std::uint32_t place(World& world, std::size_t model, std::string name, const Pose& X_WM) {
  const auto body = static_cast<std::uint32_t>(world.instances.size());
  if (world.models[model].is_robot()) world.robots.push_back(body);
  world.instances.push_back({std::move(name), model, X_WM});
  return body;
}

/// Does the same with a separate model.
inline std::uint32_t place(World& world, Model model, std::string name, const Pose& X_WM) {
  world.models.push_back(std::move(model));
  return place(world, world.models.size() - 1, std::move(name), X_WM);
}

}  // namespace cohort::description
