#include "server/parsing/sdf/sdf_report.hpp"

#include <algorithm>
#include <utility>

namespace cohort::parsing {

void SdfReport::problem(const sdf::ElementPtr& element, std::string message, std::string_view child) const {
  Location location = files_.locate(element);
  if (!child.empty()) location.element += "/" + std::string(child);
  problems_.push_back({std::move(location.file), location.line, std::move(location.element), std::move(message)});
}

void SdfReport::warning(const sdf::ElementPtr& element, std::string message) const {
  Location location = files_.locate(element);
  warnings_.push_back({std::move(location.file), location.line, std::move(location.element), std::move(message)});
}

void SdfReport::warning_once(const sdf::ElementPtr& element, const std::string& message) const {
  const auto file = files_.locate(element).file;
  const bool is_said = std::any_of(warnings_.begin(), warnings_.end(),
                                   [&](const Problem& said) { return said.file == file && said.message == message; });
  if (!is_said) warning(element, message);
}

}  // namespace cohort::parsing
