#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/description/world.hpp"

namespace cohort::description {

/// The ids, ascending, of the robots that a selector means:
/// - `all`;
/// - an id, such as `7`;
/// - a range of ids with both ends, such as `0..7`;
/// - a scoped name, in which `*` stands for any characters or none, such as `explorers/*`.
/// Throws std::invalid_argument, with a message for the user, if it is none of these or means no robot.
std::vector<std::uint32_t> select_robots(const World& world, const std::string& selector);

/// All that any of `selectors` selects, ascending; throws as the other one.
std::vector<std::uint32_t> select_robots(const World& world, std::span<const std::string> selectors);

/// All that any of `selectors` selects, ascending; one that selects nothing does not matter.
std::vector<std::uint32_t> select_robots_of_any(const World& world, std::span<const std::string> selectors);

/// Whether a name is `pattern`, in which `*` stands for any characters or none.
bool matches(std::string_view name, std::string_view pattern);

/// The instances, ascending, whose names are `selector`, in which `*` stands for any characters or none. Throws
/// std::invalid_argument, with a message for the user, if there are none.
std::vector<std::size_t> select_objects(const World& world, const std::string& selector);

}  // namespace cohort::description
