// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace cohort::parsing {

/// The kind of value in the text of an element or an attribute.
enum class ValueType { none, text, flag, integer, count, real, vector2, vector3, color, time, pose };

/// How often an element may occur in its parent.
enum class Presence { once, at_most_once, any, at_least_once, deprecated };

struct ValueRule {
  ValueType type = ValueType::none;
  std::string standard;  ///< default text
  double least = -std::numeric_limits<double>::infinity();
  double greatest = std::numeric_limits<double>::infinity();
};

/// The effect of an element or an attribute that does not have its default value.
enum class Effect {
  full,        ///< as SDF defines it
  appearance,  ///< on appearance or names in other simulators, none on what is simulated
  none,        ///< on how other simulators compute or look, none here
  missing,     ///< on motion or measurements in other simulators, none here
  told         ///< none; the reader of its parent warns of it
};

struct AttributeRule {
  std::string name;
  ValueRule value;
  bool is_required = false;
  Effect effect = Effect::full;
  std::string remark;  ///< follows the message about a missing effect
};

struct ElementRule;

struct ChildRule {
  const ElementRule* element;
  Presence presence;
  Effect effect = Effect::full;  ///< also of everything below it, if not `full`
  std::string remark;            ///< follows the message about a missing effect; says what is told
};

/// The content that SDF 1.12 allows in an element (http://sdformat.org/spec, version 1.12).
struct ElementRule {
  std::string name;
  ValueRule value;
  bool takes_anything = false;  ///< as in <plugin>
  bool is_shared = false;       ///< defined at the left margin, for use in several places
  std::vector<AttributeRule> attributes;
  std::vector<ChildRule> children;

  /// Returns the rule of a child; nullptr if SDF knows none of this name here.
  const ElementRule* child(std::string_view child_name) const;
  const ChildRule* child_rule(std::string_view child_name) const;
  /// Returns the rule of an attribute; nullptr if SDF knows none of this name here.
  const AttributeRule* attribute(std::string_view attribute_name) const;
};

/// Returns the rule of <sdf>. It lives as long as the program; threads may read it at the same time.
const ElementRule& sdf_rule();

/// Returns the number of numbers in a value; 0 for one that does not consist of numbers.
std::size_t count_of_numbers(ValueType type);

/// The rules as text, a line for each element, indented below its parent:
///
///     NAME PRESENCE [TYPE [>=LEAST] [<=GREATEST] ["STANDARD"]] [...] [EFFECT] [@ATTRIBUTE[!] TYPE ["STANDARD"]
///         [EFFECT]]...
///
/// PRESENCE is `1`, `?` (at most once), `*` (any number), `+` (at least once) or `-` (deprecated). `...` allows any
/// children, and `!` marks a required attribute. A line that begins with `@` continues the element above it.
/// `[NAME] PRESENCE [EFFECT]` is the element that is defined at the left margin. EFFECT is `-`
/// (appearance), `~` (none), `x` (missing) or `!` (told), with a remark in quotation marks directly after it; `full` is
/// not written.
extern const char* const rules_of_worlds;
extern const char* const rules_of_models;
extern const char* const rules_of_sensors;

}  // namespace cohort::parsing
