// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace cohort::tool {

/// A check of an option's value. Returns what was expected; empty if the value is valid.
using Check = std::function<std::string(const std::string& value)>;

inline constexpr double most_seconds = 9e9;  ///< fits into nanoseconds

Check whole_number(std::uint64_t least, std::uint64_t greatest);
/// `unit`: that of the number, such as `seconds`.
Check number_above_zero(double greatest, const std::string& unit = "");
Check number_from_zero(double greatest, const std::string& unit = "");
Check max_or_number_above_zero(double greatest);
Check domain_range();
Check one_of(std::vector<std::string> names);

}  // namespace cohort::tool
