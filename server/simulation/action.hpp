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

/// What a person or a program may do to a running world, at a boundary, as plain data. Objects are called by their
/// scoped names; poses, forces and velocities are of the world frame W, in SI units. `Simulation::act` does it and says
/// why it cannot be done. Names follow simulation_interfaces (ros-simulation).
namespace cohort {

/// The name of one of the world's models, or a model that somebody has read: a world that runs reads none.
using ModelChoice = std::variant<std::string, description::ParsedModelPtr>;

/// A new object, at rest. A robot gets the next id, which was never another's, and joins a team.
struct SpawnObject {
  std::string name;  ///< scoped; empty: that of the model
  ModelChoice model;
  Pose X_WM;                    ///< of the model
  bool allow_renaming = false;  ///< a name that is taken gets a number
  std::string team{};           ///< of a robot; empty: the only team, or the only one with robots of this model
};
/// Out of the world, for good.
struct RemoveObject {
  std::string name;
};
/// At rest, with its joints as they are.
struct SetPose {
  std::string name;
  Pose X_WM;
};
/// Of the root link, which has to be free to move.
struct SetVelocity {
  std::string name;
  Eigen::Vector3d linear_W = Eigen::Vector3d::Zero();   ///< of its origin [m/s]
  Eigen::Vector3d angular_W = Eigen::Vector3d::Zero();  ///< [rad/s]
};
/// Of `object/light`, of all lights of an object, or of a light of the world.
struct SetLight {
  std::string name;
  bool on = true;
  std::optional<double> intensity{};       ///< >= 0 [1]; stays as it is if absent
  std::optional<Eigen::Vector3d> color{};  ///< red, green and blue from 0 to 1
};
/// At a link's centre of mass, from this boundary on.
struct ApplyForce {
  std::string name;
  std::string link;                                    ///< empty: the root link
  Eigen::Vector3d force_W = Eigen::Vector3d::Zero();   ///< [N]
  Eigen::Vector3d torque_W = Eigen::Vector3d::Zero();  ///< [N m]
  std::chrono::nanoseconds duration{0};                ///< at least one step, and whole ones
};
using Action = std::variant<SpawnObject, RemoveObject, SetPose, SetVelocity, SetLight, ApplyForce>;

/// For recordings and the wire: little-endian, and the same bytes for the same action.
std::vector<std::byte> to_bytes(const Action& action);
/// Reads an action, and by `read_model` the text of a model in it. Throws std::invalid_argument if `bytes` are not
/// exactly one action, or the text is no model. Whether the action's values make sense, `Simulation::act` says.
Action action_from_bytes(std::span<const std::byte> bytes, const description::ModelReader& read_model);

}  // namespace cohort
