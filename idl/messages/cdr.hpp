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

/// CDR, little-endian, as ROS 2 has it: the encapsulation 00 01 00 00, then the fields, each number at a multiple of
/// its size from the first byte after the encapsulation (OMG DDSI-RTPS 2.5, 10; CORBA 3.4 part 2, 9.3).
namespace cohort::messages {

using Bytes = std::vector<std::byte>;
using ByteView = std::span<const std::byte>;

/// A message that ends too early or is no little-endian CDR.
class CdrError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A field of a message: its name in ROS and where it is. `field` makes one.
template <class Message, class Value>
struct Field {
  const char* name;
  Value Message::*member;
};

template <class Message, class Value>
constexpr Field<Message, Value> field(const char* name, Value Message::*member) {
  return {name, member};
}

/// A struct that says which message of ROS it is:
///
///     struct Point {
///       double x = 0, y = 0, z = 0;
///       static constexpr const char* type = "geometry_msgs/msg/Point";
///       static constexpr auto fields = std::tuple(field("x", &Point::x), field("y", &Point::y), field("z",
///       &Point::z));
///     };
///
/// Fields are numbers, bool, std::string, other messages, std::vector and std::array of these. That is all that
/// encoding, decoding and its schema (ros_schema.hpp) need.
template <class T>
concept RosMessage = requires {
  T::type;
  T::fields;
};

static_assert(std::endian::native == std::endian::little);

/// Bytes that a value takes at least.
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
      return of_fields();
    } else {
      return std::is_arithmetic_v<Value> ? sizeof(Value) : 4;
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

  /// Begins another message.
  void clear() {
    constexpr std::array<std::byte, 4> encapsulation = {std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}};
    bytes_.assign(encapsulation.begin(), encapsulation.end());
  }

  template <class Number>
  requires std::is_arithmetic_v<Number>
  void add(Number number) {
    if constexpr (std::is_same_v<Number, bool>) {
      add(static_cast<std::uint8_t>(number ? 1 : 0));
    } else {
      align(sizeof number);
      append(&number, sizeof number);
    }
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
    static_assert(!std::is_same_v<Value, bool>, "std::vector<bool> has no array of bool");
    add_count(values.size());
    add_all(values.data(), values.size());
  }
  template <RosMessage Message>
  void add(const Message& message) {
    std::apply([&](const auto&... fields) { (add(message.*fields.member), ...); }, Message::fields);
  }

  /// The message, until it is changed.
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
    if (count > std::numeric_limits<std::uint32_t>::max()) throw CdrError("a list or text is longer than CDR allows");
    add(static_cast<std::uint32_t>(count));
  }
  template <class Value>
  void add_all(const Value* values, std::size_t count) {
    if (count == 0) return;
    if constexpr (std::is_arithmetic_v<Value> && !std::is_same_v<Value, bool>) {
      align(sizeof(Value));
      append(values, count * sizeof(Value));
    } else {
      for (std::size_t i = 0; i < count; ++i) add(values[i]);
    }
  }

  Bytes bytes_;
};

/// Reads what a CdrWriter, or ROS, wrote. Throws CdrError; takes no more memory than the message may fill.
class CdrReader {
 public:
  explicit CdrReader(ByteView message) {
    if (message.size() < 4) throw CdrError("a message of " + std::to_string(message.size()) + " bytes is no CDR");
    if (message[0] != std::byte{0} || message[1] != std::byte{1})
      throw CdrError("the message is no little-endian CDR: it does not begin with 00 01");
    bytes_ = message.subspan(4);
  }

  template <class Number>
  requires std::is_arithmetic_v<Number>
  void read(Number& number) {
    if constexpr (std::is_same_v<Number, bool>) {
      number = *take(1, 1) != std::byte{0};
    } else {
      std::memcpy(&number, take(sizeof number, sizeof number), sizeof number);
    }
  }
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
    static_assert(!std::is_same_v<Value, bool>, "std::vector<bool> has no array of bool");
    values.resize(read_count(CdrSize<Value>::least()));
    read_all(values.data(), values.size());
  }
  template <RosMessage Message>
  void read(Message& message) {
    std::apply([&](const auto&... fields) { (read(message.*fields.member), ...); }, Message::fields);
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
      throw CdrError("the message ends at its byte " + std::to_string(bytes_.size() + 4) + "; there should be " +
                     std::to_string(size) + " more");
    at_ += skipped + size;
    return bytes_.data() + (at_ - size);
  }
  // A count of things that take at least `bytes_each`.
  std::size_t read_count(std::size_t bytes_each) {
    const auto count = get<std::uint32_t>();
    if (count > left() / std::max<std::size_t>(1, bytes_each))
      throw CdrError("a list or text of " + std::to_string(count) + " in a message that has " + std::to_string(left()) +
                     " bytes left");
    return count;
  }
  template <class Value>
  void read_all(Value* values, std::size_t count) {
    if (count == 0) return;
    if constexpr (std::is_arithmetic_v<Value> && !std::is_same_v<Value, bool>) {
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

/// What comes after the message's last field is ignored. Throws CdrError.
template <RosMessage Message>
Message decode(ByteView bytes) {
  return CdrReader(bytes).get<Message>();
}

}  // namespace cohort::messages
