#include "server/parsing/sdf/sdf_report.hpp"

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

}  // namespace cohort::parsing
