// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/world/read_breakable_joints.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "server/core/text.hpp"

namespace cohort::parsing {
namespace {

// Returns the index in `things` of the one that a key names; reports a missing one with a message that begins with
// `otherwise`.
template <class Things>
std::optional<std::size_t> find_named(const ExtensionValues& values, const char* key, const Things& things,
                                      const std::string& otherwise, const SdfReport& report) {
  std::vector<std::string> names;
  names.reserve(things.size());
  for (const auto& thing : things) names.push_back(thing.name);
  const std::string& name = values.text(key);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  report.problem(values.where(key), otherwise + " '" + name + "'" + suggestion(name, names));
  return std::nullopt;
}

std::optional<std::size_t> find_object(const ExtensionValues& values, const char* key, const World& world,
                                       const SdfReport& report) {
  return find_named(values, key, world.instances, "there is no object", report);
}

std::optional<std::size_t> find_link(const ExtensionValues& values, const char* key, const Instance& object,
                                     const Model& model, const SdfReport& report) {
  if (!values.has(key)) return 0;
  return find_named(values, key, model.links, "'" + object.name + "' has no link", report);
}

}  // namespace

std::optional<BreakableJoint> read_breakable_joint(const ExtensionValues& values, const World& world,
                                                   const SdfReport& report) {
  const std::optional<std::size_t> first = find_object(values, "first", world, report);
  const std::optional<std::size_t> second = find_object(values, "second", world, report);
  if (!first || !second) return std::nullopt;
  const auto model = [&](std::size_t object) -> const Model& { return world.models[world.instances[object].model]; };
  const auto first_link = find_link(values, "first_link", world.instances[*first], model(*first), report);
  const auto second_link = find_link(values, "second_link", world.instances[*second], model(*second), report);
  if (!first_link || !second_link) return std::nullopt;
  if (*first == *second) {
    report.problem(values.where("second"), "expected an object other than '" + values.text("first") + "'");
    return std::nullopt;
  }
  if (model(*first).is_static && model(*second).is_static) {
    report.problem(values.element(), "neither '" + values.text("first") + "' nor '" + values.text("second") +
                                         "' can move, because both are static");
    return std::nullopt;
  }
  BreakableJoint joint{values.name(), *first, *first_link, *second, *second_link};
  joint.first_place = report.place_of(values.where("first"));
  joint.second_place = report.place_of(values.where("second"));
  if (values.has("pose")) joint.X_LP = values.pose("pose");
  if (values.text("type") == "revolute") joint.type = JointType::revolute;
  if (values.text("type") == "ball") joint.type = JointType::ball;
  joint.damping = values.real("damping");
  const Eigen::Vector3d& axis = values.vector("axis");
  if (joint.type == JointType::revolute && axis.norm() > 0.0) joint.axis_P = axis.normalized();
  if (!(axis.norm() > 0.0)) report.problem(values.where("axis"), "expected a direction that is not zero");
  if (values.has("breaking_force")) joint.breaking_force = values.real("breaking_force");
  if (values.has("breaking_torque")) joint.breaking_torque = values.real("breaking_torque");
  return joint;
}

}  // namespace cohort::parsing
