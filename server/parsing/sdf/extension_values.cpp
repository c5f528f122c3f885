// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/extension_values.hpp"

#include <algorithm>
#include <set>

#include "server/core/text.hpp"

namespace cohort::parsing {
namespace {

const ExtensionKey* find_key(const Extension& extension, const Element* element) {
  if (!has_prefix(element->name())) return nullptr;
  for (const ExtensionKey& key : extension.keys)
    if (key.name == without_prefix(element->name())) return &key;
  return nullptr;
}

std::string value_text(const Element* element) { return std::string(trimmed(element->text())); }

// Returns the names that an element in this parent can have, with their prefix.
std::vector<std::string> names_in(std::string_view parent) {
  std::vector<std::string> names;
  for (const Extension& extension : extensions())
    if (extension.parent == parent) names.push_back(prefixed(extension.name));
  return names;
}

bool is_extension(std::string_view name) {
  const std::span<const Extension> all = extensions();
  return std::any_of(all.begin(), all.end(), [&](const Extension& extension) { return extension.name == name; });
}

void report_misplaced(const Element* element, std::string_view parent, const SdfReport& report) {
  for (const Extension& extension : extensions())
    if (has_prefix(element->name()) && extension.name == without_prefix(element->name())) {
      const std::string home =
          is_extension(extension.parent) ? prefixed(extension.parent) : std::string(extension.parent);
      report.problem(element, "<" + element->name() + "> must be in <" + home + ">");
      return;
    }
  report.problem(element, "unknown element" + suggestion(element->name(), names_in(parent)));
}

void report_extensions_below(const Element* element, const SdfReport& report) {
  for (const Element* const child : element->children()) {
    if (has_prefix(child->name())) {
      if (find_extension(without_prefix(child->name()), element->name()) == nullptr)
        report_misplaced(child, element->name(), report);
    } else if (child->name() != "plugin") {
      report_extensions_below(child, report);
    }
  }
}

}  // namespace

std::optional<ExtensionValues> ExtensionValues::read(const Element* element, const Extension& extension,
                                                     const SdfReport& report) {
  ExtensionValues values;
  values.element_ = element;
  const bool name_is_right = values.read_name(extension, report);
  const ExtensionKey itself{extension.name, extension.value, "", "", extension.doc};
  const bool content_is_right = extension.value == ExtensionValue::group ? values.read_children(extension, report)
                                                                         : values.read_value(element, itself, report);
  if (!name_is_right || !content_is_right) return std::nullopt;
  return values;
}

std::optional<ExtensionValues> ExtensionValues::from_foreign(const Element* element, const std::string& name,
                                                             const Extension& extension,
                                                             const std::vector<ForeignValue>& values,
                                                             const SdfReport& report) {
  ExtensionValues read;
  read.element_ = element;
  read.name_ = name;
  read.foreign_ = values;
  bool valid = true;
  for (const ExtensionKey& key : extension.keys) {
    for (const ForeignValue& each : values) {
      if (each.key != key.name) continue;
      if (std::optional<Value> value = parse_value(each.text, key)) {
        read.add(key.name, *std::move(value));
      } else {
        report.problem(each.where, why_wrong(each.text, key));
        valid = false;
      }
    }
    if (read.has(key.name) || key.fallback == no_value) continue;
    if (key.required())
      valid = false;
    else
      read.add(key.name, *parse_value(key.fallback, key));
  }
  return valid ? std::optional(std::move(read)) : std::nullopt;
}

void ExtensionValues::put_in_scope(const std::string& prefix, const Extension& extension) {
  if (prefix.empty()) return;
  name_ = prefix + name_;
  for (const ExtensionKey& key : extension.keys)
    if (key.value == ExtensionValue::name) prefix_texts(key.name, prefix);
}

const Element* ExtensionValues::where(std::string_view key, std::size_t place) const {
  for (const ForeignValue& value : foreign_)
    if (value.key == key && place-- == 0) return value.where;
  if (!foreign_.empty()) return element_;
  const Element* child = element_->child(prefixed(key));
  while (child != nullptr && place-- > 0) child = child->next_alike();
  return child ? child : element_;
}

bool ExtensionValues::read_name(const Extension& extension, const SdfReport& report) {
  bool valid = true;
  for (const auto& [key, text] : element_->node().attributes) {
    if (key.find(':') != std::string::npos || (extension.has_name && key == "name")) continue;
    report.problem(element_, "unknown attribute '" + key + "'");
    valid = false;
  }
  if (!extension.has_name) return valid;
  if (element_->has_attribute("name")) name_ = trimmed(element_->attribute("name"));
  // A slash separates the parts of the names of channels and instances.
  if (name_.empty() || name_.find('/') != std::string::npos) {
    report.problem(element_, "expected an attribute name=\"NAME\", with a NAME without '/'");
    valid = false;
  }
  return valid;
}

bool ExtensionValues::read_children(const Extension& extension, const SdfReport& report) {
  bool valid = true;
  std::vector<std::string> known;
  for (const ExtensionKey& each : extension.keys) known.push_back(prefixed(each.name));
  std::set<std::string> misspelt;
  for (const Element* const child : element_->children()) {
    const ExtensionKey* const key = find_key(extension, child);
    if (key == nullptr) {
      report.problem(child, "unknown element" + suggestion(child->name(), known));
      if (const auto meant = nearest(child->name(), known)) misspelt.insert(*meant);
      valid = false;
    } else if (!key->repeats && child != element_->child(child->name())) {
      report.problem(child, "<" + child->name() + "> is given twice");
      valid = false;
    } else if (key->value != ExtensionValue::group) {
      valid = read_value(child, *key, report) && valid;
    }
  }
  for (const ExtensionKey& key : extension.keys) {
    if (element_->child(prefixed(key.name)) != nullptr) continue;
    if (misspelt.contains(prefixed(key.name))) continue;  // one mistake, one message
    if (key.required()) {
      report.problem(element_, "missing: " + std::string(key.doc), prefixed(key.name));
      valid = false;
    } else if (key.fallback != no_value) {
      add(key.name, *parse_value(key.fallback, key));
    }
  }
  return valid;
}

bool ExtensionValues::read_value(const Element* element, const ExtensionKey& key, const SdfReport& report) {
  if (!element->children().empty()) {
    const Element* const stray = element->children().front();
    report.problem(stray, "unexpected element; <" + element->name() + "> must contain " + expected(key));
    return false;
  }
  const std::string text = value_text(element);
  std::optional<Value> value = parse_value(text, key);
  if (!value) {
    report.problem(element, why_wrong(text, key));
    return false;
  }
  add(key.name, *std::move(value));
  return true;
}

std::vector<std::pair<const Element*, const Extension*>> extensions_in(const Element* element,
                                                                       const SdfReport& report) {
  std::vector<std::pair<const Element*, const Extension*>> found;
  for (const Element* const child : element->children()) {
    if (!has_prefix(child->name())) {
      if (child->name() != "model") report_extensions_below(child, report);
    } else if (const Extension* const extension = find_extension(without_prefix(child->name()), element->name())) {
      found.emplace_back(child, extension);
    } else {
      report_misplaced(child, element->name(), report);
    }
  }
  return found;
}

}  // namespace cohort::parsing
