// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <optional>

#include "server/recording/replay.hpp"
#include "tools/cli/common/command_line.hpp"
#include "tools/cli/common/log.hpp"

namespace cohort::tool {

/// An interval of log times of a recording, with both ends included [s].
struct RecordingPart {
  double from = 0.0;
  std::optional<double> to{};  ///< none: to the end
};

void add_part_options(CommandLine line, RecordingPart& part);

inline constexpr const char* nothing_in_part = "the recording contains no data between '--from' and '--to'";

std::chrono::nanoseconds start_of_part(const RecordingPart& part);
std::chrono::nanoseconds end_of_part(const RecordingPart& part);

/// Calls `visit` at each tick boundary of the part, and shows progress. Returns false if it was stopped. Throws
/// std::invalid_argument if the part contains no boundary.
bool replay_part(recording::Replay& replay, const RecordingPart& part, Log& log, const std::atomic<bool>& stop,
                 const std::function<void()>& visit);

}  // namespace cohort::tool
