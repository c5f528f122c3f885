// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/set_in_sdf.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "server/core/text.hpp"
#include "server/parsing/sdf/schema/sdf_schema.hpp"
#include "server/parsing/sdf/schema/yaml_sdf.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"

namespace cohort::parsing {
namespace {

// Returns the element or attribute that a step of a path means; the step itself if there is none. An element that
// `node` has comes first: both SDF and Cohort have a <population>.
std::string known_name(const ElementSchema& schema, const std::string& step, const XmlNode* node = nullptr) {
  std::string with_prefix = prefixed(step);
  if (node != nullptr && node->child(step) == nullptr && node->child(with_prefix) != nullptr) return with_prefix;
  if (schema.has_attribute(step) || schema.has_child(step)) return step;
  return schema.has_child(with_prefix) ? with_prefix : step;
}

// Returns the names of the attributes and elements of an element, without the prefix of Cohort.
std::vector<std::string> keys_of(const ElementSchema& schema) {
  std::vector<std::string> keys = schema.attributes();
  for (const std::string& child : schema.children())
    keys.push_back(has_prefix(child) ? child.substr(prefixed("").size()) : child);
  return keys;
}

class SdfSetter {
 public:
  SdfSetter(const Setting& setting, std::vector<Problem>& problems) : setting_(setting), problems_(problems) {}

  void set(XmlNode& sdf) {
    XmlNode changed = sdf;
    if (set_below(changed, ElementSchema::root(), 0)) sdf = std::move(changed);
  }

 private:
  bool fail(const XmlNode& where, const std::string& message) const {
    problems_.push_back({where.file->shown, where.line, setting_.path_text(), message});
    return false;
  }

  // Finds the element of each step. `written`: the steps with the prefix of Cohort, without names of elements.
  bool set_below(XmlNode& node, const ElementSchema& schema, std::size_t done) {
    const std::string name = known_name(schema, setting_.path[done], &node);
    written_.push_back(name);
    const bool is_last = done + 1 == setting_.path.size();
    if (schema.has_attribute(name)) {
      if (!is_last) return fail(node, "cannot be set, since '" + name + "' is an attribute");
      return take_value(node, schema, name);
    }
    const std::vector<std::size_t> those = children_called(node, name);
    if (is_last || those.empty()) return replace(node, schema.child(name), those, done);

    const ElementSchema of_child = schema.child(name);
    std::vector<std::string> names;
    for (const std::size_t i : those) {
      const std::string its = name_of(node.children[i]);
      if (its == setting_.path[done + 1]) return set_named(node, node.children[i], of_child, done);
      if (!its.empty()) names.push_back(its);
    }
    if (those.size() == 1 && known_below(of_child, setting_.path[done + 1]))
      return set_below(node.children[those.front()], of_child, done + 1);
    const std::string& step = setting_.path[done + 1];
    const std::vector<std::string> keys = keys_of(of_child);
    if (name == "world" || nearest(step, keys))
      return fail(node, "cannot be set, since <" + name + "> has no '" + step + "'" + suggestion(step, keys));
    return fail(node, "cannot be set, since there is no <" + name + "> named '" + step + "'" + suggestion(step, names));
  }

  bool set_named(XmlNode& parent, XmlNode& node, const ElementSchema& schema, std::size_t done) {
    if (done + 2 < setting_.path.size()) return set_below(node, schema, done + 2);
    return fail(parent, "cannot be set as a whole, since it has a name; expected the path of a part of it");
  }

  static bool known_below(const ElementSchema& schema, const std::string& step) {
    const std::string name = known_name(schema, step);
    return schema.takes_anything() || schema.has_attribute(name) || schema.has_child(name) || schema.is_extension();
  }

  static std::vector<std::size_t> children_called(const XmlNode& node, const std::string& name) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < node.children.size(); ++i)
      if (node.children[i].name == name) found.push_back(i);
    return found;
  }

  // Makes elements from the rest of the path and the value, as from a world in YAML. `schema`: that of the last step
  // so far.
  std::optional<XmlNode> made(const XmlNode& where, ElementSchema schema, std::size_t done) {
    std::vector<std::string> path = written_;
    for (std::size_t i = done + 1; i < setting_.path.size(); ++i) {
      path.push_back(known_name(schema, setting_.path[i]));
      schema = schema.child(path.back());
    }
    const std::size_t before = problems_.size();
    XmlNode top = sdf_of_yaml(*document_of(path, setting_.value, where.line), where.file->shown, problems_);
    if (problems_.size() > before) return std::nullopt;
    for (std::size_t i = 0; i + 1 < written_.size(); ++i) top = XmlNode(top.children.back());
    set_position(top, where);
    return top;
  }

  static void set_position(XmlNode& node, const XmlNode& where) {
    node.file = where.file;
    node.line = where.line;
    for (XmlNode& child : node.children) set_position(child, where);
  }

  // Puts the elements of the value in the place of those of the same name.
  bool replace(XmlNode& node, const ElementSchema& schema, const std::vector<std::size_t>& old, std::size_t done) {
    std::optional<XmlNode> parent = made(node, schema, done);
    if (!parent) return false;
    const std::string name = written_.back();
    const std::size_t place = old.empty() ? node.children.size() : old.front();
    std::erase_if(node.children, [&](const XmlNode& child) { return child.name == name; });
    node.children.insert(node.children.begin() + static_cast<std::ptrdiff_t>(place), parent->children.begin(),
                         parent->children.end());
    return true;
  }

  bool take_value(XmlNode& node, const ElementSchema& schema, const std::string& attribute) {
    const std::optional<XmlNode> parent = made(node, schema, setting_.path.size() - 1);
    if (!parent) return false;
    set_attribute(node, attribute, value_of(*parent, attribute));
    return true;
  }

  const Setting& setting_;
  std::vector<Problem>& problems_;
  std::vector<std::string> written_;
};

}  // namespace

void set_in_sdf(XmlNode& sdf, const Setting& setting, std::vector<Problem>& problems) {
  SdfSetter(setting, problems).set(sdf);
}

}  // namespace cohort::parsing
