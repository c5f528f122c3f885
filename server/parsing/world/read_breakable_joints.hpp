// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "server/description/world.hpp"
#include "server/parsing/sdf/extension_values.hpp"

namespace cohort::parsing {

/// Reads a `cohort:breakable_joint` of a world whose objects are complete. Returns nothing, with a report, if it is
/// invalid.
std::optional<BreakableJoint> read_breakable_joint(const ExtensionValues& values, const World& world,
                                                   const SdfReport& report);

}  // namespace cohort::parsing
