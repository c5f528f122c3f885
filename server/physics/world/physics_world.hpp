#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include "server/core/hash.hpp"
#include "server/core/snapshot.hpp"
#include "server/core/worker_pool.hpp"
#include "server/description/world.hpp"
#include "server/geometry/scene/scene.hpp"

namespace cohort::physics {

/// Two bodies that touched during the last step.
struct Contact {
  std::uint32_t body_a = 0;
  std::uint32_t body_b = 0;
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

/// What the tracks of one treel drive do, relative to the hull.
struct TrackState {
  double position = 0.0;  ///< way travelled since the world began [m]
  double velocity = 0.0;  ///< [m/s]
  double traction = 0.0;  ///< force along the track over the last step [N]
};
enum class Side : std::uint8_t { left = 0, right = 1 };

struct Wrench {
  Eigen::Vector3d force_W;   ///< [N]
  Eigen::Vector3d torque_W;  ///< [N m]
};

/// What a connection bears before it breaks.
struct ConnectionLimits {
  double force = std::numeric_limits<double>::infinity();   ///< [N]
  double torque = std::numeric_limits<double>::infinity();  ///< [N m]
};

/// How a connection yields; with the defaults not at all. Axes are those of P on body a. Springs and dampers are
/// implicit, and so stable at any stiffness and step; what exceeds a limit slips: where it came to is its new rest.
struct ConnectionGive {
  static constexpr double rigid = std::numeric_limits<double>::infinity();

  double linear_stiffness = rigid;  ///< [N/m]
  double linear_damping = 0.0;      ///< beside a stiffness that is not rigid [N s/m]
  double holding_force = rigid;     ///< along each axis [N]
  Eigen::Vector3d angular_stiffness = Eigen::Vector3d::Constant(rigid);  ///< about each axis [N m/rad]
  Eigen::Vector3d angular_damping = Eigen::Vector3d::Zero();             ///< [N m s/rad]
  Eigen::Vector3d holding_torque = Eigen::Vector3d::Constant(rigid);     ///< 0: turns freely [N m]
};

/// A body that is no longer simulated: it stays where it was last, touches nothing and is seen by nobody.
struct Quarantine {
  enum class Reason : std::uint8_t {
    not_finite,  ///< its velocities left the numbers, or all that is sensible
    left_world,  ///< it fell below the lowest point or went further than 1,000 km
  };
  std::uint32_t body = 0;
  Reason reason = Reason::not_finite;
};

/// The moving part of a world: rigid multibodies in reduced coordinates, stepped by semi-implicit Euler with the
/// description's solver. Bodies are the instances of the description, under the same indices; links,
/// joints and devices keep their indices in the model. Poses and states are those of the last completed step. Setters
/// and `step` belong to one thread; getters may run from any thread between steps.
///
/// With Fidelity::planar bodies have a position and a heading only, on flat ground: planar_world.hpp says what of all
/// this is then different.
class World {
 public:
  virtual ~World() = default;

  /// Advances by one step of the description. The result depends on the state and the targets alone, not on the number
  /// of workers. A body whose state breaks is quarantined, and the others go on as if it had not been there.
  virtual void step() = 0;
  /// Those of the last step, in the order of the bodies.
  virtual std::span<const Quarantine> quarantined() const = 0;
  /// Whether the body is in the world: neither quarantined nor removed.
  virtual bool is_active(std::uint32_t body) const = 0;
  /// Whether steps leave the body as it is until something touches it: it has been still for half a second, with all
  /// that it hangs together with. Never of a static or a planar body.
  virtual bool is_asleep(std::uint32_t body) const = 0;

  /// Adds an instance of one of the description's models, which may have come since the world was built; between steps.
  /// Returns its body, the next free index. Throws std::invalid_argument for a model that cannot be simulated, or not
  /// there; nothing is changed then.
  virtual std::uint32_t add_body(std::size_t model, const Pose& X_WM) = 0;
  /// The same right before `restore`, which says where it is: one that the world of the snapshot was given in mid-run.
  virtual void recreate_body(std::size_t model, const Pose& X_WM) = 0;
  /// Takes a body out of the world, also one that is static: it touches nothing, is seen by nobody and does not move,
  /// and what connects it is released. Between steps, as the next three.
  virtual void remove_body(std::uint32_t body) = 0;
  /// A body that was removed or quarantined comes back as it was, at rest if it was quarantined.
  virtual void put_back_body(std::uint32_t body) = 0;
  /// Puts the whole model of a body at X_WM, at rest, with its joints as they are; connections are released. Throws
  /// std::invalid_argument where a planar body has no ground; it then stays where it was.
  virtual void place_body(std::uint32_t body, const Pose& X_WM) = 0;
  /// A force at the centre of mass of a link, and a torque, that act during the next step, besides others.
  virtual void push_body(std::uint32_t body, std::size_t link, const Wrench& wrench) = 0;

  virtual const geometry::Scene& scene() const = 0;
  virtual std::size_t body_count() const = 0;
  virtual std::size_t model_of(std::uint32_t body) const = 0;  ///< its index in the description

  virtual Pose link_pose(std::uint32_t body, std::size_t link) const = 0;    ///< X_WL
  virtual Twist link_twist(std::uint32_t body, std::size_t link) const = 0;  ///< zero for a static body
  virtual double joint_position(std::uint32_t body, std::size_t joint) const = 0;
  virtual double joint_velocity(std::uint32_t body, std::size_t joint) const = 0;
  virtual TrackState track(std::uint32_t body, std::size_t drive, Side side) const = 0;

