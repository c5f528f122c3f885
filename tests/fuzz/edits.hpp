// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace cohort::fuzz {

/// Takes an input as changes to `bytes`, for formats that a fuzzer would never meet by itself: ten bytes a change,
/// where (two), what (one) and with which value (seven).
template <class Byte>
std::vector<Byte> edited(std::vector<Byte> bytes, std::span<const std::uint8_t> input) {
  static_assert(sizeof(Byte) == 1);
  constexpr std::size_t length = 10;
  constexpr std::size_t most_changes = 16;
  for (std::size_t change = 0; change < most_changes && input.size() >= length && !bytes.empty(); ++change) {
    const std::size_t at = (input[0] * 256U + input[1]) * 7919U % bytes.size();
    const std::size_t left = bytes.size() - at;
    switch (input[2] % 4) {
      case 0: bytes[at] = static_cast<Byte>(input[3]); break;
      case 1: std::memcpy(bytes.data() + at, input.data() + 3, std::min<std::size_t>(left, input[3] % 8)); break;
      case 2: std::memset(bytes.data() + at, input[3] % 2 == 0 ? 0xff : 0x7f, std::min<std::size_t>(left, 8)); break;
      default:
        if (input[3] % 16 == 0)
          bytes.resize(at);
        else
          bytes[at] = static_cast<Byte>(static_cast<std::uint8_t>(bytes[at]) ^ (1U << (input[3] % 8)));
    }
    input = input.subspan(length);
  }
  return bytes;
}

}  // namespace cohort::fuzz
