#include "server/parsing/sdf/schema/build_elements.hpp"

#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include "server/core/text.hpp"
#include "server/parsing/files/sdf_version.hpp"
#include "server/parsing/sdf/schema/sdf_angles.hpp"
#include "server/parsing/sdf/schema/sdf_schema.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"

namespace cohort::parsing {
namespace {

constexpr int most_levels = 100;  // including nested models

bool refers_to_frame(const std::string& element, const std::string& attribute) {
  static const std::set<std::pair<std::string, std::string>> known = {{"frame", "attached_to"},
                                                                      {"pose", "relative_to"},
                                                                      {"model", "placement_frame"},
                                                                      {"model", "canonical_link"},
                                                                      {"custom_rpy", "parent_frame"}};
  return known.contains({element, attribute});
}

// Replaces white space in a text by single spaces, like libsdformat.
std::string with_single_spaces(const std::string& text) {
  std::string joined;
  for (const std::string_view word : words(text)) (joined += joined.empty() ? "" : " ") += word;
  return joined;
}

void add_text_attribute(const sdf::ElementPtr& element, const std::string& name, const std::string& value) {
  element->AddAttribute(name, "string", "", true, "");
  element->GetAttribute(name)->SetFromString(value);
}

std::string xpath_of(const sdf::ElementPtr& parent, const XmlNode& child) {
  const std::string* const name = child.attribute("name");
  return parent->XmlPath() + "/" + child.name + (name != nullptr ? "[@name=\"" + *name + "\"]" : "");
}

class TreeReader {
 public:
  TreeReader(ElementBuilder& builder, std::vector<const XmlNode*>& nodes, sdf::Errors& errors)
      : builder_(builder), nodes_(nodes), errors_(errors) {}

  /// Reads a node into an empty element of this definition.
  bool read(const XmlNode& node, const sdf::ElementPtr& element, const sdf::ElementPtr& definition);
  int line_of(const XmlNode& node) {
    nodes_.push_back(&node);
    return static_cast<int>(nodes_.size()) - 1;
  }
  bool fail(sdf::ErrorCode code, const std::string& message, int line, const std::string& xpath) {
    errors_.emplace_back(code, message);
    errors_.back().SetLineNumber(line);
    if (!xpath.empty()) errors_.back().SetXmlPath(xpath);
    return false;
  }

 private:
  bool read_attributes(const XmlNode& node, const sdf::ElementPtr& element);
  bool read_attribute(const XmlNode& node, const std::string& name, const std::string& value,
                      const sdf::ElementPtr& element);
  bool read_child(const XmlNode& child, const sdf::ElementPtr& parent, const sdf::ElementPtr& of_child,
                  const sdf::ElementPtr& of_parent);
  void copy_unknown(const XmlNode& node, const sdf::ElementPtr& parent);
  bool add_required(const sdf::ElementPtr& element);

