// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

enum class ExtensionValue {
  name,          ///< name of a link, joint or device of the same model, or of a material
  object,        ///< scoped name of an object of the world, or of a link of it
  uri,           ///< model://NAME or a path
  choice,        ///< one of ExtensionKey::choices
  flag,          ///< `true` or `false`
  real,          ///< any finite number
  non_negative,  ///< a finite number >= 0
  positive,      ///< a finite number > 0
  fraction,      ///< a number from 0 to 1
  count,         ///< a whole number from 1 to 1 000 000
  whole,         ///< a whole number >= 0 of at most 64 bits
  point,         ///< "x y"
  vector,        ///< "x y z"
  place,         ///< "x y heading"
  pose,          ///< "x y z roll pitch yaw", rotated about the fixed axes x, then y, then z; or "x y z qx qy qz qw"
  group          ///< a separate extension with its own entry
};

/// The fallback of an optional key that has no value if it is absent.
inline constexpr std::string_view no_value = "none";

struct ExtensionKey {
  std::string_view name;  ///< without the prefix
  ExtensionValue value = ExtensionValue::real;
  std::string_view unit;      ///< `1` if dimensionless, empty if not a quantity
  std::string_view fallback;  ///< default if the element is absent; empty if it is required
  std::string_view doc;
  bool repeats = false;  ///< may be given any number of times
  std::span<const std::string_view> choices{};

  bool required() const { return fallback.empty(); }
};

struct Extension {
  std::string_view name;    ///< without the prefix
  std::string_view parent;  ///< the parent element: one of SDF or another extension
  bool has_name = false;    ///< carries the attribute `name`
  std::string_view doc;
  std::span<const ExtensionKey> keys;
  std::string_view topic;                        ///< topic of `cohort help` that lists it
  ExtensionValue value = ExtensionValue::group;  ///< `group` if it has keys; otherwise the kind of its value
};

/// The prefix of elements, without the colon.
inline constexpr std::string_view extension_prefix = "cohort";
/// Returns the name with prefix and colon.
inline std::string prefixed(std::string_view name) { return std::string(extension_prefix) + ":" + std::string(name); }
inline bool has_prefix(std::string_view name) { return name.starts_with(prefixed("")); }
/// Returns the name without the prefix; unchanged if it has none.
inline std::string_view without_prefix(std::string_view name) {
  return has_prefix(name) ? name.substr(extension_prefix.size() + 1) : name;
}

}  // namespace cohort::parsing
