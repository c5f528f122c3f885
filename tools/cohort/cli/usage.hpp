#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

/// What people read who mistype a command.
namespace cohort::tool {

/// Checks of an option's value; their messages say what was expected.
CLI::Validator whole_number(std::uint64_t least, std::uint64_t greatest);
inline constexpr double most_seconds = 9e9;  ///< fits into nanoseconds

CLI::Validator number_above_zero(double greatest);
CLI::Validator number_from_zero(double greatest);
CLI::Validator max_or_number_above_zero(double greatest);
CLI::Validator domain_range();
CLI::Validator one_of(std::vector<std::string> names);

/// What is wrong, in one sentence with the nearest known name, and which help to ask for.
std::string usage_error(const CLI::App& app, const CLI::ParseError& error);

}  // namespace cohort::tool
