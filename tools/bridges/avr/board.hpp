#pragma once

#include <chrono>
#include <cohort/controller.hpp>
#include <cstdint>
#include <memory>

#include "tools/bridges/avr/core.hpp"
#include "tools/bridges/avr/pins.hpp"

namespace cohort::avr {

/// The devices around a robot's microcontroller: its sensors and motors. One thread at a time.
class Board {
 public:
  virtual ~Board() = default;

  /// Looks the robot's channels up and connects to a core that has not run yet. Throws std::runtime_error if the robot
  /// or the chip lacks what is needed.
  virtual void start(const Start& start, Core& core) = 0;

  /// Says the simulated time of the core's cycle 0, before the first frame.
  virtual void switch_on(std::chrono::nanoseconds /*time*/) {}

  /// Brings what the robot senses to the core, which then runs from cycle `begin` to `end`.
  virtual void sense(const Observation& observation, std::uint64_t begin, std::uint64_t end) = 0;

  /// Sets the robot's command by what the core did meanwhile.
  virtual void act(Command& command) = 0;
};

/// Makes the board that a file of pins describes.
std::unique_ptr<Board> make_board(const Pins& pins);

}  // namespace cohort::avr
