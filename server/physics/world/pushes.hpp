// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "server/physics/world/physics_world.hpp"

namespace cohort::physics {

/// External forces that act during the next step.
class Pushes {
 public:
  struct Push {
    std::uint32_t member = 0;
    int segment = 0;
    std::size_t link = 0;
    Eigen::Vector3d point_W;
    Wrench wrench;  ///< at the point
  };

  void add(const Push& push) {
    pushes_.insert(std::upper_bound(pushes_.begin(), pushes_.end(), push, is_before), push);
  }
  void clear() { pushes_.clear(); }

  /// Calls `visit(push)` for those on one body, in the order in which they were added. Thread-safe.
  template <class Visit>
  void for_each_of(std::uint32_t member, Visit&& visit) const {
    if (pushes_.empty()) return;
    Push first;
    first.member = member;
    const auto [begin, end] = std::equal_range(pushes_.begin(), pushes_.end(), first, is_before);
    std::for_each(begin, end, visit);
  }

 private:
  static bool is_before(const Push& one, const Push& two) { return one.member < two.member; }

  std::vector<Push> pushes_;  // by member
};

}  // namespace cohort::physics
