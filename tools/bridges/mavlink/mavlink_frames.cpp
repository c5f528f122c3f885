// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/mavlink/mavlink_frames.hpp"

#include <algorithm>
#include <array>

#include "tools/bridges/mavlink/hil_messages.hpp"

namespace cohort::mavlink {
namespace {

constexpr std::uint8_t start_of_frame = 0xfd;
constexpr std::size_t header_size = 10;
constexpr std::size_t checksum_size = 2;
constexpr std::size_t signature_size = 13;
constexpr std::uint8_t is_signed = 1;  // flag of incompatible features, the only one that there is

template <class... Messages>
std::optional<std::uint8_t> extra_in(std::uint32_t id) {
  std::optional<std::uint8_t> extra;
  ((id == Messages::id ? (void)(extra = Messages::crc_extra) : (void)0), ...);
  return extra;
}

std::optional<std::uint8_t> extra_of(std::uint32_t id) {
  return extra_in<Heartbeat, CommandLong, HilActuatorControls, HilSensor, HilGps, HilStateQuaternion>(id);
}

std::uint32_t id_in(std::span<const std::uint8_t> frame) {
  return frame[7] | static_cast<std::uint32_t>(frame[8]) << 8 | static_cast<std::uint32_t>(frame[9]) << 16;
}

// 0 if more bytes are needed to know it.
std::size_t frame_size(std::span<const std::uint8_t> stream) {
  if (stream.size() < 3) return 0;
  return header_size + stream[1] + checksum_size + (stream[2] & is_signed ? signature_size : 0);
}

bool may_be_frame(std::span<const std::uint8_t> stream) {
  return stream[0] == start_of_frame && (stream.size() < 3 || (stream[2] & ~is_signed) == 0);
}

std::uint16_t checksum_of(std::span<const std::uint8_t> frame, std::uint8_t extra) {
  const std::uint16_t so_far = checksum(frame.subspan(1, header_size - 1 + frame[1]));
  return checksum(std::array{extra}, so_far);
}

bool has_its_checksum(std::span<const std::uint8_t> frame) {
  const auto extra = extra_of(id_in(frame));
  const std::size_t end = header_size + frame[1];
  return !extra || checksum_of(frame, *extra) == (frame[end] | frame[end + 1] << 8);
}

}  // namespace

std::uint16_t checksum(std::span<const std::uint8_t> bytes, std::uint16_t seed) {
  std::uint16_t crc = seed;
  for (const std::uint8_t byte : bytes) {
    auto mixed = static_cast<std::uint8_t>(byte ^ (crc & 0xff));
    mixed = static_cast<std::uint8_t>(mixed ^ (mixed << 4));
    crc = static_cast<std::uint16_t>((crc >> 8) ^ (mixed << 8) ^ (mixed << 3) ^ (mixed >> 4));
  }
  return crc;
}

std::vector<std::uint8_t> frame_of(const Packet& packet, std::uint8_t crc_extra) {
  std::size_t size = packet.payload.size();
  while (size > 1 && packet.payload[size - 1] == 0) --size;
  std::vector<std::uint8_t> frame = {start_of_frame,
                                     static_cast<std::uint8_t>(size),
                                     0,
                                     0,
                                     packet.sequence,
                                     packet.system,
                                     packet.component,
                                     static_cast<std::uint8_t>(packet.id),
                                     static_cast<std::uint8_t>(packet.id >> 8),
                                     static_cast<std::uint8_t>(packet.id >> 16)};
  frame.reserve(header_size + size + checksum_size);
  for (std::size_t i = 0; i < size; ++i) frame.push_back(packet.payload[i]);
  const std::uint16_t crc = checksum_of(frame, crc_extra);
  frame.push_back(static_cast<std::uint8_t>(crc));
  frame.push_back(static_cast<std::uint8_t>(crc >> 8));
  return frame;
}

std::size_t size_at(std::span<const std::uint8_t> stream) {
  if (stream.empty()) return 0;
  if (may_be_frame(stream)) {
    const std::size_t size = frame_size(stream);
    if (size == 0 || size > stream.size()) return size;
    if (has_its_checksum(stream.first(size))) return size;
  }
  const auto next = std::find(stream.begin() + 1, stream.end(), start_of_frame);
  return static_cast<std::size_t>(next - stream.begin());
}

Piece piece_of(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < header_size + checksum_size || !may_be_frame(bytes) || frame_size(bytes) != bytes.size() ||
      !has_its_checksum(bytes))
    return {};
  const auto payload = bytes.subspan(header_size, bytes[1]);
  return {Packet{bytes[4], bytes[5], bytes[6], id_in(bytes), {payload.begin(), payload.end()}},
          extra_of(id_in(bytes)).has_value()};
}

}  // namespace cohort::mavlink
