// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/included_model.hpp"

#include <cmath>
#include <string_view>
#include <utility>

#include "server/core/text.hpp"
#include "server/parsing/sdf/schema/sdf_angles.hpp"
#include "server/parsing/sdf/schema/value_text.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"
#include "server/parsing/sdf/world_joints.hpp"

namespace cohort::parsing {
namespace {

std::string pose_text(const Pose& X) {
  std::string text;
  for (const double number : X.position) text += shortest_text(number) + " ";
  for (const double number : X.orientation.coeffs()) text += shortest_text(number) + " ";  // x y z w
  text.pop_back();
  return text;
}

// Makes directions of friction that are written in the frame of the merged model refer to `proxy`.
void redirect_friction(XmlNode& node, const std::string& proxy) {
  for (auto& [name, value] : node.attributes)
    if (node.name == "fdir1" && name.ends_with(":expressed_in") && value == "__model__") value = proxy;
  for (XmlNode& child : node.children) redirect_friction(child, proxy);
}

// Makes all references to the frame of the merged model refer to `proxy`.
void refer_to_proxy(XmlNode& node, const std::string& proxy) {
  const auto redirect = [&](XmlNode* where, const std::string& attribute, bool also_if_absent) {
    if (where == nullptr) return;
    const std::string* const value = where->attribute(attribute);
    const bool is_absent = value == nullptr || value->empty();
    if (is_absent ? also_if_absent : *value == "__model__") set_attribute(*where, attribute, proxy);
  };
  if (node.name == "link")
    for (XmlNode& part : node.children)
      if (part.name == "collision") redirect_friction(part, proxy);
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

}  // namespace

void set_child(XmlNode& node, const XmlNode& child) {
  for (XmlNode& each : node.children)
    if (each.name == child.name) {
      each = child;
      return;
    }
  node.children.push_back(child);
}

bool refers_to_frame(const std::string& attribute) {
  return attribute == "relative_to" || attribute == "attached_to" || attribute == "expressed_in";
}

std::optional<Pose> pose_in_world(const XmlNode* pose) {
  if (pose == nullptr) return Pose{};
  for (const auto& [name, value] : pose->attributes)
    if (name != "degrees" && name != "rotation_format") return std::nullopt;
  if (flaw_of_angles(*pose)) return std::nullopt;
  for (const std::string_view part : words(pose->text))
    if (const auto number = parse_real(part); !number || !std::isfinite(*number)) return std::nullopt;
  return written_pose(*pose);
}

XmlNode as_included(const XmlNode& model, const XmlNode& include) {
  XmlNode changed = model;
  if (const XmlNode* const name = include.child("name")) set_attribute(changed, "name", name->text);
  if (const XmlNode* const frame = include.child("placement_frame"))
    set_attribute(changed, "placement_frame", frame->text);
  if (const XmlNode* const pose = include.child("pose")) set_child(changed, *pose);
  if (const XmlNode* const is_static = include.child("static")) set_child(changed, *is_static);
  for (const XmlNode& part : include.children)
    if (part.name == "plugin" || part.name == added_joint) {
      changed.children.push_back(part);
      if (part.name == added_joint) changed.children.back().name = "joint";
    }
  return changed;
}

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

std::vector<XmlNode> merged(const XmlNode& model, const Frames& frames, const XmlNode& include) {
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
  const std::string link = frames.link_of("__model__").value_or("");
  const std::string* const placement = changed.attribute("placement_frame");
  const auto X_MP = placement != nullptr ? frames.pose_of(*placement) : std::nullopt;
  if (X_MP) {
    const std::string placed = "_merged__" + name + "__placement__";
    add_frame(placed, "", std::move(pose));
    pose = {"pose",
            include.line,
            include.file,
            {{"relative_to", placed}, {"rotation_format", "quat_xyzw"}},
            pose_text(X_MP->inverse()),
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

}  // namespace cohort::parsing
