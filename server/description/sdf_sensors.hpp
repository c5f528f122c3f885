// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "server/core/pose.hpp"
#include "server/description/readout.hpp"

/// The `<sensor>` types of SDF on a link or a joint, as plain data. They look along the x axis of S, with y to the left
/// and z up.
namespace cohort::description {

/// Types `lidar`, `gpu_lidar`, `ray` and `gpu_ray`. Rays start at the origin of S, in rows, the lowest first; in a row
/// from the smallest bearing to the largest. Observation `NAME/0/ranges` [m], row by row.
struct Lidar {
  std::string name;
  std::size_t link = 0;
  Pose X_LS;
  std::size_t columns = 1;     ///< rays in a row
  std::size_t rows = 1;        ///< >= 1
  double min_bearing = 0.0;    ///< bearing of a ray about the z axis of S, from its x axis [rad]
  double max_bearing = 0.0;    ///< a single column is midway between the two
  double min_elevation = 0.0;  ///< elevation of a row above the xy plane of S [rad]
  double max_elevation = 0.0;
  double min_range = 0.0;  ///< reading for objects that are nearer, without noise [m]
  double max_range = 0.0;  ///< reading for objects that are farther away, or for none, without noise [m]
  Readout readout{};
};

/// Type `imu`. Observations `NAME/0/orientation`, the quaternion x y z w of S in its reference frame,
/// `NAME/0/angular_velocity` [rad/s] and `NAME/0/linear_acceleration`, acceleration minus gravity [m/s^2], both in S.
struct Imu {
  std::string name;
  std::size_t link = 0;
  Pose X_LS;
  bool has_orientation = true;
  bool is_relative_to_world = false;                        ///< the reference frame is given in the world frame,
                                                            ///< otherwise in the initial frame S
  Eigen::Vector3d reference_rpy = Eigen::Vector3d::Zero();  ///< roll, pitch and yaw of the reference frame there
  Readout readout{};
};

/// Type `contact`. Observations `NAME/0/touching`, 0 or 1, and `NAME/0/force` [N] of one collision.
struct ContactSensor {
  std::string name;
  std::size_t link = 0;
  std::size_t collision = 0;  ///< index in the link
  Readout readout{};
};

/// Type `force_torque`, on a joint. Observations `NAME/0/force` [N] and `NAME/0/torque` about the origin of the joint
/// [N m].
struct ForceTorqueSensor {
  enum class Frame : std::uint8_t { child, parent, sensor };

  std::string name;
  std::size_t joint = 0;
  Pose X_JS;
  Frame axes = Frame::child;
  bool is_on_parent = true;  ///< force of the child on the parent; otherwise of the parent on the child
  Readout readout{};
};

/// Type `altimeter`. Observations `NAME/0/vertical_position`, along the z axis of the world from the initial position
/// of S [m], and `NAME/0/vertical_velocity` [m/s].
struct Altimeter {
  std::string name;
  std::size_t link = 0;
  Pose X_LS;
  Readout readout{};
};

/// Type `navsat`. Observations `NAME/0/position`, of S in the world frame, east, north and up of the origin of the
/// world [m], and `NAME/0/velocity` in the same axes [m/s].
struct NavSat {
  std::string name;
  std::size_t link = 0;
  Pose X_LS;
  Readout readout{};
};

/// Type `magnetometer`. Observation `NAME/0/magnetic_field`, the field of the world in S [T].
struct Magnetometer {
  std::string name;
  std::size_t link = 0;
  Pose X_LS;
  Readout readout{};
};

/// Type `logical_camera`: detects objects whose origin is in a frustum. Observations `NAME/0/count`, and for the
/// nearest ones `NAME/0/object`, `NAME/0/position` [m] and `NAME/0/orientation` in S.
struct LogicalCamera {
  static constexpr std::size_t capacity = 16;

  std::string name;
  std::size_t link = 0;
  Pose X_LS;
  double near = 0.0;            ///< along the x axis of S [m]
  double far = 0.0;             ///< [m]
  double horizontal_fov = 0.0;  ///< whole angle [rad]
  double aspect_ratio = 1.0;    ///< width / height of the field of view
  Readout readout{};
};

/// Type `air_pressure`. Observation `NAME/0/pressure` [Pa].
struct AirPressureSensor {
  std::string name;
  std::size_t link = 0;
  Pose X_LS;
  double reference_altitude = 0.0;  ///< altitude of the origin of the world above sea level [m]
  Readout readout{};
};

}  // namespace cohort::description
