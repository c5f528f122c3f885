// SPDX-License-Identifier: Apache-2.0
#include "server/physics/islands/island_parts.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace cohort::physics {

void IslandParts::reset(std::uint32_t count) {
  links_.clear();
  part_of_.assign(count, none);
}

void IslandParts::find_neighbours() {
  first_neighbour_.assign(part_of_.size() + 2, 0);
  for (const auto& [a, b] : links_) {
    ++first_neighbour_[a + 2];
    ++first_neighbour_[b + 2];
  }
  std::partial_sum(first_neighbour_.begin(), first_neighbour_.end(), first_neighbour_.begin());
  neighbours_.resize(2 * links_.size());
  // Filling advances each start index by one place, to where it belongs.
  for (const auto& [a, b] : links_) {
    neighbours_[first_neighbour_[a + 1]++] = b;
    neighbours_[first_neighbour_[b + 1]++] = a;
  }
}

void IslandParts::cut(std::uint32_t size) {
  find_neighbours();
  const auto count = static_cast<std::uint32_t>(part_of_.size());
  assert(size > 0);
  bodies_.clear();
  begin_.assign(1, 0);
  std::vector<std::uint32_t> waiting;  // neighbours of full parts, in the order of discovery
  std::vector<std::uint32_t> growing;  // neighbours of this part
  std::size_t next_waiting = 0;
  std::uint32_t lowest = 0;
  while (bodies_.size() < count) {
    const std::uint32_t part = this->count();
    growing.clear();
    std::size_t next_growing = 0;
    const std::size_t full = std::min<std::size_t>(count, begin_.back() + size);
    while (bodies_.size() < full) {
      std::uint32_t body = 0;
      if (next_growing < growing.size()) {
        body = growing[next_growing++];
      } else if (next_waiting < waiting.size()) {
        body = waiting[next_waiting++];
      } else {
        while (part_of_[lowest] != none) ++lowest;
        body = lowest;
      }
      if (part_of_[body] != none) continue;
      part_of_[body] = part;
      bodies_.push_back(body);
      for (std::uint32_t i = first_neighbour_[body]; i < first_neighbour_[body + 1]; ++i)
        if (part_of_[neighbours_[i]] == none) growing.push_back(neighbours_[i]);
    }
    waiting.insert(waiting.end(), growing.begin() + static_cast<std::ptrdiff_t>(next_growing), growing.end());
    std::sort(bodies_.begin() + begin_.back(), bodies_.end());
    begin_.push_back(static_cast<std::uint32_t>(bodies_.size()));
  }
}

}  // namespace cohort::physics
