#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "server/description/devices.hpp"
#include "server/description/emitter.hpp"
#include "server/description/shape.hpp"

/// A model as plain data, read once and never changed. SI units; radians; frames as in SDFormat: M the model, L a link,
/// C a collision, J a joint, S a sensor. A member `X_AB` is the pose of frame B in frame A.
namespace cohort::description {

/// Of two surfaces that touch: the smaller friction, the larger restitution and the larger rolling resistance, unless
/// the world has a MaterialPair for them; the larger spinning resistance. Of friction that has a direction that of the
/// surface with the smaller coefficient along it holds, and the smaller coefficient across it. Springs in series, and
/// the sum of the dampings. The larger bounce threshold of those that are given.
struct Surface {
  double friction = 1.0;             ///< Coulomb coefficient [1]
  double restitution = 0.0;          ///< share of the normal velocity that comes back [1]
  double rolling_resistance = 0.0;   ///< torque against rolling for each newton of normal force [m]
  double spinning_resistance = 0.0;  ///< torque against turning about the normal, for each newton of it [m]
  std::uint32_t material = 0;        ///< index into World::materials
  bool is_grippable = false;         ///< by a gripper, anywhere
  /// Along which `friction` holds, a unit vector in C; zero: in every direction.
  Eigen::Vector3d friction_direction = Eigen::Vector3d::Zero();
  double second_friction = 1.0;                                ///< Coulomb coefficient across that direction [1]
  double stiffness = std::numeric_limits<double>::infinity();  ///< of each point of contact [N/m]
  double damping = 1.0;                                        ///< beside a stiffness [N s/m]
  std::optional<double> bounce_threshold{};                    ///< slower than this nothing bounces [m/s]
  std::uint16_t category_bitmask = every_bit;
  std::uint16_t collide_bitmask = every_bit;

  static constexpr std::uint16_t every_bit = 0xFFFF;
  bool has_direction() const { return !friction_direction.isZero(0.0); }
};

/// By SDF's rule for bitmasks: one is of a category with which the other collides.
inline bool may_collide(const Surface& a, const Surface& b) {
  return ((a.category_bitmask & b.collide_bitmask) | (b.category_bitmask & a.collide_bitmask)) != 0;
}

struct Collision {
  std::string name;
  Pose X_LC;
  Shape shape;
  Surface surface;
};

/// What is shown of a link: to people, never to sensors.
struct Visual {
  std::string name;
  Pose X_LV;
  Shape shape;
  Eigen::Vector4d color;   ///< red, green, blue and opacity, from 0 to 1
  bool has_color = false;  ///< it was written: otherwise a mesh has the colours of its file, if there are any
};

struct Inertial {
  double mass = 1.0;                                      ///< [kg], > 0
  Pose X_LI;                                              ///< I: the centre of mass and the axes of `inertia`
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Identity();  ///< about the centre of mass, in I [kg m^2]
};

/// Of a link that does not say.
inline Eigen::Vector3d default_color() { return {0.5, 0.5, 0.5}; }

struct Link {
  std::string name;
  Pose X_ML;
  Inertial inertial;
  std::vector<Collision> collisions;
  Eigen::Vector3d color = default_color();  ///< for cameras: that of the first visual; red, green, blue from 0 to 1
  std::vector<Visual> visuals{};            ///< those whose shape can be read
  bool feels_wind = false;                  ///< SDF's enable_wind
  bool feels_gravity = true;                ///< SDF's gravity
  bool is_kinematic = false;                ///< of the root alone: nothing but commands changes how it moves
};

/// A circle that grippers hold on to, in the xy plane of R: the T-shaped ring around the turret of an s-bot.
struct GripRing {
  std::string name;
  std::size_t link = 0;
  Pose X_LR;
  double radius = 0.0;  ///< [m]
};

enum class JointType { fixed, revolute, prismatic, ball, universal, screw };

/// One direction in which a joint turns [rad] or slides [m].
struct JointAxis {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();     ///< unit vector in J
  double lower = -std::numeric_limits<double>::infinity();  ///< [rad] or [m]
  double upper = std::numeric_limits<double>::infinity();
  double limit_stiffness = std::numeric_limits<double>::infinity();  ///< of both limits [N m/rad] or [N/m]
  double limit_damping = 0.0;                                        ///< of limits that are not rigid, as `damping`
  double damping = 0.0;                                              ///< [N m s/rad] or [N s/m]
  double friction = 0.0;                                             ///< Coulomb friction of the joint [N m] or [N]
  double spring_stiffness = 0.0;                                     ///< [N m/rad] or [N/m]
  double spring_reference = 0.0;                                     ///< where the spring is at rest [rad] or [m]
  // Of a motor on it, whatever the motor itself may do:
  double max_effort = std::numeric_limits<double>::infinity();    ///< [N m] or [N]
  double max_velocity = std::numeric_limits<double>::infinity();  ///< [rad/s] or [m/s]
};

/// Joins two links of the same model, or a link and the world.
struct Joint {
  static constexpr std::size_t world = std::numeric_limits<std::size_t>::max();

  std::string name;
  JointType type = JointType::fixed;
  std::size_t parent = 0;  ///< index into Model::links, or `world`
  std::size_t child = 0;   ///< index into Model::links
  Pose X_LJ;               ///< in the child link
  JointAxis axis;          ///< of all but fixed joints; of a ball only damping and friction; of a screw, how it turns
  JointAxis second_axis;   ///< of a universal joint: the one that moves with the first, fixed in the child
  double thread_pitch = 0.0;  ///< of a screw: its way along the axis for each turn [m], negative: left-handed
};

/// Lets one joint follow another: its position is `multiplier` times that of the leader, plus `offset`. Of joints with
/// several axes the first.
struct Coupling {
  std::size_t follower = 0;  ///< index into Model::joints
  std::size_t leader = 0;    ///< likewise
  double multiplier = 1.0;   ///< [1], [m/rad] or [rad/m]
  double offset = 0.0;       ///< [rad] or [m]
};

/// Links in an order in which every parent comes before its children; link 0 is the root, which is free to move unless
/// a joint ties it to the world. Every link is the child of at most one of the joints; what closes a loop stands apart.
/// Devices in document order, which is the order of their channels. A static model has
/// neither joints nor devices, and its links stay at X_ML.
struct Model {
  // In one source, as those of Device are.
  Model();
  Model(const Model& other);
  Model(Model&& other) noexcept;
  Model& operator=(const Model& other);
  Model& operator=(Model&& other) noexcept;
  ~Model();

  std::string name;
  bool is_static = false;
  bool may_sleep = true;      ///< steps may pass over an instance that has been still for a while
  bool self_collide = false;  ///< links of one instance collide with each other, but for those that a joint connects
  std::vector<Link> links;
  std::vector<Joint> joints;
  std::vector<Joint>
      loop_joints{};  ///< between links that joints connect already; without limits, springs and friction
  std::vector<Coupling> couplings{};
  std::vector<Device> devices;
  std::vector<Emitter> emitters;
  std::vector<GripRing> grip_rings{};
  std::vector<Fin> fins{};
  std::vector<Drag> drags{};

  /// A robot is a model that can be observed or commanded.
  bool is_robot() const { return !devices.empty(); }
  /// Why its root link stays where it is, such as "is static"; null if it is free to move.
  const char* why_fixed() const {
    const auto ties_root = [](const Joint& joint) { return joint.parent == Joint::world && joint.child == 0; };
    if (is_static) return "is static";
    return std::any_of(joints.begin(), joints.end(), ties_root) ? "is tied to the world by a joint" : nullptr;
  }
};

}  // namespace cohort::description
