#include <algorithm>
#include <cmath>
#include <map>
#include <sdf/Frame.hh>
#include <sdf/Joint.hh>
#include <sdf/Link.hh>
#include <sdf/Model.hh>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "server/core/text.hpp"
#include "server/parsing/sdf/sdf_files.hpp"
#include "server/parsing/sdf/sdf_schema.hpp"
#include "server/parsing/sdf/xml_edit.hpp"

namespace cohort::parsing {
namespace {

// An element costs libsdformat some 60 kB, and up to 100, since each carries the schema of what it may hold.
constexpr std::size_t most_elements = 50'000;

// Of an element in an <include>: what is wrong with it, or nothing.
std::optional<std::string> flaw_of_part(const XmlNode& part, const XmlNode& include) {
  static const std::map<std::string, std::vector<std::string>> attributes_of = {
      {"uri", {}},
      {"name", {}},
      {"static", {}},
      {"placement_frame", {}},
      {"pose", {"relative_to", "degrees", "rotation_format"}},
      {"plugin", {"name", "filename"}}};
  const auto known = attributes_of.find(part.name);
  if (known == attributes_of.end()) {
    std::vector<std::string> names;
    for (const auto& [name, attributes] : attributes_of) names.push_back(name);
    return "unknown element" + suggestion(part.name, names);
  }
  const bool is_plugin = part.name == "plugin";
  if (!is_plugin && include.child(part.name) != &part) return "<" + part.name + "> is given twice";
  for (const auto& [attribute, value] : part.attributes)
    if (std::find(known->second.begin(), known->second.end(), attribute) == known->second.end())
      return "unknown attribute '" + attribute + "'" + suggestion(attribute, known->second);
  if (is_plugin) return part.text.empty() ? std::nullopt : std::optional<std::string>("unexpected text");
  if (part.name != "pose" && part.text.empty()) return "expected a value";
  constexpr std::string_view flags[] = {"true", "false", "1", "0"};
  if (part.name == "static" && std::find(std::begin(flags), std::end(flags), part.text) == std::end(flags))
    return "expected true or false, not '" + part.text + "'";
  return std::nullopt;
}

// The element that cannot be, and what is wrong with it.
std::optional<std::pair<const XmlNode*, std::string>> flaw_of_include(const XmlNode& include) {
  for (const auto& [name, value] : include.attributes)
    if (name != "merge" && name.find(':') == std::string::npos)
      return std::pair{&include, "unknown attribute '" + name + "'" + suggestion(name, {"merge"})};
  for (const XmlNode& part : include.children) {
    if (part.name == "experimental:params" && !include.file->is_foreign)
      return std::pair{&part, "parameters of an include are not supported"};
    if (part.name.find(':') != std::string::npos) continue;
    if (const std::optional<std::string> flaw = flaw_of_part(part, include)) return std::pair{&part, *flaw};
  }
  if (include.child("placement_frame") != nullptr && include.child("pose") == nullptr)
    return std::pair{&include, "a <placement_frame> needs a <pose>, which it is placed at"};
  return std::nullopt;
}

bool is_merged(const XmlNode& include) {
  const std::string* const merge = include.attribute("merge");
  return merge != nullptr && (*merge == "true" || *merge == "1");
}

bool is_true(const XmlNode* flag) { return flag != nullptr && (flag->text == "true" || flag->text == "1"); }

void set_child(XmlNode& node, const XmlNode& child) {
  for (XmlNode& each : node.children)
    if (each.name == child.name) {
      each = child;
      return;
    }
  node.children.push_back(child);
}

// The frames of a model, without anything that has mass or shape.
XmlNode frames_of(const XmlNode& model) {
  XmlNode frames{model.name, model.line, model.file, model.attributes, "", {}};
  for (const XmlNode& child : model.children) {
    if (child.name == "model") {
      frames.children.push_back(frames_of(child));
    } else if (child.name == "pose" || child.name == "frame" || child.name == "static") {
      frames.children.push_back(child);
    } else if (child.name == "link" || child.name == "joint") {
      XmlNode bare{child.name, child.line, child.file, child.attributes, "", {}};
      if (child.name == "joint") set_attribute(bare, "type", "fixed");
      for (const XmlNode& part : child.children)
        if (part.name == "pose" || part.name == "parent" || part.name == "child") bare.children.push_back(part);
      frames.children.push_back(std::move(bare));
    }
  }
  return frames;
}

bool refers_to_frame(const std::string& attribute) {
  return attribute == "relative_to" || attribute == "attached_to" || attribute == "expressed_in";
}

// The pose of what is placed in the world's own frame; nothing if another frame is named, or if anything is wrong with
// it, which libsdformat is to say.
std::optional<ignition::math::Pose3d> pose_in_world(const XmlNode* pose) {
  if (pose == nullptr) return ignition::math::Pose3d::Zero;
  const sdf::ElementPtr element =
      sdf_definition()->GetElementDescription("model")->GetElementDescription("pose")->Clone();
  for (const auto& [name, value] : pose->attributes) {
    const sdf::ParamPtr attribute = element->GetAttribute(name);
    if (!attribute || refers_to_frame(name) || !attribute->SetFromString(value)) return std::nullopt;
  }
  if (pose->text.empty()) return ignition::math::Pose3d::Zero;
  for (const std::string_view part : words(pose->text))
    if (const auto number = parse_real(part); !number || !std::isfinite(*number)) return std::nullopt;
  ignition::math::Pose3d X;
  if (!element->GetValue()->SetFromString(pose->text) || !element->GetValue()->Get(X)) return std::nullopt;
  return X;
}

// The model of a file as an <include> has it.
XmlNode as_included(const XmlNode& model, const XmlNode& include) {
  XmlNode changed = model;
  if (const XmlNode* const name = include.child("name")) set_attribute(changed, "name", name->text);
  if (const XmlNode* const frame = include.child("placement_frame"))
    set_attribute(changed, "placement_frame", frame->text);
  if (const XmlNode* const pose = include.child("pose")) set_child(changed, *pose);
  if (const XmlNode* const is_static = include.child("static")) set_child(changed, *is_static);
  for (const XmlNode& part : include.children)
    if (part.name == "plugin") changed.children.push_back(part);
  return changed;
}

template <class Posed>
std::optional<ignition::math::Pose3d> pose_in_model(const Posed* posed) {
  ignition::math::Pose3d X;
  if (posed == nullptr || !posed->SemanticPose().Resolve(X, "__model__").empty()) return std::nullopt;
  return X;
}

std::optional<ignition::math::Pose3d> pose_of_frame(const sdf::Model& model, const std::string& name) {
  if (auto X = pose_in_model(model.FrameByName(name))) return X;
  if (auto X = pose_in_model(model.LinkByName(name))) return X;
  if (auto X = pose_in_model(model.JointByName(name))) return X;
  return pose_in_model(model.ModelByName(name));
}

std::string pose_text(const ignition::math::Pose3d& X) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(17);
  text << X.Pos().X() << ' ' << X.Pos().Y() << ' ' << X.Pos().Z() << ' ' << X.Rot().X() << ' ' << X.Rot().Y() << ' '
       << X.Rot().Z() << ' ' << X.Rot().W();
  return text.str();
}

// Of models and frames.
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

// How many models and frames there are before what comes next.
std::size_t place_after(const std::vector<XmlNode>& children) {
  return static_cast<std::size_t>(std::ranges::count_if(
      children, [](const XmlNode& child) { return child.name == "model" || child.name == "frame"; }));
}

// Whatever refers to the merged model's own frame refers to `proxy` from now on.
void refer_to_proxy(XmlNode& node, const std::string& proxy) {
  const auto redirect = [&](XmlNode* where, const std::string& attribute, bool also_if_absent) {
    if (where == nullptr) return;
    const std::string* const value = where->attribute(attribute);
    const bool is_absent = value == nullptr || value->empty();
    if (is_absent ? also_if_absent : *value == "__model__") set_attribute(*where, attribute, proxy);
  };
  if (node.name == "link" || node.name == "model") {
    if (child_of(node, "pose") == nullptr) node.children.push_back({"pose", node.line, node.file, {}, "", {}});
    redirect(child_of(node, "pose"), "relative_to", true);
  } else if (node.name == "frame") {
    redirect(&node, "attached_to", true);
    redirect(child_of(node, "pose"), "relative_to", false);
  } else if (node.name == "joint") {
    redirect(child_of(node, "pose"), "relative_to", false);
    for (const char* const end : {"parent", "child"})
      if (XmlNode* const link = child_of(node, end); link != nullptr && link->text == "__model__") link->text = proxy;
    for (const char* const axis : {"axis", "axis2"})
      if (XmlNode* const each = child_of(node, axis)) redirect(child_of(*each, "xyz"), "expressed_in", false);
  }
}

// What <include merge="true"> puts into a model: all named parts of the other, whose own frame becomes a <frame>. As
// libsdformat does it, in the same names.
std::vector<XmlNode> merged(const XmlNode& model, const sdf::Model& sdf_model, const XmlNode& include) {
  const XmlNode changed = as_included(model, include);
  const std::string name = *changed.attribute("name");
  const std::string proxy = "_merged__" + name + "__model__";
  std::vector<XmlNode> parts;
  const auto add_frame = [&](const std::string& frame, const std::string& attached_to, XmlNode pose) {
    if (pose.attribute("relative_to") == nullptr || pose.attribute("relative_to")->empty())
      set_attribute(pose, "relative_to", "__model__");
    parts.push_back({"frame", include.line, include.file, {{"name", frame}}, "", {std::move(pose)}});
    if (!attached_to.empty()) set_attribute(parts.back(), "attached_to", attached_to);
  };
  const XmlNode* const own = changed.child("pose");
  XmlNode pose = own != nullptr ? *own : XmlNode{"pose", include.line, include.file, {}, "", {}};
  const std::string link = sdf_model.CanonicalLinkAndRelativeName().second;
  const std::string* const placement = changed.attribute("placement_frame");
  const auto X_MP = placement != nullptr ? pose_of_frame(sdf_model, *placement) : std::nullopt;
  if (X_MP) {
    const std::string placed = "_merged__" + name + "__placement__";
    add_frame(placed, "", std::move(pose));
    pose = {"pose",
            include.line,
            include.file,
            {{"relative_to", placed}, {"rotation_format", "quat_xyzw"}},
            pose_text(X_MP->Inverse()),
            {}};
  }
  add_frame(proxy, link, std::move(pose));
  for (const XmlNode& child : changed.children) {
    const bool is_named = child.name == "link" || child.name == "model" || child.name == "joint" ||
                          child.name == "frame" || child.name == "gripper" || child.name == "plugin";
    if (!is_named && child.name.find(':') == std::string::npos) continue;
    parts.push_back(child);
    refer_to_proxy(parts.back(), proxy);
  }
  return parts;
}

}  // namespace

