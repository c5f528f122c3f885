#pragma once

#include <span>
#include <string_view>

/// The `cohort:` elements that extend SDFormat, as a table: the reader checks files against it, and manuals and help
/// are made from it.
namespace cohort::description {

enum class ExtensionValue {
  name,          ///< of a link, joint or device of the same model
  uri,           ///< model://NAME or a path
  real,          ///< any finite number
  non_negative,  ///< a finite number >= 0
  positive,      ///< a finite number > 0
  count,         ///< a whole number from 1 to 1 000 000
  whole,         ///< a whole number >= 0 of at most 64 bits
  point,         ///< "x y"
  pose,          ///< "x y z roll pitch yaw", rotated about the fixed axes x, then y, then z
  group          ///< an extension of its own, described by its own entry
};

struct ExtensionKey {
  std::string_view name;  ///< without the prefix
  ExtensionValue value = ExtensionValue::real;
  std::string_view unit;      ///< `1` if dimensionless, empty if not a quantity
  std::string_view fallback;  ///< what holds if the element is absent; empty if it must be there
  std::string_view doc;

  bool required() const { return fallback.empty(); }
};

struct Extension {
  std::string_view name;    ///< without the prefix
  std::string_view parent;  ///< the element that it stands in: `model`, `world` or another extension
  bool has_name = false;    ///< carries the attribute `name`
  std::string_view doc;
  std::span<const ExtensionKey> keys;
};

/// Without the colon.
inline constexpr std::string_view extension_prefix = "cohort";

std::span<const Extension> extensions();

/// nullptr if there is none of this name in such a parent.
const Extension* find_extension(std::string_view name, std::string_view parent);

}  // namespace cohort::description
