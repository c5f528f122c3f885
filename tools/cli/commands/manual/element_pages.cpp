// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/commands/manual/element_pages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "server/core/text.hpp"
#include "server/parsing/sdf/schema/sdf_rules.hpp"
#include "server/parsing/sdf/urdf/urdf_forms.hpp"
#include "server/parsing/sdf/urdf/urdf_gazebo.hpp"
#include "tools/cli/commands/manual/page_text.hpp"

namespace cohort::tool {
namespace {

using parsing::AttributeRule;
using parsing::ChildRule;
using parsing::Effect;
using parsing::ElementRule;
using parsing::UrdfAttribute;
using parsing::UrdfForm;
using parsing::ValueRule;
using parsing::ValueType;

constexpr std::string_view sdf_introduction = R"(
These are the elements and attributes of SDFormat 1.12, and what they do in Cohort. An element without a remark has the
effect that SDFormat defines. The remarks have these meanings:

- **appearance only**: it changes how other simulators look, or a name that is not used here. Nothing is reported.
- **no effect**: it changes how other simulators compute or look. One warning names all such elements of a file.
- **ignored**: it changes motion or measurements in other simulators, but not here. Each such name causes a warning.

There is no message about an element with the default value. Elements that SDFormat does not define are
[unknown](../sdf.md#third-party-files). [SDFormat support](../sdf.md) explains the elements that have an effect. A
visual with a `<plane>`, `<heightmap>` or `<image>` is not shown. A test reads the elements of this page with other
values and compares the world and the messages with the remarks (`ctest --preset release -R Elements`).
)";

constexpr std::string_view urdf_introduction = R"(
These are the elements and attributes of URDF, and what they do in Cohort. An element without a remark has the effect
that URDF defines. Every other element outside of `<visual>` causes a warning. [URDF](../urdf.md) explains how files
are read, and names the elements of Bullet's `<contact>`.
)";

std::string_view name_of(ValueType type) {
  switch (type) {
    case ValueType::none: return "";
    case ValueType::text: return "text";
    case ValueType::flag: return "`true` or `false`";
    case ValueType::integer: return "whole number";
    case ValueType::count: return "whole number ≥ 0";
    case ValueType::real: return "number";
    case ValueType::vector2: return "2 numbers";
    case ValueType::vector3: return "3 numbers";
    case ValueType::color: return "colour";
    case ValueType::time: return "time";
    case ValueType::pose: return "pose";
  }
  return "";
}

std::string value_text(const ValueRule& rule) {
  std::string text;
  if (rule.type == ValueType::none) return text;
  text = fmt::format(" · {}", name_of(rule.type));
  if (std::isfinite(rule.least)) text += fmt::format(" ≥ {}", shortest_text(rule.least));
  if (std::isfinite(rule.greatest)) text += fmt::format(" ≤ {}", shortest_text(rule.greatest));
  if (!rule.standard.empty()) text += fmt::format(" · default `{}`", rule.standard);
  return text;
}

// Marks elements in a text as code.
std::string with_code(std::string_view text) {
  std::string result;
  for (const char c : text) result += c == '<' ? "`<" : c == '>' ? ">`" : std::string(1, c);
  return result;
}

std::string effect_text(Effect effect, const std::string& remark) {
  switch (effect) {
    case Effect::full: return "";
    case Effect::appearance: return " · **appearance only**";
    case Effect::none: return " · **no effect**";
    case Effect::missing: return fmt::format(" · **ignored**{}", with_code(remark));
    case Effect::told: return fmt::format(" · **ignored**: {}", with_code(remark));
  }
  return "";
}

std::string bullet_of(std::string_view text) { return wrapped(fmt::format("- {}", text), "  ") + "\n"; }

/// Writes a section for each element that is defined in one place and used in others, from the root on.
class SdfSections {
 public:
  std::string text() {
    add(parsing::sdf_rule());
    std::size_t next = 0;
    while (next < found_.size()) write(*found_[next++]);  // which finds more
    return fmt::format("{}\n# Elements of SDFormat\n{}{}", made_from("server/parsing/sdf/schema"), sdf_introduction,
                       text_);
  }

