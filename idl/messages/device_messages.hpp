#pragma once

#include <cstddef>
#include <functional>
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

/// Gives X_WL of a link of one robot.
using LinkPoses = std::function<Pose(std::size_t link)>;

/// What a device of robots of one model measures, as a message of ROS 2.
struct DeviceMessage {
  std::string name;          ///< of the device, and what it measures if that takes several messages: `air/temperature`
  std::string device;        ///< whose frame S is
  const char* type = "";     ///< of the message, such as `sensor_msgs/msg/LaserScan`
  RosDefinition definition;  ///< of the message

  /// Adds the message of what a robot observes: the values of all its channels.
  std::function<void(CdrWriter&, const ros::Header&, std::span<const double> observation)> add;

  /// Returns X_WS of a robot whose links are there. Empty if the device has no place.
  std::function<Pose(const LinkPoses& X_WL)> place;
};

/// Returns the messages of a model's devices, in the order of the devices: lidars, IMUs, accelerometers, magnetometers,
/// force and torque, air pressure, climate, batteries. `observation`: the channels of its robots. Throws
/// std::logic_error if they are those of another model.
std::vector<DeviceMessage> device_messages(const description::Model& model, std::span<const Channel> observation);

}  // namespace cohort::messages
