// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/read_source.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>

#include "server/core/text.hpp"
#include "server/parsing/files/sdf_version.hpp"
#include "server/parsing/files/xacro.hpp"
#include "server/parsing/sdf/file_kind.hpp"
#include "server/parsing/sdf/repair/mend_sdf.hpp"
#include "server/parsing/sdf/repair/newer_sdf.hpp"
#include "server/parsing/sdf/repair/older_sdf.hpp"
#include "server/parsing/sdf/repair/oldest_sdf.hpp"
#include "server/parsing/sdf/repair/pass_over_unknown.hpp"
#include "server/parsing/sdf/repair/scoped_names.hpp"
#include "server/parsing/sdf/repair/what_is_seen.hpp"
#include "server/parsing/sdf/schema/missing_effects.hpp"
#include "server/parsing/sdf/schema/yaml_sdf.hpp"
#include "server/parsing/sdf/set_in_sdf.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"
#include "server/parsing/sdf/urdf/urdf_file.hpp"

namespace cohort::parsing {
namespace {

void set_file(XmlNode& node, const SourceFile* file) {
  node.file = file;
  for (XmlNode& child : node.children) set_file(child, file);
}

// SDF requires the <uri> of an image in every <heightmap>, even if it is defined by a function.
void name_terrains(XmlNode& node) {
  for (XmlNode& child : node.children) name_terrains(child);
  if (node.name == "heightmap" && node.child("cohort:terrain") != nullptr && node.child("uri") == nullptr)
    node.children.push_back({"uri", node.line, node.file, {}, "cohort:terrain", {}});
}

bool is_ours(const XmlNode& root) { return root.attribute("xmlns:" + std::string(extension_prefix)) != nullptr; }

}  // namespace

bool SourceReader::read(SdfFile& file, bool is_included) {
  const std::string* const text = read_text(file);
  if (text == nullptr) return false;
  std::optional<XmlNode> source = is_yaml(file.path) ? read_yaml(*text, file) : read_xml(*text, file);
  if (!source) return false;
  set_file(*source, &file);
  file.tree = *std::move(source);
  if (!convert(file)) return false;
  for (const std::string& setting : input_.settings_of(file.path))
    set_in_sdf(file.tree, parse_setting(setting), problems_);
  tell_of_missing_effects(file.tree, warnings_);
  if (file.is_foreign) make_readable(file, is_included);
  warn_of_repeated(file.tree, ElementSchema::root(), "");
  name_terrains(file.tree);
  return true;
}

bool SourceReader::convert(SdfFile& file) {
  file.version = *file.tree.attribute("version");
  const bool may_be_scoped = version_of(file.version) < std::pair{1, 8};
  if (may_be_scoped || file.is_foreign) join_scoped_names(file.tree, file.shown, may_be_scoped ? nullptr : &warnings_);
  if (!names_are_simple(file.tree, "")) return false;
  if (file.version != converted_version) convert_older(file.tree);
  return true;
}

void SourceReader::make_readable(SdfFile& file, bool is_included) {
  pass_over_unknown(file.tree, warnings_);
  keep_what_is_shown(file.tree);
  const auto is_of_world = [](const XmlNode& child) {
    return child.name == "include" || child.name == "light" || child.name == "actor";
  };
  // A file that others include for its light has nothing to collide with.
  if (std::ranges::none_of(file.tree.children, is_of_world) || file.tree.child("world") != nullptr ||
      file.tree.child("model") != nullptr || is_included)
    return;
  // In a file with nothing else, they belong to a world.
  XmlNode world = element_at(file.tree, "world");
  set_attribute(world, "name", file.shown.stem().string());
  std::ranges::copy_if(file.tree.children, std::back_inserter(world.children), is_of_world);
  std::erase_if(file.tree.children, is_of_world);
  file.tree.children.push_back(std::move(world));
}

const std::string* SourceReader::read_text(const SdfFile& file) {
  try {
    return &input_.read(file.path);
  } catch (const std::runtime_error& error) {
    problems_.push_back({file.shown, 0, "", error.what()});
    return nullptr;
  }
}

std::optional<XmlNode> SourceReader::read_xml(const std::string& text, SdfFile& file) {
  const auto fail = [&](int line, std::string message) {
    problems_.push_back({file.shown, line, "", std::move(message)});
    return std::nullopt;
  };
  XmlOutline outline = outline_xml(text);
  if (outline.error) {
    XmlOutline loose = outline_loose_xml(text);
    if (!loose.error && !is_ours(loose.root)) outline = std::move(loose);
  }
  if (outline.error) return fail(outline.error->line, outline.error->message);
  const XmlNode& root = outline.root;
  if (input_.is_disk() && !input_.is_expanded(file.path))
    if (const XmlNode* const macro = find_macro(root, file.path)) return fail(macro->line, why_not_expanded(file.path));
  file.is_foreign = root.name == "robot" || !is_ours(root);
  if (root.name == "robot") {
    auto sdf = sdf_of_urdf(std::move(outline.root), file.shown, problems_, warnings_);
    if (sdf) mend_sdf(*sdf, file.shown, warnings_);
    return sdf;
  }

  if (root.name == "gazebo" && file.is_foreign) outline.root.name = "sdf";  // its name up to SDF 1.2
  const std::string* const version = root.attribute("version");
  if (root.name != "sdf" || version == nullptr)
    return fail(root.line, "expected <sdf version=\"" + std::string(converted_version) +
                               "\"> as the root element, not <" + root.name + ">");
  if (version_of(*version) > newest_version || version_of(*version) == std::pair{0, 0})
    return fail(root.line, "SDF version '" + *version + "' is not supported; expected a version up to 1.12");
  if (version_of(*version) < version_of(first_with_elements) && make_attributes_elements(outline.root))
    set_attribute(outline.root, "version", std::string(first_with_elements));
  take_newer(outline.root, file.shown, problems_, warnings_);
  if (version_of(*version) > version_of(converted_version))
    set_attribute(outline.root, "version", std::string(converted_version));
  if (file.is_foreign) mend_sdf(outline.root, file.shown, warnings_);
  return std::move(outline.root);
}

std::optional<XmlNode> SourceReader::read_yaml(const std::string& text, const SdfFile& file) {
  const YamlDocument document = parse_yaml(text);
  if (document.error) {
    problems_.push_back({file.shown, document.error->line, "", document.error->message});
    return std::nullopt;
  }
  XmlNode sdf = sdf_of_yaml(*document.root, file.shown, problems_);
  take_newer(sdf, file.shown, problems_, warnings_);
  return sdf;
}

bool SourceReader::names_are_simple(const XmlNode& node, const std::string& path) {
  bool are_simple = true;
  for (const XmlNode& child : node.children) {
    if (child.name == "plugin" || child.name.find(':') != std::string::npos) continue;
    const std::string child_path = path_below(path, child);
    if (const std::string* const name = child.attribute("name");
        name != nullptr && name->find("::") != std::string::npos) {
      problems_.push_back(
          {child.file->shown, child.line, child_path,
           "a name cannot contain '::', which separates the name of a model from the names of its parts"});
      are_simple = false;
    }
    are_simple = names_are_simple(child, child_path) && are_simple;
  }
  return are_simple;
}

void SourceReader::warn_of_repeated(const XmlNode& node, const ElementSchema& schema, const std::string& path) {
  for (const XmlNode& child : node.children) {
    const ElementSchema of_child = schema.child(child.name);
    if (of_child.is_free() || of_child.is_extension()) continue;
    const std::string child_path = path_below(path, child);
    if (of_child.is_single() && node.child(child.name) != &child)
      warnings_.push_back({child.file->shown, child.line, child_path, "is given twice; only the first is used"});
    warn_of_repeated(child, of_child, child_path);
  }
}

}  // namespace cohort::parsing