 private:
  void add(const ElementRule& rule) {
    if (std::ranges::find(found_, &rule) == found_.end()) found_.push_back(&rule);
  }
  void write(const ElementRule& rule) {
    text_ += fmt::format("\n## `<{}>`\n\n", rule.name);
    write_below(rule, "");
  }
  void write_below(const ElementRule& rule, const std::string& path) {
    for (const AttributeRule& attribute : rule.attributes)
      text_ += bullet_of(fmt::format("`{}@{}`{}{}{}", path, attribute.name, value_text(attribute.value),
                                     attribute.is_required ? " · required" : "",
                                     effect_text(attribute.effect, attribute.remark)));
    if (rule.takes_anything && rule.children.empty()) text_ += bullet_of("any other elements");
    for (const ChildRule& child : rule.children) write_child(child, path);
  }
  void write_child(const ChildRule& child, const std::string& path) {
    const ElementRule& rule = *child.element;
    const bool is_followed = child.effect == Effect::full;
    const std::string name = fmt::format("`{}{}`", path, rule.name);
    const bool has_own_section = is_followed && rule.is_shared;
    const std::string shown = has_own_section ? fmt::format("[{}](#{})", name, rule.name) : name;
    const bool has_more = !is_followed && !(rule.children.empty() && rule.attributes.empty());
    text_ += bullet_of(shown + (has_own_section ? "" : value_text(rule.value)) +
                       (has_more ? " and everything in it" : "") + effect_text(child.effect, child.remark));
    if (!is_followed) return;
    if (has_own_section)
      add(rule);
    else
      write_below(rule, path + rule.name + "/");
  }

  std::vector<const ElementRule*> found_;  // in the order of the sections
  std::string text_;
};

std::string value_text(const UrdfAttribute& attribute) {
  const std::string kind = attribute.numbers == 0 ? "text"
                           : attribute.numbers == 1
                               ? (attribute.positive ? "number > 0" : "number")
                               : fmt::format("{} numbers{}", attribute.numbers, attribute.positive ? " > 0" : "");
  return kind + (attribute.required ? " · required" : "");
}

std::string text_of_form(const UrdfForm& form) {
  std::string text = bullet_of(fmt::format("`{}`{}", form.name, form.has_effect ? "" : " · **ignored**"));
  for (const UrdfAttribute& attribute : form.attributes)
    text += bullet_of(fmt::format("`{}@{}` · {}", form.name, attribute.name, value_text(attribute)));
  return text;
}

std::string_view name_of(parsing::GazeboTarget target) {
  switch (target) {
    case parsing::GazeboTarget::robot: return "model";
    case parsing::GazeboTarget::link: return "link";
    case parsing::GazeboTarget::collision: return "collision";
    case parsing::GazeboTarget::visual: return "visual";
    case parsing::GazeboTarget::joint: return "joint";
  }
  return "";
}

}  // namespace

std::string sdf_elements() { return SdfSections().text(); }

std::string urdf_elements() {
  std::string text = fmt::format("{}\n# Elements of URDF\n{}", made_from("server/parsing/sdf/urdf"), urdf_introduction);
  std::vector<std::string_view> parents;
  for (const UrdfForm& form : parsing::urdf_forms())
    if (std::ranges::find(parents, form.parent) == parents.end()) parents.push_back(form.parent);
  for (const std::string_view parent : parents) {
    text += fmt::format("\n## In `<{}>`\n\n", parent);
    for (const UrdfForm& form : parsing::urdf_forms())
      if (form.parent == parent) text += text_of_form(form);
  }
  text +=
      "\n## In `<gazebo>`\n\nElements that set an [element of SDFormat](sdf-elements.md). All others are added to the "
      "link or the model.\n\n";
  for (const parsing::GazeboProperty& property : parsing::gazebo_properties())
    if (!property.path.empty())
      text += bullet_of(fmt::format("`{}` sets `{}/{}`", property.name, name_of(property.target), property.path));
  return text;
}

}  // namespace cohort::tool
