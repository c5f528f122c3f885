// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/schema/sdf_schema.hpp"

#include <algorithm>

#include "server/parsing/sdf/schema/value_text.hpp"

namespace cohort::parsing {
namespace {

const ExtensionKey* find_key(const Extension& extension, std::string_view name) {
  for (const ExtensionKey& key : extension.keys)
    if (key.name == name) return &key;
  return nullptr;
}

}  // namespace

ElementSchema ElementSchema::root() {
  ElementSchema schema;
  schema.name_ = "sdf";
  schema.rule_ = &sdf_rule();
  return schema;
}

ElementSchema ElementSchema::child(const std::string& name) const {
  ElementSchema schema;
  schema.name_ = name;
  if (is_extension() || has_prefix(name)) {
    schema.name_ = without_prefix(name);
    schema.extension_ = find_extension(schema.name_, name_);
    if (extension_ != nullptr) schema.key_ = find_key(*extension_, schema.name_);
    schema.unknown_extension_ = schema.extension_ == nullptr && schema.key_ == nullptr;
  } else if (rule_ != nullptr && !rule_->takes_anything) {
    if (const ChildRule* const child = rule_->child_rule(name)) {
      schema.rule_ = child->element;
      schema.presence_ = child->presence;
    }
  }
  return schema;
}

bool ElementSchema::takes_anything() const { return is_free() || (rule_ != nullptr && rule_->takes_anything); }

bool ElementSchema::has_child(const std::string& name) const {
  const std::vector<std::string> known = children();
  return std::find(known.begin(), known.end(), is_extension() ? prefixed(name) : name) != known.end();
}

bool ElementSchema::has_attribute(const std::string& name) const {
  const std::vector<std::string> known = attributes();
  return std::find(known.begin(), known.end(), name) != known.end();
}

bool ElementSchema::knows_child(const std::string& name) const {
  return rule_ == nullptr || rule_->takes_anything || rule_->child(name) != nullptr;
}

bool ElementSchema::knows_attribute(const std::string& name) const {
  return rule_ == nullptr || rule_->attribute(name) != nullptr;
}

bool ElementSchema::is_single() const {
  return rule_ != nullptr && (presence_ == Presence::at_most_once || presence_ == Presence::once);
}

bool ElementSchema::has_value() const {
  if (rule_ != nullptr) return rule_->value.type != ValueType::none;
  if (key_ != nullptr) return key_->value != ExtensionValue::group;
  return extension_ != nullptr && extension_->value != ExtensionValue::group;
}

bool ElementSchema::can_have(const std::string& text) const { return rule_ == nullptr || allows(rule_->value, text); }

bool ElementSchema::is_vector() const {
  if (rule_ != nullptr) {
    constexpr ValueType types[] = {ValueType::vector2, ValueType::vector3, ValueType::color, ValueType::pose};
    return std::ranges::find(types, rule_->value.type) != std::end(types);
  }
  constexpr ExtensionValue vectors[] = {ExtensionValue::point, ExtensionValue::vector, ExtensionValue::place,
                                        ExtensionValue::pose};
  return key_ != nullptr && std::ranges::find(vectors, key_->value) != std::end(vectors);
}

std::vector<std::string> ElementSchema::children() const {
  std::vector<std::string> names;
  if (rule_ != nullptr)
    for (const ChildRule& child : rule_->children) names.push_back(child.element->name);
  if (extension_ != nullptr)
    for (const ExtensionKey& key : extension_->keys) names.push_back(prefixed(key.name));
  for (const Extension& extension : extensions())
    if (extension.parent == name_) names.push_back(prefixed(extension.name));
  return names;
}

std::vector<std::string> ElementSchema::attributes() const {
  std::vector<std::string> names;
  if (rule_ != nullptr)
    for (const AttributeRule& attribute : rule_->attributes) names.push_back(attribute.name);
  if (extension_ != nullptr && extension_->has_name) names.emplace_back("name");
  return names;
}

}  // namespace cohort::parsing
