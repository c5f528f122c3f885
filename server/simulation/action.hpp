// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "server/core/pose.hpp"
#include "server/description/parsed_model.hpp"

/// An operation on a running world at a boundary, as plain data. Objects are identified by their scoped names; poses,
/// forces and velocities are in the world frame W, in SI units. `Simulation::act` carries it out or says why it cannot.
/// Names follow simulation_interfaces (ros-simulation).
namespace cohort {

/// The name of one of the world's models, or a parsed model. A running world does not parse models itself.
using ModelChoice = std::variant<std::string, description::ParsedModelPtr>;

/// Adds an object at rest. A robot gets the next id, which is never reused, and joins a team.
struct SpawnObject {
  std::string name;  ///< scoped; empty: the model's name
  ModelChoice model;
  Pose X_WM;                    ///< pose of the model
  bool allow_renaming = false;  ///< if the name is taken, a number is appended
  std::string team{};           ///< for a robot; empty: the only team, or the only one with robots of this model
};
/// Removes an object for good.
struct RemoveObject {
  std::string name;
};
/// Moves an object and stops it; its joints keep their positions.
struct SetPose {
  std::string name;
  Pose X_WM;
};
/// Sets the velocity of the root link, which must be free to move.
struct SetVelocity {
  std::string name;
  Eigen::Vector3d linear_W = Eigen::Vector3d::Zero();   ///< velocity of its origin [m/s]
  Eigen::Vector3d angular_W = Eigen::Vector3d::Zero();  ///< [rad/s]
};
/// Sets the light `object/light`, all lights of an object, or a light of the world.
struct SetLight {
  std::string name;
  bool on = true;
  std::optional<double> intensity{};       ///< >= 0 [1]; unchanged if absent
  std::optional<Eigen::Vector3d> color{};  ///< red, green and blue from 0 to 1; unchanged if absent
};
/// Applies a force at a link's centre of mass, from this boundary on.
struct ApplyForce {
  std::string name;
  std::string link;                                    ///< empty: the root link
  Eigen::Vector3d force_W = Eigen::Vector3d::Zero();   ///< [N]
  Eigen::Vector3d torque_W = Eigen::Vector3d::Zero();  ///< [N m]
  std::chrono::nanoseconds duration{0};                ///< rounded up to whole steps, at least one
};
using Action = std::variant<SpawnObject, RemoveObject, SetPose, SetVelocity, SetLight, ApplyForce>;

/// Returns the bytes for recordings and the wire: little-endian, and the same for equal actions.
std::vector<std::byte> to_bytes(const Action& action);
/// Parses an action. Parses the text of a model in it with `read_model`. Throws std::invalid_argument if `bytes` are
/// not exactly one action, or the text is not a model. The action's values are validated by `Simulation::act`.
Action action_from_bytes(std::span<const std::byte> bytes, const description::ModelReader& read_model);

}  // namespace cohort
