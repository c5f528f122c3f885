// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "server/core/ids.hpp"
#include "server/core/worker_pool.hpp"
#include "server/description/world.hpp"
#include "server/geometry/scene/scene.hpp"
#include "server/physics/world/convergence.hpp"
#include "server/physics/world/world_connections.hpp"
#include "server/physics/world/world_records.hpp"
#include "server/physics/world/world_state.hpp"

namespace cohort::physics {

/// Two bodies that touched during the last step.
struct Contact {
  BodyId body_a;
  BodyId body_b;
  Eigen::Vector3d position_W;
  Eigen::Vector3d normal_W;   ///< unit, from b towards a
  double distance = 0.0;      ///< [m]; negative if they overlap
  double impulse = 0.0;       ///< along the normal over the step [N s]
  std::uint32_t solid_a = 0;  ///< index in the scene, of body a
  std::uint32_t solid_b = 0;
};

struct Twist {
  Eigen::Vector3d angular_W;  ///< [rad/s]
  Eigen::Vector3d linear_W;   ///< at the link's origin [m/s]
};

/// The state of a device's output relative to its link: a track, a belt or a rotor.
struct OutputState {
  double position = 0.0;  ///< distance of a track since the world began [m]; 0 for belts and rotors
  double velocity = 0.0;  ///< surface velocity of a track or a belt [m/s]; velocity of a rotor [rad/s]
  double effort = 0.0;  ///< force along a track or a belt over the last step [N]; torque of a rotor on its fluid [N m]
};

/// The state of a joint and its motor. All values are zero for a fixed joint and for a static body.
struct JointState {
  double position = 0.0;  ///< [rad] or [m]
  double velocity = 0.0;  ///< [rad/s] or [m/s]
  double effort = 0.0;    ///< motor effort over the last step [N m] or [N]; 0 without a motor, and for a planar body
};

/// The last command to the motor of a joint.
struct JointTarget {
  enum class Kind : std::uint8_t {
    velocity,
    position,  ///< the joint moves to a position and stays there, within its limits and the motor's greatest velocity.
               ///< The motor brakes in time, with the effort that remains after gravity. Not for a ball joint
    effort,    ///< a force or torque, at most the motor's greatest effort; a planar joint does not move
  };
  Kind kind = Kind::velocity;
  double value = 0.0;  ///< [rad/s], [rad] or [N m]; for a prismatic joint [m/s], [m] or [N]

  static JointTarget velocity(double value) { return {Kind::velocity, value}; }
  static JointTarget position(double value) { return {Kind::position, value}; }
  static JointTarget effort(double value) { return {Kind::effort, value}; }
};

/// The extent to which the world simulates a body.
enum class Activity : std::uint8_t {
  out,     ///< quarantined or removed
  awake,   ///< static and planar bodies always are
  asleep,  ///< still for half a second, with all bodies coupled to it; steps skip it until something touches it
};

/// A body that is no longer simulated: it keeps its last pose, touches nothing and is invisible.
struct Quarantine {
  enum class Reason : std::uint8_t {
    not_finite,  ///< its velocities were not finite or far too large
    left_world,  ///< it fell below the lowest height or went further than 1,000 km
  };
  BodyId body;
  Reason reason = Reason::not_finite;
};

/// The moving part of a world: rigid multibodies in reduced coordinates, stepped by semi-implicit Euler with the solver
/// of the description. Bodies are the instances of the description and have the same indices; links, joints and devices
/// keep their indices in the model. Poses and states are those of the last completed step. Setters and `step` must be
/// called from one thread; getters may be called from any thread between steps.
///
/// With Fidelity::planar bodies have a position and a heading only, on flat ground; planar_world.hpp describes the
/// differences.
class World : public WorldState, public WorldRecords {
 public:
  virtual ~World() = default;

  /// Advances by one step of the description. The result depends only on the state and the targets, not on the number
  /// of workers. A body whose state breaks is quarantined, and the others continue as if it had not existed.
  virtual void step() = 0;
  /// Returns the bodies quarantined in the last step, in the order of the bodies.
  virtual std::span<const Quarantine> quarantined() const = 0;
  /// Returns how well steps were solved; nothing for Fidelity::planar and for other solvers than the convex one.
  virtual const Convergence& convergence() const = 0;
  virtual Activity activity(BodyId body) const = 0;
  bool is_active(BodyId body) const { return activity(body) != Activity::out; }
  bool is_asleep(BodyId body) const { return activity(body) == Activity::asleep; }

