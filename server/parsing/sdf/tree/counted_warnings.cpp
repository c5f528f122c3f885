// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/tree/counted_warnings.hpp"

#include <utility>

namespace cohort::parsing {

void CountedWarnings::add(const Problem& place, const std::string& message) {
  const auto [known, is_new] = places_.emplace(message, told_.size());
  if (is_new) {
    told_.push_back({place, 0});
    told_.back().first.message = message;
  }
  ++told_[known->second].count;
}

void CountedWarnings::tell(std::vector<Problem>& warnings) const {
  for (const auto& [first, count] : told_) {
    warnings.push_back(first);
    if (count > 1) warnings.back().message += "; it occurs " + std::to_string(count) + " times in this file";
  }
}

}  // namespace cohort::parsing
