// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <span>
#include <stdexcept>

#include "tools/bridges/avr/pins.hpp"

namespace cohort::avr {
namespace {

// Pins of the boards as Arduino's files of variants number them: standard, mega and leonardo, with port and bit.
constexpr std::array uno_digital{"D0", "D1", "D2", "D3", "D4", "D5", "D6", "D7", "B0", "B1",
                                 "B2", "B3", "B4", "B5", "C0", "C1", "C2", "C3", "C4", "C5"};
constexpr std::array uno_analog{"C0", "C1", "C2", "C3", "C4", "C5"};
constexpr std::array mega_digital{"E0", "E1", "E4", "E5", "G5", "E3", "H3", "H4", "H5", "H6", "B4", "B5", "B6", "B7",
                                  "J1", "J0", "H1", "H0", "D3", "D2", "D1", "D0", "A0", "A1", "A2", "A3", "A4", "A5",
                                  "A6", "A7", "C7", "C6", "C5", "C4", "C3", "C2", "C1", "C0", "D7", "G2", "G1", "G0",
                                  "L7", "L6", "L5", "L4", "L3", "L2", "L1", "L0", "B3", "B2", "B1", "B0"};
constexpr std::array mega_analog{"F0", "F1", "F2", "F3", "F4", "F5", "F6", "F7",
                                 "K0", "K1", "K2", "K3", "K4", "K5", "K6", "K7"};
constexpr std::array leonardo_digital{"D2", "D3", "D1", "D0", "D4", "C6", "D7", "E6", "B4",
                                      "B5", "B6", "B7", "D6", "C7", "B3", "B1", "B2", "B0"};
constexpr std::array leonardo_analog{"F7", "F6", "F5", "F4", "F1", "F0"};

std::span<const char* const> numbered(const std::string& mcu, bool analog) {
  if (mcu.starts_with("atmega328") || mcu.starts_with("atmega168"))
    return analog ? std::span<const char* const>(uno_analog) : std::span<const char* const>(uno_digital);
  if (mcu == "atmega2560" || mcu == "atmega1280")
    return analog ? std::span<const char* const>(mega_analog) : std::span<const char* const>(mega_digital);
  if (mcu == "atmega32u4")
    return analog ? std::span<const char* const>(leonardo_analog) : std::span<const char* const>(leonardo_digital);
  return {};
}

}  // namespace

Pin pin_of(const std::string& name, const std::string& mcu) {
  const bool is_port =
      name.size() == 3 && name[0] == 'P' && name[1] >= 'A' && name[1] <= 'L' && name[2] >= '0' && name[2] <= '7';
  if (is_port) return {name[1], name[2] - '0'};
  const bool is_numbered = (name.size() == 2 || name.size() == 3) && (name[0] == 'D' || name[0] == 'A') &&
                           name.find_first_not_of("0123456789", 1) == std::string::npos;
  if (is_numbered) {
    const auto pins = numbered(mcu, name[0] == 'A');
    const std::size_t number = std::stoul(name.substr(1));
    if (pins.empty())
      throw std::runtime_error("'" + name +
                               "' is an Arduino pin name, but no Arduino board has this microcontroller: expected a "
                               "port and a bit, such as PB5");
    if (number < pins.size()) return {pins[number][0], pins[number][1] - '0'};
  }
  throw std::runtime_error(
      "'" + name + "' is not a pin: expected a port and a bit, such as PB5, or an Arduino pin name, such as D13 or A0");
}

}  // namespace cohort::avr