  /// Adds an instance of one of the description's models, possibly one added after the world was built. Called between
  /// steps. Returns its body, the next index. Throws std::invalid_argument for a model that cannot be simulated or
  /// placed there; nothing is changed then. `saved_slot`: for a body of a snapshot, the slot that it had there;
  /// `restore` must follow at once and sets its pose.
  virtual BodyId add_body(std::size_t model, const Pose& X_WM,
                          std::optional<std::uint32_t> saved_slot = std::nullopt) = 0;
  /// Removes a body, which may be static, from the world, or puts a removed or quarantined body back as it was. A
  /// removed body touches nothing, is invisible and does not move; its connections are released. A quarantined body is
  /// put back at rest. Called between steps.
  virtual void set_present(BodyId body, bool is_present) = 0;
  /// Frees the memory of a removed body, which can then not be put back. Its slot serves the next body of the same
  /// model. Its root link keeps its pose. Called between steps.
  virtual void release_body(BodyId body) = 0;
  /// Returns the slot of a body, the index of its memory; `released` for a released body. Other parts of a simulation
  /// index their arrays by slot, so that these do not grow while objects come and go.
  static constexpr std::uint32_t released = 0xffffffffu;
  virtual std::uint32_t slot_of(BodyId body) const = 0;
  /// Places the whole model of a body at X_WM, at rest, with its joints unchanged; its connections are released. Throws
  /// std::invalid_argument if a planar body has no ground there; its pose is then unchanged. Called between steps.
  virtual void place_body(BodyId body, const Pose& X_WM) = 0;
  /// Applies a force at the centre of mass of a link, and a torque, during the next step. Several pushes add up.
  virtual void push_body(BodyId body, LinkId link, const Wrench& wrench) = 0;

  virtual const geometry::Scene& scene() const = 0;
  virtual std::size_t body_count() const = 0;
  virtual std::size_t model_of(BodyId body) const = 0;  ///< index of the model in the description

  virtual Pose link_pose(BodyId body, LinkId link) const = 0;    ///< X_WL
  virtual Twist link_twist(BodyId body, LinkId link) const = 0;  ///< zero for a static body
  virtual JointState joint_state(BodyId body, JointId joint) const = 0;
  /// Returns the state of a device's output, which is anything that the device drives other than joints. A
  /// description::TrackPair has the left and the right track, 0 and 1. Belts are in the order of description::belts_of,
  /// and a description::Thruster has its rotor. Throws std::out_of_range for an output that the device does not have,
  /// as does `set_device_target`.
  virtual OutputState device_state(BodyId body, DeviceId device, std::size_t output) const = 0;

  virtual WorldConnections& connections() = 0;
  virtual const WorldConnections& connections() const = 0;

  /// Sets the command of a joint with a motor.
  virtual void set_joint_target(BodyId body, JointId joint, const JointTarget& target) = 0;
  /// Sets the target velocity of a device's output. A track over ground or the surface of a belt [m/s] takes it at
  /// once, within the limits of the motor; a rotor [rad/s] follows with its time constants.
  virtual void set_device_target(BodyId body, DeviceId device, std::size_t output, double velocity) = 0;

  /// Sets the velocity of a root link that is free to move.
  virtual void set_root_twist(BodyId body, const Twist& twist) = 0;
  /// Sets the state of a joint: for every axis, an angle or a displacement and its velocity. A ball joint has the
  /// quaternion x y z w of the child in the parent and the angular velocity in the child's axes.
  virtual void set_joint_state(BodyId body, JointId joint, std::span<const double> coordinates,
                               std::span<const double> velocities) = 0;

  /// Returns the contacts of the last step: first those between sleeping bodies, then the others, both in the order of
  /// the bodies' solids. The order does not depend on the number of workers.
  virtual std::span<const Contact> contacts() const = 0;
};

}  // namespace cohort::physics
