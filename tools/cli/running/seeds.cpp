// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/running/seeds.hpp"

#include <sstream>
#include <stdexcept>

#include "server/core/text.hpp"

namespace cohort::tool {

std::vector<std::uint64_t> parse_seeds(const std::string& text) {
  std::vector<std::uint64_t> seeds;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) {
    const std::size_t dots = part.find("..");
    const auto first = parse_whole(part.substr(0, dots));
    const auto last = dots == std::string::npos ? first : parse_whole(part.substr(dots + 2));
    if (!first || !last || *last < *first)
      throw std::invalid_argument("expected seeds such as 1..30 or 4,8,15, not '" + part + "'");
    if (*last - *first >= most_seeds - seeds.size())
      throw std::invalid_argument("expected at most " + std::to_string(most_seeds) + " seeds");
    for (std::uint64_t seed = *first;; ++seed) {
      seeds.push_back(seed);
      if (seed == *last) break;
    }
  }
  return seeds;
}

}  // namespace cohort::tool
