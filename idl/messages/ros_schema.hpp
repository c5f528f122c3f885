#pragma once

#include "idl/messages/cdr.hpp"

/// What rosbag2 and Foxglove want to know of messages.
namespace cohort::messages {

/// A message's definition: `package/Name`, its lines `type name`, and the messages that are in it.
struct RosDefinition {
  std::string name;
  std::string text;
  std::vector<RosDefinition> parts;
};

/// All of it, as rosbag2 writes it: each message in it once, after a line of 80 `=` and a line `MSG: package/Name`.
std::string schema_text(const RosDefinition& definition);

/// `geometry_msgs/Pose` for `geometry_msgs/msg/Pose`.
std::string short_type(std::string_view type);

template <RosMessage Message>
RosDefinition definition();

/// The name of a type in a definition; of a message's, adds the definition to `parts`.
template <class Value>
struct RosType {
  static std::string name([[maybe_unused]] std::vector<RosDefinition>& parts) {
    if constexpr (RosMessage<Value>) {
      parts.push_back(definition<Value>());
      return parts.back().name;
    } else if constexpr (std::is_same_v<Value, bool>) {
      return "bool";
    } else if constexpr (std::is_same_v<Value, std::string>) {
      return "string";
    } else {
      static_assert(std::is_arithmetic_v<Value>);
      constexpr const char* kind = std::is_floating_point_v<Value> ? "float" : std::is_signed_v<Value> ? "int" : "uint";
      return kind + std::to_string(8 * sizeof(Value));
    }
  }
};
template <class Value>
struct RosType<std::vector<Value>> {
  static std::string name(std::vector<RosDefinition>& parts) { return RosType<Value>::name(parts) + "[]"; }
};
template <class Value, std::size_t count>
struct RosType<std::array<Value, count>> {
  static std::string name(std::vector<RosDefinition>& parts) {
    return RosType<Value>::name(parts) + "[" + std::to_string(count) + "]";
  }
};

template <class Message, class Value>
void add_field(RosDefinition& to, const Field<Message, Value>& field) {
  to.text += RosType<Value>::name(to.parts) + " " + field.name + "\n";
}

template <RosMessage Message>
RosDefinition definition() {
  RosDefinition result{short_type(Message::type), "", {}};
  std::apply([&](const auto&... fields) { (add_field(result, fields), ...); }, Message::fields);
  return result;
}

}  // namespace cohort::messages
