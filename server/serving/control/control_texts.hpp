#pragma once

#include <cstdint>
#include <string>

#include "server/run/session_snapshot.hpp"

/// For people, in replies and events.
namespace cohort::session {

/// What of its controllers a snapshot has not, after a sentence that says what was done.
inline std::string left_out_text(const SessionSnapshot& snapshot, const description::Experiment& experiment) {
  std::string text;
  if (const std::string why = why_results_differ(snapshot.build); !why.empty()) text += "; " + why;
  for (const std::string& sentence : what_is_left_out(snapshot, experiment)) text += "; " + sentence;
  return text;
}

inline std::string ticks_text(std::uint64_t count) { return std::to_string(count) + (count == 1 ? " tick" : " ticks"); }

}  // namespace cohort::session
