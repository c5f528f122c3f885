// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdarg>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/bridges/avr/image.hpp"
#include "tools/bridges/avr/output_pins.hpp"

struct avr_watchdog_t;

namespace cohort::avr {

/// A type of microcontroller, its clock and its supply.
struct Chip {
  std::string mcu;              ///< name in avr-gcc's option -mmcu, such as `atmega328p`
  std::uint32_t frequency = 0;  ///< clock frequency [Hz]
  double supply = 5.0;          ///< also the reference of its analog inputs [V]
};

/// One simulated microcontroller, from power-on. It runs in simulated time and never reads the wall clock. Therefore
/// the same image and the same inputs at the same cycles give bit-identical results. Not thread-safe.
class Core {
 public:
  /// Throws std::runtime_error if the chip is unknown, or the image is not for this chip.
  Core(const Image& image, Chip chip);
  Core(const Core&) = delete;
  Core& operator=(const Core&) = delete;
  ~Core();

  const Chip& chip() const { return chip_; }
  /// Returns simavr's handle, for functions that this class does not offer.
  avr_t* handle() const { return avr_; }
  std::uint64_t cycle() const;
  std::uint32_t program_counter() const;  ///< [bytes]

  /// Runs up to this cycle, or a few cycles further, to the end of the last instruction. A sleeping core skips to the
  /// next cycle at which an event is due.
  void run_until(std::uint64_t cycle);

  /// Calls `event` when the core has reached this cycle. Events of the same cycle are called in the order in which they
  /// were added.
  void at(std::uint64_t cycle, std::function<void()> event);
  void cancel_events() { events_.clear(); }

  Outputs& outputs() { return *outputs_; }

  /// Drives a pin from outside, as a switch or a sensor does. Throws std::runtime_error if there is no such pin.
  void set_input(Pin pin, bool high);
  /// Returns whether a pin that is driven from outside is high.
  bool input(Pin pin) const;
  /// Sets the voltage of an analog input [V], between 0 and the supply. Throws std::runtime_error if there is no such
  /// input.
  void set_voltage(int input, double volts);

  /// Calls `receive` with each byte that a serial interface sends. Throws std::runtime_error if there is no such
  /// interface.
  void connect_serial(int number, std::function<void(std::uint8_t)> receive);
  /// Sends bytes to a serial interface, and returns how many it accepted: fewer if its buffer is full or it is not
  /// enabled.
  std::size_t send_serial(int number, std::span<const std::uint8_t> bytes);

  /// Returns why the core has stopped, such as an invalid instruction; nullopt while it runs.
  const std::optional<std::string>& fault() const { return fault_; }
  /// Returns and clears the messages to the user since the last call, about resets and endless sleep.
  std::vector<std::string> take_notes();

 private:
  struct Serial {
    avr_irq_t* input = nullptr;
    std::function<void(std::uint8_t)> receive;
    bool is_full = true;
  };

  void load(const Image& image);
  void enlarge_memories();
  void connect();
  void connect_watchdog(avr_watchdog_t* watchdog);
  void disconnect_usb();
  void watch_edges_only();
  void arm();
  void sleep_for_ever(std::uint64_t cycle);
  void on_reset();
  void on_message(const std::string& text);
  avr_irq_t* pin_irq(Pin pin) const;
  Serial& serial(int number);

  static void log(avr_t* avr, int level, const char* format, va_list arguments);
  static std::uint64_t wake(avr_t* avr, std::uint64_t when, void* core);

  Chip chip_;
  avr_t* avr_ = nullptr;
  void (*reset_of_chip_)(avr_t*) = nullptr;
  void (*run_of_chip_)(avr_t*) = nullptr;
  std::unique_ptr<Outputs> outputs_;
  std::multimap<std::uint64_t, std::function<void()>> events_;
  std::uint64_t end_ = 0;  // end of the present run
  bool in_event_ = false;
  struct Driven {
    std::uint8_t mask = 0, levels = 0;
  };
  std::map<char, Driven> driven_;  // by port: pins that are driven from outside
  std::map<int, std::unique_ptr<Serial>> serials_;
  std::optional<std::string> fault_;
  std::vector<std::string> notes_;
  bool said_that_it_sleeps_ = false;
  bool was_reset_ = false;
  avr_watchdog_t* watchdog_ = nullptr;
  unsigned watchdog_prescaler_ = 0;
};

}  // namespace cohort::avr
