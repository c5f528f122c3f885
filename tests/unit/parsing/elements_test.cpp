// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "server/core/text.hpp"
#include "server/parsing/files/input_file.hpp"
#include "server/parsing/sdf/schema/sdf_rules.hpp"
#include "server/parsing/sdf/schema/value_text.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"
#include "server/parsing/writing/write_world.hpp"
#include "tests/support/worlds/element_documents.hpp"
#include "tests/support/worlds/written_worlds.hpp"

// Compares the effect of each element and attribute of SDF with the mark that it has in the rules. Each test takes one
// shared definition, and reads a small document with and without each of its parts.
namespace cohort::description::elements {
namespace {

using parsing::Effect;
using parsing::ElementRule;
using parsing::ValueRule;
using parsing::ValueType;
using parsing::XmlNode;

std::string other_number(double number, const ValueRule& rule) {
  const bool is_whole = rule.type == ValueType::integer || rule.type == ValueType::count;
  double other = number == 0.0 ? 0.25 : number / 2.0;
  if (is_whole) other = number < 2.0 ? number + 1.0 : std::floor(number / 2.0);
  return shortest_text(std::clamp(other, rule.least, rule.greatest));
}

std::string other_value(const ValueRule& rule, const std::string& value, const std::string& path) {
  if (const auto known = values().find(path); known != values().end()) return known->second;
  switch (rule.type) {
    case ValueType::none: return "";
    case ValueType::text: return "other";
    case ValueType::flag: return parsing::is_true(value) ? "false" : "true";
    default: break;
  }
  std::string other;
  for (const std::string_view word : words(value))
    other += (other.empty() ? "" : " ") + other_number(parse_real(word).value(), rule);
  return other;
}

/// Something below a shared definition.
struct Part {
  std::string path;
  Effect effect = Effect::full;
  const ValueRule* value = nullptr;      ///< for an attribute, or an element with a full effect
  const ElementRule* element = nullptr;  ///< written with all of its content
};

void add_parts(const ElementRule& rule, const std::string& path, std::vector<Part>& parts) {
  for (const auto& attribute : rule.attributes)
    parts.push_back({path + "/@" + attribute.name, attribute.effect, &attribute.value});
  for (const auto& child : rule.children) {
    const ElementRule& of_child = *child.element;
    const std::string child_path = path + "/" + of_child.name;
    if (child.effect != Effect::full || (of_child.is_shared && of_child.name == "noise"))
      parts.push_back({child_path, child.effect, &of_child.value, &of_child});
    else if (!of_child.is_shared && of_child.value.type != ValueType::none)
      parts.push_back({child_path, child.effect, &of_child.value});
    if (child.effect == Effect::full && !of_child.is_shared) add_parts(of_child, child_path, parts);
  }
}

using Definitions = std::map<std::string, const ElementRule*>;

void add_definitions(const ElementRule& rule, Definitions& all) {
  if (rule.is_shared && !all.emplace(rule.name, &rule).second) return;
  for (const auto& child : rule.children)
    if (child.effect == Effect::full) add_definitions(*child.element, all);
}

const Definitions& definitions() {
  static const Definitions all = [] {
    Definitions found;
    add_definitions(parsing::sdf_rule(), found);
    return found;
  }();
  return all;
}

std::vector<std::string> names_of_definitions() {
  std::vector<std::string> names;
  for (const auto& [name, rule] : definitions()) names.push_back(name);
  return names;
}

// Returns an element with other values for everything in it.
XmlNode full_element(const ElementRule& rule, const std::string& path) {
  XmlNode node = {rule.name, 0, nullptr, {}, other_value(rule.value, rule.value.standard, path), {}};
  for (const auto& attribute : rule.attributes)
    node.attributes.emplace_back(attribute.name,
                                 other_value(attribute.value, attribute.value.standard, path + "/@" + attribute.name));
  for (const auto& child : rule.children)
    if (!child.element->is_shared || child.presence == parsing::Presence::once)
      node.children.push_back(full_element(*child.element, path + "/" + child.element->name));
  return node;
}

XmlNode* first_of(XmlNode& node, const std::string& name) {
  if (node.name == name) return &node;
  for (XmlNode& child : node.children)
    if (XmlNode* const found = first_of(child, name)) return found;
  return nullptr;
}

std::string base_of(std::string path) {
  while (!bases().contains(path) && !path.empty())
    path.resize(path.rfind('/') == std::string::npos ? 0 : path.rfind('/'));
  return path.empty() ? "" : bases().at(path);
}

XmlNode document(const std::string& content) {
  return parsing::outline_xml("<sdf version=\"1.12\" xmlns:cohort=\"https://cohort-sim.org/sdf/1\"><world name=\"w\">" +
                              content + "</world></sdf>")
      .root;
}

XmlNode& add_first(XmlNode& parent, const std::string& name) {
  XmlNode child;
  child.name = name;
  return *parent.children.insert(parent.children.begin(), std::move(child));
}

// Returns the parent of a part, which is made together with its own parents if necessary.
XmlNode& parent_of(const std::string& path, XmlNode& root) {
  std::size_t start = path.find('/');
  XmlNode* node = first_of(root, path.substr(0, start));
  for (std::size_t end = path.find('/', start + 1); end != std::string::npos; end = path.find('/', start + 1)) {
    const std::string name = path.substr(start + 1, end - start - 1);
    start = end;
    if (node->child(name) == nullptr) add_first(*node, name);
    node = parsing::child_of(*node, name);
  }
  return *node;
}

// Writes another value of the part. An attribute or element that is not written yet becomes the first.
void change(const Part& part, XmlNode& root) {
  XmlNode& parent = parent_of(part.path, root);
  const std::string name = part.path.substr(part.path.rfind('/') + 1);
  if (name.front() == '@') {
    const std::string* const old = parent.attribute(name.substr(1));
    parsing::set_attribute(parent, name.substr(1),
                           other_value(*part.value, old != nullptr ? *old : part.value->standard, part.path));
  } else if (part.element != nullptr) {
    parent.children.insert(parent.children.begin(),
                           full_element(*part.element, part.element->is_shared ? name : part.path));
    if (parent.name == "sensor" && part.effect == Effect::told) parsing::set_attribute(parent, "type", name);
  } else {
    XmlNode* child = parsing::child_of(parent, name);
    const std::string old = child != nullptr ? child->text : part.value->standard;
    if (child == nullptr) child = &add_first(parent, name);
    child->text = other_value(*part.value, old, part.path);
  }
}

/// The visible result of reading a document.
struct Outcome {
  bool is_refused = false;
  std::string world;              ///< as exported and shown
  std::vector<Problem> messages;  ///< warnings, or the errors
};

// Returns a model with visuals as collisions, which are exported; adds their appearance to `text`.
Model with_visuals(Model model, std::string& text) {
  for (Link& link : model.links)
    for (const Visual& visual : link.visuals) {
      link.collisions.push_back({"visual", visual.X_LV, visual.shape, {}});
      for (const double channel : visual.color) text += shortest_text(channel) + " ";
      if (visual.texture != nullptr) text += visual.texture->bytes;
    }
  return model;
}

Outcome read_document(const XmlNode& root) {
  static const DocumentFolder folder;
  const std::filesystem::path file = folder / "world.sdf";
  parsing::InputFiles input;
  input.trust(file);
  input.add(file, parsing::xml_text(root));
  Outcome outcome;
  try {
    const World world = parsing::read_world(input, file, 1);
    World shown = world;
    shown.models = {};
    for (const Model& each : world.models) shown.models.push_back(with_visuals(each, outcome.world));
    outcome.world += parsing::xml_text(parsing::sdf_of(shown, folder.path()));
    outcome.messages = world.warnings;
  } catch (const InputError& error) {
    outcome.is_refused = true;
    outcome.messages = error.problems();
  }
  return outcome;
}

std::string messages_only(const std::vector<Problem>& problems) {
  std::string texts;
  for (const Problem& problem : problems) texts += problem.message + "\n";
  return texts;
}

void check(const Part& part) {
  ASSERT_NE(base_of(part.path), "") << "no document for " << part.path;
  XmlNode root = document(base_of(part.path));
  parent_of(part.path, root);
  const Outcome without = read_document(root);
  ASSERT_FALSE(without.is_refused) << texts_of(without.messages) << parsing::xml_text(root);
  change(part, root);
  const Outcome with = read_document(root);
  const std::string told = messages_only(with.messages);
  SCOPED_TRACE(part.path + "\n" + told + parsing::xml_text(root));
  if (part.effect == Effect::told) {
    EXPECT_TRUE(with.is_refused || with.messages.size() > without.messages.size());
    return;
  }
  ASSERT_FALSE(with.is_refused);
  const std::string name = part.path.substr(part.path.rfind('/') + 1);
  const std::string shown = name.front() == '@' ? "'" + name.substr(1) + "' of <" : "<" + name + ">";
  EXPECT_EQ(with.world != without.world, part.effect == Effect::full);
  const bool is_passed_over = part.effect == Effect::full || part.effect == Effect::appearance;
  if (is_passed_over) {
    EXPECT_EQ(told, messages_only(without.messages));
    return;
  }
  EXPECT_EQ(with.messages.size(), without.messages.size() + 1);
  EXPECT_NE(told.find(shown), std::string::npos);
  EXPECT_NE(told.find(part.effect == Effect::none ? "no effect in Cohort: " : "is not supported and is ignored"),
            std::string::npos);
}

class Elements : public ::testing::TestWithParam<std::string> {};

TEST_P(Elements, HaveTheEffectsThatTheRulesName) {
  std::vector<Part> parts;
  add_parts(*definitions().at(GetParam()), GetParam(), parts);
  for (const Part& part : parts)
    if (!exceptions().contains(part.path)) check(part);
}

TEST(ElementTables, NameElementsThatExist) {
  std::vector<Part> parts;
  for (const auto& [name, rule] : definitions()) add_parts(*rule, name, parts);
  for (const Texts* const table : {&values(), &exceptions()})
    for (const auto& [path, text] : *table)
      EXPECT_TRUE(std::ranges::find(parts, path, &Part::path) != parts.end()) << path;
}

INSTANTIATE_TEST_SUITE_P(Of, Elements, ::testing::ValuesIn(names_of_definitions()),
                         [](const auto& each) { return each.param; });

}  // namespace
}  // namespace cohort::description::elements
