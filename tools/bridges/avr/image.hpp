#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace cohort::avr {

/// Bytes of an image that follow each other in one memory.
struct Segment {
  std::uint32_t address = 0;
  std::vector<std::uint8_t> bytes{};
};

/// A compiled program of a microcontroller, as a file has it.
struct Image {
  std::string file;
  std::vector<Segment> flash{};
  std::vector<Segment> eeprom{};
  std::string mcu{};                         ///< that it says it is for; empty if it does not say
  std::optional<std::uint32_t> frequency{};  ///< [Hz] that it asks for, by simavr's section .mmcu

  /// Returns the address after the last byte of its program.
  std::uint32_t flash_end() const;
};

/// Reads an ELF file for AVR, or Intel HEX. Throws std::runtime_error that says what is wrong and where, and what was
/// expected.
Image read_image(const std::filesystem::path& file);

}  // namespace cohort::avr
