// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace cohort::physics {

/// A segment of a body in a problem, or the world.
struct Anchor {
  int body = -1;  ///< index of the body in the problem, -1: the world
  int segment = 0;
};

/// Maps the solids of the scene to the bodies of this step's problems.
struct Anchors {
  static constexpr std::uint32_t nobody = 0xffffffffu;
  struct Part {
    std::uint32_t member = nobody;  ///< `nobody`: part of the world
    int segment = 0;
  };

  std::vector<Part> part_of_solid;
  std::vector<int> index_of_member;  ///< index in its island's problem, or -1 if it is not in one

  bool moves(std::uint32_t solid) const { return part_of_solid[solid].member != nobody; }
  std::uint32_t member(std::uint32_t solid) const { return part_of_solid[solid].member; }
  Anchor of(std::uint32_t solid) const {
    const Part& part = part_of_solid[solid];
    if (part.member == nobody) return {};
    return {index_of_member[part.member], part.segment};
  }
};

}  // namespace cohort::physics
