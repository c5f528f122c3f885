// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/sdf_values.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "server/core/text.hpp"
#include "server/parsing/sdf/schema/value_text.hpp"

namespace cohort::parsing {
namespace {

bool is_simulated(const std::string& name) {
  constexpr std::string_view ignored[] = {"visual", "light",      "sensor",    "plugin",           "scene",
                                          "gui",    "atmosphere", "actor",     "particle_emitter", "state",
                                          "audio",  "road",       "projector", "population"};
  return std::find(std::begin(ignored), std::end(ignored), name) == std::end(ignored) &&
         name.find(':') == std::string::npos;
}

bool is_hexadecimal(std::string_view text) {
  return (text.starts_with("0x") || text.starts_with("0X")) && text.size() > 2 &&
         text.find_first_not_of("0123456789abcdefABCDEF", 2) == std::string_view::npos;
}

void check_value(const Element& element, const SdfReport& report) {
  const ValueType type = element.rule()->value.type;
  const std::size_t count = count_of_numbers(type);
  if (count == 0 && type != ValueType::pose) return;
  if (!element.is_set()) {
    // A pose may have only attributes.
    if (type != ValueType::pose) report.problem(&element, "expected a number");
    return;
  }
  const std::string text = element.text();
  const std::vector<std::string_view> parts = words(text);
  for (const std::string_view part : parts) {
    if (type == ValueType::count && is_hexadecimal(part)) continue;
    const std::optional<double> number = parse_real(part);
    // A limit may be infinite.
    const bool valid = number && (std::isfinite(*number) || (std::isinf(*number) && count == 1));
    if (!valid) {
      report.problem(&element, "'" + std::string(part) + "' is not a number");
      return;
    }
  }
  if (count > 0 && parts.size() != count)
    report.problem(&element, "expected " + std::to_string(count) + " numbers, not '" + text + "'");
}

}  // namespace

std::optional<Eigen::Vector3d> written_unit_vector(const Element* element) {
  if (element == nullptr) return std::nullopt;
  const Eigen::Vector3d written = element->vector();
  return is_unit(written.squaredNorm()) ? std::optional(written) : std::nullopt;
}

void check_numbers(const Element* element, const SdfReport& report) {
  if (element->rule() != nullptr) check_value(*element, report);
  for (const Element* const child : element->children())
    if (is_simulated(child->name())) check_numbers(child, report);
}

}  // namespace cohort::parsing
