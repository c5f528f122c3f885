// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/avr/board.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace cohort::avr {
namespace {

// One wire of a board, of a robot that runs.
class Part {
 public:
  virtual ~Part() = default;
  virtual void sense(const Observation&, std::uint64_t /*begin*/, std::uint64_t /*end*/) {}
  virtual void act(Command&) {}
};

void check_index(const ChannelValue& value, std::size_t size) {
  if (value.index >= size)
    throw std::runtime_error("'" + value.channel + "' has " + std::to_string(size) + " values: invalid index " +
                             std::to_string(value.index));
}

// A value that is observed.
class Observed {
 public:
  Observed(const Start& start, const ChannelValue& value)
      : channel_(start.observation(value.channel)), index_(value.index) {
    check_index(value, channel_.size);
  }
  double in(const Observation& observation) const { return observation.values(channel_)[index_]; }

 private:
  ObservationChannel channel_;
  std::size_t index_;
};

class Commanded {
 public:
  Commanded(const Start& start, const ChannelValue& value)
      : channel_(start.command(value.channel)), index_(value.index) {
    check_index(value, channel_.size);
  }
  void set(Command& command, double value) const { command.set(channel_, value, index_); }

 private:
  CommandChannel channel_;
  std::size_t index_;
};

// A pin that may be left out.
class Watched {
 public:
  Watched(Core& core, const std::optional<Pin>& pin)
      : core_(&core), output_(pin ? &core.outputs().watch(*pin) : nullptr) {}
  double duty(double otherwise) const { return output_ != nullptr ? output_->duty(core_->cycle()) : otherwise; }

 private:
  Core* core_;
  Output* output_;
};

class MotorPart final : public Part {
 public:
  MotorPart(const Motor& motor, const Start& start, Core& core)
      : channel_(start, motor.command),
        scale_(motor.scale),
        enable_(core, motor.enable),
        forward_(core, motor.forward),
        backward_(core, motor.backward),
        direction_(core, motor.direction) {}
  void act(Command& command) override {
    const double sign = 2.0 * direction_.duty(1.0) - 1.0;
    channel_.set(command, scale_ * enable_.duty(1.0) * (forward_.duty(1.0) - backward_.duty(0.0)) * sign);
  }

 private:
  Commanded channel_;
  double scale_;
  Watched enable_, forward_, backward_, direction_;
};

class ServoPart final : public Part {
 public:
  ServoPart(const Servo& servo, const Start& start, Core& core)
      : channel_(start, servo.command), core_(core), output_(core.outputs().watch(servo.pin)), pulses_(servo.pulses) {}
  void act(Command& command) override {
    // A servo without pulses has no power.
    const std::uint64_t memory = core_.chip().frequency / 10;
    const std::uint64_t now = core_.cycle();
    if (const auto pulse = output_.pulse(now > memory ? now - memory : 0))
      channel_.set(command, pulses_(*pulse / core_.chip().frequency));
  }

 private:
  Commanded channel_;
  Core& core_;
  Output& output_;
  Curve pulses_;
};

class LedPart final : public Part {
 public:
  LedPart(const Led& led, const Start& start, Core& core) : channel_(start.command(led.channel)), low_(led.active_low) {
    for (const auto* pin : {&led.red, &led.green, &led.blue}) colors_.emplace_back(core, *pin ? *pin : led.all);
    if (channel_.size != 1 && channel_.size != colors_.size())
      throw std::runtime_error("'" + led.channel + "' is not the channel of an LED");
  }
  void act(Command& command) override {
    for (std::size_t i = 0; i < channel_.size; ++i) {
      const double duty = colors_[i].duty(low_ ? 1.0 : 0.0);
      command.set(channel_, low_ ? 1.0 - duty : duty, i);
    }
  }

