// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "server/simulation/simulation.hpp"

namespace cohort::tool {

/// Returns the present state of all objects of a simulation as JSON, in SI units and radians. Matrices are arrays of
/// rows. A pose is x y z and the quaternion x y z w. A missing limit is null. docs/cli.md lists the keys.
std::string facts_as_json(const Simulation& simulation);

/// Returns the same as text, with a line for each link and joint.
std::string facts_as_text(const Simulation& simulation);

}  // namespace cohort::tool
