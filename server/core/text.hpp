// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "idl/text/edit_distance.hpp"

/// Parsing of user input: strict, of whole texts, and independent of the locale. Numbers are converted exactly.
namespace cohort {

/// Returns the text without white space at both ends.
std::string_view trimmed(std::string_view text);

/// Returns the parts between white space.
std::vector<std::string_view> words(std::string_view text);

/// Parses a decimal number; returns nothing if the text has other parts ("1,5", "3 m"). Accepts infinity and NaN.
std::optional<double> parse_real(std::string_view text);

/// Parses a non-negative integer of at most 64 bits.
std::optional<std::uint64_t> parse_whole(std::string_view text);

/// Returns the shortest text that parses to exactly this number.
std::string shortest_text(double number);

/// Returns the known name that an unknown one is probably a misspelling of, or nothing.
std::optional<std::string> nearest(std::string_view unknown, const std::vector<std::string>& known);

/// Returns the end of a message about an unknown name: "; did you mean 'x'?" with the nearest name, otherwise the known
/// names if they are few.
std::string suggestion(std::string_view unknown, const std::vector<std::string>& known);

}  // namespace cohort
