#pragma once

#include <optional>

#include "server/description/world.hpp"
#include "server/parsing/sdf/extension_values.hpp"

namespace cohort::parsing {

/// A `cohort:breakable_joint` of a world whose objects are all there. Nothing if it cannot be; the report then has it.
std::optional<BreakableJoint> read_breakable_joint(const ExtensionValues& values, const World& world,
                                                   const SdfReport& report);

}  // namespace cohort::parsing
