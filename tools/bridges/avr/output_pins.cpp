// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/avr/output_pins.hpp"

#include <cstring>
#include <stdexcept>
#include <utility>

#include "tools/bridges/avr/simavr.hpp"

namespace cohort::avr {
namespace {

constexpr int pins_of_a_port = 8;

bool is_kind(const avr_io_t* module, const char* kind) {
  return module->kind != nullptr && std::strcmp(module->kind, kind) == 0;
}

int field(avr_t* core, avr_regbit_t place) { return place.reg != 0 ? avr_regbit_get(core, place) : 0; }

int field(avr_t* core, const avr_regbit_t* places, int count) {
  int value = 0;
  for (int i = 0; i < count; ++i) value |= (field(core, places[i]) != 0 ? 1 : 0) << i;
  return value;
}

double word(const avr_t* core, avr_io_addr_t low, avr_io_addr_t high) {
  return core->data[low] + (high != 0 ? 256.0 * core->data[high] : 0.0);
}

// How a timer counts: once upwards in each period, or up and down again.
enum class Counting { level, fast, both_ways };
struct Mode {
  Counting counting = Counting::level;
  double top = 0.0;
};

// The data sheet's tables of waveform generation modes, for timers of 8 and of 16 bits.
Mode mode_of(avr_t* core, const avr_timer_t& timer) {
  const int number = field(core, timer.wgm, 4);
  const auto& first = timer.comp[AVR_TIMER_COMPA];
  const double compare = word(core, first.r_ocr, first.r_ocrh);
  if (timer.r_tcnth == 0) {
    switch (number) {
      case 1: return {Counting::both_ways, 255.0};
      case 3: return {Counting::fast, 255.0};
      case 5: return {Counting::both_ways, compare};
      case 7: return {Counting::fast, compare};
      default: return {};
    }
  }
  const double capture = timer.r_icr != 0 ? word(core, timer.r_icr, timer.r_icrh) : 0.0;
  switch (number) {
    case 1: return {Counting::both_ways, 255.0};
    case 2: return {Counting::both_ways, 511.0};
    case 3: return {Counting::both_ways, 1023.0};
    case 5: return {Counting::fast, 255.0};
    case 6: return {Counting::fast, 511.0};
    case 7: return {Counting::fast, 1023.0};
    case 8:
    case 10: return {Counting::both_ways, capture};
    case 9:
    case 11: return {Counting::both_ways, compare};
    case 14: return {Counting::fast, capture};
    case 15: return {Counting::fast, compare};
    default: return {};
  }
}

// simavr 1.6 lacks modes of some timers; without them a timer overflows all the time. They count up and down there in
// one go, so that overflows come twice as often as on the chip.
void add_missing_modes(avr_timer_t& timer) {
  const auto add = [&timer](int number, unsigned kind, unsigned top, unsigned size) {
    avr_timer_wgm_t& mode = timer.wgm_op[number];
    if (mode.kind != avr_timer_wgm_none) return;
    mode.kind = kind & 0xffU;
    mode.top = top & 0xffU;
    mode.size = size & 0xffU;
  };
  add(1, avr_timer_wgm_fc_pwm, avr_timer_wgm_reg_constant, 8);
  if (timer.r_tcnth == 0) {
    add(5, avr_timer_wgm_pwm, avr_timer_wgm_reg_ocra, 8);
    return;
  }
  add(2, avr_timer_wgm_fc_pwm, avr_timer_wgm_reg_constant, 9);
  add(3, avr_timer_wgm_fc_pwm, avr_timer_wgm_reg_constant, 10);
  add(10, avr_timer_wgm_pwm, avr_timer_wgm_reg_icr, 16);
  add(11, avr_timer_wgm_pwm, avr_timer_wgm_reg_ocra, 16);
}

// Data sheet of the ATmega328P, 15.7.3 and 15.7.4: `compare` of `top`, `com` as in the tables of compare output modes.
Waveform pulse_width_modulated(Mode mode, int com, double compare, double prescaler) {
  const bool fast = mode.counting == Counting::fast;
  const double period = prescaler * (fast ? mode.top + 1.0 : 2.0 * mode.top);
  if (com == avr_timer_com_toggle) return {0.5, 2.0 * period};
  double duty = 0.0;
  if (fast)
    duty = (compare + 1.0) / (mode.top + 1.0);
  else if (mode.top > 0.0)
    duty = compare / mode.top;
  if (duty > 1.0) duty = 1.0;
  if (com == avr_timer_com_set) duty = 1.0 - duty;
  if (duty <= 0.0 || duty >= 1.0) return {duty, 0.0};
  return {duty, period};
}

}  // namespace

std::string name_of(const Pin& pin) { return std::string("P") + pin.port + std::to_string(pin.bit); }

void Output::begin_window(std::uint64_t cycle) {
  window_ = cycle;
  since_ = cycle;
  high_ = 0.0;
}

double Output::duty(std::uint64_t cycle) const {
  if (cycle <= window_) return waveform_.duty;
  return (high_ + waveform_.duty * static_cast<double>(cycle - since_)) / static_cast<double>(cycle - window_);
}

std::optional<double> Output::pulse(std::uint64_t oldest) const {
  if (waveform_.period > 0.0) return waveform_.duty * waveform_.period;
  if (pulse_ended_ == 0 || pulse_ended_ < oldest) return std::nullopt;
  return static_cast<double>(pulse_length_);
}

std::optional<double> Output::period(std::uint64_t oldest) const {
  if (waveform_.period > 0.0) return waveform_.period;
  if (last_period_ == 0 || rise_ < last_period_ || rise_ - last_period_ < oldest) return std::nullopt;
  return static_cast<double>(last_period_);
}

void Output::set(std::uint64_t cycle, Waveform waveform) {
  if (waveform == waveform_) return;
  high_ += waveform_.duty * static_cast<double>(cycle - since_);
  since_ = cycle;
  const Waveform before = waveform_;
  waveform_ = waveform;
  if (before.period > 0.0 || waveform.period > 0.0) return;
  const bool high = waveform.duty > 0.5;
  if (high) {
    last_period_ = cycle - rise_;
    rise_ = cycle;
  } else {
    pulse_ended_ = cycle;
    pulse_length_ = cycle - rise_;
  }
  if (edge) edge(cycle, high);
}

struct Outputs::Port {
  Outputs* outputs;
  char name;
  avr_io_addr_t port_register;
  std::uint8_t levels = 0;
  std::uint8_t directions = 0;  // a bit is set for an output
  std::array<std::unique_ptr<Output>, pins_of_a_port> pins{}, sinks{};

