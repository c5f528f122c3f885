// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace cohort {

/// A named part of a robot's observation or command: `size` consecutive float64 values.
struct Channel {
  std::string name;  ///< `device/index/quantity`, such as `proximity/3/reading`
  std::string unit;  ///< SI, `1` if dimensionless
  std::uint32_t size = 1;
  double lower = 0.0;       ///< least valid value
  double upper = 0.0;       ///< greatest valid value
  double neutral = 0.0;     ///< command: used until the first answer; observation: value until the first report
  bool is_measured = true;  ///< false for counts and flags, which have no noise
};

}  // namespace cohort
