// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/files/sdf_version.hpp"

#include <charconv>
#include <system_error>

namespace cohort::parsing {

std::pair<int, int> version_of(std::string_view text) {
  std::pair<int, int> version{0, 0};
  const char* const end = text.data() + text.size();
  const auto [dot, error] = std::from_chars(text.data(), end, version.first);
  if (error != std::errc{} || dot == end || *dot != '.') return {0, 0};
  const auto [stopped, second_error] = std::from_chars(dot + 1, end, version.second);
  if (second_error != std::errc{} || stopped != end || version.second < 0) return {0, 0};
  return version;
}

}  // namespace cohort::parsing
