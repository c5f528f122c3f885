#pragma once

#include <cstdint>
#include <string>

namespace cohort {

/// A named part of a robot's observation or command: `size` float64 values in a row.
struct Channel {
  std::string name;  ///< `device/index/quantity`, such as `proximity/3/reading`
  std::string unit;  ///< SI, `1` if dimensionless
  std::uint32_t size = 1;
  double lower = 0.0;       ///< least valid value
  double upper = 0.0;       ///< greatest valid value
  double neutral = 0.0;     ///< acts until a first answer does; of an observation: until a first report
  bool is_measured = true;  ///< false of counts and flags, which have no noise
};

}  // namespace cohort
