// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

struct avr_irq_t;
struct avr_t;

namespace cohort::avr {

/// A pin of the microcontroller, such as PB5.
struct Pin {
  char port = 'A';
  int bit = 0;
  bool operator==(const Pin&) const = default;
};
std::string name_of(const Pin& pin);

/// The waveform of a pin: it is high for a fraction of each period.
struct Waveform {
  double duty = 0.0;    ///< 0 to 1
  double period = 0.0;  ///< [cycles]; 0: a constant level, with a `duty` of 0 or 1
  bool operator==(const Waveform&) const = default;
};

/// An output pin: how long it was high, and its pulses.
class Output {
 public:
  /// Called at each change of the level, unless a timer generates the waveform.
  std::function<void(std::uint64_t cycle, bool high)> edge{};

  Waveform waveform() const { return waveform_; }
  /// Restarts the measurement.
  void begin_window(std::uint64_t cycle);
  /// Returns the fraction of the window, up to this cycle, in which the pin was high.
  double duty(std::uint64_t cycle) const;
  /// Returns the length of the last complete pulse [cycles]; nullopt if none has ended since the cycle `oldest`.
  std::optional<double> pulse(std::uint64_t oldest) const;
  /// Returns the cycles from one rising edge to the next; nullopt if there were not two since the cycle `oldest`.
  std::optional<double> period(std::uint64_t oldest) const;

  void set(std::uint64_t cycle, Waveform waveform);

 private:
  Waveform waveform_;
  std::uint64_t since_ = 0;         // cycle at which the waveform or the window began
  std::uint64_t window_ = 0;        // cycle at which it began
  double high_ = 0.0;               // [cycles] in the window up to `since_`
  std::uint64_t rise_ = 0;          // cycle of the last one
  std::uint64_t pulse_ended_ = 0;   // 0: there was none
  std::uint64_t pulse_length_ = 0;  // [cycles]
  std::uint64_t last_period_ = 0;   // [cycles] before the last rising edge; 0: there was none
};

/// All output pins of a core. The waveform of a timer's pin is computed from the timer's registers with the formulas of
/// the data sheet, because simavr's own pins follow timers only in some modes.
class Outputs {
 public:
  Outputs(avr_t* core, std::string mcu);
  Outputs(const Outputs&) = delete;
  Outputs& operator=(const Outputs&) = delete;
  ~Outputs();

  /// Returns the pin's output, which is measured from now on. Throws std::runtime_error if there is no such pin.
  Output& watch(Pin pin);
  /// Returns an output that counts as high while the pin is driven low. A load between the pin and the supply, such as
  /// an LED, is then on. Throws as `watch`.
  Output& watch_sink(Pin pin);
  /// Called when the chip has reset its registers.
  void reset();
  void begin_window();

 private:
  struct Compare;
  struct Port;
  void find_ports();
  void find_timers();
  Port& port_of(Pin pin);
  void update(Port& port);
  Waveform waveform_of(const Port& port, int bit) const;
  static void on_port(avr_irq_t* irq, std::uint32_t value, void* port);
  static void on_direction(avr_irq_t* irq, std::uint32_t value, void* port);
  static void on_register(avr_irq_t* irq, std::uint32_t value, void* compare);
  static void on_compare(avr_irq_t* irq, std::uint32_t value, void* compare);

  avr_t* core_;
  std::string mcu_;
  std::vector<std::unique_ptr<Port>> ports_;
  std::vector<std::unique_ptr<Compare>> compares_;
};

}  // namespace cohort::avr
