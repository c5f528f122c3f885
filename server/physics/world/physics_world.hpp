#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>

#include "server/core/ids.hpp"
#include "server/core/worker_pool.hpp"
#include "server/description/world.hpp"
#include "server/geometry/scene/scene.hpp"
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
  double distance = 0.0;      ///< [m], negative: they overlap
  double impulse = 0.0;       ///< along the normal over the step [N s]
  std::uint32_t solid_a = 0;  ///< of body a, in the scene
  std::uint32_t solid_b = 0;
};

struct Twist {
  Eigen::Vector3d angular_W;  ///< [rad/s]
  Eigen::Vector3d linear_W;   ///< of the link's origin [m/s]
};

/// What an output of a device does, relative to the link that it is on: a track, a belt or a rotor.
struct OutputState {
  double position = 0.0;  ///< way of a track since the world began [m]; 0 for belts and rotors, which do not count it
  double velocity = 0.0;  ///< of the surface of a track or a belt [m/s], of a rotor [rad/s]
  double effort = 0.0;  ///< force along a track or a belt over the last step [N]; torque of a rotor on its fluid [N m]
};

/// A joint and its motor. All is zero for a joint that is fixed and for a body that is static.
struct JointState {
  double position = 0.0;  ///< [rad] or [m]
  double velocity = 0.0;  ///< [rad/s] or [m/s]
  double effort = 0.0;    ///< of its motor over the last step [N m] or [N]; 0 without one, and for a planar body
};

/// What the motor of a joint does: the last that it was told.
struct JointTarget {
  enum class Kind : std::uint8_t {
    velocity,
    position,  ///< goes there, within the joint's limits, no faster than the motor may and so that it can brake in time
               ///< with what effort the motor has beside gravity, and stays; not of a ball joint
    effort,    ///< a force or torque, no more than the motor may give; a planar joint stays where it is
  };
  Kind kind = Kind::velocity;
  double value = 0.0;

  static JointTarget velocity(double value) { return {Kind::velocity, value}; }
  static JointTarget position(double value) { return {Kind::position, value}; }
  static JointTarget effort(double value) { return {Kind::effort, value}; }
};

/// How far the world simulates a body.
enum class Activity : std::uint8_t {
  out,     ///< it was quarantined or removed
  awake,   ///< also a static or a planar body, always
  asleep,  ///< steps leave it as it is until something touches it: it has been still for half a second, with all that
           ///< it hangs together with
};

/// Whether a body is new in its world, or was there in the world of a snapshot that is restored next.
enum class Arrival : std::uint8_t { anew, restored };

/// A body that is no longer simulated: it stays where it was last, touches nothing and is seen by nobody.
struct Quarantine {
  enum class Reason : std::uint8_t {
    not_finite,  ///< its velocities left the numbers, or all that is sensible
    left_world,  ///< it fell below the lowest point or went further than 1,000 km
  };
  BodyId body;
  Reason reason = Reason::not_finite;
};

/// The moving part of a world: rigid multibodies in reduced coordinates, stepped by semi-implicit Euler with the
/// description's solver. Bodies are the instances of the description, under the same indices; links,
/// joints and devices keep their indices in the model. Poses and states are those of the last completed step. Setters
/// and `step` belong to one thread; getters may run from any thread between steps.
///
/// With Fidelity::planar bodies have a position and a heading only, on flat ground: planar_world.hpp says what of all
/// this is then different.
class World : public WorldState, public WorldRecords {
 public:
  virtual ~World() = default;

  /// Advances by one step of the description. The result depends on the state and the targets alone, not on the number
  /// of workers. A body whose state breaks is quarantined, and the others go on as if it had not been there.
  virtual void step() = 0;
  /// Those of the last step, in the order of the bodies.
  virtual std::span<const Quarantine> quarantined() const = 0;
  virtual Activity activity(BodyId body) const = 0;
  bool is_active(BodyId body) const { return activity(body) != Activity::out; }
  bool is_asleep(BodyId body) const { return activity(body) == Activity::asleep; }

  /// Adds an instance of one of the description's models, which may have come since the world was built; between steps.
  /// Returns its body, the next free index. Throws std::invalid_argument for a model that cannot be simulated, or not
  /// there; nothing is changed then. With Arrival::restored `restore`, which says where it is, comes right after.
  virtual BodyId add_body(std::size_t model, const Pose& X_WM, Arrival arrival = Arrival::anew) = 0;
  /// Takes a body out of the world, also one that is static: it touches nothing, is seen by nobody and does not move,
  /// and what connects it is released. Or puts a body that was removed or quarantined back as it was, at rest if it was
  /// quarantined. Between steps, as the next two.
  virtual void set_present(BodyId body, bool is_present) = 0;
  /// Puts the whole model of a body at X_WM, at rest, with its joints as they are; connections are released. Throws
  /// std::invalid_argument where a planar body has no ground; it then stays where it was.
  virtual void place_body(BodyId body, const Pose& X_WM) = 0;
  /// A force at the centre of mass of a link, and a torque, that act during the next step, besides others.
  virtual void push_body(BodyId body, LinkId link, const Wrench& wrench) = 0;

  virtual const geometry::Scene& scene() const = 0;
  virtual std::size_t body_count() const = 0;
  virtual std::size_t model_of(BodyId body) const = 0;  ///< its index in the description

  virtual Pose link_pose(BodyId body, LinkId link) const = 0;    ///< X_WL
  virtual Twist link_twist(BodyId body, LinkId link) const = 0;  ///< zero for a static body
  virtual JointState joint_state(BodyId body, JointId joint) const = 0;
  /// What a device drives beside joints are its outputs: the left and the right track of a description::TrackPair, 0
  /// and 1; belts, in the order of description::belts_of; the rotor of a description::Thruster. Throws
  /// std::out_of_range for an output that the device does not have, as `set_device_target` does.
  virtual OutputState device_state(BodyId body, DeviceId device, std::size_t output) const = 0;

  virtual WorldConnections& connections() = 0;
  virtual const WorldConnections& connections() const = 0;

  /// For a joint that a motor drives.
  virtual void set_joint_target(BodyId body, JointId joint, const JointTarget& target) = 0;
  /// Sets the velocity that an output of a device goes to: of a track over ground or of the surface of a belt [m/s], at
  /// once but for the limits of the motor; of a rotor [rad/s], with its time constants.
  virtual void set_device_target(BodyId body, DeviceId device, std::size_t output, double velocity) = 0;

  /// Of a root link that is free to move.
  virtual void set_root_twist(BodyId body, const Twist& twist) = 0;
  /// An angle or a way and its velocity, one of each for every axis; of a ball joint the quaternion x y z w of the
  /// child in the parent and the angular velocity in the child's axes.
  virtual void set_joint_state(BodyId body, JointId joint, std::span<const double> coordinates,
                               std::span<const double> velocities) = 0;

  /// Those between bodies that sleep first, each in the order of the bodies' solids: the same for any number of
  /// workers.
  virtual std::span<const Contact> contacts() const = 0;
};

}  // namespace cohort::physics
