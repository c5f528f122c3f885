// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "server/parsing/keys/extensions.hpp"

/// The keys of experiments, as a table like that of the `cohort:` elements: the reader checks files against it, and
/// manuals and help are made from it.
namespace cohort::parsing {

/// Returns the maps of which an experiment consists. The top-level map is `experiment`, whose parent is empty. Every
/// other map is in its parent, directly or in a list.
std::span<const Extension> experiment_parts();

/// Returns the part of this name, which must exist.
const Extension& experiment_part(std::string_view name, std::string_view parent);

}  // namespace cohort::parsing
