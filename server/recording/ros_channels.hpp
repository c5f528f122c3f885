// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "idl/messages/ros_sensor_messages.hpp"
#include "server/recording/mcap/format/mcap.hpp"

/// Messages of ROS 2 in MCAP files, in rosbag2's layout.
namespace cohort::recording {

namespace ros = messages::ros;

/// Returns the metadata of a channel in a ROS 2 bag: reliable, and with `is_latched` transient local like /tf_static.
StringMap ros_channel_metadata(bool is_latched = false);

/// Adds the schema of a message to a McapWriter or a RecordingFile.
template <messages::RosMessage Message, class Writer>
SchemaId add_ros_schema(Writer& writer) {
  return writer.add_schema(Message::type, "ros2msg", messages::schema_text(messages::definition<Message>()));
}

/// Adds a channel for messages with this schema.
template <class Writer>
ChannelId add_ros_channel(Writer& writer, std::string topic, SchemaId schema, bool is_latched = false) {
  return writer.add_channel(std::move(topic), schema, "cdr", ros_channel_metadata(is_latched));
}

}  // namespace cohort::recording
