// SPDX-License-Identifier: Apache-2.0
#include "server/physics/islands/islands.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace cohort::physics {

void Islands::reset(std::uint32_t count) {
  root_.resize(count);
  std::iota(root_.begin(), root_.end(), 0u);
}

std::uint32_t Islands::find(std::uint32_t member) {
  while (root_[member] != member) {
    root_[member] = root_[root_[member]];
    member = root_[member];
  }
  return member;
}

void Islands::link(std::uint32_t a, std::uint32_t b) {
  assert(a < root_.size() && b < root_.size());
  const std::uint32_t root_a = find(a);
  const std::uint32_t root_b = find(b);
  root_[std::max(root_a, root_b)] = std::min(root_a, root_b);
}

void Islands::finish() {
  const auto count = static_cast<std::uint32_t>(root_.size());
  island_.resize(count);
  begin_.assign(1, 0);
  // A root is the lowest member of its island, so it comes before the others.
  for (std::uint32_t member = 0; member < count; ++member) {
    root_[member] = find(member);
    if (root_[member] == member) {
      island_[member] = static_cast<std::uint32_t>(begin_.size()) - 1;
      begin_.push_back(0);
    }
    ++begin_[island_[root_[member]] + 1];
  }
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  assert(begin_.back() == count);
  members_.resize(count);
  std::vector<std::uint32_t>& fill = island_;  // reused, by root: index of the next member
  for (std::uint32_t member = 0; member < count; ++member)
    if (root_[member] == member) fill[member] = begin_[fill[member]];
  for (std::uint32_t member = 0; member < count; ++member) members_[fill[root_[member]]++] = member;
}

}  // namespace cohort::physics
