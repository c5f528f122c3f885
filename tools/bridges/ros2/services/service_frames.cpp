// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ros2/services/service_frames.hpp"

#include <cstring>
#include <stdexcept>
#include <utility>

namespace cohort::bridges::ros2 {
namespace {

struct FieldWriter {
  std::string& bytes;

  void raw(const void* data, std::size_t size) { bytes.append(static_cast<const char*>(data), size); }
  void count(std::size_t number) { (*this)(static_cast<std::uint32_t>(number)); }

  void operator()(std::uint32_t value) { raw(&value, sizeof value); }
  void operator()(std::int64_t value) { raw(&value, sizeof value); }
  void operator()(bool value) { bytes.push_back(value ? 1 : 0); }
  void operator()(const Guid& value) { raw(value.data(), value.size()); }
  void operator()(const std::string& value) { count(value.size()), raw(value.data(), value.size()); }
  void operator()(const std::vector<std::string>& values) {
    count(values.size());
    for (const std::string& value : values) (*this)(value);
  }
};

struct FieldReader {
  std::string_view bytes;

  std::string_view take(std::size_t size) {
    if (size > bytes.size())
      throw std::runtime_error("frame: a field has " + std::to_string(size) + " bytes, but only " +
                               std::to_string(bytes.size()) + " are left");
    const std::string_view taken = bytes.substr(0, size);
    bytes.remove_prefix(size);
    return taken;
  }
  void raw(void* data, std::size_t size) { std::memcpy(data, take(size).data(), size); }

  void operator()(std::uint32_t& value) { raw(&value, sizeof value); }
  void operator()(std::int64_t& value) { raw(&value, sizeof value); }
  void operator()(bool& value) { value = take(1).front() != 0; }
  void operator()(Guid& value) { raw(value.data(), value.size()); }
  void operator()(std::string& value) {
    std::uint32_t size = 0;
    (*this)(size);
    value = take(size);
  }
  void operator()(std::vector<std::string>& values) {
    std::uint32_t number = 0;
    (*this)(number);
    for (std::uint32_t i = 0; i < number; ++i) (*this)(values.emplace_back());
  }
};

template <typename Frame>
std::string encode_any(Frame frame) {
  std::string fields;
  std::visit(
      [&](auto& each) {
        fields.push_back(static_cast<char>(each.kind));
        each.visit(FieldWriter{fields});
      },
      frame);
  if (fields.size() > largest_frame)
    throw std::length_error("frame of " + std::to_string(fields.size()) + " bytes; at most " +
                            std::to_string(largest_frame) + " are possible");
  std::string bytes;
  FieldWriter{bytes}.count(fields.size());
  return bytes + fields;
}

// Tries the alternatives of the variant from number I on.
template <typename Frame, std::size_t I = 0>
Frame decode(std::uint8_t kind, std::string_view fields) {
  if constexpr (I == std::variant_size_v<Frame>) {
    throw std::runtime_error("frame: unknown kind " + std::to_string(kind));
  } else {
    using Each = std::variant_alternative_t<I, Frame>;
    if (kind != Each::kind) return decode<Frame, I + 1>(kind, fields);
    Each each;
    FieldReader reader{fields};
    each.visit(reader);
    if (!reader.bytes.empty())
      throw std::runtime_error("frame of kind " + std::to_string(kind) + ": " + std::to_string(reader.bytes.size()) +
                               " extra bytes");
    return each;
  }
}

}  // namespace

std::string encode(const FrameToHelper& frame) { return encode_any(frame); }
std::string encode(const FrameToBridge& frame) { return encode_any(frame); }

template <typename Frame>
std::optional<Frame> FrameStream<Frame>::next() {
  const std::string_view rest = std::string_view(bytes_).substr(begin_);
  std::uint32_t size = 0;
  if (rest.size() >= sizeof size) {
    std::memcpy(&size, rest.data(), sizeof size);
    if (size == 0 || size > largest_frame)
      throw std::runtime_error("frame of " + std::to_string(size) + " bytes; expected 1 to " +
                               std::to_string(largest_frame));
  }
  if (size == 0 || rest.size() - sizeof size < size) {
    bytes_.erase(0, std::exchange(begin_, 0));
    return {};
  }
  begin_ += sizeof size + size;
  const std::string_view frame = rest.substr(sizeof size, size);
  return decode<Frame>(static_cast<std::uint8_t>(frame.front()), frame.substr(1));
}

template class FrameStream<FrameToHelper>;
template class FrameStream<FrameToBridge>;

}  // namespace cohort::bridges::ros2
