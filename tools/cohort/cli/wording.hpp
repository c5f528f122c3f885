#pragma once

#include <cstddef>
#include <string>

namespace cohort::tool {

/// "1 robot", "16 robots".
inline std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

}  // namespace cohort::tool
