// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/avr/pins.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <stdexcept>

namespace cohort::avr {
namespace {

constexpr std::size_t largest_pins_file = 1U << 20U;
constexpr std::size_t most_wires = 200;

// A mapping whose keys are read one by one; keys that remain unread are errors.
class Keys {
 public:
  Keys(std::string file, std::string mcu, const YAML::Node& node, const std::string& what)
      : file_(std::move(file)), mcu_(std::move(mcu)), node_(node) {
    if (!node_.IsMap()) refuse(node_, "expected " + what + " as a map of keys and values");
  }

  bool has(const std::string& key) const { return static_cast<bool>(node_[key]); }
  const YAML::Node& node() const { return node_; }

  template <class Value>
  Value get(const std::string& key, const char* expected) {
    taken_.insert(key);
    const YAML::Node value = node_[key];
    if (!value) refuse(node_, "'" + key + "' is missing: expected " + expected);
    try {
      return value.as<Value>();
    } catch (const YAML::Exception&) {
      refuse(value, "'" + key + "': expected " + expected);
    }
  }
  double number(const std::string& key) {
    const double value = get<double>(key, "a number");
    if (!std::isfinite(value)) refuse(node_[key], "'" + key + "': expected a finite number");
    return value;
  }
  double number(const std::string& key, double otherwise) { return has(key) ? number(key) : otherwise; }
  double positive(const std::string& key) {
    const double value = number(key);
    if (value <= 0.0) refuse(node_[key], "'" + key + "': expected a number above 0");
    return value;
  }
  std::string text(const std::string& key) { return get<std::string>(key, "a string"); }

  /// Takes one of two words, and returns whether it is the first.
  bool is_first(const std::string& key, const std::string& first, const std::string& second, bool otherwise) {
    if (!has(key)) return otherwise;
    const std::string word = text(key);
    if (word != first && word != second) refuse(node_[key], "'" + key + "': expected " + first + " or " + second);
    return word == first;
  }

  Pin pin(const std::string& key) {
    const std::string name = get<std::string>(key, "a pin");
    try {
      return pin_of(name, mcu_);
    } catch (const std::runtime_error& error) {
      refuse(node_[key], "'" + key + "': " + error.what());
    }
  }
  std::optional<Pin> optional_pin(const std::string& key) {
    return has(key) ? std::optional<Pin>(pin(key)) : std::nullopt;
  }

  ChannelValue value(const std::string& key) {
    ChannelValue value{text(key)};
    if (has("index")) value.index = get<std::uint16_t>("index", "the index of a value of the channel, from 0");
    return value;
  }

  Curve curve(const std::string& key, double scale_of_x) {
    taken_.insert(key);
    const YAML::Node list = node_[key];
    if (!list) refuse(node_, "'" + key + "' is missing: expected points, as [[X, Y], [X, Y]]");
    std::vector<Curve::Point> points;
    for (const YAML::Node& each : list) {
      if (!each.IsSequence() || each.size() != 2) refuse(each, "'" + key + "': expected a point as [X, Y]");
      try {
        points.push_back({each[0].as<double>() * scale_of_x, each[1].as<double>()});
      } catch (const YAML::Exception&) {
        refuse(each, "'" + key + "': expected two numbers");
      }
      const bool ascends = points.size() < 2 || points[points.size() - 2].x < points.back().x;
      if (!ascends || !std::isfinite(points.back().x) || !std::isfinite(points.back().y))
        refuse(each, "'" + key + "': expected finite numbers, with X in ascending order");
    }
    if (points.size() < 2) refuse(list, "'" + key + "': expected two points or more");
    return Curve(std::move(points));
  }

  /// Returns the only one of these keys that it has.
  std::string only_one_of(const std::vector<std::string>& keys) {
    std::string found, all;
    for (const std::string& key : keys) {
      all += (all.empty() ? "" : ", ") + key;
      if (!has(key)) continue;
      if (!found.empty()) refuse(node_, "has both '" + found + "' and '" + key + "': expected one of " + all);
      found = key;
    }
    if (found.empty()) refuse(node_, "expected one of " + all);
    return found;
  }

