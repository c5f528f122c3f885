// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <stdexcept>

#include "tools/bridges/avr/kilobot.hpp"
#include "tools/bridges/avr/simavr.hpp"

namespace cohort::avr::kilobot {
namespace {

using std::chrono::nanoseconds;

constexpr std::uint32_t nominal_frequency = 8'000'000;  // [Hz]
constexpr double supply = 3.0;                          // [V]
constexpr double clock_tolerance = 0.01;                // data sheet of the ATmega328P, 8.6: a calibrated oscillator
constexpr nanoseconds latest_power_on{500'000'000};
constexpr nanoseconds run_message_at{1'000'000'000};
constexpr unsigned run_messages = 3;
constexpr std::uint64_t run_messages_apart = 80'000;  // [cycles]
constexpr std::uint8_t run_message = 0x88;

constexpr double fastest = 0.01;           // [m/s] of one side
constexpr int calibrated_motor = 70;       // out of 255: a side has its greatest speed from here on
constexpr double half_of_battery = 2.05;   // [V] at ADC6, behind a divider
constexpr double noise_of_battery = 0.01;  // [V], so that the lowest bit is random
constexpr int light_input = 7, battery_input = 6;

// Parameters that differ from robot to robot.
struct Traits {
  std::uint32_t frequency;
  nanoseconds power_on;
};

double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11U) * 0x1p-53; }

Traits traits_of(const Start& start) {
  std::mt19937_64 random(start.seed);
  const double deviation = (2.0 * uniform(random) - 1.0) * clock_tolerance;
  const double delay = uniform(random) * static_cast<double>(latest_power_on.count());
  return {static_cast<std::uint32_t>(nominal_frequency * (1.0 + deviation)),
          nanoseconds{static_cast<std::int64_t>(delay)}};
}

// Addresses and order of bytes as kilolib reads them.
std::vector<Segment> eeprom_of(std::uint32_t robot) {
  constexpr unsigned left_turn = 0x05, right_turn = 0x09, left_straight = 0x0c, right_straight = 0x14;
  constexpr unsigned low_gains = 0x20, high_gains = 0x50, sending_pins = 0x90, number = 0xb0;
  constexpr int distances = 14;
  constexpr double contact = 0.033, apart = 0.005;  // [m]
  std::vector<Segment> segments{{sending_pins, {0x01}},
                                {number, {static_cast<std::uint8_t>(robot), static_cast<std::uint8_t>(robot >> 8U)}}};
  for (const unsigned address : {left_turn, right_turn, left_straight, right_straight})
    segments.push_back({address, {calibrated_motor}});
  Segment low{low_gains}, high{high_gains};
  const auto add = [](Segment& segment, int count) {
    segment.bytes.push_back(static_cast<std::uint8_t>(count >> 8));
    segment.bytes.push_back(static_cast<std::uint8_t>(count & 0xff));
  };
  for (int i = 0; i < distances; ++i) {
    const Gains gains = gains_at(contact + apart * i);
    add(low, gains.low);
    add(high, gains.high);
  }
  segments.push_back(low);
  segments.push_back(high);
  return segments;
}

class KilobotBoard final : public Board {
 public:
  KilobotBoard(Air& air, bool overhead) : air_(air), overhead_(overhead) {}
  void start(const Start& start, Core& core) override;
  void switch_on(nanoseconds time) override { transceiver_->switch_on(time); }
  void sense(const Observation& observation, std::uint64_t begin, std::uint64_t end) override;
  void act(Command& command) override;

 private:
  std::vector<Heard> heard_in(const Observation& observation) const;
  static void on_conversion(avr_irq_t* irq, std::uint32_t mux, void* board);

  struct Light {
    Output *dim, *bright;
  };

