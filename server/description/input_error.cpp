// SPDX-License-Identifier: Apache-2.0
#include "server/description/input_error.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "server/description/shortened.hpp"

namespace cohort::description {
namespace {

// Sorts problems: files in the order of their first problem, each from its first line to its last. A problem that is
// found twice, in a file that is read twice, is reported once.
std::vector<Problem> in_order(std::vector<Problem> problems) {
  for (Problem& problem : problems)
    for (std::string* text : {&problem.element, &problem.message}) *text = shortened(std::move(*text));
  std::set<std::string> said;
  std::erase_if(problems, [&](const Problem& problem) { return !said.insert(problem.text()).second; });
  std::map<std::filesystem::path, std::size_t> rank;
  for (const Problem& problem : problems) rank.emplace(problem.file, rank.size());
  std::stable_sort(problems.begin(), problems.end(), [&](const Problem& a, const Problem& b) {
    return std::pair(rank[a.file], a.line) < std::pair(rank[b.file], b.line);
  });
  return problems;
}

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
    : std::runtime_error(in_lines(in_order(problems))), problems_(in_order(std::move(problems))) {}

}  // namespace cohort::description
