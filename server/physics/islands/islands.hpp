// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace cohort::physics {

/// Groups of things that touch, directly or through others. The islands depend only on the links, not on their order.
class Islands {
 public:
  /// Starts again, with each member of [0, count) in an island of its own.
  void reset(std::uint32_t count);
  void link(std::uint32_t a, std::uint32_t b);
  /// Sorts the members; call it after the last link.
  void finish();
  /// Replaces each member of [0, count) by its name, after `finish`. Names are in ascending order.
  void rename(std::span<const std::uint32_t> names) {
    for (std::uint32_t& member : members_) member = names[member];
  }

  /// Islands are ordered by their lowest members.
  std::uint32_t count() const { return static_cast<std::uint32_t>(begin_.size()) - 1; }
  /// Ascending.
  std::span<const std::uint32_t> members(std::uint32_t island) const {
    return {members_.data() + begin_[island], members_.data() + begin_[island + 1]};
  }

 private:
  std::uint32_t find(std::uint32_t member);

  std::vector<std::uint32_t> root_;    // a lower member of the same island, or itself
  std::vector<std::uint32_t> island_;  // by root
  std::vector<std::uint32_t> begin_{0};
  std::vector<std::uint32_t> members_;
};

}  // namespace cohort::physics
