// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cohort/types.hpp>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

/// The kinematic tree of a robot: its links, the joints between them, and where its sensors are. Links and joints are
/// those of the model file, without joints that close loops. Values are in SI units.
namespace cohort {

/// The pose of a frame B in a frame A: the position of B's origin in A [m], and the rotation from B to A.
struct FramePose {
  Vector3 position{};
  Quaternion orientation{};
  bool operator==(const FramePose&) const = default;
};

/// A rigid body.
struct LinkInfo {
  std::string name;
  double mass = 0.0;         ///< [kg]
  Vector3 center_of_mass{};  ///< in the link's frame [m]
  bool operator==(const LinkInfo&) const = default;
};

/// One direction in which a joint turns or slides. Positions are in rad, or in m for a prismatic joint.
struct AxisInfo {
  Vector3 direction{};        ///< unit vector in the joint's frame
  double lower = 0.0;         ///< lowest position [rad] or [m]; infinite if there is no limit
  double upper = 0.0;         ///< highest position
  double max_velocity = 0.0;  ///< limit for motors [rad/s] or [m/s]; infinite if there is none
  double max_effort = 0.0;    ///< limit for motors [N m] or [N]; infinite if there is none
  bool operator==(const AxisInfo&) const = default;
};

/// A joint between two links, or between the world and a link. At joint position q about or along its axis, the pose of
/// the child link in the parent link is `pose` * `frame` * motion(q) * inverse(`frame`).
struct JointInfo {
  enum class Type : std::uint32_t { fixed = 0, revolute = 1, prismatic = 2, ball = 3, universal = 4, screw = 5 };
  static constexpr std::uint32_t world = std::numeric_limits<std::uint32_t>::max();

  std::string name;
  Type type = Type::fixed;
  std::uint32_t parent = 0;  ///< index of a link, less than `child`; or `world`
  std::uint32_t child = 0;   ///< index of a link, which has no other parent
  FramePose pose;            ///< pose of the child link in the parent link, or in the world, at joint position 0
  FramePose frame;           ///< pose of the joint's frame in the child link
  /// None for fixed and ball joints, two for universal joints, otherwise one. The second axis of a universal joint
  /// moves with the first.
  std::vector<AxisInfo> axes;
  double thread_pitch = 0.0;  ///< for screw joints: travel along the axis per turn [m]; negative if left-handed
  /// Names of the encoders, motors and drives that measure or move the joint. An encoder `wheel` measures its position
  /// in the observation channel `wheel/0/position`.
  std::vector<std::string> devices;
  bool operator==(const JointInfo&) const = default;
};

/// The place of a sensor on a link.
struct SensorInfo {
  std::string name;        ///< as in the names of its channels
  std::uint32_t link = 0;  ///< index of the link
  FramePose pose;          ///< pose of the sensor's frame in the link
  bool operator==(const SensorInfo&) const = default;
};

struct KinematicTree {
  std::vector<LinkInfo> links;      ///< the first one is the root, and each comes after its parent; empty if not known
  std::vector<JointInfo> joints;    ///< in the order of the model
  std::vector<SensorInfo> sensors;  ///< those with a fixed pose on a link, in the order of their channels
  bool operator==(const KinematicTree&) const = default;
};

}  // namespace cohort
