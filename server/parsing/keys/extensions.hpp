#pragma once

#include <span>
#include <string_view>

#include "server/parsing/keys/extension.hpp"

/// The `cohort:` elements that extend SDFormat, as a table: the reader checks files against it, and manuals and help
/// are made from it.
namespace cohort::parsing {

std::span<const Extension> extensions();

/// nullptr if there is none of this name in such a parent.
const Extension* find_extension(std::string_view name, std::string_view parent);

}  // namespace cohort::parsing
