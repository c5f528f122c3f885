// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace cohort::avr {

/// A contiguous range of bytes in one memory.
struct Segment {
  std::uint32_t address = 0;
  std::vector<std::uint8_t> bytes{};
};

/// A compiled program for a microcontroller, as read from a file.
struct Image {
  std::string file;
  std::vector<Segment> flash{};
  std::vector<Segment> eeprom{};
  std::string mcu{};                         ///< microcontroller named by the image; empty: none
  std::optional<std::uint32_t> frequency{};  ///< required clock [Hz], from simavr's section .mmcu

  /// Returns the address after the last byte of its program.
  std::uint32_t flash_end() const;
};

/// Reads an ELF file for AVR, or Intel HEX. Throws std::runtime_error that says what is wrong and where, and what was
/// expected.
Image read_image(const std::filesystem::path& file);

}  // namespace cohort::avr