  /// From the next step on keeps what `joint_wrench` and `link_acceleration` tell of a body that moves, which are zero
  /// otherwise. Between steps. None of the three is part of the state: after `restore`, and where a body was put
  /// elsewhere or is not in the world, both are zero until the end of the next step. A static body has neither.
  virtual void record(std::uint32_t body) = 0;
  /// On the joint's child by its parent over the last step, about the joint's origin, both as they were when the step
  /// began: all that goes through the joint, of motor, friction, damping, spring, limits and what the joint does not
  /// let move; also of a fixed joint. Zero for a planar body.
  virtual Wrench joint_wrench(std::uint32_t body, std::size_t joint) const = 0;
  /// Mean acceleration over the last step of a point that is fixed to a link, in world axes, gravity not taken out
  /// [m/s^2]: zero at rest, `gravity` in free fall.
  virtual Eigen::Vector3d link_acceleration(std::uint32_t body, std::size_t link,
                                            const Eigen::Vector3d& p_LP) const = 0;
  /// Of the joint's motor over the last step [N m] or [N]; 0 if it has none, and for a planar body.
  virtual double joint_effort(std::uint32_t body, std::size_t joint) const = 0;
  /// Mechanical power that the body's devices gave to what they move over the last step, joints, tracks, belts and
  /// rotors, each at its velocity at the end of the step; one that brakes counts as 0 [W].
  virtual double driven_power(std::uint32_t body) const = 0;

  /// Holds a link of `body_a`, which moves, to one of `body_b` as they are now, around the frame P of link a; from the
  /// next step on. Returns the connection's number, which counts up from 0. Between steps.
  virtual std::uint32_t connect(std::uint32_t body_a, std::size_t link_a, const Pose& X_LP, std::uint32_t body_b,
                                std::size_t link_b, const ConnectionLimits& limits = {}) = 0;
  virtual void disconnect(std::uint32_t connection) = 0;
  /// How many there ever were.
  virtual std::uint32_t connections_made() const = 0;
  virtual bool is_connected(std::uint32_t connection) const = 0;
  /// From the next step on; between steps.
  virtual void set_connection_give(std::uint32_t connection, const ConnectionGive& give) = 0;
  /// On link a by link b, about the origin of P on a, over the last step; what broke it if that was in the last step,
  /// otherwise zero if it does not hold.
  virtual Wrench connection_wrench(std::uint32_t connection) const = 0;
  /// The same on link b by link a, about the origin of P as b carries it.
  virtual Wrench connection_reaction(std::uint32_t connection) const = 0;
  /// The connections that broke in the last step, ascending.
  virtual std::span<const std::uint32_t> broken_connections() const = 0;

  /// For a joint that a motor drives, as the next two. The last of the three that was called is what the motor does.
  virtual void set_joint_velocity_target(std::uint32_t body, std::size_t joint, double velocity) = 0;
  /// Goes there, within the joint's limits, no faster than the motor may and so that it can brake in time with what
  /// effort the motor has beside gravity, and stays. Not of a ball joint.
  virtual void set_joint_position_target(std::uint32_t body, std::size_t joint, double position) = 0;
  /// A force or torque, no more than the motor may give [N m] or [N]. A planar joint stays where it is.
  virtual void set_joint_effort_target(std::uint32_t body, std::size_t joint, double effort) = 0;
  /// `drive`: index of a TreelDrive among the model's devices; velocity of the track over ground [m/s].
  virtual void set_track_velocity_target(std::uint32_t body, std::size_t drive, Side side, double velocity) = 0;

  /// Of a link that is a belt: of its surface along it [m/s].
  virtual void set_belt_velocity_target(std::uint32_t body, std::size_t link, double velocity) = 0;

  /// `device`: index of a Rotor among the model's devices; its velocity [rad/s].
  virtual double rotor_velocity(std::uint32_t body, std::size_t device) const = 0;
  /// What its velocity goes to, with its time constants [rad/s].
  virtual void set_rotor_velocity_target(std::uint32_t body, std::size_t device, double velocity) = 0;

  /// Of a root link that is free to move.
  virtual void set_root_twist(std::uint32_t body, const Twist& twist) = 0;
  /// An angle or a way and its velocity, one of each for every axis; of a ball joint the quaternion x y z w of the
  /// child in the parent and the angular velocity in the child's axes.
  virtual void set_joint_state(std::uint32_t body, std::size_t joint, std::span<const double> coordinates,
                               std::span<const double> velocities) = 0;

  /// Those between bodies that sleep first, each in the order of the bodies' solids: the same for any number of
  /// workers.
  virtual std::span<const Contact> contacts() const = 0;

  /// Adds all that decides how `body` goes on: pose, velocities, joints, tracks, targets, warm-start impulses.
  virtual void hash_body(std::uint32_t body, StateHash& hash) const = 0;
  /// Adds every contact point and every connection with what the solver's warm start takes from it.
  virtual void hash_contacts(StateHash& hash) const = 0;

  /// Everything that decides how the world goes on; between steps.
  virtual void save(SnapshotWriter& writer) const = 0;
  /// Into a world as it is after its construction, of the same description. Throws SnapshotError if the snapshot is of
  /// something else; the world is then not to be used.
  virtual void restore(SnapshotReader& reader) = 0;
};

}  // namespace cohort::physics
