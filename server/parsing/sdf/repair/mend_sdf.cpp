// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/repair/mend_sdf.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "server/core/text.hpp"
#include "server/parsing/sdf/tree/counted_warnings.hpp"
#include "server/parsing/sdf/tree/xml_edit.hpp"

namespace cohort::parsing {
namespace {

// The sensor types of SDF 1.9, and the older names `gpu_ray` and `ray`.
constexpr std::string_view sensor_types =
    "air_pressure altimeter boundingbox_camera camera contact custom depth_camera force_torque gps gpu_lidar gpu_ray "
    "imu lidar logical_camera magnetometer multicamera navsat none ray rfid rfidtag rgbd_camera segmentation_camera "
    "sonar thermal_camera wide_angle_camera wireless_receiver wireless_transmitter";

class SdfMender {
 public:
  SdfMender(const std::filesystem::path& file, std::vector<Problem>& warnings) : file_(file), warnings_(warnings) {}

  void mend(XmlNode& node, const std::string& path);
  void tell() const { told_.tell(warnings_); }

 private:
  void tell_of(const XmlNode& node, const std::string& path, const std::string& message) {
    told_.add({file_, node.line, path, ""}, message);
  }
  void mend_model(XmlNode& model, const std::string& path);
  void take_world_link(XmlNode& model, const std::string& path);
  void mend_masses(XmlNode& model, const std::string& path);
  void give_link(XmlNode& model, const std::string& path);
  void name_apart(XmlNode& around, const std::string& path);
  void mend_link(XmlNode& link, const std::string& path);
  void number_apart(XmlNode& link, std::string_view kind, const std::string& path);
  void mend_joint(XmlNode& joint, const std::string& path);
  void mend_friction(XmlNode& friction, const std::string& path);
  bool knows_sensor(const XmlNode& sensor, const std::string& path);

