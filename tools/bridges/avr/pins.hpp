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

/// One value of a channel of the robot.
struct ChannelValue {
  std::string channel;    ///< such as `left_wheel/0/velocity`
  std::size_t index = 0;  ///< index of the value in a channel with several
};

/// A function by points with straight lines between them; beyond the first and the last it stays as it is there.
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

/// A motor behind a bridge: `scale` × duty(enable) × (duty(forward) - duty(backward)), where what is absent counts as
/// full, and with its direction reversed where `direction` is low.
struct Motor {
  ChannelValue command;
  double scale = 1.0;
  std::optional<Pin> enable, forward, backward, direction;
};

/// A servo: a command by the length of its pulses [s].
struct Servo {
  ChannelValue command;
  Pin pin;
  Curve pulses;
};

/// An LED: how bright by duty, for one value or for red, green and blue.
struct Led {
  std::string channel;
  std::optional<Pin> red, green, blue, all;
  bool active_low = false;
};

/// A loudspeaker: a frequency by edges; it is silent without them.
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

/// An analog input: a voltage by an observation.
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

/// An HC-SR04: an echo as long as sound needs for twice the range.
struct Ultrasonic {
  ChannelValue observation;  ///< [m]
  Pin trigger, echo;
};

using Wire = std::variant<Motor, Servo, Led, Speaker, Switch, Analog, Encoder, Ultrasonic>;

/// One entry of a file of pins, and its line there.
struct Entry {
  Wire wire;
  int line = 0;
};

/// A robot's wiring: what is on which pin.
struct Pins {
  std::string file;
  std::string mcu{};                         ///< empty if it does not say
  std::optional<std::uint32_t> frequency{};  ///< [Hz]
  double supply = 5.0;                       ///< [V]
  std::optional<int> serial{};               ///< the serial interface that people see
  std::vector<Entry> wires{};
};

/// Reads a file of pins. Throws std::runtime_error that says file, line, what is wrong, and what was expected.
Pins read_pins(const std::filesystem::path& file);

/// Reads the name of a pin: `PB5`, or as on the board of an Arduino, `D13` or `A0`, where `mcu` is on one. Throws
/// std::runtime_error.
Pin pin_of(const std::string& name, const std::string& mcu);

}  // namespace cohort::avr
