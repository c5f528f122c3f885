// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace cohort {

/// The error thrown if a snapshot cannot be read, or does not match the simulation.
class SnapshotError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A writer of consecutive numbers in little-endian format.
class SnapshotWriter {
 public:
  template <class Number>
  requires std::is_arithmetic_v<Number> || std::is_enum_v<Number>
  void add(Number number) {
    const std::size_t at = bytes_.size();
    bytes_.resize(at + sizeof number);
    std::memcpy(bytes_.data() + at, &number, sizeof number);
  }
  template <class Number>
  requires std::is_arithmetic_v<Number> || std::is_enum_v<Number>
  void add_all(const Number* numbers, std::size_t count) {
    if (count == 0) return;
    const std::size_t at = bytes_.size();
    bytes_.resize(at + count * sizeof *numbers);
    std::memcpy(bytes_.data() + at, numbers, count * sizeof *numbers);
  }
  /// Adds the number of elements that follow; `SnapshotReader::read_count` checks it.
  void add_count(std::size_t count) { add(static_cast<std::uint64_t>(count)); }

  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

/// The layout of a simulation's numbers in a snapshot. Later builds extend it, and read the earlier ones.
enum class SnapshotLayout { first, with_belt_loads, with_slots };

/// Reads the data of a SnapshotWriter, in the same order. Throws SnapshotError at the end of the bytes. A snapshot may
/// come from an untrusted source, so callers must validate the numbers.
class SnapshotReader {
 public:
  explicit SnapshotReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <class Number>
  requires std::is_arithmetic_v<Number> || std::is_enum_v<Number>
  void read(Number& number) {
    if (bytes_.size() < sizeof number) throw SnapshotError("the snapshot is incomplete");
    std::memcpy(&number, bytes_.data(), sizeof number);
    bytes_ = bytes_.subspan(sizeof number);
  }
  template <class Number>
  requires std::is_arithmetic_v<Number> || std::is_enum_v<Number>
  void read_all(Number* numbers, std::size_t count) {
    if (count == 0) return;
    if (bytes_.size() / sizeof *numbers < count) throw SnapshotError("the snapshot is incomplete");
    std::memcpy(numbers, bytes_.data(), count * sizeof *numbers);
    bytes_ = bytes_.subspan(count * sizeof *numbers);
  }
  /// Reads a flag, which must be 0 or 1.
  void read(bool& flag) {
    std::uint8_t number = 0;
    read(number);
    if (number > 1) throw SnapshotError("snapshot: a flag is neither 0 nor 1");
    flag = number == 1;
  }
  /// Reads the number of elements that follow, each of which takes at least `bytes_each` bytes.
  std::size_t read_count(std::size_t bytes_each) {
    std::uint64_t count = 0;
    read(count);
    if (count > bytes_.size() / bytes_each) throw SnapshotError("the snapshot is incomplete");
    return static_cast<std::size_t>(count);
  }
  /// Reads the number of elements, and throws SnapshotError unless it is `count`. `what`: the name of the elements in
  /// the message.
  void expect_count(std::size_t count, const std::string& what) {
    std::uint64_t saved = 0;
    read(saved);
    if (saved != count)
      throw SnapshotError("the snapshot belongs to another experiment: it has " + std::to_string(saved) + " " + what +
                          ", not " + std::to_string(count));
  }
  bool is_at_end() const { return bytes_.empty(); }

  /// Returns the layout of the snapshot as given at its beginning; by default the latest one.
  SnapshotLayout layout() const { return layout_; }
  void set_layout(SnapshotLayout layout) { layout_ = layout; }

 private:
  std::span<const std::byte> bytes_;
  SnapshotLayout layout_ = SnapshotLayout::with_slots;
};

}  // namespace cohort
