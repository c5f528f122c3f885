// SPDX-License-Identifier: Apache-2.0
#include "server/recording/rosbag2_metadata.hpp"

#include <map>

#include "idl/messages/parse_schema.hpp"
#include "idl/messages/ros_type_hash.hpp"

namespace cohort::recording {
namespace {

// Returns a YAML scalar in double quotes.
std::string yaml_text(std::string_view text) {
  std::string result = "\"";
  for (const char letter : text) {
    if (letter == '\n')
      result += "\\n";
    else if (static_cast<unsigned char>(letter) < 0x20)
      result += ' ';
    else
      result += (letter == '"' || letter == '\\' ? "\\" : "") + std::string(1, letter);
  }
  return result + "\"";
}

struct Topic {
  const Channel* channel = nullptr;  // the first channel of the topic
  std::uint64_t count = 0;           // messages of all its channels
};

// Returns the topics by name. A channel without a schema is left out: it has no type, which rosbag2 requires.
std::map<std::string, Topic> topics_of(const McapReader& reader) {
  std::map<std::string, Topic> topics;
  const std::map<ChannelId, std::uint64_t>& counts = reader.statistics().messages_of_channels;
  for (const auto& [id, channel] : reader.channels()) {
    if (!reader.schemas().contains(channel.schema)) continue;
    Topic& topic = topics[channel.topic];
    if (topic.channel == nullptr) topic.channel = &channel;
    if (const auto count = counts.find(id); count != counts.end()) topic.count += count->second;
  }
  return topics;
}

std::string text_of(const McapReader& reader, const Topic& topic) {
  const Channel& channel = *topic.channel;
  const auto qos = channel.metadata.find("offered_qos_profiles");
  return "    - topic_metadata:\n        name: " + yaml_text(channel.topic) +
         "\n        type: " + yaml_text(reader.schemas().at(channel.schema).name) +
         "\n        serialization_format: " + yaml_text(channel.message_encoding) +
         "\n        offered_qos_profiles: " + yaml_text(qos == channel.metadata.end() ? "" : qos->second) +
         "\n        type_description_hash: " + yaml_text(channel_type_hash(reader, channel)) +
         "\n      message_count: " + std::to_string(topic.count) + "\n";
}

}  // namespace

std::string channel_type_hash(const McapReader& reader, const Channel& channel) {
  const auto schema = reader.schemas().find(channel.schema);
  if (schema == reader.schemas().end() || schema->second.encoding != "ros2msg") return {};
  try {
    return messages::type_hash(messages::parse_schema(schema->second.name, schema->second.data));
  } catch (const messages::SchemaError&) {
    return {};
  }
}

std::string rosbag2_metadata(const McapReader& reader, const std::string& file_name) {
  const Statistics& statistics = reader.statistics();
  std::string topics;
  std::uint64_t messages = 0;
  for (const auto& [name, topic] : topics_of(reader)) {
    topics += text_of(reader, topic);
    messages += topic.count;
  }
  const std::string duration = std::to_string((statistics.end_time - statistics.start_time).count());
  const std::string start = std::to_string(statistics.start_time.count());
  const std::string count = std::to_string(messages);
  // Compression here is that of rosbag2 itself, in addition to that of MCAP.
  return "rosbag2_bagfile_information:\n  version: 8\n  storage_identifier: mcap\n  duration:\n    nanoseconds: " +
         duration + "\n  starting_time:\n    nanoseconds_since_epoch: " + start + "\n  message_count: " + count +
         "\n  topics_with_message_count:" + (topics.empty() ? " []\n" : "\n" + topics) +
         "  compression_format: \"\"\n  compression_mode: \"\"\n  relative_file_paths:\n    - " + yaml_text(file_name) +
         "\n  files:\n    - path: " + yaml_text(file_name) +
         "\n      starting_time:\n        nanoseconds_since_epoch: " + start +
         "\n      duration:\n        nanoseconds: " + duration + "\n      message_count: " + count +
         "\n  custom_data: ~\n  ros_distro: jazzy\n";
}

}  // namespace cohort::recording
