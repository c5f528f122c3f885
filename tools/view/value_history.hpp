// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace cohort::view {

/// One value of a robot over time.
struct ValueSeries {
  std::uint32_t robot = 0;      ///< id
  std::string name;             ///< such as `proximity/3/reading`, `camera/0/image[7]`, `→ tracks/0/velocity`
  std::string unit;             ///< SI; `1` if dimensionless
  std::vector<double> times{};  ///< [s], ascending
  std::vector<double> values{};
};

/// The answer to `history`.
struct ValueHistory {
  std::vector<ValueSeries> series{};
  bool is_reduced = false;       ///< values were left out
  std::optional<double> next{};  ///< start of the next request [s], if this is only the first part
};

}  // namespace cohort::view