  ElementBuilder& builder_;
  std::vector<const XmlNode*>& nodes_;
  sdf::Errors& errors_;
  int level_ = 0;
};

bool TreeReader::read_attribute(const XmlNode& node, const std::string& name, const std::string& value,
                                const sdf::ElementPtr& element) {
  if (name.find(':') != std::string::npos) {
    add_text_attribute(element, name, value);
    return true;
  }
  const int line = *element->LineNumber();
  const std::string xpath = element->XmlPath() + "[@" + name + "=\"" + value + "\"]";
  const sdf::ParamPtr attribute = element->GetAttribute(name);
  if (!attribute) {
    fail(sdf::ErrorCode::ATTRIBUTE_INCORRECT_TYPE,
         "XML Attribute[" + name + "] in element[" + node.name + "] not defined in SDF.\n", line, xpath);
    return true;
  }
  if (value == "__root__" && refers_to_frame(element->GetName(), name))
    fail(sdf::ErrorCode::ATTRIBUTE_INVALID,
         "'" + value + "' is reserved; it cannot be used as a value of attribute [" + name + "]", line, xpath);
  return attribute->SetFromString(value) ||
         fail(sdf::ErrorCode::ATTRIBUTE_INVALID, "Unable to read attribute[" + name + "]", line, xpath);
}

bool TreeReader::read_attributes(const XmlNode& node, const sdf::ElementPtr& element) {
  for (const auto& [name, value] : node.attributes)
    if (!read_attribute(node, name, value, element)) return false;
  for (const sdf::ParamPtr& attribute : element->GetAttributes())
    if (attribute->GetRequired() && !attribute->GetSet())
      return fail(
          sdf::ErrorCode::ATTRIBUTE_MISSING,
          "Required attribute[" + attribute->GetKey() + "] in element[" + node.name + "] is not specified in SDF.",
          *element->LineNumber(), element->XmlPath());
  return true;
}

bool read_value(const XmlNode& node, const sdf::ElementPtr& element) {
  const sdf::ParamPtr value = element->GetValue();
  if (!value) return true;
  if (!node.text.empty()) return value->SetFromString(with_single_spaces(node.text));
  return value->Reparse() && value->SetFromString("");
}

// A nested model has the definition of the outer one. libsdformat does not keep the version in which it was written.
bool TreeReader::read_child(const XmlNode& child, const sdf::ElementPtr& parent, const sdf::ElementPtr& of_child,
                            const sdf::ElementPtr& of_parent) {
  const bool is_nested = !of_child->ReferenceSDF().empty();
  const sdf::ElementPtr& definition = is_nested ? of_parent : of_child;
  const sdf::ElementPtr element = builder_.element_of(definition);
  const int line = line_of(child);
  element->SetParent(parent);
  if (is_nested) element->SetOriginalVersion("");
  element->SetLineNumber(line);
  element->SetXmlPath(xpath_of(parent, child));
  if (!read(child, element, definition))
    return fail(sdf::ErrorCode::ELEMENT_INVALID, "Error reading element <" + child.name + ">", line,
                element->XmlPath());
  parent->InsertElement(element);
  return true;
}

// Copies an element that is unknown to SDF, with values as text.
void TreeReader::copy_unknown(const XmlNode& node, const sdf::ElementPtr& parent) {
  const auto element = std::make_shared<sdf::Element>();
  element->SetParent(parent);
  element->SetName(node.name);
  element->SetLineNumber(line_of(node));
  if (!node.text.empty()) element->AddValue("string", with_single_spaces(node.text), true);
  for (const auto& [name, value] : node.attributes) add_text_attribute(element, name, value);
  for (const XmlNode& child : node.children) copy_unknown(child, element);
  parent->InsertElement(element);
}

// Only a joint has required elements without defaults.
bool TreeReader::add_required(const sdf::ElementPtr& element) {
  for (unsigned i = 0; i < element->GetElementDescriptionCount(); ++i) {
    const sdf::ElementPtr definition = element->GetElementDescription(i);
    const std::string& name = definition->GetName();
    if ((definition->GetRequired() != "1" && definition->GetRequired() != "+") || element->HasElement(name)) continue;
    if (element->GetName() == "joint" && element->Get<std::string>("type") != "ball")
      return fail(sdf::ErrorCode::ELEMENT_MISSING,
                  "XML Missing required element[" + name + "], child of element[joint]", *element->LineNumber(),
                  element->XmlPath() + "/" + name);
    element->AddElement(name)->SetExplicitlySetInFile(false);
  }
  return true;
}

bool TreeReader::read(const XmlNode& node, const sdf::ElementPtr& element, const sdf::ElementPtr& definition) {
  if (!read_attributes(node, element) || !read_value(node, element)) return false;
  if (const auto flaw = flaw_of_angles(node))
    fail(sdf::ErrorCode::ELEMENT_INCORRECT_TYPE, *flaw, *element->LineNumber(), element->XmlPath());
  if (element->GetCopyChildren()) {
    for (const XmlNode& child : node.children) copy_unknown(child, element);
    return true;
  }
  if (level_ == most_levels)
    return node.children.empty() ||
           fail(sdf::ErrorCode::ELEMENT_INVALID, "is nested more than " + std::to_string(most_levels) + " levels deep",
                *element->LineNumber(), element->XmlPath());
  ++level_;
  std::vector<const XmlNode*> unknown;
  for (const XmlNode& child : node.children) {
    if (const sdf::ElementPtr of_child = element->GetElementDescription(child.name)) {
      if (!read_child(child, element, of_child, definition)) return false;
      continue;
    }
    unknown.push_back(&child);
    if (child.name.find(':') == std::string::npos)
      fail(sdf::ErrorCode::ELEMENT_INCORRECT_TYPE,
           "XML Element[" + child.name + "], child of element[" + node.name + "], not defined in SDF.", line_of(child),
           xpath_of(element, child));
  }
  --level_;
  for (const XmlNode* const child : unknown) copy_unknown(*child, element);
  return add_required(element);
}

const XmlNode* pose_of_model(const XmlNode& tree) {
  const XmlNode* const model = tree.child("model");
  return model != nullptr ? model->child("pose") : nullptr;
}

bool has_scoped_name(const XmlNode& node) {
  if (node.name == "plugin" || node.name.find(':') != std::string::npos) return false;
  return value_of(node, "name").find("::") != std::string::npos || std::ranges::any_of(node.children, has_scoped_name);
}

// Copies attributes and value, but no definitions of children.
sdf::ElementPtr bare_copy(const sdf::ElementPtr& definition) {
  sdf::ElementPtr copy = std::make_shared<sdf::Element>();
  copy->SetName(definition->GetName());
  copy->SetRequired(definition->GetRequired());
  copy->SetCopyChildren(definition->GetCopyChildren());
  for (const sdf::ParamPtr& attribute : definition->GetAttributes())
    copy->AddAttribute(attribute->GetKey(), attribute->GetTypeName(), attribute->GetDefaultAsString(),
                       attribute->GetRequired(), attribute->GetDescription());
  if (const sdf::ParamPtr value = definition->GetValue())
    copy->AddValue(value->GetTypeName(), value->GetDefaultAsString(), value->GetRequired(),
                   value->GetMinValueAsString().value_or(""), value->GetMaxValueAsString().value_or(""),
                   value->GetDescription());
  return copy;
}

}  // namespace

sdf::ElementPtr ElementBuilder::element_of(const sdf::ElementPtr& definition) {
  sdf::ElementPtr& bare = bare_[definition];
  if (!bare) bare = bare_copy(definition);
  sdf::ElementPtr element = bare->Clone();
  for (unsigned i = 0; i < definition->GetElementDescriptionCount(); ++i)
    element->AddElementDescription(definition->GetElementDescription(i));
  return element;
}

sdf::SDFPtr ElementBuilder::build(const XmlNode& tree, const std::string& version, const std::filesystem::path& file,
                                  std::vector<const XmlNode*>& nodes, sdf::Errors& errors) {
  nodes = {nullptr};
  TreeReader reader(*this, nodes, errors);
  const sdf::SDFPtr sdf = std::make_shared<sdf::SDF>();
  const sdf::ElementPtr root = element_of(sdf_definition());
  sdf->Root(root);
  sdf->SetFilePath(file.string());
  root->SetOriginalVersion(version);
  root->SetLineNumber(reader.line_of(tree));
  root->SetXmlPath("/sdf");
  if (const XmlNode* const pose = pose_of_model(tree); pose != nullptr && !value_of(*pose, "relative_to").empty()) {
    reader.fail(sdf::ErrorCode::ATTRIBUTE_INVALID,
                "Attribute //pose[@relative_to] of top level model must be left empty, found //pose[@relative_to='" +
                    value_of(*pose, "relative_to") + "'].\n",
                reader.line_of(*pose), "");
    return nullptr;
  }
  if (!reader.read(tree, root, root)) return nullptr;
  if (version_of(version) < std::pair{1, 8} || !has_scoped_name(tree)) return sdf;
  errors.emplace_back(
      sdf::ErrorCode::RESERVED_NAME,
      "Delimiter '::' found in attribute names of element <sdf>, which is not allowed in SDFormat >= 1.8");
  return nullptr;
}

}  // namespace cohort::parsing
