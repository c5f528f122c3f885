#pragma once

#include <string>

#include "server/simulation/simulation.hpp"

namespace cohort::tool {

/// All objects of a simulation as it is now, for programs: JSON, in SI units, radians and rows of numbers. A pose is
/// x y z and the quaternion x y z w. What has no limit is null. docs/cli.md says what there is.
std::string facts_as_json(const Simulation& simulation);

/// The same for people: a line for each link and joint.
std::string facts_as_text(const Simulation& simulation);

}  // namespace cohort::tool
