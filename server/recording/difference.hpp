#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "server/recording/replay.hpp"

namespace cohort::recording {

/// A quantity that is not the same in two runs.
struct QuantityDifference {
  std::string object;    ///< scoped name; empty: of the world as a whole
  std::string quantity;  ///< `command`, `action`, `pose`, `velocity`, `joint`, `contact`, `observation`, `presence`
  std::string detail;    ///< which of them, such as a channel, a joint or `x`; may be empty
  std::string first;     ///< its value in the one run, so that another number has other digits
  std::string second;    ///< in the other
};

/// Where two runs part.
struct Parting {
  std::uint64_t tick = 0;  ///< the first one
  std::chrono::nanoseconds log_time{0};
  /// Commands that act from this tick on or actions taken at it, if these differ: what is then another does so from the
  /// next tick on. Otherwise what differs in the states of this tick.
  std::vector<QuantityDifference> differences;
  std::uint64_t more = 0;  ///< differences beyond those listed
};

struct Comparison {
  std::uint64_t boundaries = 0;      ///< the same in both
  std::optional<Parting> parting{};  ///< none: they do not part
  std::string ends;                  ///< if one of them ends before the other, a sentence
};

/// Compares two recordings by what they hold, and where they part runs both again to find what differs there. Throws as
/// Recording and Replay do. `progress` is called at each boundary; if it returns false nothing further is compared.
Comparison compare(const Recording& first, const Recording& second, unsigned threads,
                   const std::function<bool(std::chrono::nanoseconds)>& progress);

/// What differs in two worlds: of each object in its order what comes first of presence, pose, velocity, joints,
/// commands and observations; then contacts.
std::vector<QuantityDifference> differences(const Simulation& first, const Simulation& second);

}  // namespace cohort::recording