/// What of a world is named by something else in it.
struct SdfFiles::Named {
  std::set<std::string> frames;
  std::set<std::string> scopes;    ///< of `robot::link`, `robot`
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

/// What an <include> leads to.
struct SdfFiles::Found {
  const SdfFile& file;
  const XmlNode& model;  ///< in its tree
  std::string name;
};

bool SdfFiles::replace_includes(XmlNode& node, const std::string& path, SdfFile& file) {
  const bool is_world = node.name == "world";
  Named named;
  if (is_world) named.collect(node);
  if (is_world) named.repeated = repeated_names_in(node);
  std::set<std::string> names = is_world ? names_in(node) : std::set<std::string>{};  // those of includes too
  bool usable = true;
  std::vector<XmlNode> children;
  children.reserve(node.children.size());
  for (XmlNode& child : node.children) {
    const std::string child_path = (path.empty() ? "" : path + "/") + step_of(child);
    if (child.name != "include" || (!is_world && node.name != "model")) {
      if (child.name == "world" || child.name == "model") usable = replace_includes(child, child_path, file) && usable;
      if (is_world && child.name == "model" && set_apart(child, named, place_after(children), file)) continue;
      children.push_back(std::move(child));
      continue;
    }
    std::optional<Found> found = follow(child, child_path, file);
    if (!found) continue;
    if (is_world && file.is_foreign && names.contains(found->name)) rename_include(child, child_path, names, *found);
    const bool merges = is_merged(child);
    if (is_world && merges) {
      problems_.push_back({file.shown, child.line, child_path, "merge=\"true\" has a meaning in a <model> only"});
    } else if (is_world && !names.insert(found->name).second) {
      problems_.push_back({file.shown, child.line, "world/include[" + found->name + "]",
                           "another model has the name '" + found->name + "'"});
    } else if (is_world) {
      if (!replace_in_world(child, child_path, *found, named, children, file)) return false;
    } else if (!fits(child, child_path, found->file, file)) {
      return false;
    } else {
      replace_in_model(child, *found, merges, children);
    }
  }
  node.children = std::move(children);
  return usable;
}

void SdfFiles::rename_include(XmlNode& include, const std::string& path, const std::set<std::string>& taken,
                              Found& found) {
  const std::string before = found.name;
  for (int number = 1; taken.contains(found.name); ++number) found.name = before + "_" + std::to_string(number);
  warnings_.push_back({include.file->shown, include.line, path,
                       "another model has the name '" + before + "'; this one is called '" + found.name + "'"});
  set_child(include, element_at(include, "name", found.name));
}

void SdfFiles::replace_in_model(const XmlNode& include, const Found& found, bool merges,
                                std::vector<XmlNode>& children) {
  if (!merges) {
    children.push_back(as_included(found.model, include));
    return;
  }
  for (XmlNode& part : merged(found.model, *found.file.root.Model(), include)) children.push_back(std::move(part));
}

bool SdfFiles::fits(const XmlNode& include, const std::string& path, const SdfFile& included, SdfFile& file) {
  file.size += included.size;
  if (file.size <= most_elements) return true;
  problems_.push_back({include.file->shown, include.line, path,
                       "with this, models in models have more than " + std::to_string(most_elements) + " elements"});
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
  const XmlNode* const pose = model.child("pose");
  const bool is_quaternion = pose != nullptr && value_of(*pose, "rotation_format") == "quat_xyzw";
  std::string content;
  add_content(model, content);
  const auto [alike, is_new] = file.parts.emplace(std::move(content), nullptr);
  if (!is_new) {
    file.includes.push_back({name, alike->second, false, place, X_WM, true, is_quaternion});
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
  part->within = "world/";
  part->tree = element_at(file.tree, "sdf");
  part->tree.attributes = file.tree.attributes;
  part->tree.children.push_back(std::move(model));
  alike->second = part.get();
  file.includes.push_back({name, part.get(), false, place, X_WM, true, is_quaternion});
  return true;
}

const SdfFile& SdfFiles::load_part(const SdfFile& part) {
  SdfFile& own = *files_.at(part.path);
  const std::size_t before = problems_.size();
  load(own);
  for (std::size_t i = before; i < problems_.size(); ++i)
    if (!problems_[i].element.empty()) problems_[i].element.insert(0, own.within);
  return own;
}

void SdfFiles::let_go(const SdfFile& part) {
  SdfFile& own = *files_.at(part.path);
  own.root = sdf::Root();
  own.nodes = {};
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
    return problem(*uri, error.what());
  }
  if (std::find(opening_.begin(), opening_.end(), found.file) != opening_.end())
    return problem(*uri, "'" + found.file.string() + "' includes itself");
  const SdfFile& included = open(found.file, found.file);
  if (!included.sound) {
    file.complete = false;  // its own problems have been said
    return std::nullopt;
  }
  const XmlNode* const model = included.tree.child("model");
  if (included.root.Model() == nullptr || model == nullptr) {
    for (const char* const nothing : {"light", "actor"})  // of no consequence here, as in a world
      if (included.tree.child(nothing) != nullptr) return std::nullopt;
    return problem(*uri, "'" + included.shown.string() + "' has no <model>");
  }
  const XmlNode* const name = include.child("name");
  return Found{included, *model, name != nullptr ? name->text : name_of(*model)};
}

bool SdfFiles::replace_in_world(const XmlNode& include, const std::string& path, const Found& found, const Named& named,
                                std::vector<XmlNode>& children, SdfFile& file) {
  if (include.child("plugin") != nullptr) {  // it shares its model with no other
    children.push_back(as_included(found.model, include));
    return fits(include, path, found.file, file);
  }
  const XmlNode model = as_included({"model", include.line, include.file, found.model.attributes, "", {}}, include);
  const XmlNode* const own_pose = found.model.child("pose");
  const XmlNode* const pose = include.child("pose") != nullptr ? include.child("pose") : own_pose;
  const XmlNode* const is_static =
      include.child("static") != nullptr ? include.child("static") : found.model.child("static");
  file.includes.push_back({found.name, &found.file, is_true(is_static), place_after(children), {}});
  const std::string* const placement = model.attribute("placement_frame");
  if (named.scopes.contains(found.name) || (placement != nullptr && !placement->empty())) {
    children.push_back(as_included(frames_of(found.model), include));
    return true;
  }
  if (!named.frames.contains(found.name)) file.includes.back().X_WM = pose_in_world(pose);
  if (file.includes.back().X_WM) return true;
  // A frame costs libsdformat a hundredth of what a model does.
  XmlNode frame{"frame", include.line, include.file, {{"name", found.name}}, "", {}};
  if (pose != nullptr) frame.children.push_back(*pose);
  children.push_back(std::move(frame));
  return true;
}

}  // namespace cohort::parsing
