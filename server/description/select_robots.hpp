// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/description/world.hpp"

namespace cohort::description {

/// Returns the ids, ascending, of the robots that a selector matches:
/// - `all`;
/// - an id, such as `7`;
/// - a range of ids with both ends, such as `0..7`;
/// - a scoped name, in which `*` matches any characters or none, such as `explorers/*`.
/// Throws std::invalid_argument, with a message for the user, if it is none of these or matches no robot.
std::vector<std::uint32_t> select_robots(const World& world, const std::string& selector);

/// Returns the ids, ascending, that any of `selectors` matches; throws if one of them matches no robot.
std::vector<std::uint32_t> select_robots(const World& world, std::span<const std::string> selectors);

/// Returns the ids, ascending, that any of `selectors` matches; ignores those that match no robot.
std::vector<std::uint32_t> select_robots_of_any(const World& world, std::span<const std::string> selectors);

/// Returns whether a name matches `pattern`, in which `*` matches any characters or none.
bool matches(std::string_view name, std::string_view pattern);

/// Returns the instances, ascending, whose names match `selector`, in which `*` matches any characters or none. Throws
/// std::invalid_argument, with a message for the user, if there are none.
std::vector<std::size_t> select_objects(const World& world, const std::string& selector);

}  // namespace cohort::description
