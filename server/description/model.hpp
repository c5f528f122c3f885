#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "server/description/shape.hpp"

/// A model as plain data, read once and never changed. SI units; radians; frames as in SDFormat: M the model, L a link,
/// C a collision, J a joint, S a sensor. A member `X_AB` is the pose of frame B in frame A.
namespace cohort::description {

/// Of two surfaces that touch, unless the world has a MaterialPair for them: the smaller friction, the larger
/// restitution and the larger rolling resistance.
struct Surface {
  double friction = 1.0;            ///< Coulomb coefficient [1]
  double restitution = 0.0;         ///< share of the normal velocity that comes back [1]
  double rolling_resistance = 0.0;  ///< torque against rolling for each newton of normal force [m]
  std::uint32_t material = 0;       ///< index into World::materials
};

struct Collision {
  std::string name;
  Pose X_LC;
  Shape shape;
  Surface surface;
};

struct Inertial {
  double mass = 1.0;                                      ///< [kg], > 0
  Pose X_LI;                                              ///< I: the centre of mass and the axes of `inertia`
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Identity();  ///< about the centre of mass, in I [kg m^2]
};

struct Link {
  std::string name;
  Pose X_ML;
  Inertial inertial;
  std::vector<Collision> collisions;
};

enum class JointType { fixed, revolute, prismatic, ball, universal };

/// One direction in which a joint turns [rad] or slides [m].
struct JointAxis {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();     ///< unit vector in J
  double lower = -std::numeric_limits<double>::infinity();  ///< [rad] or [m]
  double upper = std::numeric_limits<double>::infinity();
  double damping = 0.0;           ///< [N m s/rad] or [N s/m]
  double friction = 0.0;          ///< Coulomb friction of the joint [N m] or [N]
  double spring_stiffness = 0.0;  ///< [N m/rad] or [N/m]
  double spring_reference = 0.0;  ///< where the spring is at rest [rad] or [m]
};

/// Joins two links of the same model, or a link and the world. Links form a tree: every link is the child of at most
/// one joint.
struct Joint {
  static constexpr std::size_t world = std::numeric_limits<std::size_t>::max();

  std::string name;
  JointType type = JointType::fixed;
  std::size_t parent = 0;  ///< index into Model::links, or `world`
  std::size_t child = 0;   ///< index into Model::links
  Pose X_LJ;               ///< in the child link
  JointAxis axis;          ///< of a revolute, prismatic or universal joint; of a ball only damping and friction
  JointAxis second_axis;   ///< of a universal joint: the one that moves with the first, fixed in the child
};

/// Two tracks that share one rigid body ("treels", tracks and wheels of the s-bot): drawn as four ground points, two a
/// side. Commands `NAME/left/velocity` and `NAME/right/velocity` [m/s].
struct TreelDrive {
  std::string name;
  std::size_t link = 0;
  double half_gauge = 0.0;           ///< |y| of the ground points in the link's frame [m]
  double half_contact_length = 0.0;  ///< |x| of the ground points [m]
  double ground_height = 0.0;        ///< z of the ground points [m]
  double wheel_radius = 0.0;         ///< from motor torque to traction [m]
  double max_torque = 0.0;           ///< per side [N m]
  double max_velocity = 0.0;         ///< of the ground points [m/s]
  double friction = 0.0;             ///< Coulomb coefficient of the tracks; a pair has the smaller of the two

  /// The joints of the real wheels that this stands for. Where wheels are simulated (Fidelity::articulated) their
  /// motors are the drive; elsewhere they are welded to the link, and their collisions are none.
  std::vector<std::size_t> left_wheels{};
  std::vector<std::size_t> right_wheels{};
};

/// A motor with a velocity loop on one joint, on the first axis of a universal one. Command `NAME/0/velocity` [rad/s]
/// or [m/s].
struct VelocityMotor {
  std::string name;
  std::size_t joint = 0;
  double max_velocity = 0.0;
  double max_effort = 0.0;  ///< [N m] or [N]
};

/// Position and velocity of one joint: observations `NAME/0/position` and `NAME/0/velocity`.
struct JointEncoder {
  std::string name;
  std::size_t joint = 0;
};

/// Way and velocity of each track relative to the hull: observations `NAME/left/position` [m], `NAME/left/velocity`
/// [m/s] and the same of the right.
struct TreelEncoder {
  std::string name;
  std::size_t drive = 0;  ///< index into Model::devices of a TreelDrive
};

/// A ring of infrared proximity sensors in the xy plane of S, looking outwards, numbered counter-clockwise from
/// `first_bearing`. Observations `NAME/I/reading`: 1 at contact, falling linearly to 0 at `range`.
struct ProximityRing {
  std::string name;
  std::size_t link = 0;
  Pose X_LS;
  std::size_t count = 0;
  double first_bearing = 0.0;  ///< of sensor 0, from the x axis of S [rad]
  double spacing = 0.0;        ///< between neighbours [rad]
  double ring_radius = 0.0;    ///< where the rays start [m]
  double range = 0.0;          ///< from there [m]
  double noise = 0.0;          ///< standard deviation of the Gaussian noise on a reading [1]
};

using Device = std::variant<TreelDrive, VelocityMotor, JointEncoder, TreelEncoder, ProximityRing>;

/// Links in an order in which every parent comes before its children; link 0 is the root, which is free to move unless
/// a joint ties it to the world. Devices in document order, which is the order of their channels. A static model has
/// neither joints nor devices, and its links stay at X_ML.
struct Model {
  std::string name;
  bool is_static = false;
  bool self_collide = false;  ///< links of one instance collide with each other, but for those that a joint connects
  std::vector<Link> links;
  std::vector<Joint> joints;
  std::vector<Device> devices;

  /// A robot is a model that can be observed or commanded.
  bool is_robot() const { return !devices.empty(); }
};

}  // namespace cohort::description