  Air& air_;
  bool overhead_;
  Core* core_ = nullptr;
  std::unique_ptr<Transceiver> transceiver_;
  std::mt19937_64 noise_;
  std::uint32_t robot_ = 0;
  CommandChannel left_, right_, color_, sending_, message_;
  ObservationChannel ambient_, count_;
  std::vector<ObservationChannel> ranges_, messages_;
  Output *counter_clockwise_ = nullptr, *clockwise_ = nullptr;
  std::array<Light, 3> lights_{};
};

void KilobotBoard::start(const Start& start, Core& core) {
  core_ = &core;
  robot_ = start.robot;
  noise_.seed(~start.seed);
  left_ = start.command("legs/left/velocity");
  right_ = start.command("legs/right/velocity");
  color_ = start.command("led/0/color");
  sending_ = start.command("infrared/0/sending");
  message_ = start.command("infrared/0/message");
  ambient_ = start.observation("light/0/reading");
  count_ = start.observation("infrared/0/count");
  ranges_ = start.observations("infrared/*/range");
  messages_ = start.observations("infrared/*/message", ranges_.size());
  if (color_.size != 3 || message_.size != 1)
    throw std::runtime_error(
        "expected the devices of the model 'kilobot', with a color of three values and messages of one value");

  Outputs& outputs = core.outputs();
  counter_clockwise_ = &outputs.watch({'B', 3});
  clockwise_ = &outputs.watch({'D', 3});
  lights_ = {{{&outputs.watch_sink({'D', 5}), &outputs.watch_sink({'D', 4})},
              {&outputs.watch_sink({'C', 3}), &outputs.watch_sink({'C', 2})},
              {&outputs.watch_sink({'C', 5}), &outputs.watch_sink({'C', 4})}}};
  core.set_input({'D', 0}, true);  // it is not on its charger
  avr_irq_register_notify(
      avr_io_getirq(core.handle(), static_cast<std::uint32_t>(AVR_IOCTL_ADC_GETIRQ), ADC_IRQ_OUT_TRIGGER),
      &KilobotBoard::on_conversion, this);
  transceiver_ = std::make_unique<Transceiver>(air_, start.robot, core);
  if (!overhead_) return;
  const Traits traits = traits_of(start);
  const auto message = overhead_message(run_message);
  for (unsigned i = 0; i < run_messages; ++i)
    transceiver_->receive_message(
        cycles_in(run_message_at - traits.power_on, core.chip().frequency) + i * run_messages_apart, message);
}

std::vector<Heard> KilobotBoard::heard_in(const Observation& observation) const {
  std::vector<Heard> heard;
  const auto reported = static_cast<std::size_t>(std::max(observation[count_], 0.0));
  for (std::size_t i = 0; i < std::min(reported, ranges_.size()); ++i) {
    // The newest come first, and other robots may send anything.
    const double message = observation[messages_[i]];
    if (!(message >= 0.0 && message <= 1e9)) continue;
    const auto robot = static_cast<std::uint32_t>(message);
    const auto is_it = [robot](const Heard& other) { return other.robot == robot; };
    if (std::none_of(heard.begin(), heard.end(), is_it)) heard.push_back({robot, observation[ranges_[i]]});
  }
  return heard;
}

void KilobotBoard::sense(const Observation& observation, std::uint64_t, std::uint64_t) {
  transceiver_->hear(heard_in(observation));
  core_->set_voltage(light_input, std::clamp(observation[ambient_], 0.0, 1.0) * supply);
}

void KilobotBoard::on_conversion(avr_irq_t*, std::uint32_t, void* board) {
  auto* self = static_cast<KilobotBoard*>(board);
  self->core_->set_voltage(battery_input, half_of_battery + noise_of_battery * (uniform(self->noise_) - 0.5));
}

void KilobotBoard::act(Command& command) {
  const std::uint64_t now = core_->cycle();
  const auto speed = [now](const Output& motor) {
    return fastest * std::min(1.0, motor.duty(now) * 255.0 / calibrated_motor);
  };
  // The motor that turns the robot counter-clockwise moves its right side.
  command.set(right_, speed(*counter_clockwise_));
  command.set(left_, speed(*clockwise_));
  for (std::size_t i = 0; i < lights_.size(); ++i)
    command.set(color_, (lights_[i].dim->duty(now) + 2.0 * lights_[i].bright->duty(now)) / 3.0, i);
  command.set(sending_, 1.0);
  command.set(message_, robot_);
}

}  // namespace

Chip chip() { return {"atmega328p", nominal_frequency, supply}; }

void prepare(Robot::Options& options, const Start& start) {
  const Traits traits = traits_of(start);
  options.chip.frequency = traits.frequency;
  options.power_on = traits.power_on;
  std::vector<Segment> eeprom = eeprom_of(start.robot);
  eeprom.insert(eeprom.end(), options.image.eeprom.begin(), options.image.eeprom.end());
  options.image.eeprom = std::move(eeprom);
}

std::unique_ptr<Board> make_board(Air& air, bool overhead) { return std::make_unique<KilobotBoard>(air, overhead); }

std::array<std::uint8_t, 12> overhead_message(std::uint8_t type) {
  constexpr unsigned polynomial = 0x8408;  // CRC-CCITT with the lowest bit first
  constexpr std::size_t place_of_type = 9;
  std::array<std::uint8_t, 12> message{};
  message[place_of_type] = type;
  unsigned sum = 0xffff;
  for (std::size_t i = 0; i <= place_of_type; ++i) {
    sum ^= message[i];
    for (int bit = 0; bit < 8; ++bit) sum = (sum & 1U) != 0 ? sum >> 1U ^ polynomial : sum >> 1U;
  }
  message[place_of_type + 1] = static_cast<std::uint8_t>(sum);
  message[place_of_type + 2] = static_cast<std::uint8_t>(sum >> 8U);
  return message;
}

}  // namespace cohort::avr::kilobot
