#pragma once

#include <span>
#include <string_view>

#include "server/parsing/keys/extensions.hpp"

/// The keys of experiments, as a table like that of the `cohort:` elements: the reader checks files against it, and
/// manuals and help are made from it.
namespace cohort::parsing {

/// The maps that an experiment is made of. The whole is `experiment`, whose parent is empty; any other stands in its
/// parent, alone or in a list.
std::span<const Extension> experiment_parts();

/// There has to be one.
const Extension& experiment_part(std::string_view name, std::string_view parent);

}  // namespace cohort::parsing
