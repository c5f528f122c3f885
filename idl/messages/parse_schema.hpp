// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string_view>

#include "idl/messages/ros_schema.hpp"

namespace cohort::messages {

/// The error thrown if a text is not a message schema in the format of rosbag2.
class SchemaError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Returns the definition of a message from its schema in a recording, in the format of `schema_text`. `type` is its
/// name, such as `nav_msgs/msg/Odometry`. All nested messages, at any depth, are direct parts of the definition.
/// Comments, constants and default values are omitted, because hashes do not depend on them. Throws SchemaError.
RosDefinition parse_schema(std::string_view type, std::string_view text);

}  // namespace cohort::messages
