// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

/// Frames of MAVLink 2: a header of ten bytes, a payload without its trailing zeros, a checksum. Pure functions.
namespace cohort::mavlink {

inline constexpr std::size_t largest_payload = 255;

struct Packet {
  std::uint8_t sequence = 0;
  std::uint8_t system = 0;
  std::uint8_t component = 0;
  std::uint32_t id = 0;  ///< message id
  std::vector<std::uint8_t> payload{};
};

/// Returns the frame of a packet, whose payload has at most `largest_payload` bytes.
std::vector<std::uint8_t> frame_of(const Packet& packet, std::uint8_t crc_extra);

/// Returns the size of the first piece of a stream [bytes]: a frame, or invalid bytes up to where the next frame may
/// begin. Returns 0 if more bytes are needed.
std::size_t size_at(std::span<const std::uint8_t> stream);

/// A piece of a stream, as `size_at` delimits it.
struct Piece {
  std::optional<Packet> packet;  ///< nullopt: the bytes are not a frame, or the checksum is wrong
  bool is_known = false;         ///< the message is in hil_messages.hpp; other messages' checksums cannot be checked
};
Piece piece_of(std::span<const std::uint8_t> bytes);

/// Returns MAVLink's variant of the X.25 checksum: CRC-16/MCRF4XX.
std::uint16_t checksum(std::span<const std::uint8_t> bytes, std::uint16_t seed = 0xffff);

}  // namespace cohort::mavlink
