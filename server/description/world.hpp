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

/// One placed copy of a model.
struct Instance {
  std::string name;       ///< scoped, unique in the world, such as `explorers/sbot_7`
  std::size_t model = 0;  ///< index into World::models
  Pose X_WM;
  bool is_present = true;  ///< from the beginning; otherwise an event of the experiment brings it
};

/// What is simulated of a model (docs/fidelity.md).
enum class Fidelity {
  articulated,  ///< every joint and wheel
  treel,        ///< a treel drive stands for the wheels under it
  planar,       ///< flat ground: position and heading only
};

/// How joints and contacts are solved, island by island.
enum class Solver {
  iterative,  ///< sequential impulses, warm-started
  direct,     ///< Dantzig's algorithm on the whole island
  hybrid,     ///< direct for islands of few bodies, iterative for others
};

/// How bodies come by their velocities, and answer impulses: two ways to the same numbers. Planar bodies need neither.
enum class Dynamics {
  bullet,  ///< bodies of Bullet and its articulated-body algorithm
  cohort,  ///< our own mass matrix and its factors
};

struct PhysicsSettings {
  Fidelity fidelity = Fidelity::treel;
  Dynamics dynamics = Dynamics::bullet;
  Solver solver = Solver::iterative;
  std::uint32_t iterations = 10;                             ///< of the iterative solver, at the most
  std::uint32_t direct_bodies = 4;                           ///< hybrid: the largest island that is solved directly
  double lowest = -std::numeric_limits<double>::infinity();  ///< a body below this z has left the world [m]
  bool sleeping = true;                                      ///< steps pass over what has been still for a while
  bool strict = false;                                       ///< a body that breaks or leaves the world ends the run
};

/// The air where no source is near.
struct Climate {
  double temperature = 293.15;  ///< [K]
  double humidity = 0.5;        ///< relative [1]
};

/// The air that bodies move in.
struct Air {
  double density = 1.225;                          ///< of the standard atmosphere at sea level [kg/m^3]
  Eigen::Vector3d wind = Eigen::Vector3d::Zero();  ///< the same everywhere [m/s]
  /// Of links that feel the wind: force for each kilogram and m/s of wind that passes them [1/s].
  double wind_force = 1.0;
};

/// All below a height, and all that is there.
struct Water {
  double level = 0.0;                                 ///< z of its surface [m]
  double density = 1000.0;                            ///< [kg/m^3]
  Eigen::Vector3d current = Eigen::Vector3d::Zero();  ///< the same everywhere [m/s]
};

/// What holds between two materials in place of the surfaces' own coefficients. Either order; a material may be paired
/// with itself.
struct MaterialPair {
  std::uint32_t first = 0;  ///< index into World::materials
  std::uint32_t second = 0;
  double friction = 1.0;
  double restitution = 0.0;
  double rolling_resistance = 0.0;  ///< [m]
};

/// Links of two objects, held together as they stand at first until that takes too much. One of the two moves.
struct BreakableJoint {
  std::string name;
  std::size_t first = 0;  ///< index into World::instances
  std::size_t first_link = 0;
  std::size_t second = 0;
  std::size_t second_link = 0;
  std::optional<Pose> X_LP{};  ///< where it is, in the first link; at the origin of the second one if absent
  double breaking_force = std::numeric_limits<double>::infinity();   ///< [N]
  double breaking_torque = std::numeric_limits<double>::infinity();  ///< [N m]
  Problem first_place{};   ///< where a file names the first object, without a message
  Problem second_place{};  ///< the same of the second one
};

/// A model of which events of an experiment bring new objects.
struct SpawnableModel {
  std::string uri;        ///< as the experiment has it
  std::size_t model = 0;  ///< index into World::models
};

/// A world with every include and population expanded. A robot's id is its place in `robots`.
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
  std::vector<std::string> materials{""};  ///< 0 is of all that names none
  std::vector<MaterialPair> material_pairs;
  Models models;
  /// First those that stand where a file says, then those of the populations in their order, then those that events of
  /// an experiment bring.
  std::vector<Instance> instances;
  std::vector<Population> populations;
  std::vector<BreakableJoint> breakable_joints;
  std::vector<SpawnableModel> spawnable_models{};
  std::vector<std::size_t> robots;  ///< indices into `instances`, in their order
  std::vector<Problem> warnings;    ///< what the file asks for and is not simulated
  std::size_t seed_warnings = 0;    ///< how many of the last warnings depend on the seed

  const Instance& robot(std::uint32_t id) const { return instances[robots[id]]; }
  const Model& robot_model(std::uint32_t id) const { return models[robot(id).model]; }
};

}  // namespace cohort::description