  Waveform sink(int bit) const { return {(directions & ~levels) >> bit & 1 ? 1.0 : 0.0, 0.0}; }
};

// One compare unit of a timer, and the pin that it may take over.
struct Outputs::Compare {
  Port* port;
  int bit;
  avr_timer_t* timer;
  avr_timer_comp_t* unit;
  bool high = false;  // as the last match left it, in modes that do not make a waveform
};

Outputs::Outputs(avr_t* core, std::string mcu) : core_(core), mcu_(std::move(mcu)) {
  find_ports();
  find_timers();
}

Outputs::~Outputs() = default;

void Outputs::find_ports() {
  for (avr_io_t* module = core_->io_port; module != nullptr; module = module->next) {
    if (!is_kind(module, "port")) continue;
    const auto* port = reinterpret_cast<const avr_ioport_t*>(module);
    ports_.push_back(std::make_unique<Port>(Port{this, port->name, port->r_port}));
    avr_irq_register_notify(module->irq + IOPORT_IRQ_REG_PORT, on_port, ports_.back().get());
    avr_irq_register_notify(module->irq + IOPORT_IRQ_DIRECTION_ALL, on_direction, ports_.back().get());
  }
}

void Outputs::find_timers() {
  for (avr_io_t* module = core_->io_port; module != nullptr; module = module->next) {
    if (!is_kind(module, "timer")) continue;
    auto* timer = reinterpret_cast<avr_timer_t*>(module);
    add_missing_modes(*timer);
    for (int i = 0; i < AVR_TIMER_COMP_COUNT; ++i) {
      avr_timer_comp_t& unit = timer->comp[i];
      for (const auto& port : ports_) {
        if (unit.com_pin.reg == 0 || unit.com_pin.reg != port->port_register) continue;
        compares_.push_back(
            std::make_unique<Compare>(Compare{port.get(), static_cast<int>(unit.com_pin.bit), timer, &unit}));
        Compare* compare = compares_.back().get();
        avr_irq_register_notify(module->irq + TIMER_IRQ_OUT_COMP + i, on_compare, compare);
        // A register of 16 bits takes effect when its low byte is written.
        const std::array<unsigned, 7> registers{unit.r_ocr,        timer->comp[0].r_ocr, timer->r_icr,    unit.com.reg,
                                                timer->wgm[0].reg, timer->wgm[2].reg,    timer->cs[0].reg};
        for (const unsigned address : registers) {
          if (address == 0) continue;
          avr_irq_t* written = avr_iomem_getirq(core_, static_cast<avr_io_addr_t>(address), nullptr, AVR_IOMEM_IRQ_ALL);
          avr_irq_register_notify(written, on_register, compare);
        }
      }
    }
  }
}

Outputs::Port& Outputs::port_of(Pin pin) {
  for (const auto& port : ports_)
    if (port->name == pin.port && pin.bit >= 0 && pin.bit < pins_of_a_port) return *port;
  throw std::runtime_error("an " + mcu_ + " has no pin " + name_of(pin));
}

Output& Outputs::watch(Pin pin) {
  Port& port = port_of(pin);
  auto& output = port.pins[static_cast<std::size_t>(pin.bit)];
  if (!output) {
    output = std::make_unique<Output>();
    output->set(core_->cycle, waveform_of(port, pin.bit));
  }
  return *output;
}

Output& Outputs::watch_sink(Pin pin) {
  Port& port = port_of(pin);
  auto& output = port.sinks[static_cast<std::size_t>(pin.bit)];
  if (!output) {
    output = std::make_unique<Output>();
    output->set(core_->cycle, port.sink(pin.bit));
  }
  return *output;
}

void Outputs::reset() {
  for (const auto& compare : compares_) compare->high = false;
  for (const auto& port : ports_) {
    port->levels = port->directions = 0;
    update(*port);
  }
}

void Outputs::begin_window() {
  for (const auto& port : ports_)
    for (const auto* outputs : {&port->pins, &port->sinks})
      for (const auto& output : *outputs)
        if (output) output->begin_window(core_->cycle);
}

void Outputs::update(Port& port) {
  for (int bit = 0; bit < pins_of_a_port; ++bit) {
    if (Output* output = port.pins[static_cast<std::size_t>(bit)].get())
      output->set(core_->cycle, waveform_of(port, bit));
    if (Output* output = port.sinks[static_cast<std::size_t>(bit)].get()) output->set(core_->cycle, port.sink(bit));
  }
}

Waveform Outputs::waveform_of(const Port& port, int bit) const {
  const auto has = [bit](std::uint8_t bits) { return (bits >> bit & 1) != 0; };
  // A pin that is an input, even one with a pull-up, drives nothing.
  if (!has(port.directions)) return {};
  for (const auto& compare : compares_) {
    if (compare->port != &port || compare->bit != bit) continue;
    const int com = field(core_, compare->unit->com);
    if (com == avr_timer_com_normal) continue;
    avr_timer_t& timer = *compare->timer;
    const Mode mode = mode_of(core_, timer);
    if (mode.counting == Counting::level) return {compare->high ? 1.0 : 0.0, 0.0};
    const int clock = field(core_, timer.cs, 4);
    if (clock == 0) return {};
    const double prescaler = timer.cs_div[clock] < 16 ? static_cast<double>(1U << timer.cs_div[clock]) : 1.0;
    return pulse_width_modulated(mode, com, word(core_, compare->unit->r_ocr, compare->unit->r_ocrh), prescaler);
  }
  return {has(port.levels) ? 1.0 : 0.0, 0.0};
}

void Outputs::on_port(avr_irq_t*, std::uint32_t value, void* port) {
  auto* written = static_cast<Port*>(port);
  written->levels = static_cast<std::uint8_t>(value);
  written->outputs->update(*written);
}

void Outputs::on_direction(avr_irq_t*, std::uint32_t value, void* port) {
  auto* written = static_cast<Port*>(port);
  written->directions = static_cast<std::uint8_t>(value);
  written->outputs->update(*written);
}

void Outputs::on_register(avr_irq_t*, std::uint32_t, void* compare) {
  Port* port = static_cast<Compare*>(compare)->port;
  port->outputs->update(*port);
}

void Outputs::on_compare(avr_irq_t*, std::uint32_t value, void* compare) {
  auto* matched = static_cast<Compare*>(compare);
  matched->high = (value & 1U) != 0;
  Port* port = matched->port;
  if (mode_of(port->outputs->core_, *matched->timer).counting == Counting::level) port->outputs->update(*port);
}

}  // namespace cohort::avr
