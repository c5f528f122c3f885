// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "idl/messages/cdr.hpp"
#include "idl/messages/ros_schema.hpp"
#include "idl/messages/ros_sensor_messages.hpp"
#include "server/core/channel.hpp"
#include "server/core/pose.hpp"
#include "server/description/model.hpp"

namespace cohort::messages {

/// Returns X_WL of a link of one robot.
using LinkPoses = std::function<Pose(std::size_t link)>;

/// A fixed pose of a frame S on a link L.
struct PlaceOnLink {
  std::size_t link = 0;
  Pose X_LS;
};

/// A ROS 2 message with the measurements of a device of the robots of one model.
struct DeviceMessage {
  std::string name;  ///< its topic relative to the robot's name: `scan`, or `scan/front` for several such devices
  std::vector<std::string> devices;    ///< names of the devices whose measurements it contains
  std::string frame;                   ///< name of S within the robot: the device's, or `proximity_3` on a ring;
                                       ///< `_frame` appended if a link has that name
  const char* type = "";               ///< type of the message, such as `sensor_msgs/msg/LaserScan`
  RosDefinition definition;            ///< definition of the message
  std::chrono::nanoseconds period{0};  ///< time between measurements; 0: every tick

  /// Writes the message for a robot's observation, which has the values of all channels.
  std::function<void(CdrWriter&, const ros::Header&, std::span<const double> observation)> add;

  /// Returns X_WS for a robot with these link poses. Empty if the device has no pose.
  std::function<Pose(const LinkPoses& X_WL)> place;

  /// The fixed pose of S on a link. Empty if the device has no pose, or S moves.
  std::optional<PlaceOnLink> place_on_link{};
};

/// A position on the WGS 84 ellipsoid.
struct GeodeticPlace {
  double latitude = 0.0;   ///< [degrees]
  double longitude = 0.0;  ///< [degrees]
  double altitude = 0.0;   ///< above the ellipsoid [m]
};

}  // namespace cohort::messages
