// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

/// Little-endian CDR, as in ROS 2: the encapsulation header 00 01 00 00, then the fields. Each number is aligned to its
/// size, counted from the first byte after the header (OMG DDSI-RTPS 2.5, 10; CORBA 3.4 part 2, 9.3).
namespace cohort::messages {

using Bytes = std::vector<std::byte>;
using ByteView = std::span<const std::byte>;

/// The error thrown if a message ends too early or is not little-endian CDR.
class CdrError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A field of a message: its name in ROS, its member, and the maximum length of the string or sequence in ROS (0: no
/// limit). Created by `field`.
template <class Message, class Value>
struct Field {
  const char* name;
  Value Message::*member;
  std::size_t bound;
};

template <class Message, class Value>
constexpr Field<Message, Value> field(const char* name, Value Message::*member, std::size_t bound = 0) {
  return {name, member, bound};
}

/// A struct that describes its ROS message:
///
///     struct Point {
///       double x = 0, y = 0, z = 0;
///       static constexpr const char* type = "geometry_msgs/msg/Point";
///       static constexpr auto fields =
///           std::tuple(field("x", &Point::x), field("y", &Point::y), field("z", &Point::z));
///     };
///
/// Fields are numbers, bool, std::byte, std::string, other messages, and std::vector and std::array of these. Encoding,
/// decoding and the schema (ros_schema.hpp) need nothing else.
template <class T>
concept RosMessage = requires {
  T::type;
  T::fields;
};

/// A message that later versions have extended with fields at its end. `least_fields` is the number of fields in the
/// first version; further fields that are missing keep their default values. Not for nested messages.
template <class T>
concept GrownMessage = RosMessage<T> && requires {
  T::least_fields;
};

static_assert(std::endian::native == std::endian::little);

/// True for a message without fields. ROS encodes it as one byte, because IDL has no empty structs.
template <RosMessage Message>
inline constexpr bool has_no_fields = std::tuple_size_v<decltype(Message::fields)> == 0;

/// True for types whose values have the same bytes in CDR and in memory.
template <class Value>
inline constexpr bool is_plain =
    (std::is_arithmetic_v<Value> && !std::is_same_v<Value, bool>) || std::is_same_v<Value, std::byte>;

/// The minimum size of a value [bytes].
template <class Value>
struct CdrSize {
  static constexpr std::size_t of_fields() {
    return std::apply([](const auto&... fields) { return (std::size_t{0} + ... + size_of(fields)); }, Value::fields);
  }
  template <class Message, class Member>
  static constexpr std::size_t size_of(const Field<Message, Member>&) {
    return CdrSize<Member>::least();
  }
  static constexpr std::size_t least() {
    if constexpr (RosMessage<Value>) {
      return has_no_fields<Value> ? 1 : of_fields();
    } else {
      return is_plain<Value> || std::is_same_v<Value, bool> ? sizeof(Value) : 4;
    }
  }
};
template <class Value, std::size_t count>
struct CdrSize<std::array<Value, count>> {
  static constexpr std::size_t least() { return count * CdrSize<Value>::least(); }
};

class CdrWriter {
 public:
  CdrWriter() { clear(); }

  /// Starts another message.
  void clear() {
    constexpr std::array<std::byte, 4> encapsulation = {std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}};
    bytes_.assign(encapsulation.begin(), encapsulation.end());
  }

  void add(bool flag) { add(static_cast<std::uint8_t>(flag ? 1 : 0)); }
  template <class Number>
  requires is_plain<Number>
  void add(Number number) {
    align(sizeof number);
    append(&number, sizeof number);
  }
  void add(const std::string& text) {
    add_count(text.size() + 1);
    append(text.c_str(), text.size() + 1);
  }
  template <class Value, std::size_t count>
  void add(const std::array<Value, count>& values) {
    add_all(values.data(), values.size());
  }
  template <class Value>
  void add(const std::vector<Value>& values) {
    static_assert(!std::is_same_v<Value, bool>, "std::vector<bool> does not store an array of bool");
    add_count(values.size());
    add_all(values.data(), values.size());
  }
  template <RosMessage Message>
  void add([[maybe_unused]] const Message& message) {
    if constexpr (has_no_fields<Message>) add(std::uint8_t{0});
    std::apply([&](const auto&... fields) { (add(message.*fields.member), ...); }, Message::fields);
  }

  /// Returns the message; valid until it is changed.
  const Bytes& bytes() const { return bytes_; }

 private:
  static constexpr std::size_t encapsulation_size = 4;

  void align(std::size_t size) {
    const std::size_t beyond = (bytes_.size() - encapsulation_size) % size;
    if (beyond != 0) bytes_.resize(bytes_.size() + size - beyond);
  }
  void append(const void* from, std::size_t size) {
    const std::size_t at = bytes_.size();
    bytes_.resize(at + size);
    std::memcpy(bytes_.data() + at, from, size);
  }
  void add_count(std::size_t count) {
    if (count > std::numeric_limits<std::uint32_t>::max())
      throw CdrError("a sequence or string is longer than CDR allows");
    add(static_cast<std::uint32_t>(count));
  }
  template <class Value>
  void add_all(const Value* values, std::size_t count) {
    if (count == 0) return;
    if constexpr (is_plain<Value>) {
      align(sizeof(Value));
      append(values, count * sizeof(Value));
    } else {
      for (std::size_t i = 0; i < count; ++i) add(values[i]);
    }
  }

  Bytes bytes_;
};

/// A reader of messages from a CdrWriter or from ROS. Throws CdrError. The length of a sequence is checked against the
/// size of the message before memory is allocated.
class CdrReader {
 public:
  explicit CdrReader(ByteView message) {
    if (message.size() < 4) throw CdrError("a message of " + std::to_string(message.size()) + " bytes is not CDR");
    if (message[0] != std::byte{0} || message[1] != std::byte{1})
      throw CdrError("the message is not little-endian CDR: it does not begin with 00 01");
    bytes_ = message.subspan(4);
  }

