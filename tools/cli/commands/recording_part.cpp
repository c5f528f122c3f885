// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/commands/recording_part.hpp"

#include "tools/cli/common/terminal/replay_progress.hpp"
#include "tools/cli/common/wording.hpp"

namespace cohort::tool {

void add_part_options(CommandLine line, RecordingPart& part) {
  line.add_option("--from", part.from,
                  "Start of the part, in simulated seconds from the start of the recording (default: 0)")
      .check(number_from_zero(most_seconds, "seconds"))
      .type_name("S");
  line.add_option("--to", part.to,
                  "End of the part, in simulated seconds from the start of the recording (default: its end)")
      .check(number_from_zero(most_seconds, "seconds"))
      .type_name("S");
}

std::chrono::nanoseconds start_of_part(const RecordingPart& part) { return nanoseconds(part.from); }

std::chrono::nanoseconds end_of_part(const RecordingPart& part) {
  return part.to ? nanoseconds(*part.to) : std::chrono::nanoseconds::max();
}

bool replay_part(recording::Replay& replay, const RecordingPart& part, Log& log, const std::atomic<bool>& stop,
                 const std::function<void()>& visit) {
  ReplayProgress progress(log);
  bool goes_on = replay.seek(start_of_part(part));
  if (!goes_on || replay.recorded().log_time > end_of_part(part)) throw std::invalid_argument(nothing_in_part);
  for (; goes_on && replay.recorded().log_time <= end_of_part(part); goes_on = replay.advance()) {
    if (stop) return false;
    progress.at(replay.recorded().log_time, "replayed");
    visit();
  }
  log.clear_progress();
  return true;
}

}  // namespace cohort::tool
