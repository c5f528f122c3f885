// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tools/bridges/avr/output_pins.hpp"

namespace cohort::avr {

/// One value of a robot's channel.
struct ChannelValue {
  std::string channel;    ///< such as `left_wheel/0/velocity`
  std::size_t index = 0;  ///< index of the value in a channel with several
};

/// A piecewise linear function; constant before the first point and after the last.
class Curve {
 public:
  struct Point {
    double x, y;
  };
  explicit Curve(std::vector<Point> points) : points_(std::move(points)) {}
  double operator()(double x) const;

 private:
  std::vector<Point> points_;  // x ascending, at least two
};

/// A motor on an H-bridge. Its command is `scale` × duty(enable) × (duty(forward) - duty(backward)). The duty of an
/// absent pin is 1. A low `direction` reverses the motor.
struct Motor {
  ChannelValue command;
  double scale = 1.0;
  std::optional<Pin> enable, forward, backward, direction;
};

/// A servo: the curve maps the pulse length [s] to the command.
struct Servo {
  ChannelValue command;
  Pin pin;
  Curve pulses;
};

/// An LED: its brightness is the duty, of one pin or of red, green and blue.
struct Led {
  std::string channel;
  std::optional<Pin> red, green, blue, all;
  bool active_low = false;
};

/// A loudspeaker: its frequency is that of the pin's edges; it is silent without edges.
struct Speaker {
  std::string device;
  Pin pin;
  double intensity = 1.0;
};

/// A switch that is on while an observation is above or below a threshold.
struct Switch {
  ChannelValue observation;
  Pin pin;
  double threshold = 0.5;
  bool is_on_above = true;
  bool is_low_when_on = true;
};

/// An analog input: the curve maps the observation to a voltage.
struct Analog {
  ChannelValue observation;
  int input = 0;
  Curve volts;
};

/// An encoder of a wheel: edges on one pin, or in quadrature on two.
struct Encoder {
  ChannelValue observation;  ///< the wheel's position [rad]
  Pin a;
  std::optional<Pin> b;
  double edges_per_turn = 0.0;  ///< on both pins together
};

/// An ultrasonic range sensor HC-SR04: its echo pulse lasts as long as sound travels to the obstacle and back.
struct Ultrasonic {
  ChannelValue observation;  ///< [m]
  Pin trigger, echo;
};

using Wire = std::variant<Motor, Servo, Led, Speaker, Switch, Analog, Encoder, Ultrasonic>;

/// One entry of a pin map, and its line in the file.
struct Entry {
  Wire wire;
  int line = 0;
};

/// A robot's wiring: the device on each pin.
struct Pins {
  std::string file;
  std::string mcu{};                         ///< empty: not specified
  std::optional<std::uint32_t> frequency{};  ///< [Hz]
  double supply = 5.0;                       ///< [V]
  std::optional<int> serial{};               ///< serial interface shown to the user
  std::vector<Entry> wires{};
};

/// Reads a pin map. Throws std::runtime_error that names the file, the line, the error, and what was expected.
Pins read_pins(const std::filesystem::path& file);

/// Reads the name of a pin, such as `PB5`. If an Arduino board has this `mcu`, also reads the board's names, such as
/// `D13` or `A0`. Throws std::runtime_error.
Pin pin_of(const std::string& name, const std::string& mcu);

}  // namespace cohort::avr
