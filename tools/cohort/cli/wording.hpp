#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace cohort::tool {

/// "1 robot", "16 robots".
inline std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

inline double seconds(std::chrono::nanoseconds duration) { return std::chrono::duration<double>(duration).count(); }
inline std::chrono::nanoseconds nanoseconds(double seconds) {
  return std::chrono::round<std::chrono::nanoseconds>(std::chrono::duration<double>(seconds));
}
inline double microseconds(std::chrono::nanoseconds duration) {
  return std::chrono::duration<double, std::micro>(duration).count();
}

}  // namespace cohort::tool
