// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/sdf_report.hpp"

#include <algorithm>
#include <utility>

namespace cohort::parsing {

Problem SdfReport::place_of(const Element* element) const {
  Location location = SdfFiles::locate(element);
  return {std::move(location.file), location.line, std::move(location.element), ""};
}

void SdfReport::problem(const Element* element, std::string message, std::string_view child) const {
  Problem& problem = problems_.emplace_back(place_of(element));
  if (!child.empty()) problem.element += "/" + std::string(child);
  problem.message = std::move(message);
}

void SdfReport::stop(const Element* element, std::string message) const {
  problem(element, std::move(message));
  throw InputError(problems_);
}

void SdfReport::warning(const Element* element, std::string message) const {
  warnings_.push_back(place_of(element));
  warnings_.back().message = std::move(message);
}

void SdfReport::warning_once(const Element* element, const std::string& message) const {
  const auto file = SdfFiles::locate(element).file;
  const bool is_said = std::any_of(warnings_.begin(), warnings_.end(),
                                   [&](const Problem& said) { return said.file == file && said.message == message; });
  if (!is_said) warning(element, message);
}

bool SdfReport::flaw(const Element* element, const std::string& message, const std::string& remedy) const {
  if (!is_foreign(element)) {
    problem(element, message);
    return false;
  }
  warning(element, message + "; " + remedy);
  return true;
}

bool SdfReport::forgive(const Element* element, std::size_t count, const std::string& remedy) const {
  if (problems_.size() == count || !is_foreign(element)) return false;
  for (std::size_t i = count; i < problems_.size(); ++i) {
    warnings_.push_back(std::move(problems_[i]));
    warnings_.back().message += "; " + remedy;
  }
  problems_.resize(count);
  return true;
}

}  // namespace cohort::parsing
