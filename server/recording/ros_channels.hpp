#pragma once

#include "idl/messages/ros_sensor_messages.hpp"
#include "server/recording/mcap/format/mcap.hpp"

/// Messages of ROS 2 in MCAP files, as rosbag2 writes them.
namespace cohort::recording {

namespace ros = messages::ros;

/// The metadata that a channel has in a bag of ROS 2: reliable, and `is_latched` as of /tf_static.
StringMap ros_channel_metadata(bool is_latched = false);

/// Adds the schema of a message to a McapWriter or a RecordingFile.
template <messages::RosMessage Message, class Writer>
SchemaId add_ros_schema(Writer& writer) {
  return writer.add_schema(Message::type, "ros2msg", messages::schema_text(messages::definition<Message>()));
}

/// The same for a channel of such messages.
template <class Writer>
ChannelId add_ros_channel(Writer& writer, std::string topic, SchemaId schema, bool is_latched = false) {
  return writer.add_channel(std::move(topic), schema, "cdr", ros_channel_metadata(is_latched));
}

}  // namespace cohort::recording
