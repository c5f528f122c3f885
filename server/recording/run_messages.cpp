// SPDX-License-Identifier: Apache-2.0
#include "server/recording/run_messages.hpp"

#include <algorithm>
#include <cctype>

namespace cohort::recording {
namespace {

bool is_alphanumeric(char letter) { return std::isalnum(static_cast<unsigned char>(letter)) != 0; }

}  // namespace

Commands decode_commands(ByteView bytes) {
  auto commands = messages::decode<Commands>(bytes);
  const std::size_t count = commands.robots.size();
  if (commands.places.size() != count || commands.values.size() != count)
    throw messages::CdrError("commands have " + std::to_string(count) + " robots, " +
                             std::to_string(commands.places.size()) + " places and " +
                             std::to_string(commands.values.size()) + " values");
  return commands;
}

// Returns a name of lower-case letters, digits and single underscores that starts with a letter.
std::string ros_field_name(std::string_view channel) {
  std::string name;
  for (const char letter : channel) {
    if (is_alphanumeric(letter))
      name += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    else if (!name.empty() && name.back() != '_')
      name += '_';
  }
  while (!name.empty() && name.back() == '_') name.pop_back();
  if (name.empty() || std::isalpha(static_cast<unsigned char>(name.front())) == 0) name = "channel_" + name;
  return name;
}

std::string observation_type(std::string_view model) {
  std::string name;
  bool begins_word = true;
  for (const char letter : model) {
    if (is_alphanumeric(letter))
      name += begins_word ? static_cast<char>(std::toupper(static_cast<unsigned char>(letter))) : letter;
    begins_word = !is_alphanumeric(letter);
  }
  if (name.empty() || std::isalpha(static_cast<unsigned char>(name.front())) == 0) name = "Robot" + name;
  return "cohort_msgs/msg/" + name + "Observation";
}

std::string observation_schema(std::span<const cohort::Channel> channels) {
  std::string text = "builtin_interfaces/Time stamp\n";
  for (const cohort::Channel& channel : channels)
    text += (channel.size == 1 ? "float64 " : "float64[" + std::to_string(channel.size) + "] ") +
            ros_field_name(channel.name) + "\n";
  const messages::RosDefinition time = messages::definition<ros::Time>();
  return messages::schema_text({"", text, {{"builtin_interfaces/Time", time.text, {}}}});
}

}  // namespace cohort::recording