  void finish() const {
    for (const auto& each : node_) {
      const auto key = each.first.as<std::string>("");
      if (taken_.contains(key)) continue;
      std::string known;
      for (const std::string& name : taken_) known += (known.empty() ? "" : ", ") + name;
      refuse(each.first, "'" + key + "': unknown key; expected one of " + known);
    }
  }

  void take(const std::string& key) { taken_.insert(key); }

  [[noreturn]] void refuse(const YAML::Node& at, const std::string& why) const {
    const int line = at.Mark().line;
    throw std::runtime_error(file_ + ":" + (line >= 0 ? std::to_string(line + 1) + ":" : "") + " " + why);
  }

 private:
  std::string file_;
  std::string mcu_;
  YAML::Node node_;
  std::set<std::string> taken_;
};

Motor read_motor(Keys& entry) {
  Motor motor{entry.value("motor"), entry.number("scale"), {}, {}, {}, {}};
  motor.enable = entry.optional_pin("enable");
  motor.forward = entry.optional_pin("forward");
  motor.backward = entry.optional_pin("backward");
  motor.direction = entry.optional_pin("direction");
  if (!motor.enable && !motor.forward)
    entry.refuse(entry.node(),
                 "a motor requires 'forward', optionally with 'backward', or 'enable', optionally with 'direction'");
  if (motor.direction && (motor.forward || motor.backward))
    entry.refuse(entry.node(), "expected either 'direction', or 'forward' and 'backward', not both");
  if (motor.backward && !motor.forward) entry.refuse(entry.node(), "a motor with 'backward' needs 'forward'");
  return motor;
}

Servo read_servo(Keys& entry) {
  constexpr double microsecond = 1e-6;
  return {entry.value("servo"), entry.pin("pin"), entry.curve("pulses", microsecond)};
}

Led read_led(Keys& entry) {
  Led led{entry.text("led"), {}, {}, {}, {}};
  led.red = entry.optional_pin("red");
  led.green = entry.optional_pin("green");
  led.blue = entry.optional_pin("blue");
  led.all = entry.optional_pin("pin");
  led.active_low = entry.is_first("lit", "low", "high", false);
  if (!led.red && !led.green && !led.blue && !led.all)
    entry.refuse(entry.node(), "an LED needs a 'pin', or 'red', 'green' and 'blue'");
  return led;
}

Switch read_switch(Keys& entry, const std::string& key) {
  Switch input{entry.value(key), entry.pin("pin")};
  if (entry.has("above") && entry.has("below"))
    entry.refuse(entry.node(), "expected either 'above' or 'below', not both");
  input.is_on_above = !entry.has("below");
  input.threshold = entry.number(input.is_on_above ? "above" : "below", 0.5);
  input.is_low_when_on = entry.is_first("pressed", "low", "high", true);
  return input;
}

Analog read_analog(Keys& entry, const std::string& mcu) {
  Analog analog{entry.value("analog"), 0, Curve({})};
  const std::string pin = entry.text("pin");
  const bool is_input = (pin.starts_with("ADC") || pin.starts_with('A')) && pin.size() <= 5;
  const std::string number = pin.substr(std::min<std::size_t>(pin.size(), pin.starts_with("ADC") ? 3 : 1));
  if (!is_input || number.empty() || number.find_first_not_of("0123456789") != std::string::npos)
    entry.refuse(entry.node()["pin"], "'pin': expected an analog input, such as A0 of a board or ADC0 of the chip");
  analog.input = std::stoi(number);
  if (mcu == "atmega32u4" && !pin.starts_with("ADC")) {
    // A0 to A5 of the board, as its file of variants has them.
    constexpr std::array inputs{7, 6, 5, 4, 1, 0};
    if (analog.input >= static_cast<int>(inputs.size())) entry.refuse(entry.node()["pin"], "'pin': expected A0 to A5");
    analog.input = inputs[static_cast<std::size_t>(analog.input)];
  }
  if (entry.has("points")) {
    analog.volts = entry.curve("points", 1.0);
  } else {
    const double scale = entry.number("scale"), offset = entry.number("offset", 0.0);
    constexpr double far = 1e6;
    analog.volts = Curve({{-far, offset - far * scale}, {far, offset + far * scale}});
  }
  return analog;
}

Encoder read_encoder(Keys& entry) {
  return {entry.value("encoder"), entry.pin("a"), entry.optional_pin("b"), entry.positive("edges_per_turn")};
}

Wire read_wire(Keys& entry, const std::string& mcu) {
  const std::string kind = entry.only_one_of(
      {"motor", "servo", "led", "loudspeaker", "button", "bumper", "analog", "encoder", "ultrasonic"});
  if (kind == "motor") return read_motor(entry);
  if (kind == "servo") return read_servo(entry);
  if (kind == "led") return read_led(entry);
  if (kind == "loudspeaker")
    return Speaker{entry.text(kind), entry.pin("pin"), entry.has("intensity") ? entry.positive("intensity") : 1.0};
  if (kind == "button" || kind == "bumper") return read_switch(entry, kind);
  if (kind == "analog") return read_analog(entry, mcu);
  if (kind == "encoder") return read_encoder(entry);
  return Ultrasonic{entry.value(kind), entry.pin("trigger"), entry.pin("echo")};
}

YAML::Node load(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file))
    throw std::runtime_error(file.string() + ": no such file: expected a pin map");
  if (std::filesystem::file_size(file) > largest_pins_file)
    throw std::runtime_error(file.string() + ": is larger than 1 MiB, the limit for pin maps");
  try {
    return YAML::LoadFile(file.string());
  } catch (const YAML::ParserException& error) {
    throw std::runtime_error(file.string() + ":" + std::to_string(error.mark.line + 1) + ": " + error.msg);
  } catch (const YAML::Exception& error) {
    throw std::runtime_error(file.string() + ": " + error.what());
  }
}

}  // namespace