  const std::filesystem::path& file_;
  std::vector<Problem>& warnings_;
  CountedWarnings told_;
};

void SdfMender::mend(XmlNode& node, const std::string& path) {
  if (node.name == "model") mend_model(node, path);
  if (node.name == "model" || node.name == "world") name_apart(node, path);
  if (node.name == "link") mend_link(node, path);
  if (node.name == "joint") mend_joint(node, path);
  if (node.name == "friction") mend_friction(node, path);
  if (node.name == "plugin" || node.name == "visual" || node.name == "sensor" || node.name == "state") return;
  for (XmlNode& child : node.children) mend(child, path_below(path, child));
}

std::string text_of_child(const XmlNode& node, std::string_view name) {
  const XmlNode* const child = node.child(name);
  return child != nullptr ? child->text : "";
}

bool is_flag_set(const XmlNode& node, std::string_view name) {
  const std::string flag = text_of_child(node, name);
  return flag == "true" || flag == "1";
}

void SdfMender::mend_model(XmlNode& model, const std::string& path) {
  take_world_link(model, path);
  if (!is_flag_set(model, "static")) mend_masses(model, path);
  give_link(model, path);
}

// Joints refer to the world by the name `world`. A link of this name that is not solid is treated as the world.
void SdfMender::take_world_link(XmlNode& model, const std::string& path) {
  const auto is_it = [](const XmlNode& child) { return child.name == "link" && value_of(child, "name") == "world"; };
  const auto link = std::ranges::find_if(model.children, is_it);
  if (link == model.children.end()) return;
  if (link->child("collision") == nullptr) {
    tell_of(*link, path + "/link[world]", "a link called 'world' without collisions is treated as the world");
    model.children.erase(link);
    return;
  }
  tell_of(*link, path + "/link[world]",
          "the name 'world' is reserved for the world; this link is renamed to 'world_link'");
  set_attribute(*link, "name", "world_link");
  for (XmlNode& joint : model.children)
    if (joint.name == "joint")
      for (XmlNode& end : joint.children)
        if ((end.name == "parent" || end.name == "child") && end.text == "world") end.text = "world_link";
}

// In Bullet, a root link without mass is fixed to the world. Other links without mass get the mass of their shapes when
// those are read (read_link.cpp).
void SdfMender::mend_masses(XmlNode& model, const std::string& path) {
  std::set<std::string> children;
  for (const XmlNode& joint : model.children)
    if (joint.name == "joint") children.insert(text_of_child(joint, "child"));
  std::vector<XmlNode> held;
  const XmlNode* first = nullptr;
  std::string weightless;
  for (XmlNode& link : model.children) {
    XmlNode* const inertial = link.name == "link" ? child_of(link, "inertial") : nullptr;
    if (inertial == nullptr || parse_real(text_of_child(*inertial, "mass")) != 0.0) continue;
    const std::string name = value_of(link, "name");
    if (children.contains(name)) {
      if (first == nullptr) first = &link;
      weightless += (weightless.empty() ? "'" : ", '") + name + "'";
      continue;
    }
    *inertial = element_at(link, "inertial");
    XmlNode inertia = element_at(link, "inertia");
    for (const char* const moment : {"ixx", "iyy", "izz"}) inertia.children.push_back(element_at(link, moment, "1"));
    inertial->children = {element_at(link, "mass", "1"), std::move(inertia)};
    tell_of(link, path + "/" + step_of(link), "a root link without mass is fixed to the world");
    XmlNode& joint = held.emplace_back(element_at(link, "joint"));
    joint.attributes = {{"name", name + "_to_world"}, {"type", "fixed"}};
    joint.children = {element_at(link, "parent", "world"), element_at(link, "child", name)};
  }
  if (first != nullptr)
    tell_of(*first, path,
            "links without mass: " + weightless +
                "; their masses are computed from their collisions at 1000 kg/m^3, or else from their visuals, or else "
                "set to 1 g");
  std::ranges::move(held, std::back_inserter(model.children));
}

void SdfMender::give_link(XmlNode& model, const std::string& path) {
  const auto holds_any = [](const XmlNode& child) {
    return child.name == "link" || child.name == "model" || child.name == "include";
  };
  if (std::ranges::any_of(model.children, holds_any)) return;
  tell_of(model, path, "has no links and therefore no effect");
  XmlNode link = element_at(model, "link");
  set_attribute(link, "name", "link");
  std::erase_if(model.children, [](const XmlNode& child) { return child.name == "static"; });
  model.children.push_back(element_at(model, "static", "true"));
  model.children.push_back(std::move(link));
}

// Up to SDF 1.6, a joint or a frame could have the name of a link or a model.
void SdfMender::name_apart(XmlNode& around, const std::string& path) {
  std::set<std::string> names;
  for (const XmlNode& child : around.children)
    if (child.name == "link" || child.name == "model") names.insert(value_of(child, "name"));
  for (const std::string_view kind : {"joint", "frame"})
    for (XmlNode& part : around.children) {
      const std::string name = value_of(part, "name");
      if (part.name != kind || name.empty() || names.insert(name).second) continue;
      std::string other = name + "_" + part.name;
      for (int number = 0; !names.insert(other).second; ++number)
        other = name + "_" + part.name + std::to_string(number);
      tell_of(part, path_below(path, part),
              "another element of the " + around.name + " has this name; this one is renamed to '" + other + "'");
      set_attribute(part, "name", other);
    }
}

bool SdfMender::knows_sensor(const XmlNode& sensor, const std::string& path) {
  const std::string type = value_of(sensor, "type");
  const std::vector<std::string_view> known = words(sensor_types);
  if (std::ranges::find(known, type) != known.end()) return true;
  tell_of(sensor, path_below(path, sensor), "the sensor type '" + type + "' is not supported; the sensor is ignored");
  return false;
}

void SdfMender::mend_link(XmlNode& link, const std::string& path) {
  std::erase_if(link.children,
                [&](const XmlNode& child) { return child.name == "sensor" && !knows_sensor(child, path); });
  for (const char* const kind : {"collision", "sensor"}) number_apart(link, kind, path);
  for (XmlNode& sensor : link.children)  // cameras never see it
    if (XmlNode* const camera = sensor.name == "sensor" ? child_of(sensor, "camera") : nullptr)
      camera->children.clear();
}

// Renames parts of a link that have the same name.
void SdfMender::number_apart(XmlNode& link, std::string_view kind, const std::string& path) {
  std::set<std::string> names;
  for (XmlNode& part : link.children) {
    const std::string name = value_of(part, "name");
    if (part.name != kind || name.empty() || names.insert(name).second) continue;
    std::string other = name + "_1";
    for (int number = 2; !names.insert(other).second; ++number) other = name + "_" + std::to_string(number);
    tell_of(part, path_below(path, part),
            "another " + part.name + " of the link has this name; this one is renamed to '" + other + "'");
    set_attribute(part, "name", other);
  }
}

// The default axis of SDF is z. The two axes of a joint must differ.
void SdfMender::mend_joint(XmlNode& joint, const std::string& path) {
  const std::string type = value_of(joint, "type");
  if (value_of(joint, "name") == "world") {
    tell_of(joint, path, "the name 'world' is reserved for the world; this joint is renamed to 'world_joint'");
    set_attribute(joint, "name", "world_joint");
  }
  if (type == "fixed" || type == "ball") return;
  const bool has_two = type == "universal" || type == "revolute2";
  for (const char* const name : {"axis", "axis2"}) {
    if (name == std::string_view("axis2") && !has_two) break;
    XmlNode* axis = child_of(joint, name);
    if (axis != nullptr && axis->child("xyz") != nullptr) continue;
    const bool is_second = name == std::string_view("axis2");
    tell_of(joint, path,
            std::string("has no direction for <") + name + ">; the " + (is_second ? "y" : "z") + " axis is used");
    if (axis == nullptr) axis = &joint.children.emplace_back(element_at(joint, name));
    axis->children.push_back(element_at(joint, "xyz", is_second ? "0 1 0" : "0 0 1"));
  }
}

// A negative coefficient means unlimited friction in ODE. SDF does not define it.
void SdfMender::mend_friction(XmlNode& friction, const std::string& path) {
  XmlNode* const ode = child_of(friction, "ode");
  if (ode == nullptr) return;
  for (XmlNode& coefficient : ode->children) {
    if (coefficient.name != "mu" && coefficient.name != "mu2") continue;
    const auto value = parse_real(coefficient.text);
    if (!value || !(*value < 0.0)) continue;
    tell_of(coefficient, path + "/ode/" + coefficient.name, "expected a coefficient >= 0; unlimited friction is used");
    coefficient.text = "1000";
  }
}

}  // namespace

void mend_sdf(XmlNode& sdf, const std::filesystem::path& file, std::vector<Problem>& warnings) {
  SdfMender mender(file, warnings);
  mender.mend(sdf, "");
  mender.tell();
}

}  // namespace cohort::parsing
