#pragma once

#include <map>
#include <string>
#include <vector>

#include "server/description/input_error.hpp"

namespace cohort::parsing {

/// Words of other people's files that mean nothing here. Each is told once, with its first place and how often it
/// stands there.
class UnknownNames {
 public:
  /// `place` has no message; `message` tells one word from another.
  void add(const Problem& place, const std::string& message);

  /// In the order of their first places.
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
