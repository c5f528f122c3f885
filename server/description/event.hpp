// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "server/core/pose.hpp"
#include "server/description/emitter.hpp"

/// Events, stop conditions and outputs of an experiment, as plain data. Objects are indices into World::instances.
/// Times are simulated; an event happens at the first boundary (the instant between two ticks) that is not before its
/// time.
namespace cohort::description {

/// Adds the object to the world, at its last or initial pose, or removes it.
struct SetPresence {
  bool present = true;
  bool once = false;  ///< the object appears for the first time, or is removed permanently
};
/// Moves the object to a pose, at rest, with unchanged joint positions.
struct PlaceAt {
  Pose X_WM;
};
/// Sets the velocity of the root link, which must be free to move.
struct SetVelocity {
  Eigen::Vector3d linear_W = Eigen::Vector3d::Zero();   ///< velocity of its origin [m/s]
  Eigen::Vector3d angular_W = Eigen::Vector3d::Zero();  ///< [rad/s]
};
/// Applies a force to a link at its centre of mass.
struct ApplyForce {
  std::size_t link = 0;
  Eigen::Vector3d force_W = Eigen::Vector3d::Zero();   ///< [N]
  Eigen::Vector3d torque_W = Eigen::Vector3d::Zero();  ///< [N m]
  std::chrono::nanoseconds duration{0};
};
/// Changes some of the emitters of the object.
struct SetEmitters {
  std::vector<std::size_t> emitters;  ///< indices into Model::emitters
  EmitterChange change;
};
/// Creates a new object with one of Experiment::spawners.
struct SpawnNew {
  std::size_t spawner = 0;
};
using Effect = std::variant<SetPresence, PlaceAt, SetVelocity, ApplyForce, SetEmitters, SpawnNew>;

/// Maximum number of objects that the events of an experiment can create in total.
inline constexpr std::size_t most_spawned = 10'000;

/// A source of new objects: each event that uses it creates one, named `name` and the next number.
struct Spawner {
  std::string name;       ///< `late` gives late_1, late_2 ...; numbers of names in use are skipped
  std::size_t model = 0;  ///< index into World::models
  Pose X_WM;
  Eigen::Vector2d area =
      Eigen::Vector2d::Zero();  ///< size of a rectangle centred on X_WM in which objects are placed [m]
  std::string team{};           ///< team of a new robot
  std::size_t most = 100;       ///< objects in a run, >= 1
};

struct Event {
  std::chrono::nanoseconds time{0};
  std::size_t object = 0;  ///< not used for a new object
  Effect effect;
  std::string kind;  ///< name of the kind in the file
};

/// The events that happen each time one of some robots begins an action.
struct Reaction {
  std::string action;                 ///< name of the UserAction
  std::vector<std::uint32_t> robots;  ///< ids, ascending, of the robots that have it
  std::vector<Event> events;          ///< all at the same time, in this order; their times are not used
};

/// At least one of the objects is in the world, and the origins of the root links of all that are in the world lie
/// inside a rectangle.
struct AllInside {
  Eigen::Vector2d lower = Eigen::Vector2d::Zero();  ///< [m]
  Eigen::Vector2d upper = Eigen::Vector2d::Zero();
};
/// The origin of the root link of one of the objects in the world is beyond a line.
struct OneBeyond {
  Eigen::Vector2d point = Eigen::Vector2d::Zero();       ///< on the line [m]
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();  ///< perpendicular to the line; any length
};
/// The root links of all of the objects in the world are slower than this.
struct AllAtRest {
  double speed = 0.0;      ///< [m/s]
  double turn_rate = 0.0;  ///< [rad/s]
};
struct OneQuarantined {};

/// A condition that ends a run before its duration is over.
struct StopCondition {
  std::string name;  ///< for display, such as `inside`
  std::vector<std::size_t> objects;
  std::variant<AllInside, OneBeyond, AllAtRest, OneQuarantined> what;
  std::chrono::nanoseconds holds_for{0};  ///< time for which it must hold, at every boundary
};

enum class Quantity {
  position,      ///< x, y, z of the root link [m]
  pose,          ///< the same, and the quaternion x y z w
  heading,       ///< angle in the plane from the x axis of the world to that of the root link [rad]
  velocity,      ///< velocity of the origin of the root link [m/s]
  count,         ///< number of the objects in the world
  quarantined,   ///< number of the objects that have been quarantined
  joint_force,   ///< force of a breakable joint on the first link, then on the second: x, y, z in the world frame [N]
  joint_torque,  ///< the same [N m]
};

/// A quantity that is printed during a run.
struct PrintedQuantity {
  Quantity quantity = Quantity::position;
  std::string selector;  ///< selector of the objects, as written
  std::vector<std::size_t> objects;
  std::vector<std::size_t> joints;  ///< indices into World::breakable_joints, for quantities of joints
  std::chrono::nanoseconds every{0};
};

/// Objects whose most recent poses are kept, and how many.
struct History {
  std::vector<std::size_t> objects;  ///< ascending
  std::size_t length = 0;
  std::chrono::nanoseconds every{0};  ///< 0 for every tick
};

/// Contents of a recording in addition to the data that replays the run. Rates are in simulated time, rounded to whole
/// ticks; 0 means none.
struct Recorded {
  double pose_rate = 10.0;              ///< for every object that moves [Hz]
  double joint_rate = 0.0;              ///< for joint states and the poses of all links [Hz]
  double observation_rate = 0.0;        ///< maximum; never more than the controller of the robot receives [Hz]
  std::vector<std::uint32_t> observed;  ///< robots, ascending
  std::vector<std::string> selectors;   ///< selectors of the observed robots, as written; empty for all
  std::chrono::nanoseconds snapshot_interval = std::chrono::seconds(30);
};

}  // namespace cohort::description
