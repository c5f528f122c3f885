// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/common/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include "idl/text/domains.hpp"
#include "server/core/text.hpp"

namespace cohort::tool {
namespace {

bool is_above_zero(const std::string& text, double greatest) {
  const auto number = parse_real(text);
  return number && *number > 0.0 && *number <= greatest;
}

std::string number_of(const std::string& unit) { return unit.empty() ? "a number" : "a number of " + unit; }

}  // namespace

Check whole_number(std::uint64_t least, std::uint64_t greatest) {
  return [=](const std::string& text) {
    const auto number = parse_whole(text);
    return number && *number >= least && *number <= greatest
               ? std::string()
               : fmt::format("expected a whole number from {} to {}, not '{}'", least, greatest, text);
  };
}

Check number_above_zero(double greatest, const std::string& unit) {
  return [=](const std::string& text) {
    return is_above_zero(text, greatest)
               ? std::string()
               : fmt::format("expected {} above 0 and up to {}, not '{}'", number_of(unit), greatest, text);
  };
}

Check number_from_zero(double greatest, const std::string& unit) {
  return [=](const std::string& text) {
    const auto value = parse_real(text);
    return value && *value >= 0.0 && *value <= greatest
               ? std::string()
               : fmt::format("expected {} from 0 to {}, not '{}'", number_of(unit), greatest, text);
  };
}

Check max_or_number_above_zero(double greatest) {
  return [=](const std::string& text) {
    return text == "max" || is_above_zero(text, greatest)
               ? std::string()
               : fmt::format("expected max, or a number above 0 and up to {}, not '{}'", greatest, text);
  };
}

Check domain_range() {
  return [](const std::string& text) -> std::string {
    try {
      parse_domains(text);
      return {};
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
  };
}

Check one_of(std::vector<std::string> names) {
  return [names = std::move(names)](const std::string& text) {
    return std::find(names.begin(), names.end(), text) != names.end()
               ? std::string()
               : fmt::format("there is no '{}'{}", text, suggestion(text, names));
  };
}

}  // namespace cohort::tool
