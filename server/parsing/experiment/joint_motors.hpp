// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "server/description/world.hpp"
#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

/// Returns the text of a model in SDF that includes `uri` and adds a position motor to each revolute, prismatic or
/// screw joint that follows no other joint. Returns nothing unless `world` has exactly one model that is not static,
/// and this model has such joints and no device that drives anything. A velocity limit that a joint does not give is
/// 3.14 rad/s or 1 m/s. An effort limit that it does not give is ten times the weight of the model, for a torque at a
/// lever arm of 1 m.
std::optional<std::string> text_with_joint_motors(const World& world, const std::string& uri);

}  // namespace cohort::parsing
