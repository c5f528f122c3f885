// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <istream>
#include <locale>
#include <ostream>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

/// The state of a controller as bytes: `Controller::save` writes values, and `Controller::load` reads them in the same
/// order. The format is little-endian and the same on every machine.
namespace cohort {

static_assert(std::endian::native == std::endian::little, "state is written in the byte order of the machine");

/// Maximum size of the state of one robot's controller [bytes].
inline constexpr std::size_t largest_state = std::size_t{1} << 20;

/// The error thrown if a state ends too early or contains an invalid value.
class StateError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A number, a flag or an enumerator. `long double` is excluded, because its format depends on the compiler.
template <class Value>
concept StateValue = (std::is_arithmetic_v<Value> && !std::is_same_v<Value, long double>) || std::is_enum_v<Value>;

/// A random number generator with the interface of the standard library, such as std::mt19937_64.
template <class Engine>
concept StateEngine = requires(Engine& engine, const Engine& same, std::istream& in, std::ostream& out) {
  typename Engine::result_type;
  engine.discard(1);
  out << same;
  in >> engine;
};

/// A writer of the state of a controller, valid during `save` only.
class StateWriter {
 public:
  template <StateValue Value>
  void write(Value value) {
    add(&value, sizeof value);
  }
  template <class Ticks, class Period>
  void write(std::chrono::duration<Ticks, Period> duration) {
    write(duration.count());
  }
  void write(std::string_view text) {
    write(static_cast<std::uint64_t>(text.size()));
    add(text.data(), text.size());
  }
  template <StateValue Value>
  requires(!std::is_same_v<Value, bool>) void write(const std::vector<Value>& values) {
    write(static_cast<std::uint64_t>(values.size()));
    add(values.data(), values.size() * sizeof(Value));
  }
  /// Writes the state of a random number generator in the text format of the C++ standard.
  template <StateEngine Engine>
  void write(const Engine& engine) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text << engine;
    write(std::string_view(text.view()));
  }
  /// Writes several values, one after the other.
  template <class First, class Second, class... More>
  void write(const First& first, const Second& second, const More&... more) {
    write(first);
    write(second);
    (write(more), ...);
  }

  /// Marks the state as not saved. A run that continues from this snapshot then restarts the controller, with a
  /// warning.
  void leave_out() { is_left_out_ = true; }
  bool is_left_out() const { return is_left_out_; }
  std::span<const std::byte> bytes() const { return bytes_; }

 private:
  void add(const void* from, std::size_t size) {
    const auto* const bytes = static_cast<const std::byte*>(from);
    bytes_.insert(bytes_.end(), bytes, bytes + size);
  }

  std::vector<std::byte> bytes_;
  bool is_left_out_ = false;
};

/// A reader of the values that a StateWriter wrote, in the same order, valid during `load` only. Its functions throw
/// StateError if the state ends too early. A snapshot may come from an untrusted source, so check values that can be
/// invalid.
class StateReader {
 public:
  explicit StateReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <StateValue Value>
  requires(!std::is_same_v<Value, bool>) void read(Value& value) { take(&value, sizeof value); }
  void read(bool& flag) {
    std::uint8_t number = 0;
    read(number);
    if (number > 1) throw StateError("invalid state: a flag is neither 0 nor 1");
    flag = number == 1;
  }
  /// Reads an enumerator. Throws StateError unless its value is from 0 to that of `last`.
  template <class Enum>
  requires std::is_enum_v<Enum>
  void read_up_to(Enum& value, Enum last) {
    read(value);
    if (static_cast<std::int64_t>(value) < 0 || value > last)
      throw StateError("invalid state: an enumerator is out of range");
  }
  template <class Ticks, class Period>
  void read(std::chrono::duration<Ticks, Period>& duration) {
    Ticks count{};
    read(count);
    duration = std::chrono::duration<Ticks, Period>(count);
  }
  void read(std::string& text) {
    text.resize(read_count(1));
    take(text.data(), text.size());
  }
  template <StateValue Value>
  requires(!std::is_same_v<Value, bool>) void read(std::vector<Value>& values) {
    values.resize(read_count(sizeof(Value)));
    take(values.data(), values.size() * sizeof(Value));
  }
  template <StateEngine Engine>
  void read(Engine& engine) {
    std::string text;
    read(text);
    std::istringstream words(text);
    words.imbue(std::locale::classic());
    if (!(words >> engine)) throw StateError("invalid state: expected a random number generator");
  }
  template <class First, class Second, class... More>
  void read(First& first, Second& second, More&... more) {
    read(first);
    read(second);
    (read(more), ...);
  }

  /// Returns the unread bytes.
  std::span<const std::byte> rest() const { return bytes_; }

 private:
  std::size_t read_count(std::size_t bytes_each) {
    std::uint64_t count = 0;
    read(count);
    if (count > bytes_.size() / bytes_each) throw StateError("invalid state: unexpected end");
    return static_cast<std::size_t>(count);
  }
  void take(void* to, std::size_t size) {
    if (bytes_.size() < size) throw StateError("invalid state: unexpected end");
    if (size != 0) std::memcpy(to, bytes_.data(), size);
    bytes_ = bytes_.subspan(size);
  }

  std::span<const std::byte> bytes_;
};

}  // namespace cohort
