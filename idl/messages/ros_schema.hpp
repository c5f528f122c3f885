// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "idl/messages/cdr.hpp"

/// Descriptions of messages for rosbag2, Foxglove and the ROS 2 graph.
namespace cohort::messages {

/// The type of a field, as in type_description_interfaces/msg/FieldType of ROS 2.
struct RosFieldType {
  // The type of one value of a field.
  enum Id : int {
    nested = 1,
    int8 = 2,
    uint8 = 3,
    int16 = 4,
    uint16 = 5,
    int32 = 6,
    uint32 = 7,
    int64 = 8,
    uint64 = 9,
    float32 = 10,
    float64 = 11,
    boolean = 15,
    byte = 16,
    string = 17,
    bounded_string = 21
  };
  // Added to the type of one value, for arrays and sequences.
  static constexpr int array = 48;
  static constexpr int bounded_sequence = 96;
  static constexpr int unbounded_sequence = 144;

  int id = 0;
  std::size_t capacity = 0;         ///< for an array or a bounded sequence
  std::size_t string_capacity = 0;  ///< for a bounded string
  std::string nested_type{};        ///< such as `std_msgs/msg/Header`
};

struct RosField {
  std::string name;
  RosFieldType type;
};

/// The definition of a message: `name` is `package/Name`, `text` has a line `type name` for each field, and `parts` are
/// the nested messages. The type hash is computed from `type`, which is `package/msg/Name`, and `fields`.
struct RosDefinition {
  std::string name;
  std::string text;
  std::vector<RosDefinition> parts;
  std::string type{};
  std::vector<RosField> fields{};
};

/// Returns the whole definition in the format of rosbag2: each nested message once, after a line of 80 `=` and a line
/// `MSG: package/Name`.
std::string schema_text(const RosDefinition& definition);

/// Returns `geometry_msgs/Pose` for `geometry_msgs/msg/Pose`.
std::string short_type(std::string_view type);

template <RosMessage Message>
RosDefinition definition();

/// The type of a field as text and as a value.
struct RosTypeText {
  std::string text;
  RosFieldType type;
};

/// Returns the type of a field in a definition; for a nested message, adds its definition to `parts`. `bound` is the
/// maximum length of its text or list.
template <class Value>
struct RosType {
  static RosTypeText of([[maybe_unused]] std::vector<RosDefinition>& parts, [[maybe_unused]] std::size_t bound) {
    using Id = RosFieldType::Id;
    if constexpr (RosMessage<Value>) {
      parts.push_back(definition<Value>());
      return {parts.back().name, {Id::nested, 0, 0, Value::type}};
    } else if constexpr (std::is_same_v<Value, bool>) {
      return {"bool", {Id::boolean}};
    } else if constexpr (std::is_same_v<Value, std::byte>) {
      return {"byte", {Id::byte}};
    } else if constexpr (std::is_same_v<Value, char>) {
      return {"char", {Id::uint8}};
    } else if constexpr (std::is_same_v<Value, std::string>) {
      if (bound == 0) return {"string", {Id::string}};
      return {"string<=" + std::to_string(bound), {Id::bounded_string, 0, bound}};
    } else {
      static_assert(std::is_arithmetic_v<Value>);
      constexpr bool is_float = std::is_floating_point_v<Value>;
      constexpr bool is_signed = std::is_signed_v<Value>;
      constexpr int step = std::bit_width(sizeof(Value)) - 1;  // 0 for int8, 3 for int64
      constexpr int id = is_float ? Id::float32 + step - 2 : (is_signed ? Id::int8 : Id::uint8) + 2 * step;
      constexpr const char* kind = is_float ? "float" : is_signed ? "int" : "uint";
      return {kind + std::to_string(8 * sizeof(Value)), {id}};
    }
  }
};
template <class Value>
struct RosType<std::vector<Value>> {
  static RosTypeText of(std::vector<RosDefinition>& parts, std::size_t bound) {
    RosTypeText one = RosType<Value>::of(parts, 0);
    one.text += bound == 0 ? "[]" : "[<=" + std::to_string(bound) + "]";
    one.type.id += bound == 0 ? RosFieldType::unbounded_sequence : RosFieldType::bounded_sequence;
    one.type.capacity = bound;
    return one;
  }
};
template <class Value, std::size_t count>
struct RosType<std::array<Value, count>> {
  static RosTypeText of(std::vector<RosDefinition>& parts, std::size_t) {
    RosTypeText one = RosType<Value>::of(parts, 0);
    one.text += "[" + std::to_string(count) + "]";
    one.type.id += RosFieldType::array;
    one.type.capacity = count;
    return one;
  }
};

template <class Message, class Value>
void add_field(RosDefinition& to, const Field<Message, Value>& field) {
  RosTypeText type = RosType<Value>::of(to.parts, field.bound);
  to.text += type.text + " " + field.name + "\n";
  to.fields.push_back({field.name, std::move(type.type)});
}

template <RosMessage Message>
RosDefinition definition() {
  RosDefinition result{short_type(Message::type), "", {}, Message::type, {}};
  std::apply([&](const auto&... fields) { (add_field(result, fields), ...); }, Message::fields);
  return result;
}

}  // namespace cohort::messages