  void read(bool& flag) { flag = *take(1, 1) != std::byte{0}; }
  template <class Number>
  requires is_plain<Number>
  void read(Number& number) { std::memcpy(&number, take(sizeof number, sizeof number), sizeof number); }
  void read(std::string& text) {
    const std::size_t count = read_count(1);
    const std::byte* bytes = take(count, 1);
    text.assign(reinterpret_cast<const char*>(bytes), count);
    if (!text.empty() && text.back() == '\0') text.pop_back();
  }
  template <class Value, std::size_t count>
  void read(std::array<Value, count>& values) {
    read_all(values.data(), count);
  }
  template <class Value>
  void read(std::vector<Value>& values) {
    static_assert(!std::is_same_v<Value, bool>, "std::vector<bool> does not store an array of bool");
    values.resize(read_count(CdrSize<Value>::least()));
    read_all(values.data(), values.size());
  }
  template <RosMessage Message>
  void read([[maybe_unused]] Message& message) {
    if constexpr (has_no_fields<Message>) take(1, 1);
    [[maybe_unused]] std::size_t count = 0;
    const auto read_field = [&](const auto& field) {
      if constexpr (GrownMessage<Message>)
        if (count++ >= Message::least_fields && left() == 0) return;
      read(message.*field.member);
    };
    std::apply([&](const auto&... fields) { (read_field(fields), ...); }, Message::fields);
  }
  template <class Value>
  Value get() {
    Value value{};
    read(value);
    return value;
  }

  std::size_t left() const { return bytes_.size() - at_; }

 private:
  const std::byte* take(std::size_t size, std::size_t alignment) {
    const std::size_t beyond = at_ % alignment;
    const std::size_t skipped = beyond == 0 ? 0 : alignment - beyond;
    if (skipped > left() || size > left() - skipped)
      throw CdrError("the message ends at byte " + std::to_string(bytes_.size() + 4) + "; expected " +
                     std::to_string(size) + " more");
    at_ += skipped + size;
    return bytes_.data() + (at_ - size);
  }
  // Reads the number of elements, each of which takes at least `bytes_each` bytes.
  std::size_t read_count(std::size_t bytes_each) {
    const auto count = get<std::uint32_t>();
    if (count > left() / std::max<std::size_t>(1, bytes_each))
      throw CdrError("a sequence or string has " + std::to_string(count) + " elements, but the message has " +
                     std::to_string(left()) + " bytes left");
    return count;
  }
  template <class Value>
  void read_all(Value* values, std::size_t count) {
    if (count == 0) return;
    if constexpr (is_plain<Value>) {
      std::memcpy(values, take(count * sizeof(Value), sizeof(Value)), count * sizeof(Value));
    } else {
      for (std::size_t i = 0; i < count; ++i) read(values[i]);
    }
  }

  ByteView bytes_;
  std::size_t at_ = 0;
};

template <RosMessage Message>
Bytes encode(const Message& message) {
  CdrWriter writer;
  writer.add(message);
  return writer.bytes();
}

/// Decodes a message; ignores bytes after the last field. Throws CdrError.
template <RosMessage Message>
Message decode(ByteView bytes) {
  return CdrReader(bytes).get<Message>();
}

}  // namespace cohort::messages