 private:
  CommandChannel channel_;
  bool low_;
  std::vector<Watched> colors_;
};

class SpeakerPart final : public Part {
 public:
  SpeakerPart(const Speaker& speaker, const Start& start, Core& core)
      : frequency_(start.command(speaker.device + "/0/frequency")),
        intensity_(start.command(speaker.device + "/0/intensity")),
        core_(core),
        output_(core.outputs().watch(speaker.pin)),
        loudness_(speaker.intensity) {}
  void sense(const Observation&, std::uint64_t begin, std::uint64_t) override { began_ = begin; }
  void act(Command& command) override {
    const auto period = output_.period(began_);
    if (!period) return;
    command.set(frequency_, core_.chip().frequency / *period);
    command.set(intensity_, loudness_);
  }

 private:
  CommandChannel frequency_, intensity_;
  Core& core_;
  Output& output_;
  double loudness_;
  std::uint64_t began_ = 0;
};

class SwitchPart final : public Part {
 public:
  SwitchPart(const Switch& input, const Start& start, Core& core)
      : channel_(start, input.observation), core_(core), input_(input) {
    core_.set_input(input_.pin, input_.is_low_when_on);
  }
  void sense(const Observation& observation, std::uint64_t, std::uint64_t) override {
    const double value = channel_.in(observation);
    const bool on = input_.is_on_above ? value > input_.threshold : value < input_.threshold;
    core_.set_input(input_.pin, on != input_.is_low_when_on);
  }

 private:
  Observed channel_;
  Core& core_;
  Switch input_;
};

class AnalogPart final : public Part {
 public:
  AnalogPart(const Analog& analog, const Start& start, Core& core)
      : channel_(start, analog.observation), core_(core), analog_(analog) {
    core_.set_voltage(analog_.input, 0.0);
  }
  void sense(const Observation& observation, std::uint64_t, std::uint64_t) override {
    core_.set_voltage(analog_.input, analog_.volts(channel_.in(observation)));
  }

 private:
  Observed channel_;
  Core& core_;
  Analog analog_;
};

// The way since the last observation is made again, evenly, during this run: later by one period of the robot's team.
class EncoderPart final : public Part {
 public:
  EncoderPart(const Encoder& encoder, const Start& start, Core& core)
      : channel_(start, encoder.observation), core_(core), encoder_(encoder) {
    show(0);
  }
  void sense(const Observation& observation, std::uint64_t begin, std::uint64_t end) override {
    const double edges = channel_.in(observation)*encoder_.edges_per_turn / (2.0 * std::numbers::pi);
    if (!std::isfinite(edges) || std::abs(edges) > most_counted) return;
    if (!has_before_) before_ = edges;
    has_before_ = true;
    const auto from = static_cast<std::int64_t>(std::floor(before_)), to = static_cast<std::int64_t>(std::floor(edges));
    const std::int64_t step = to > from ? 1 : -1;
    // A robot that was put elsewhere has not turned its wheels so fast.
    const bool is_too_many = std::abs(to - from) > most_edges;
    for (std::int64_t shown = is_too_many ? to : from; shown != to;) {
      // Upwards an edge is where the next number begins; downwards, where the present one does.
      const double at = static_cast<double>(step > 0 ? shown + 1 : shown);
      shown += step;
      const double share = std::clamp((at - before_) / (edges - before_), 0.0, 1.0);
      core_.at(begin + static_cast<std::uint64_t>(share * static_cast<double>(end - begin)),
               [this, shown] { show(shown); });
    }
    before_ = edges;
  }

 private:
  static constexpr double most_counted = 1e15;
  static constexpr std::int64_t most_edges = 20'000;

  void show(std::int64_t edge) {
    if (!encoder_.b) {
      core_.set_input(encoder_.a, (edge & 1) != 0);
      return;
    }
    // 00, 10, 11, 01: one of the two changes at a time.
    const auto place = edge & 3;
    core_.set_input(encoder_.a, place == 1 || place == 2);
    core_.set_input(*encoder_.b, place == 2 || place == 3);
  }