double Curve::operator()(double x) const {
  if (!(x < points_.back().x)) return points_.back().y;
  if (x <= points_.front().x) return points_.front().y;
  const auto after = std::ranges::find_if(points_, [x](const Point& point) { return x < point.x; });
  const auto before = after - 1;
  return before->y + (after->y - before->y) * (x - before->x) / (after->x - before->x);
}

Pins read_pins(const std::filesystem::path& file) {
  const YAML::Node document = load(file);
  Pins pins{file.string()};
  Keys top(pins.file, "", document, "a pin map");
  if (top.has("mcu")) pins.mcu = top.text("mcu");
  if (top.has("frequency")) pins.frequency = top.get<std::uint32_t>("frequency", "a frequency [Hz]");
  if (top.has("supply")) pins.supply = top.positive("supply");
  if (pins.supply > 6.0) top.refuse(document["supply"], "'supply': expected at most 6 V");
  if (top.has("serial")) pins.serial = top.get<std::uint8_t>("serial", "the number of a serial interface");
  top.take("wires");
  const YAML::Node wires = document["wires"];
  if (!wires || !wires.IsSequence()) top.refuse(wires ? wires : document, "expected 'wires' as a list");
  if (wires.size() > most_wires) top.refuse(wires, "expected at most 200 wires");
  for (const YAML::Node& node : wires) {
    Keys entry(pins.file, pins.mcu, node, "a wire");
    pins.wires.push_back({read_wire(entry, pins.mcu), node.Mark().line + 1});
    entry.finish();
  }
  top.finish();
  return pins;
}

}  // namespace cohort::avr
