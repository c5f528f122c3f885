// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

/// Warnings about a file. Each message is reported once, with its first position and the number of occurrences.
class CountedWarnings {
 public:
  /// `place` has no message.
  void add(const Problem& place, const std::string& message);

  /// Adds the warnings in the order of their first positions.
  void tell(std::vector<Problem>& warnings) const;

 private:
  struct Told {
    Problem first;
    int count = 0;
  };
  std::vector<Told> told_;
  std::map<std::string, std::size_t> places_;  // in told_, by message
};

}  // namespace cohort::parsing
