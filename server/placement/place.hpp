// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "server/description/world.hpp"
#include "server/placement/placer.hpp"

namespace cohort::placement {

/// Places the populations of a world with another seed: sets the instances, robots and warnings that the world has when
/// it is read with this seed. `placer` must have been made from this world, or from one that differs only in the seed.
/// Returns true if the instances are the same as before except for their poses. If not, indices of instances or robots
/// that are stored elsewhere become invalid. Adds problems to `problems`; the world is then unusable.
bool place(World& world, const Placer& placer, std::uint64_t seed, std::vector<Problem>& problems);

/// Adds the instances of all populations to a world that has only its other instances. `names` are the names of all
/// instances.
void add_populations(World& world, std::uint64_t seed, std::set<std::string>& names, std::vector<Problem>& problems);

/// Sets the robots of a world whose instances are complete.
void set_robots(World& world);

/// Checks everything that refers to instances by name, in a world whose instances are complete, and warns of
/// populations with too few instances.
void check_instances(World& world, std::vector<Problem>& problems);

}  // namespace cohort::placement
