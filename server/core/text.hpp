#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "client_sdk/text/edit_distance.hpp"

/// Reading what a person typed: whole and strict, and the same in every locale. Numbers that are read as they were.
namespace cohort {

/// Without white space at either end.
std::string_view trimmed(std::string_view text);

/// The parts between white space.
std::vector<std::string_view> words(std::string_view text);

/// A decimal number, or nothing if any of the text is something else ("1,5", "3 m"). Infinite and NaN are numbers here.
std::optional<double> parse_real(std::string_view text);

/// A non-negative whole number of at most 64 bits.
std::optional<std::uint64_t> parse_whole(std::string_view text);

/// The shortest text that is read as this number again, to the bit.
std::string shortest_text(double number);

/// The known name that an unknown one is a slip away from, or nothing.
std::optional<std::string> nearest(std::string_view unknown, const std::vector<std::string>& known);

/// What to add to a message about an unknown name: "; did you mean 'x'?" with the nearest one, otherwise the known ones
/// if they are few.
std::string suggestion(std::string_view unknown, const std::vector<std::string>& known);

}  // namespace cohort
