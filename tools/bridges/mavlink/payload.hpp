// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <type_traits>
#include <vector>

#include "tools/bridges/mavlink/mavlink_frames.hpp"

/// Encodes messages to payloads and decodes them: fields without padding, little-endian.
namespace cohort::mavlink {

namespace coding {

template <std::size_t size>
using UnsignedOf = std::conditional_t<
    size == 1, std::uint8_t,
    std::conditional_t<size == 2, std::uint16_t, std::conditional_t<size == 4, std::uint32_t, std::uint64_t>>>;

template <class Number>
void put(std::vector<std::uint8_t>& payload, const Number& number) {
  const auto bits = std::bit_cast<UnsignedOf<sizeof number>>(number);
  for (std::size_t byte = 0; byte < sizeof number; ++byte)
    payload.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(bits) >> 8 * byte));
}
template <class Number, std::size_t size>
void put(std::vector<std::uint8_t>& payload, const std::array<Number, size>& numbers) {
  for (const Number& number : numbers) put(payload, number);
}

// Bytes beyond the end of a payload count as zeros.
template <class Number>
void take(std::span<const std::uint8_t>& payload, Number& number) {
  std::uint64_t bits = 0;
  for (std::size_t byte = 0; byte < sizeof number; ++byte) {
    if (payload.empty()) break;
    bits |= static_cast<std::uint64_t>(payload.front()) << 8 * byte;
    payload = payload.subspan(1);
  }
  number = std::bit_cast<Number>(static_cast<UnsignedOf<sizeof number>>(bits));
}
template <class Number, std::size_t size>
void take(std::span<const std::uint8_t>& payload, std::array<Number, size>& numbers) {
  for (Number& number : numbers) take(payload, number);
}

}  // namespace coding

template <class Message>
std::vector<std::uint8_t> payload_of(const Message& message) {
  std::vector<std::uint8_t> payload;
  std::apply([&](const auto&... field) { (coding::put(payload, field), ...); }, Message::fields(message));
  return payload;
}

/// Returns the message in a packet; nullopt if the packet contains another message.
template <class Message>
std::optional<Message> message_in(const Packet& packet) {
  if (packet.id != Message::id) return std::nullopt;
  Message message;
  std::span<const std::uint8_t> payload = packet.payload;
  std::apply([&](auto&... field) { (coding::take(payload, field), ...); }, Message::fields(message));
  return message;
}

}  // namespace cohort::mavlink
