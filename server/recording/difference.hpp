// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "server/recording/replay.hpp"

namespace cohort::recording {

/// A quantity that differs between two runs.
struct QuantityDifference {
  std::string object;    ///< scoped name; empty for the world as a whole
  std::string quantity;  ///< `command`, `action`, `pose`, `velocity`, `joint`, `contact`, `observation`, `presence`
  std::string detail;    ///< the channel, joint or coordinate, such as `x`; may be empty
  std::string first;     ///< value in the first run, with enough digits to tell different numbers apart
  std::string second;    ///< value in the second run
};

/// The point at which two runs diverge.
struct Parting {
  std::uint64_t tick = 0;  ///< the first tick that differs
  std::chrono::nanoseconds log_time{0};
  /// Differences of the commands that act from this tick on, or of the actions taken at it, if there are any; their
  /// effects differ from the next tick on. Otherwise differences of the states at this tick.
  std::vector<QuantityDifference> differences;
  std::uint64_t more = 0;  ///< differences beyond those listed
};

struct Comparison {
  std::uint64_t boundaries = 0;      ///< number of identical boundaries
  std::optional<Parting> parting{};  ///< empty if the runs do not diverge
  std::string ends;                  ///< a sentence if one run ends before the other; otherwise empty
};

/// Compares the contents of two recordings. Where they diverge, it replays both to find the differences. Throws as
/// Recording and Replay do. `progress` is called at each boundary; if it returns false, the comparison ends.
Comparison compare(const Recording& first, const Recording& second, unsigned threads,
                   const std::function<bool(std::chrono::nanoseconds)>& progress);

/// Returns the differences of two worlds: for each object, in order, the first quantity that differs among presence,
/// pose, velocity, joints, commands and observations; then the contacts.
std::vector<QuantityDifference> differences(const Simulation& first, const Simulation& second);

}  // namespace cohort::recording
