// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// The packets that programs exchange with an e-puck2 over WiFi (docs/bridges/epuck2.md). Pure functions.
namespace cohort::epuck2 {

inline constexpr std::size_t command_size = 21;
inline constexpr std::size_t sensors_size = 104;
inline constexpr int image_width = 160;
inline constexpr int image_height = 120;
inline constexpr std::uint8_t greatest_brightness =
    100;  // for each colour of an RGB LED; larger values leave the LED unchanged

/// The fields of a command packet.
struct Command {
  bool wants_image = false;
  bool wants_sensors = false;
  bool calibrates = false;
  bool avoids_obstacles = false;
  bool sets_steps = false;  ///< `left` and `right` are positions of the step counters, not speeds
  std::int16_t left = 0;    ///< [steps/s], or [steps]
  std::int16_t right = 0;
  std::array<bool, 4> red_leds{};                         ///< LED1, LED3, LED5, LED7
  std::array<std::array<std::uint8_t, 3>, 4> rgb_leds{};  ///< LED2, LED4, LED6, LED8
  bool body_led = false;
  bool front_led = false;
  std::uint8_t sound = 0;
};

/// Returns the error in the first bytes of a command, which may be incomplete; nothing if a robot would accept it.
std::optional<std::string> mistake_of(std::span<const std::uint8_t> begun);
/// Decodes the `command_size` bytes of a command.
Command decode(std::span<const std::uint8_t> bytes);

/// Contents of the sensors packet, in the packet's units.
struct Sensors {
  std::array<std::int16_t, 3> acceleration{};  ///< x right, y forward, z up; 768 is 1 g
  float acceleration_size = 0.0F;
  float orientation = 0.0F;                        ///< [degrees]
  float inclination = 0.0F;                        ///< [degrees]
  std::array<std::int16_t, 3> angular_velocity{};  ///< 131 is one degree per second
  std::array<float, 3> magnetic_field{};           ///< [uT]
  std::int8_t temperature = 0;                     ///< [degrees Celsius]
  std::array<std::uint16_t, 8> proximity{};
  std::array<std::uint16_t, 8> ambient_light{};
  std::uint16_t distance = 0;  ///< [mm]
  std::array<std::uint16_t, 4> microphones{};
  std::array<std::int16_t, 2> steps{};  ///< left, right
  std::uint16_t battery = 0;
  std::uint8_t has_micro_sd = 0;
  std::array<std::uint8_t, 3> remote_control{};
  std::uint8_t selector = 0;
  std::array<std::uint16_t, 3> ground{};
  std::array<std::uint16_t, 3> ground_light{};
  std::uint8_t button = 0;
};

/// Returns a packet of the robot: an id of one byte, then the payload.
std::vector<std::uint8_t> sensors_packet(const Sensors& sensors);
/// Returns a black image, because nothing is rendered.
std::vector<std::uint8_t> image_packet();
std::vector<std::uint8_t> empty_packet();

}  // namespace cohort::epuck2
