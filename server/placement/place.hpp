#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "server/description/world.hpp"
#include "server/placement/placer.hpp"

namespace cohort::placement {

/// Places the populations of a world by another seed: gives it the instances, robots and warnings that it has when it
/// is read with this seed. `placer` was made of the world, or of one that differs from it in its seed alone. Returns
/// whether the instances are the same as before, but for their poses; if not, what refers to instances or robots by
/// index, outside the world, is out of date. What is wrong is added to `problems`; the world is then of no use.
bool place(World& world, const Placer& placer, std::uint64_t seed, std::vector<Problem>& problems);

/// Makes the instances of populations in a world that has only the instances before them. `names` are those of all
/// instances.
void add_populations(World& world, std::uint64_t seed, std::set<std::string>& names, std::vector<Problem>& problems);

/// Sets the robots of a world whose instances are all there.
void set_robots(World& world);

/// Checks what names instances in a world whose instances are all there, and warns of populations with fewer instances
/// than they should have.
void check_instances(World& world, std::vector<Problem>& problems);

}  // namespace cohort::placement
