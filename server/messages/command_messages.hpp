// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "idl/messages/cdr.hpp"
#include "idl/messages/ros_schema.hpp"
#include "server/core/channel.hpp"
#include "server/description/model.hpp"

namespace cohort::messages {

/// A ROS 2 message that commands a device of the robots of one model. Motors and drives are not included.
struct CommandMessage {
  std::string name;  ///< its topic relative to the robot's name, such as `gripper/opening`
  std::string device;
  const char* type = "";            ///< type of the message, such as `std_msgs/msg/Float64`
  RosDefinition definition;         ///< definition of the message
  std::vector<std::size_t> places;  ///< indices of its values in a robot's command

  /// Sets the values at `places` of a robot's command, which has all channels. Throws std::invalid_argument, and
  /// changes nothing, if a value is not finite or the number of values is wrong. Throws CdrError as CdrReader does.
  std::function<void(CdrReader&, std::span<double> command)> read;
};

/// Returns the messages that a model's devices accept, in the order of the devices. `command` has the channels of its
/// robots. Throws std::logic_error if these channels belong to another model.
std::vector<CommandMessage> command_messages(const description::Model& model, std::span<const Channel> command);

}  // namespace cohort::messages
