// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace cohort::tool {

inline constexpr std::size_t most_seeds = 100'000;

/// Parses seeds: `1..30`, `7`, or several of these separated by commas. Keeps order and repetitions. Throws
/// std::invalid_argument that says what was expected.
std::vector<std::uint64_t> parse_seeds(const std::string& text);

}  // namespace cohort::tool
