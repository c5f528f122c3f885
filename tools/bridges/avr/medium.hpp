// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace cohort::avr {

/// A medium that carries signals between boards in less than a frame. All boards of a frame run for one window, on any
/// number of threads. Then the medium carries their signals to the others, which receive them in a later window.
class Medium {
 public:
  virtual ~Medium() = default;

  /// Returns the length of a window. It is shorter than the time from sending to receiving, by at least the longest
  /// instruction.
  virtual std::chrono::nanoseconds window() const = 0;

  /// Called between two windows, while no core runs.
  virtual void exchange() = 0;
};

}  // namespace cohort::avr
