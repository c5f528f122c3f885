// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

#include "server/parsing/sdf/include_rules.hpp"
#include "server/parsing/sdf/included_model.hpp"
#include "server/parsing/sdf/schema/value_text.hpp"
#include "server/parsing/sdf/sdf_files.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"
#include "server/parsing/sdf/world_joints.hpp"

namespace cohort::parsing {
namespace {

// The tree of a model is copied into each model that includes it.
constexpr std::size_t most_elements = 50'000;

// Returns the names of models and frames.
std::set<std::string> names_in(const XmlNode& world) {
  std::set<std::string> names;
  for (const XmlNode& child : world.children)
    if (child.name == "model" || child.name == "frame") names.insert(name_of(child));
  return names;
}

std::set<std::string> repeated_names_in(const XmlNode& world) {
  std::set<std::string> names;
  std::set<std::string> repeated;
  for (const XmlNode& child : world.children)
    if ((child.name == "model" || child.name == "frame") && !names.insert(name_of(child)).second)
      repeated.insert(name_of(child));
  return repeated;
}

// Moves the joints that hold a model to its element or its <include>, as elements with this name of an element. Their
// scoped names differ from all names in the model.
void move_joints(HoldingJoints& holding, const std::string& model, std::string_view name, XmlNode& element) {
  const auto [begin, end] = holding.equal_range(model);
  for (auto joint = begin; joint != end; ++joint) {
    element.children.push_back(std::move(joint->second));
    element.children.back().name = name;
    set_attribute(element.children.back(), "name", "world::" + name_of(element.children.back()));
  }
  holding.erase(begin, end);
}

void report_lost_models(const HoldingJoints& holding, const std::string& path, std::vector<Problem>& problems) {
  for (const auto& [model, joint] : holding)
    problems.push_back({joint.file->shown, joint.line, path_below(path, joint),
                        "the world has no model '" + model + "' that the joint could hold"});
}

// Returns the number of models and frames before the next child.
std::size_t place_after(const std::vector<XmlNode>& children) {
  return static_cast<std::size_t>(std::ranges::count_if(
      children, [](const XmlNode& child) { return child.name == "model" || child.name == "frame"; }));
}

}  // namespace

/// The elements of a world to which others in it refer by name.
struct SdfFiles::Named {
  std::set<std::string> frames;
  std::set<std::string> scopes;    ///< `robot` for `robot::link`
  std::set<std::string> repeated;  ///< names of several models and frames

