#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <optional>

#include "server/recording/replay.hpp"
#include "tools/cohort/cli/command_line.hpp"
#include "tools/cohort/cli/log.hpp"

namespace cohort::tool {

/// Log times of a recording, both in it [s].
struct RecordingPart {
  double from = 0.0;
  std::optional<double> to{};  ///< none: to the end
};

void add_part_options(CommandLine line, RecordingPart& part);

inline constexpr const char* nothing_in_part = "the recording has nothing in the time that is asked for";

std::chrono::nanoseconds start_of_part(const RecordingPart& part);
std::chrono::nanoseconds end_of_part(const RecordingPart& part);

/// Calls `visit` at each boundary of the part, and shows where it is. False if it was stopped. Throws
/// std::invalid_argument if there is no boundary in the part.
bool replay_part(recording::Replay& replay, const RecordingPart& part, Log& log, const std::atomic<bool>& stop,
                 const std::function<void()>& visit);

}  // namespace cohort::tool
