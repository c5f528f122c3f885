#pragma once

#include <optional>
#include <string>

#include "server/description/world.hpp"
#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

/// Returns the text of a model in SDF that includes `uri` and adds a position motor to each revolute, prismatic or
/// screw joint that follows no other joint. Returns nothing if `world` does not have exactly one model that is not
/// static, or if this has no such joint or drives one already. A limit that the joint does not give is 3.14 rad/s or
/// 1 m/s, and ten times the weight of the model [N], or this at 1 m [N m].
std::optional<std::string> text_with_joint_motors(const World& world, const std::string& uri);

}  // namespace cohort::parsing
