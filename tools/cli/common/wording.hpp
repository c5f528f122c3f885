// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <chrono>
#include <cstddef>
#include <string>

#include "server/parsing/experiment/read_experiment.hpp"

namespace cohort::tool {

/// Returns a count with its noun: "1 robot", "16 robots".
inline std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

inline double seconds(std::chrono::nanoseconds duration) { return std::chrono::duration<double>(duration).count(); }
/// Returns " of 10.00", or nothing for a run without end.
inline std::string of_duration(std::chrono::nanoseconds duration) {
  return duration >= parsing::without_end ? "" : fmt::format(" of {:.2f}", seconds(duration));
}
inline std::chrono::nanoseconds nanoseconds(double seconds) {
  return std::chrono::round<std::chrono::nanoseconds>(std::chrono::duration<double>(seconds));
}
inline double microseconds(std::chrono::nanoseconds duration) {
  return std::chrono::duration<double, std::micro>(duration).count();
}

}  // namespace cohort::tool
