// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "server/run/session_snapshot.hpp"

/// Human-readable texts in replies and events.
namespace cohort::session {

/// Returns the sentences on controllers whose state a snapshot lacks, to be appended to a message.
inline std::string left_out_text(const SessionSnapshot& snapshot, const description::Experiment& experiment) {
  std::string text;
  if (const std::string why = why_results_differ(snapshot.build); !why.empty()) text += "; " + why;
  for (const std::string& sentence : what_is_left_out(snapshot, experiment)) text += "; " + sentence;
  return text;
}

inline std::string ticks_text(std::uint64_t count) { return std::to_string(count) + (count == 1 ? " tick" : " ticks"); }

}  // namespace cohort::session
