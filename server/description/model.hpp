// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/description/devices.hpp"
#include "server/description/emitter.hpp"
#include "server/description/joint_type.hpp"
#include "server/description/shape.hpp"

/// A model as plain data, which is read once and never changed. Units are SI, angles in radians. Frames are as in
/// SDFormat: M the model, L a link, C a collision, J a joint, S a sensor. A member `X_AB` is the pose of frame B in
/// frame A.
namespace cohort::description {

/// Contact properties of a surface. For two surfaces in contact, the smaller friction, the product of restitutions, and
/// the larger resistances to rolling and spinning apply. A MaterialPair of the world replaces all of these except the
/// resistance to spinning. If both surfaces have a friction direction, that of the surface with the smaller coefficient
/// `friction` applies. The coefficient across it is the smaller of the two. Stiffnesses combine as springs in series,
/// and dampings add up. The larger of the given bounce thresholds applies.
struct Surface {
  double friction = 1.0;             ///< Coulomb coefficient [1]
  double restitution = 0.0;          ///< coefficient of restitution [1]
  double rolling_resistance = 0.0;   ///< ratio of rolling torque to normal force [m]
  double spinning_resistance = 0.0;  ///< ratio of torque about the normal to normal force [m]
  std::uint32_t material = 0;        ///< index into World::materials
  bool is_grippable = false;         ///< grippers can grasp any point
  /// Direction in which `friction` applies, a unit vector in C, or in the frame of `friction_link`; zero for every
  /// direction.
  Eigen::Vector3d friction_direction = Eigen::Vector3d::Zero();
  /// Index into Model::links of another link, with which the direction turns. For example, the direction of a mecanum
  /// wheel turns with the chassis.
  std::optional<std::size_t> friction_link{};
  double second_friction = 1.0;                                ///< Coulomb coefficient across that direction [1]
  double stiffness = std::numeric_limits<double>::infinity();  ///< for each point of contact [N/m]
  double damping = 1.0;                                        ///< if the stiffness is finite [N s/m]
  std::optional<double> bounce_threshold{};                    ///< impacts below this velocity do not bounce [m/s]
  std::uint16_t category_bitmask = every_bit;
  std::uint16_t collide_bitmask = every_bit;

  static constexpr std::uint16_t every_bit = 0xFFFF;
  bool has_direction() const { return !friction_direction.isZero(0.0); }
};

/// Returns whether the surfaces can collide by the bitmasks of SDF: one belongs to a category with which the other
/// collides.
inline bool may_collide(const Surface& a, const Surface& b) {
  return ((a.category_bitmask & b.collide_bitmask) | (b.category_bitmask & a.collide_bitmask)) != 0;
}

struct Collision {
  std::string name;
  Pose X_LC;
  Shape shape;
  Surface surface;
};

/// The appearance of a link for people; sensors do not see it.
struct Visual {
  std::string name;
  Pose X_LV;
  Shape shape;
  Eigen::Vector4d color;   ///< red, green, blue and opacity, from 0 to 1
  bool has_color = false;  ///< the colour is given; otherwise a mesh has the colours and textures of its file, if any
  std::shared_ptr<const Image> texture{};  ///< shown instead of the colour; null if there is none
};

/// A linear map of spatial vectors: angular, then linear.
using SpatialMatrix = Eigen::Matrix<double, 6, 6>;

struct Inertial {
  double mass = 1.0;                                      ///< [kg], > 0
  Pose X_LI;                                              ///< I: at the centre of mass, with the axes of `inertia`
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Identity();  ///< about the centre of mass, in I [kg m^2]
  /// The added mass: inertia of the fluid around the link, about the origin of L, in L [kg m^2], [kg m], [kg];
  /// symmetric.
  std::shared_ptr<const SpatialMatrix> added_mass{};  ///< null if there is none
};

/// Returns the colour of a link without a colour of its own.
inline Eigen::Vector3d default_color() { return {0.5, 0.5, 0.5}; }

struct Link {
  std::string name;
  Pose X_ML;
  Inertial inertial;
  std::vector<Collision> collisions;
  Eigen::Vector3d color =
      default_color();            ///< as seen by cameras: that of the first visual; red, green, blue from 0 to 1
  std::vector<Visual> visuals{};  ///< those whose shape can be read
  bool feels_wind = false;        ///< SDF's enable_wind
  bool feels_gravity = true;      ///< SDF's gravity
  bool is_kinematic = false;      ///< for a root link: only commands change its motion
};

/// A circle that grippers can grasp, in the xy plane of R: the T-shaped ring around the turret of an s-bot.
struct GripRing {
  std::string name;
  std::size_t link = 0;
  Pose X_LR;
  double radius = 0.0;  ///< [m]
};

/// One direction in which a joint turns [rad] or slides [m].
struct JointAxis {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();     ///< unit vector in J
  double lower = -std::numeric_limits<double>::infinity();  ///< [rad] or [m]
  double upper = std::numeric_limits<double>::infinity();
  double limit_stiffness = std::numeric_limits<double>::infinity();  ///< for both limits [N m/rad] or [N/m]
  double limit_damping = 0.0;     ///< for limits that are not rigid; units as for `damping`
  double damping = 0.0;           ///< [N m s/rad] or [N s/m]
  double friction = 0.0;          ///< Coulomb friction of the joint [N m] or [N]
  double spring_stiffness = 0.0;  ///< [N m/rad] or [N/m]
  double spring_reference = 0.0;  ///< position at which the spring is relaxed [rad] or [m]
  // Limits for any motor on the joint:
  double max_effort = std::numeric_limits<double>::infinity();    ///< [N m] or [N]
  double max_velocity = std::numeric_limits<double>::infinity();  ///< [rad/s] or [m/s]
};

/// A joint between two links of the same model, or between a link and the world.
struct Joint {
  static constexpr std::size_t world = std::numeric_limits<std::size_t>::max();

