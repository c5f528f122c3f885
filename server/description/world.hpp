// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/description/kept_files.hpp"
#include "server/description/models.hpp"
#include "server/description/population.hpp"

namespace cohort::description {

/// An instance of a model: one copy of it with a pose.
struct Instance {
  std::string name;       ///< scoped, unique in the world, such as `explorers/sbot_7`
  std::size_t model = 0;  ///< index into World::models
  Pose X_WM;
  bool is_present = true;  ///< initially; otherwise an event of the experiment adds it
};

/// The level of detail of the simulated models (docs/fidelity.md).
enum class Fidelity {
  articulated,  ///< every joint and wheel
  treel,        ///< a treel drive replaces the wheels under it
  planar,       ///< flat ground: position and heading only
};

/// The solver for joints and contacts, island by island.
enum class Solver {
  iterative,  ///< sequential impulses, warm-started
  convex,     ///< Newton's method on a convex function of the velocities, down to its minimum
  direct,     ///< Dantzig's algorithm on the whole island
  hybrid,     ///< direct for islands of few bodies, iterative for others
};

/// The algorithm for forward dynamics and responses to impulses; both give the same results. Planar bodies need
/// neither.
enum class Dynamics {
  bullet,  ///< bodies of Bullet and its articulated-body algorithm
  cohort,  ///< mass matrix and factorisation of Cohort
};

struct PhysicsSettings {
  Fidelity fidelity = Fidelity::treel;
  Dynamics dynamics = Dynamics::bullet;
  Solver solver = Solver::convex;
  std::uint32_t iterations = 10;                             ///< maximum number, for the iterative solver
  std::uint32_t direct_bodies = 4;                           ///< largest island that the hybrid solver solves directly
  double lowest = -std::numeric_limits<double>::infinity();  ///< a body below this z has left the world [m]
  bool sleeping = true;                                      ///< steps skip bodies that have been at rest for a while
  bool strict = false;                                       ///< a body that breaks or leaves the world ends the run
};

/// The air far from all sources.
struct Climate {
  double temperature = 293.15;  ///< [K]
  double humidity = 0.5;        ///< relative [1]
};

/// The air around all bodies.
struct Air {
  double density = 1.225;                          ///< standard atmosphere at sea level [kg/m^3]
  Eigen::Vector3d wind = Eigen::Vector3d::Zero();  ///< the same everywhere [m/s]
  /// Force on links with wind enabled, per kilogram and per m/s of relative wind [1/s].
  double wind_force = 1.0;
};

/// Water, which fills everything below a height.
struct Water {
  double level = 0.0;                                 ///< z of the water surface [m]
  double density = 1000.0;                            ///< [kg/m^3]
  Eigen::Vector3d current = Eigen::Vector3d::Zero();  ///< the same everywhere [m/s]
};

/// Contact parameters of two materials, which replace those of the surfaces. The order does not matter, and a material
/// may be paired with itself.
struct MaterialPair {
  std::uint32_t first = 0;  ///< index into World::materials
  std::uint32_t second = 0;
  double friction = 1.0;
  double restitution = 0.0;
  double rolling_resistance = 0.0;  ///< [m]
};

/// A joint that fixes links of two objects in their initial relative pose until it is overloaded. At least one of the
/// two must not be static.
struct BreakableJoint {
  std::string name;
  std::size_t first = 0;  ///< index into World::instances
  std::size_t first_link = 0;
  std::size_t second = 0;
  std::size_t second_link = 0;
  std::optional<Pose> X_LP{};  ///< pose in the first link; at the origin of the second link if absent
  double breaking_force = std::numeric_limits<double>::infinity();   ///< [N]
  double breaking_torque = std::numeric_limits<double>::infinity();  ///< [N m]
  Problem first_place{};                              ///< position of the first object in the file, without a message
  Problem second_place{};                             ///< position of the second object
  JointType type = JointType::fixed;                  ///< or revolute, about `axis_P`; or ball
  Eigen::Vector3d axis_P = Eigen::Vector3d::UnitZ();  ///< unit; P: the frame of the joint
  double damping = 0.0;                               ///< about the axis, or every axis of a ball joint [N m s/rad]
};

/// A model from which events of an experiment create new objects.
struct SpawnableModel {
  std::string uri;        ///< as written in the experiment
  std::size_t model = 0;  ///< index into World::models
};

/// A world with all includes and populations expanded. The id of a robot is its index in `robots`.
struct World {
  std::string name;
  std::filesystem::path file;
  std::chrono::nanoseconds step{10'000'000};
  Eigen::Vector3d gravity{0.0, 0.0, -9.81};                            ///< [m/s^2]
  Eigen::Vector3d magnetic_field{5.5645e-6, 22.8758e-6, -42.3884e-6};  ///< the same everywhere; SDF's default [T]
  PhysicsSettings physics;
  Climate climate;
  Air air;
  std::optional<Water> water{};
  std::vector<std::string> materials{""};  ///< 0 is for collisions without a material
  std::vector<MaterialPair> material_pairs;
  Models models;
  /// Instances with a pose in the file come first, then those of the populations in their order, then those that events
  /// of an experiment add.
  std::vector<Instance> instances;
  std::vector<Population> populations;
  std::vector<BreakableJoint> breakable_joints;
  std::vector<SpawnableModel> spawnable_models{};
  std::vector<std::size_t> robots;  ///< indices into `instances`, in their order
  std::vector<Problem> warnings;    ///< features of the file that are not simulated
  std::size_t seed_warnings = 0;    ///< number of warnings at the end that depend on the seed
  std::size_t replaced_meshes = 0;  ///< number of missing mesh files whose collisions were replaced or left out

  const Instance& robot(std::uint32_t id) const { return instances[robots[id]]; }
  const Model& robot_model(std::uint32_t id) const { return models[robot(id).model]; }
};

}  // namespace cohort::description
