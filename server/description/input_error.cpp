#include "server/description/input_error.hpp"

#include <utility>

namespace cohort::description {
namespace {

std::string in_lines(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) {
    if (!text.empty()) text += '\n';
    text += problem.text();
  }
  return text;
}

}  // namespace

std::string Problem::text() const {
  std::string text = file.string();
  if (line > 0) text += ":" + std::to_string(line);
  text += ": ";
  if (!element.empty()) text += element + ": ";
  return text + message;
}

InputError::InputError(std::vector<Problem> problems)
    : std::runtime_error(in_lines(problems)), problems_(std::move(problems)) {}

}  // namespace cohort::description
