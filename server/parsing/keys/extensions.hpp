// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "server/parsing/keys/extension.hpp"

/// The `cohort:` elements that extend SDFormat, as a table: the reader checks files against it, and manuals and help
/// are made from it.
namespace cohort::parsing {

std::span<const Extension> extensions();

/// Returns the keys that every sensor has beside its own. They come last among its keys.
std::span<const ExtensionKey> sensor_keys();

/// Returns the extension of this name in such a parent; nullptr if there is none.
const Extension* find_extension(std::string_view name, std::string_view parent);

}  // namespace cohort::parsing
