// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace cohort::physics {

/// A partition of a large island into connected parts that can be solved separately. The parts depend only on the links
/// and their order.
class IslandParts {
 public:
  /// Starts again with the bodies [0, count).
  void reset(std::uint32_t count);
  void link(std::uint32_t a, std::uint32_t b) { links_.emplace_back(a, b); }
  /// Cuts the island; call it after the last link. Each part grows from its first body along the links until it has
  /// `size` bodies; only the last part has fewer.
  void cut(std::uint32_t size);

  std::uint32_t count() const { return static_cast<std::uint32_t>(begin_.size()) - 1; }
  std::uint32_t part_of(std::uint32_t body) const { return part_of_[body]; }
  /// Ascending.
  std::span<const std::uint32_t> bodies(std::uint32_t part) const {
    return {bodies_.data() + begin_[part], bodies_.data() + begin_[part + 1]};
  }

 private:
  static constexpr std::uint32_t none = 0xffffffffu;

  void find_neighbours();

  std::vector<std::pair<std::uint32_t, std::uint32_t>> links_;
  std::vector<std::uint32_t> neighbours_;  // neighbours of all bodies, one body after the other
  std::vector<std::uint32_t> first_neighbour_;
  std::vector<std::uint32_t> part_of_;
  std::vector<std::uint32_t> bodies_;
  std::vector<std::uint32_t> begin_{0};
};

}  // namespace cohort::physics
