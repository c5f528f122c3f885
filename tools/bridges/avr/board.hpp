// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cohort/controller.hpp>
#include <cstdint>
#include <memory>

#include "tools/bridges/avr/core.hpp"
#include "tools/bridges/avr/pins.hpp"

namespace cohort::avr {

/// The devices around a robot's microcontroller: its sensors and motors. Not thread-safe.
class Board {
 public:
  virtual ~Board() = default;

  /// Looks up the robot's channels and connects to a core that has not run yet. Throws std::runtime_error if the robot
  /// lacks a channel, or the chip a pin or an interface.
  virtual void start(const Start& start, Core& core) = 0;

  /// Called before the first frame with the simulated time of the core's cycle 0.
  virtual void switch_on(std::chrono::nanoseconds /*time*/) {}

  /// Sets the core's inputs from the robot's observation. The core then runs from cycle `begin` to `end`.
  virtual void sense(const Observation& observation, std::uint64_t begin, std::uint64_t end) = 0;

  /// Sets the robot's command from the core's outputs in these cycles.
  virtual void act(Command& command) = 0;
};

/// Makes the board that a pin map describes.
std::unique_ptr<Board> make_board(const Pins& pins);

}  // namespace cohort::avr
