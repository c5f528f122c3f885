// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/plugins/plugin.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "server/core/text.hpp"
#include "server/parsing/sdf/sdf_values.hpp"

namespace cohort::parsing {
namespace {

// Parameters for topics, which have no effect on motion or measurement.
constexpr std::string_view of_no_consequence[] = {"ros",
                                                  "topic",
                                                  "sub_topic",
                                                  "odom_topic",
                                                  "tf_topic",
                                                  "frame_id",
                                                  "child_frame_id",
                                                  "odom_publish_frequency",
                                                  "update_rate",
                                                  "updateRate",
                                                  "robotNamespace",
                                                  "robot_namespace",
                                                  "namespace",
                                                  "commandTopic",
                                                  "command_topic",
                                                  "odometryTopic",
                                                  "odometry_topic",
                                                  "odometryFrame",
                                                  "odometry_frame",
                                                  "robotBaseFrame",
                                                  "robot_base_frame",
                                                  "publish_odom",
                                                  "publish_odom_tf",
                                                  "publish_wheel_tf",
                                                  "publishOdom",
                                                  "publishOdomTF",
                                                  "publishTf",
                                                  "publishWheelTF",
                                                  "publishWheelJointState",
                                                  "odometrySource",
                                                  "odometry_source",
                                                  "num_wheel_pairs",
                                                  "rosDebugLevel",
                                                  "alwaysOn",
                                                  "always_on",
                                                  "use_actuator_msg",
                                                  "actuator_number",
                                                  "actuatorNumber",
                                                  "motorNumber",
                                                  "commandSubTopic",
                                                  "motorSpeedPubTopic",
                                                  "actuatorTopic",
                                                  "rotorVelocitySlowdownSim"};

}  // namespace

std::string why_no_joint(const Model& model, const std::string& name, const std::string& scope) {
  if (std::ranges::find(model.loop_joints, scope + name, &Joint::name) != model.loop_joints.end())
    return "the joint '" + name +
           "' closes a kinematic loop, but motors, encoders and mimic joints need a joint of the tree; in the file, "
           "move it before another joint of the loop";
  std::vector<std::string> names;
  for (const Joint& joint : model.joints) names.push_back(joint.name);
  return "the model has no joint '" + name + "'" + suggestion(name, names);
}

std::string text_of_parameter(const Element* parameter) { return std::string(trimmed(parameter->text())); }

std::vector<const Element*> Plugin::all(ParameterNames names) {
  asked_.insert(names.begin(), names.end());
  std::vector<const Element*> found;
  for (const Element* const child : element_->children())
    if (std::find(names.begin(), names.end(), child->name()) != names.end()) found.push_back(child);
  return found;
}

const Element* Plugin::first(ParameterNames names) {
  const std::vector<const Element*> found = all(names);
  return found.empty() ? nullptr : found.front();
}

template <class Value>
std::optional<Value> Plugin::value(ParameterNames names, ExtensionValue kind) {
  const Element* const parameter = first(names);
  if (!parameter) return std::nullopt;
  const ExtensionKey key{"", kind, "", "", ""};
  const std::string text = text_of_parameter(parameter);
  if (const auto parsed = parse_value(text, key)) return std::get<Value>(*parsed);
  report_.problem(parameter, why_wrong(text, key));
  return std::nullopt;
}

std::optional<double> Plugin::number(ParameterNames names, ExtensionValue kind) { return value<double>(names, kind); }

std::optional<Eigen::Vector3d> Plugin::vector(ParameterNames names) {
  return value<Eigen::Vector3d>(names, ExtensionValue::vector);
}

std::string Plugin::text_or(const std::string& fallback, ParameterNames names) {
  const Element* const parameter = first(names);
  return parameter ? text_of_parameter(parameter) : fallback;
}

void Plugin::warn_of_unread() const {
  std::string unread;
  for (const Element* const child : element_->children()) {
    const std::string name = "<" + child->name() + ">";
    if (asked_.contains(child->name()) || unread.find(name) != std::string::npos ||
        std::ranges::find(of_no_consequence, child->name()) != std::end(of_no_consequence))
      continue;
    unread += (unread.empty() ? "" : ", ") + name;
  }
  if (!unread.empty()) report_.warning_once(element_, "this plugin does not support " + unread);
}

ModelPlugin::Values& ModelPlugin::Values::take(std::string_view key, ParameterNames names,
                                               const std::string& fallback) {
  const std::vector<const Element*> found = plugin_.all(names);
  const auto& of = *std::ranges::find(extension_.keys, key, &ExtensionKey::name);
  for (const Element* parameter : found) {
    values_.push_back({of.name, text_of_parameter(parameter), parameter});
    if (!of.repeats) break;
  }
  if (!found.empty()) return *this;
  if (!fallback.empty()) return set(key, fallback);
  if (of.required()) plugin_.report().problem(plugin_.element(), "missing: " + std::string(of.doc), *names.begin());
  return *this;
}

ModelPlugin::Values& ModelPlugin::Values::set(std::string_view key, const std::string& text, const Element* where) {
  values_.push_back({key, text, where ? where : plugin_.element()});
  return *this;
}

ModelPlugin::Values& ModelPlugin::Values::set(std::string_view key, double value, const Element* where) {
  return set(key, shortest_text(value), where);
}

ModelPlugin::Values& ModelPlugin::Values::set(std::string_view key, const Pose& X) {
  std::string text;
  for (const double number : X.position) text += shortest_text(number) + " ";
  for (const double number : X.orientation.coeffs()) text += shortest_text(number) + " ";  // x y z w
  return set(key, text);
}

void ModelPlugin::Values::finish(std::string name, const std::string& link) {
  std::replace(name.begin(), name.end(), '/', '_');
  std::string unique = name;
  const auto used = [&] { return std::string(extension_.topic) + "/" + plugin_.prefix_ + unique; };
  for (int i = 1; !plugin_.names_.insert(used()).second; ++i) unique = name + "_" + std::to_string(i);
  if (auto values = ExtensionValues::from_foreign(plugin_.element(), unique, extension_, values_, plugin_.report())) {
    values->put_in_scope(plugin_.prefix_, extension_);
    plugin_.counterparts_.push_back({&extension_, *std::move(values), link.empty() ? "" : plugin_.prefix_ + link});
  }
}

const Joint* ModelPlugin::joint(const Element* parameter) const {
  const std::string name = text_of_parameter(parameter);
  const auto found = std::ranges::find(model_.joints, prefix_ + name, &Joint::name);
  if (found != model_.joints.end()) return &*found;
  report().problem(parameter, why_no_joint(model_, name, prefix_));
  return nullptr;
}

std::vector<std::pair<const Joint*, const Element*>> ModelPlugin::joints(ParameterNames names) {
  std::vector<std::pair<const Joint*, const Element*>> found;
  for (const Element* parameter : all(names))
    if (const Joint* const each = joint(parameter)) found.emplace_back(each, parameter);
  return found;
}

}  // namespace cohort::parsing
