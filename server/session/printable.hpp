#pragma once

#include <algorithm>
#include <string>

namespace cohort::session {

/// What a client says of itself, as it may stand in logs: without control characters, and not too long.
inline std::string printable(const std::string& text) {
  constexpr std::size_t longest = 100;
  std::string result = text.substr(0, longest);
  std::ranges::replace_if(
      result, [](unsigned char c) { return c < ' ' || c == 127; }, '?');
  return result;
}

}  // namespace cohort::session
