#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "server/core/pose.hpp"
#include "server/description/emitter.hpp"

/// What an experiment says of the course of a run, as plain data. Objects are indices into World::instances; times are
/// simulated, and what is to happen at one happens at the first boundary that is not before it.
namespace cohort::description {

/// The object comes into the world, where it was or at first, or leaves it.
struct SetPresence {
  bool present = true;
  bool once = false;  ///< it comes for the first time, or leaves for good
};
/// At rest, with its joints as they are.
struct PlaceAt {
  Pose X_WM;
};
/// Of the root link, which has to be free to move.
struct SetVelocity {
  Eigen::Vector3d linear_W = Eigen::Vector3d::Zero();   ///< of its origin [m/s]
  Eigen::Vector3d angular_W = Eigen::Vector3d::Zero();  ///< [rad/s]
};
/// Acts on a link at its centre of mass.
struct ApplyForce {
  std::size_t link = 0;
  Eigen::Vector3d force_W = Eigen::Vector3d::Zero();   ///< [N]
  Eigen::Vector3d torque_W = Eigen::Vector3d::Zero();  ///< [N m]
  std::chrono::nanoseconds duration{0};
};
/// Acts on some of the object's emitters.
struct SetEmitters {
  std::vector<std::size_t> emitters;  ///< indices into Model::emitters
  EmitterChange change;
};
/// A new object comes, by one of Experiment::spawners.
struct SpawnNew {
  std::size_t spawner = 0;
};
using Effect = std::variant<SetPresence, PlaceAt, SetVelocity, ApplyForce, SetEmitters, SpawnNew>;

/// How many new objects the events of an experiment may bring together.
inline constexpr std::size_t most_spawned = 10'000;

/// Makes a new object each time an event asks for one, under a name of its own: `name` and the next number.
struct Spawner {
  std::string name;       ///< `late` makes late_1, late_2 ...; a number whose name is taken is left out
  std::size_t model = 0;  ///< index into World::models
  Pose X_WM;
  Eigen::Vector2d area = Eigen::Vector2d::Zero();  ///< edges of the rectangle about X_WM that objects are put in [m]
  std::string team{};                              ///< of a robot
  std::size_t most = 100;                          ///< objects in a run, >= 1
};

struct Event {
  std::chrono::nanoseconds time{0};
  std::size_t object = 0;  ///< means nothing where a new one comes
  Effect effect;
  std::string kind;  ///< as the file calls it
};

/// What happens whenever one of some robots begins an action.
struct Reaction {
  std::string action;                 ///< name of the UserAction
  std::vector<std::uint32_t> robots;  ///< ids, ascending, of those that have it
  std::vector<Event> events;          ///< all at once, in this order; their times mean nothing
};

/// All of the objects that are in the world, and at least one, have the origins of their root links in a rectangle.
struct AllInside {
  Eigen::Vector2d lower = Eigen::Vector2d::Zero();  ///< [m]
  Eigen::Vector2d upper = Eigen::Vector2d::Zero();
};
/// The origin of the root link of one of the objects in the world is beyond a line.
struct OneBeyond {
  Eigen::Vector2d point = Eigen::Vector2d::Zero();       ///< of the line [m]
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();  ///< at right angles to the line; any length
};
/// The root links of all of the objects in the world are slower than this.
struct AllAtRest {
  double speed = 0.0;      ///< [m/s]
  double turn_rate = 0.0;  ///< [rad/s]
};
struct OneQuarantined {};

/// When a run ends before its duration is over.
struct StopCondition {
  std::string name;  ///< for people, such as `inside`
  std::vector<std::size_t> objects;
  std::variant<AllInside, OneBeyond, AllAtRest, OneQuarantined> what;
  std::chrono::nanoseconds holds_for{0};  ///< at every boundary of so long a time
};

enum class Quantity {
  position,      ///< of the root link: x, y, z [m]
  pose,          ///< the same, and the quaternion x y z w
  heading,       ///< of the root link's x axis in the plane, from that of the world [rad]
  velocity,      ///< of the root link's origin [m/s]
  count,         ///< how many of the objects are in the world
  quarantined,   ///< how many of the objects have been quarantined
  joint_force,   ///< of a breakable joint: on the first link, then on the second, x, y, z of the world [N]
  joint_torque,  ///< the same [N m]
};

/// What is printed in a run.
struct PrintedQuantity {
  Quantity quantity = Quantity::position;
  std::string selector;  ///< of the objects, as written
  std::vector<std::size_t> objects;
  std::vector<std::size_t> joints;  ///< indices into World::breakable_joints, where the quantity is of these
  std::chrono::nanoseconds every{0};
};

/// Of which objects how many poses are kept.
struct History {
  std::vector<std::size_t> objects;  ///< ascending
  std::size_t length = 0;
  std::chrono::nanoseconds every{0};  ///< 0: every tick
};

/// What a recording holds beside what replays the run. Rates are of simulated time, in whole ticks; 0: none.
struct Recorded {
  double pose_rate = 10.0;              ///< of every object that moves [Hz]
  double joint_rate = 0.0;              ///< of joint states, and of the poses of all links [Hz]
  double observation_rate = 0.0;        ///< at the most, and no more often than the robot is asked [Hz]
  std::vector<std::uint32_t> observed;  ///< robots, ascending
  std::vector<std::string> selectors;   ///< of the robots observed, as written; empty: all
  std::chrono::nanoseconds snapshot_interval = std::chrono::seconds(30);
};

}  // namespace cohort::description
