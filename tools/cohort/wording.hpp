#pragma once

#include <cstddef>
#include <string>

#include "server/description/experiment.hpp"

namespace cohort::tool {

/// "1 robot", "16 robots".
inline std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

/// As experiments write it.
inline const char* word_of(description::OnLate on_late) {
  switch (on_late) {
    case description::OnLate::wait: return "wait";
    case description::OnLate::hold: return "hold";
    case description::OnLate::zero: return "zero";
    case description::OnLate::detach: return "detach";
    case description::OnLate::stop: return "stop";
  }
  return "unknown";
}

}  // namespace cohort::tool
