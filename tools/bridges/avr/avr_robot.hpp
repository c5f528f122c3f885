// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cohort/client.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/bridges/avr/board.hpp"
#include "tools/bridges/avr/core.hpp"
#include "tools/bridges/common/link.hpp"

namespace cohort::avr {

/// Returns the number of whole cycles of a clock of this `frequency` [Hz] in a time, without accumulated rounding
/// errors.
std::uint64_t cycles_in(std::chrono::nanoseconds time, std::uint32_t frequency);

/// The destination of the bytes that firmware sends through a serial interface.
enum class SerialTo { log, pty, none };

/// One robot with its microcontroller. Not thread-safe.
class Robot {
 public:
  struct Options {
    Image image;
    Chip chip;
    SerialTo serial_to = SerialTo::log;
    int serial = 0;                        ///< number of the serial interface
    std::chrono::nanoseconds power_on{0};  ///< delay of the power-on after the first frame
  };
  /// Switches the power on. Throws std::runtime_error.
  Robot(const Options& options, std::unique_ptr<Board> board, const DrivenRobot& robot,
        std::shared_ptr<bridges::Link> pty);

  /// Runs the core from this frame's time to that of the next one, and sets the command according to the output pins.
  void step(FrameRobot& frame, std::chrono::nanoseconds time);
  /// The three parts of `step`, for robots that exchange signals within a frame. `run_until` runs the core to a time
  /// within the frame.
  void begin(const FrameRobot& frame, std::chrono::nanoseconds time);
  void run_until(std::chrono::nanoseconds time);
  void end(FrameRobot& frame);

  std::chrono::nanoseconds period() const { return period_; }

  /// Returns and clears the messages to the user about the last steps.
  std::vector<std::string> take_lines();

 private:
  void connect_serial();
  void receive(std::uint8_t byte);
  void feed_serial();
  void tell(const std::string& text) { lines_.push_back(text); }
  std::uint64_t cycle_at(std::chrono::nanoseconds time) const;
  void tell_of_the_core(std::uint64_t tick);

  Options options_;
  std::shared_ptr<bridges::Link> pty_;
  Core core_;
  std::unique_ptr<Board> board_;
  std::chrono::nanoseconds period_;
  std::optional<std::chrono::nanoseconds> switched_on_;  // time of the core's cycle 0
  std::string line_;                                     // incomplete line of the serial interface
  std::vector<std::uint8_t> sent_to_it_;                 // by the bridge, and not read by the core yet
  std::vector<std::string> lines_;
  int notes_told_ = 0;
  bool told_of_fault_ = false;
};

}  // namespace cohort::avr
