// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/avr/kilobot_infrared.hpp"

#include <algorithm>
#include <stdexcept>

#include "tools/bridges/avr/simavr.hpp"

namespace cohort::avr::kilobot {
namespace {

using std::chrono::nanoseconds;

constexpr std::int64_t second = 1'000'000'000;
constexpr std::uint64_t bit_cycles = 269;   // cycles of the nominal clock, from kilolib
constexpr std::uint64_t pulse_cycles = 9;   // the same
constexpr nanoseconds bit{33'625};          // 269 cycles at 8 MHz
constexpr nanoseconds longest_step{3'625};  // 29 cycles: an instruction and the way into an interrupt
constexpr std::array sending_pins{Pin{'B', 0}, Pin{'B', 1}, Pin{'B', 2}, Pin{'B', 6}, Pin{'B', 7}};

constexpr double contact = 0.033;     // [m] from middle to middle
constexpr double low_counts = 900.0;  // at contact
constexpr double ratio_of_gains = 4.0;
constexpr double largest_count = 1023.0;
constexpr double unit_of_strength = 1 << 20;  // strengths are whole numbers, so that what went leaves no rest
constexpr std::uint64_t held_cycles = 160;    // the amplifiers hold a pulse for longer than a conversion takes

// The light falls with the square of the distance; that of a robot that touches is 1.
double strength_at(double distance) {
  const double relative = contact / std::max(distance, contact);
  return relative * relative;
}

Gains gains_of(double strength) {
  const auto count = [strength](double gain) {
    return static_cast<int>(std::min(largest_count, gain * strength) + 0.5);
  };
  return {count(low_counts), count(low_counts * ratio_of_gains)};
}

nanoseconds time_of(std::uint64_t cycle, std::uint32_t frequency) {
  return nanoseconds{static_cast<std::int64_t>(cycle / frequency) * second +
                     static_cast<std::int64_t>(cycle % frequency) * second / frequency};
}

std::uint64_t cycle_of(nanoseconds time, std::uint32_t frequency) {
  const auto whole = static_cast<std::uint64_t>(std::max<std::int64_t>(time.count(), 0));
  return whole / second * frequency + (whole % second * frequency + second / 2) / second;
}

avr_irq_t* comparator_of(avr_t* core, int number) {
  avr_irq_t* irq = avr_io_getirq(core, static_cast<std::uint32_t>(AVR_IOCTL_ACOMP_GETIRQ), number);
  if (irq == nullptr) throw std::runtime_error("expected a microcontroller with an analog comparator");
  return irq;
}

}  // namespace

Gains gains_at(double distance) { return gains_of(strength_at(distance)); }

Transceiver::Transceiver(Air& air, std::uint32_t robot, Core& core) : air_(air), robot_(robot), core_(core) {
  avr_t* avr = core_.handle();
  comparator_ = comparator_of(avr, ACOMP_IRQ_AIN0);
  avr_raise_irq(comparator_of(avr, ACOMP_IRQ_AIN1), static_cast<std::uint32_t>(core_.chip().supply * 500.0));
  trigger_ = avr_io_getirq(avr, static_cast<std::uint32_t>(AVR_IOCTL_ADC_GETIRQ), ADC_IRQ_IN_TRIGGER);
  avr_irq_register_notify(comparator_of(avr, ACOMP_IRQ_OUT), &Transceiver::on_comparator, this);
  for (unsigned i = 0; i < sending_pins.size(); ++i)
    core_.outputs().watch(sending_pins[i]).edge = [this, i](std::uint64_t cycle, bool high) { on_pin(i, cycle, high); };
  if (!air_.transceivers_.emplace(robot_, this).second)
    throw std::runtime_error("the robot already has an infrared transceiver");
}

Transceiver::~Transceiver() { air_.transceivers_.erase(robot_); }

void Transceiver::on_pin(unsigned pin, std::uint64_t cycle, bool high) {
  const unsigned before = pins_lit_;
  pins_lit_ = high ? pins_lit_ | 1U << pin : pins_lit_ & ~(1U << pin);
  if ((before == 0) != (pins_lit_ == 0))
    sent_.push_back({switched_on_ + time_of(cycle, core_.chip().frequency), pins_lit_ != 0});
}

// A pulse ends at the robots at which it began, even if they have left its range meanwhile.
void Transceiver::pass(std::uint32_t sender, const Edge& edge) {
  if (edge.lit) {
    const auto heard = std::find_if(senders_.begin(), senders_.end(),
                                    [sender](const Heard& candidate) { return candidate.robot == sender; });
    if (heard == senders_.end()) return;
    passing_[sender] = static_cast<std::int32_t>(strength_at(heard->distance) * unit_of_strength + 0.5);
  }
  const auto passing = passing_.find(sender);
  if (passing == passing_.end()) return;
  core_.at(cycle_of(edge.time + bit - switched_on_, core_.chip().frequency),
           [this, lit = edge.lit, strength = passing->second] { light(lit, strength); });
  if (!edge.lit) passing_.erase(passing);
}

void Transceiver::light(bool lit, std::int32_t strength) {
  pulses_ += lit ? 1 : -1;
  strength_ += lit ? strength : -strength;
  avr_raise_irq(comparator_, pulses_ > 0 ? static_cast<std::uint32_t>(core_.chip().supply * 1000.0) : 0);
  if (!lit) return;
  const Gains gains = gains_of(strength_ / unit_of_strength);
  // Above the middle of a count, so that the converter, which rounds down, gives it.
  const double volts = core_.chip().supply / largest_count;
  core_.set_voltage(0, (gains.high + 0.5) * volts);
  core_.set_voltage(1, (gains.low + 0.5) * volts);
  core_.at(core_.cycle() + held_cycles, [this, pulse = ++last_pulse_] { darken(pulse); });
}

void Transceiver::darken(std::uint64_t pulse) {
  if (pulse != last_pulse_) return;
  core_.set_voltage(0, 0.0);
  core_.set_voltage(1, 0.0);
}

// Data sheet of the ATmega328P, 24.4: the comparator starts a conversion where the trigger source 1 is chosen. simavr
// does not do it by itself.
void Transceiver::on_comparator(avr_irq_t*, std::uint32_t value, void* transceiver) {
  constexpr unsigned adcsrb = 0x7b, source = 0x07, analog_comparator = 0x01;
  const auto* self = static_cast<Transceiver*>(transceiver);
  if (value != 0 && (self->core_.handle()->data[adcsrb] & source) == analog_comparator)
    avr_raise_irq(self->trigger_, 1);
}

// Sends as kilolib does. A pulse comes first, and a second one after nine bits, in which it listens for others. Then
// each byte follows as a pulse, eight bits from the lowest on, of which each 1 is a pulse, and a pulse.
void Transceiver::receive_message(std::uint64_t cycle, std::span<const std::uint8_t> message) {
  const auto pulse = [this, cycle](std::uint64_t bits) {
    const std::uint64_t begin = cycle + bits * bit_cycles;
    const auto strength = static_cast<std::int32_t>(unit_of_strength);
    core_.at(begin, [this, strength] { light(true, strength); });
    core_.at(begin + pulse_cycles, [this, strength] { light(false, strength); });
  };
  constexpr unsigned bits_of_byte = 10;
  pulse(0);
  pulse(9);
  for (std::size_t i = 0; i < message.size(); ++i) {
    const unsigned frame = message[i] << 1U | 0x201U;
    for (unsigned k = 0; k < bits_of_byte; ++k)
      if ((frame >> k & 1U) != 0) pulse(10 + bits_of_byte * i + k);
  }
}

nanoseconds Air::window() const { return bit - longest_step; }

void Air::exchange() {
  const auto has_sent = [](const auto& entry) { return !entry.second->sent_.empty(); };
  if (std::none_of(transceivers_.begin(), transceivers_.end(), has_sent)) return;
  for (const auto& [robot, receiver] : transceivers_)
    for (const auto& [from, sender] : transceivers_)
      if (sender != receiver)
        for (const Transceiver::Edge& edge : sender->sent_) receiver->pass(from, edge);
  for (const auto& [robot, sender] : transceivers_) sender->sent_.clear();
}

}  // namespace cohort::avr::kilobot
