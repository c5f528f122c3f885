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

/// Returns the size of what a stream begins with: a frame, or bytes that cannot be one up to where the next may begin.
/// 0 if more bytes are needed to know.
std::size_t size_at(std::span<const std::uint8_t> stream);

/// A piece of a stream, as `size_at` delimits it.
struct Piece {
  std::optional<Packet> packet;  ///< nothing: the bytes are no frame, or its checksum is wrong
  bool is_known = false;         ///< its message is one of hil_messages.hpp; others' checksums cannot be checked
};
Piece piece_of(std::span<const std::uint8_t> bytes);

/// X.25's checksum, as MAVLink has it: CRC-16/MCRF4XX.
std::uint16_t checksum(std::span<const std::uint8_t> bytes, std::uint16_t seed = 0xffff);

}  // namespace cohort::mavlink