  std::string name;
  JointType type = JointType::fixed;
  std::size_t parent = 0;  ///< index into Model::links, or `world`
  std::size_t child = 0;   ///< index into Model::links
  Pose X_LJ;               ///< in the child link
  JointAxis
      axis;  ///< not for fixed joints; only damping and friction for ball joints, and the rotation for screw joints
  JointAxis second_axis;      ///< for a universal joint: the axis that moves with the first, fixed in the child
  double thread_pitch = 0.0;  ///< for a screw joint: travel along the axis per turn [m]; negative if left-handed
};

/// A coupling that makes one joint follow another: its position is `multiplier` times that of the leader, plus
/// `offset`.
struct Coupling {
  std::size_t follower = 0;          ///< index into Model::joints
  std::size_t leader = 0;            ///< likewise
  double multiplier = 1.0;           ///< [1], [m/rad] or [rad/m]
  double offset = 0.0;               ///< [rad] or [m]
  bool moves_second_axis = false;    ///< the follower is a universal joint, and its second axis follows
  bool follows_second_axis = false;  ///< likewise, of the leader
};

/// A model of links, joints and devices. Every parent link comes before its children. Link 0 is the root, which is free
/// to move unless a joint attaches it to the world. Every link is the child of at most one of the joints; joints that
/// close loops are listed separately. Devices are in document order, which is the order of their channels. A static
/// model has neither joints nor devices, and its links stay at X_ML.
struct Model {
  // Defined in one source file, like those of Device.
  Model();
  Model(const Model& other);
  Model(Model&& other) noexcept;
  Model& operator=(const Model& other);
  Model& operator=(Model&& other) noexcept;
  ~Model();

  std::string name;
  bool is_static = false;
  bool may_sleep = true;      ///< steps may skip an instance that has been at rest for a while
  bool self_collide = false;  ///< links of one instance collide with each other, except those that a joint connects
  std::vector<Link> links;
  std::vector<Joint> joints;
  std::vector<Joint>
      loop_joints{};  ///< between links that other joints already connect; without limits, springs and friction
  std::vector<Coupling> couplings{};
  std::vector<Device> devices;
  std::vector<Emitter> emitters;
  std::vector<GripRing> grip_rings{};
  std::vector<Fin> fins{};
  std::vector<Drag> drags{};

  /// Returns whether the model is a robot: one that can be observed or commanded.
  bool is_robot() const { return !devices.empty(); }
  /// Returns why the root link cannot move, such as "is static"; null if it is free to move.
  const char* why_fixed() const {
    const auto ties_root = [](const Joint& joint) { return joint.parent == Joint::world && joint.child == 0; };
    if (is_static) return "is static";
    return std::any_of(joints.begin(), joints.end(), ties_root) ? "is attached to the world by a joint" : nullptr;
  }
};

}  // namespace cohort::description
