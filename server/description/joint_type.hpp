// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace cohort::description {

enum class JointType { fixed, revolute, prismatic, ball, universal, screw };

/// Properties of a joint type that are needed outside of the physics.
struct JointTypeFacts {
  JointType type;
  std::string_view name;  ///< in SDF
  int axes;               ///< axes with a position of their own
  bool slides;            ///< the position is a displacement [m], not an angle [rad]
  std::string_view flaw;  ///< why its axis cannot be referred to, to follow "the joint 'name' "; empty if it can
};

inline constexpr std::array joint_types = {
    JointTypeFacts{JointType::fixed, "fixed", 0, false, "is fixed"},
    JointTypeFacts{JointType::revolute, "revolute", 1, false, ""},
    JointTypeFacts{JointType::prismatic, "prismatic", 1, true, ""},
    JointTypeFacts{JointType::ball, "ball", 0, false, "is a ball joint, which has no single axis"},
    JointTypeFacts{JointType::universal, "universal", 2, false, ""},
    JointTypeFacts{JointType::screw, "screw", 1, false, ""}};

constexpr const JointTypeFacts& facts_of(JointType type) { return joint_types[static_cast<std::size_t>(type)]; }

/// Returns the type with this name in SDF.
constexpr std::optional<JointType> joint_type_named(std::string_view name) {
  for (const JointTypeFacts& facts : joint_types)
    if (facts.name == name) return facts.type;
  return std::nullopt;
}

static_assert([] {
  for (std::size_t i = 0; i < joint_types.size(); ++i)
    if (static_cast<std::size_t>(joint_types[i].type) != i) return false;
  return true;
}());

}  // namespace cohort::description