  Observed channel_;
  Core& core_;
  Encoder encoder_;
  bool has_before_ = false;
  double before_ = 0.0;  // [edges]
};

// As the data sheet of the HC-SR04 has it: a pulse of 10 us or more starts a measurement.
class UltrasonicPart final : public Part {
 public:
  UltrasonicPart(const Ultrasonic& sensor, const Start& start, Core& core)
      : channel_(start, sensor.observation), core_(core), pin_(sensor.echo) {
    core_.set_input(pin_, false);
    Output& trigger = core_.outputs().watch(sensor.trigger);
    trigger.edge = [this](std::uint64_t cycle, bool high) {
      if (high)
        rise_ = cycle;
      else if (seconds(cycle - rise_) >= shortest_trigger)
        ping(cycle);
    };
  }
  void sense(const Observation& observation, std::uint64_t, std::uint64_t) override {
    range_ = channel_.in(observation);
  }

 private:
  static constexpr double speed_of_sound = 343.0;  // [m/s]
  static constexpr double shortest_trigger = 10e-6;
  static constexpr double burst = 450e-6;  // [s] from the trigger to the echo's begin: eight periods, and its firmware
  static constexpr double greatest_range = 4.0;
  static constexpr double without_echo = 38e-3;  // [s]

  double seconds(std::uint64_t cycles) const { return static_cast<double>(cycles) / core_.chip().frequency; }
  std::uint64_t cycles(double seconds) const { return static_cast<std::uint64_t>(seconds * core_.chip().frequency); }

  void ping(std::uint64_t cycle) {
    if (cycle < busy_until_) return;
    const bool hears = range_ >= 0.0 && range_ <= greatest_range;
    const std::uint64_t begin = cycle + cycles(burst);
    busy_until_ = begin + cycles(hears ? 2.0 * range_ / speed_of_sound : without_echo);
    core_.at(begin, [this] { core_.set_input(pin_, true); });
    core_.at(busy_until_, [this] { core_.set_input(pin_, false); });
  }

  Observed channel_;
  Core& core_;
  Pin pin_;
  double range_ = std::numeric_limits<double>::infinity();
  std::uint64_t rise_ = 0;
  std::uint64_t busy_until_ = 0;
};

// Which part a wire becomes.
template <class>
struct PartOf;
template <>
struct PartOf<Motor> : std::type_identity<MotorPart> {};
template <>
struct PartOf<Servo> : std::type_identity<ServoPart> {};
template <>
struct PartOf<Led> : std::type_identity<LedPart> {};
template <>
struct PartOf<Speaker> : std::type_identity<SpeakerPart> {};
template <>
struct PartOf<Switch> : std::type_identity<SwitchPart> {};
template <>
struct PartOf<Analog> : std::type_identity<AnalogPart> {};
template <>
struct PartOf<Encoder> : std::type_identity<EncoderPart> {};
template <>
struct PartOf<Ultrasonic> : std::type_identity<UltrasonicPart> {};

class WiredBoard final : public Board {
 public:
  explicit WiredBoard(const Pins& pins) : pins_(pins) {}

  void start(const Start& start, Core& core) override {
    parts_.clear();
    for (const Entry& entry : pins_.wires) {
      try {
        parts_.push_back(std::visit(
            [&]<class Kind>(const Kind& wire) -> std::unique_ptr<Part> {
              return std::make_unique<typename PartOf<Kind>::type>(wire, start, core);
            },
            entry.wire));
      } catch (const std::runtime_error& error) {
        throw std::runtime_error(pins_.file + ":" + std::to_string(entry.line) + ": " + error.what());
      }
    }
  }
  void sense(const Observation& observation, std::uint64_t begin, std::uint64_t end) override {
    for (const auto& part : parts_) part->sense(observation, begin, end);
  }
  void act(Command& command) override {
    for (const auto& part : parts_) part->act(command);
  }

 private:
  Pins pins_;
  std::vector<std::unique_ptr<Part>> parts_;
};

}  // namespace

std::unique_ptr<Board> make_board(const Pins& pins) { return std::make_unique<WiredBoard>(pins); }

}  // namespace cohort::avr