  void add(const std::string& text, bool is_frame) {
    if (const std::size_t end = text.find("::"); end != std::string::npos)
      scopes.insert(text.substr(0, end));
    else if (is_frame)
      frames.insert(text);
  }
  void collect(const XmlNode& node) {
    for (const auto& [name, value] : node.attributes) add(value, refers_to_frame(name));
    add(node.text, node.name == "parent" || node.name == "child");
    for (const XmlNode& child : node.children) collect(child);
  }
};

/// The target of an <include>.
struct SdfFiles::Found {
  const SdfFile& file;
  const XmlNode& model;  ///< in its tree
  std::string name;
};

bool SdfFiles::replace_includes(XmlNode& node, const std::string& path, SdfFile& file) {
  if (node.name == "world") return replace_in_children_of_world(node, path, file);
  bool usable = true;
  std::vector<XmlNode> children;
  children.reserve(node.children.size());
  for (XmlNode& child : node.children) {
    const std::string child_path = path_below(path, child);
    if (child.name == "world" || child.name == "model") usable = replace_includes(child, child_path, file) && usable;
    if (child.name != "include" || (node.name != "model" && node.name != "sdf")) {
      children.push_back(std::move(child));
      continue;
    }
    const std::optional<Found> found = follow(child, child_path, file);
    if (!found) continue;
    if (!fits(child, child_path, found->file, file)) return false;
    if (node.name == "sdf")
      children.push_back(as_included(found->model, child));
    else
      replace_in_model(child, *found, children);
  }
  node.children = std::move(children);
  return usable;
}

bool SdfFiles::replace_in_children_of_world(XmlNode& world, const std::string& path, SdfFile& file) {
  if (!merge_in_world(world, path, file)) return false;
  HoldingJoints holding = take_world_joints(world, path, warnings_);
  Named named;
  named.collect(world);
  named.repeated = repeated_names_in(world);
  std::set<std::string> names = names_in(world);  // including those of includes
  bool usable = true;
  std::vector<XmlNode> children;
  children.reserve(world.children.size());
  for (XmlNode& child : world.children) {
    const std::string child_path = path_below(path, child);
    if (child.name == "include") {
      std::optional<Found> found = follow(child, child_path, file);
      if (!found) continue;
      if (file.is_foreign && names.contains(found->name)) rename_include(child, child_path, names, *found);
      move_joints(holding, found->name, added_joint, child);
      if (!names.insert(found->name).second)
        problems_.push_back({file.shown, child.line, "world/include[" + found->name + "]",
                             "another model has the name '" + found->name + "'"});
      else if (!replace_in_world(child, child_path, *found, named, children, file))
        return false;
      continue;
    }
    if (child.name == "model") {
      usable = replace_includes(child, child_path, file) && usable;
      move_joints(holding, name_of(child), "joint", child);
      if (set_apart(child, named, place_after(children), file)) continue;
    }
    children.push_back(std::move(child));
  }
  world.children = std::move(children);
  if (file.complete) report_lost_models(holding, path, problems_);
  return usable;
}

void SdfFiles::rename_include(XmlNode& include, const std::string& path, const std::set<std::string>& taken,
                              Found& found) {
  const std::string before = found.name;
  for (int number = 1; taken.contains(found.name); ++number) found.name = before + "_" + std::to_string(number);
  warnings_.push_back({include.file->shown, include.line, path,
                       "another model has the name '" + before + "'; this one is renamed to '" + found.name + "'"});
  set_child(include, element_at(include, "name", found.name));
}

// A world cannot have links, so the model must consist of other models.
bool SdfFiles::merge_in_world(XmlNode& world, const std::string& path, SdfFile& file) {
  std::vector<XmlNode> children;
  children.reserve(world.children.size());
  for (XmlNode& child : world.children) {
    if (child.name != "include" || !is_merged(child)) {
      children.push_back(std::move(child));
      continue;
    }
    const std::string child_path = path_below(path, child);
    const std::optional<Found> found = follow(child, child_path, file);
    if (!found) continue;
    const auto is_part_of_model = [](const XmlNode& part) { return part.name == "link" || part.name == "gripper"; };
    const auto part = std::ranges::find_if(found->model.children, is_part_of_model);
    if (part != found->model.children.end()) {
      problems_.push_back({file.shown, child.line, child_path,
                           "the model '" + found->name + "' cannot be merged into a world, because it has a <" +
                               part->name + ">; expected only models, frames, joints and plugins in it"});
      continue;
    }
    if (!fits(child, child_path, found->file, file)) return false;
    replace_in_model(child, *found, children);
  }
  world.children = std::move(children);
  return true;
}

void SdfFiles::replace_in_model(const XmlNode& include, const Found& found, std::vector<XmlNode>& children) {
  if (!is_merged(include)) {
    children.push_back(as_included(found.model, include));
    return;
  }
  for (XmlNode& part : merged(found.model, *found.file.model_frames, include)) children.push_back(std::move(part));
}

bool SdfFiles::fits(const XmlNode& include, const std::string& path, const SdfFile& included, SdfFile& file) {
  file.size += included.size;
  if (file.size <= most_elements) return true;
  problems_.push_back(
      {include.file->shown, include.line, path,
       "with this include, nested models have more than " + std::to_string(most_elements) + " elements"});
  return false;
}

bool SdfFiles::set_apart(XmlNode& model, const Named& named, std::size_t place, SdfFile& file) {
  const std::string name = name_of(model);
  const bool is_usual =
      !name.empty() && name != "world" && !name.starts_with("__") && value_of(model, "placement_frame").empty();
  if (!is_usual || named.frames.contains(name) || named.scopes.contains(name) || named.repeated.contains(name))
    return false;
  const auto X_WM = pose_in_world(model.child("pose"));
  if (!X_WM) return false;
  std::string content;
  add_content(model, content);
  const auto [alike, is_new] = file.parts.emplace(std::move(content), nullptr);
  if (!is_new) {
    file.includes.push_back({name, alike->second, false, place, X_WM, true});
    return true;
  }
  const std::filesystem::path path = file.path / ("model " + std::to_string(file.includes.size()));
  std::unique_ptr<SdfFile>& part = files_[path];
  part = std::make_unique<SdfFile>();
  part->path = path;
  part->shown = file.shown;
  part->version = file.version;
  part->is_foreign = file.is_foreign;
  part->complete = file.complete;
  part->tree = element_at(file.tree, "sdf");
  part->tree.attributes = file.tree.attributes;
  part->tree.written = "world";
  part->tree.children.push_back(std::move(model));
  alike->second = part.get();
  file.includes.push_back({name, part.get(), false, place, X_WM, true});
  return true;
}

const SdfFile& SdfFiles::load_part(const SdfFile& part) {
  SdfFile& own = *files_.at(part.path);
  load(own);
  return own;
}

void SdfFiles::let_go(const SdfFile& part) {
  SdfFile& own = *files_.at(part.path);
  own.frames.reset();
  own.model_frames.reset();
  own.elements.reset();
  own.tree = {};
}

std::optional<SdfFiles::Found> SdfFiles::follow(const XmlNode& include, const std::string& path, SdfFile& file) {
  const auto problem = [&](const XmlNode& where, std::string message) {
    problems_.push_back(
        {file.shown, where.line, &where == &include ? path : path + "/" + where.name, std::move(message)});
    file.complete = false;
    return std::nullopt;
  };
  if (const auto flaw = flaw_of_include(include)) return problem(*flaw->first, flaw->second);
  if (const XmlNode* const parameters = include.child("experimental:params"))
    warnings_.push_back({file.shown, parameters->line, path + "/experimental:params",
                         "parameters of an include are not supported and are ignored"});
  const XmlNode* const uri = include.child("uri");
  if (uri == nullptr) return problem(include, "expected <uri>model://NAME</uri>");
  FoundModel found;
  try {
    found = search_.find(uri->text, file.path.parent_path());
  } catch (const std::runtime_error& error) {
    input_.note_missing();
    return problem(*uri, error.what());
  }
  if (std::find(opening_.begin(), opening_.end(), found.file) != opening_.end())
    return problem(*uri, "'" + found.file.string() + "' includes itself");
  const SdfFile& included = open(found.file, found.file);
  if (!included.sound) {
    file.complete = false;  // its own problems have been reported
    return std::nullopt;
  }
  const XmlNode* const model = included.tree.child("model");
  if (included.model() == nullptr || model == nullptr) {
    for (const char* const nothing : {"light", "actor"})  // without effect here, as in a world
      if (included.tree.child(nothing) != nullptr) return std::nullopt;
    return problem(*uri, "'" + included.shown.string() + "' has no <model>");
  }
  const XmlNode* const name = include.child("name");
  return Found{included, *model, name != nullptr ? name->text : name_of(*model)};
}

bool SdfFiles::replace_in_world(const XmlNode& include, const std::string& path, const Found& found, const Named& named,
                                std::vector<XmlNode>& children, SdfFile& file) {
  if (include.child("plugin") != nullptr ||
      include.child(added_joint) != nullptr) {  // it shares its model with no other
    children.push_back(as_included(found.model, include));
    return fits(include, path, found.file, file);
  }
  const XmlNode model = as_included({"model", include.line, include.file, found.model.attributes, "", {}}, include);
  const XmlNode* const own_pose = found.model.child("pose");
  const XmlNode* const pose = include.child("pose") != nullptr ? include.child("pose") : own_pose;
  const XmlNode* const is_static =
      include.child("static") != nullptr ? include.child("static") : found.model.child("static");
  file.includes.push_back(
      {found.name, &found.file, is_static != nullptr && is_true(is_static->text), place_after(children), {}});
  const std::string* const placement = model.attribute("placement_frame");
  if (named.scopes.contains(found.name) || (placement != nullptr && !placement->empty())) {
    children.push_back(as_included(frames_of(found.model), include));
    return true;
  }
  if (!named.frames.contains(found.name)) file.includes.back().X_WM = pose_in_world(pose);
  if (file.includes.back().X_WM) return true;
  XmlNode frame{"frame", include.line, include.file, {{"name", found.name}}, "", {}};
  frame.written = "world/include[" + found.name + "]";
  if (pose != nullptr) frame.children.push_back(*pose);
  children.push_back(std::move(frame));
  return true;
}

}  // namespace cohort::parsing
