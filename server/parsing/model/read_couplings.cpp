// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include "server/parsing/model/read_model.hpp"
#include "server/parsing/sdf/extension_values.hpp"

namespace cohort::parsing {
namespace {

constexpr const char* second_axis_name = "axis2";

// Returns the joint; nothing, with a report, if no joint of this name has such an axis.
std::optional<std::size_t> find_joint(const Model& model, const std::string& name, bool second_axis,
                                      const Element* where, const SdfReport& report) {
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const Joint& joint = model.joints[i];
    if (joint.name != name) continue;
    const description::JointTypeFacts& facts = facts_of(joint.type);
    if (facts.axes > (second_axis ? 1 : 0)) return i;
    const std::string flaw(facts.flaw.empty() ? "has one axis, and no 'axis2'" : facts.flaw);
    report.problem(where, "the joint '" + name + "' " + flaw);
    return std::nullopt;
  }
  report.problem(where, why_no_joint(model, name));
  return std::nullopt;
}

std::optional<Coupling> read_mimic(const Element* element, const std::string& follower, const Model& model,
                                   const std::string& scope, const SdfReport& report) {
  const auto values = ExtensionValues::read(element, *find_extension("mimic", "joint"), report);
  if (!values) return std::nullopt;
  const bool moves_second_axis = values->text("axis") == second_axis_name;
  const bool follows_second_axis = values->text("followed_axis") == second_axis_name;
  const auto of_follower = find_joint(model, follower, moves_second_axis, element, report);
  const auto of_leader =
      find_joint(model, scope + values->text("joint"), follows_second_axis, values->where("joint"), report);
  if (!of_follower || !of_leader) return std::nullopt;
  return Coupling{*of_follower,           *of_leader,        values->real("multiplier"),
                  values->real("offset"), moves_second_axis, follows_second_axis};
}

// The joint between a link and the reference body. The sign is 1 if a positive rotation of the joint turns the link
// positively about this axis, and -1 otherwise.
struct Turn {
  std::size_t joint = 0;
  double sense = 1.0;
};
std::optional<Turn> find_turn(const Model& model, std::size_t reference, std::size_t link,
                              const Eigen::Vector3d& axis_M) {
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const Joint& joint = model.joints[i];
    const bool is_forwards = joint.parent == reference && joint.child == link;
    const bool is_backwards = joint.parent == link && joint.child == reference;
    if ((!is_forwards && !is_backwards) || joint.type != JointType::revolute) continue;
    const Eigen::Vector3d its_axis_M =
        model.links[joint.child].X_ML.orientation * (joint.X_LJ.orientation * joint.axis.direction);
    return Turn{i, (is_forwards ? 1.0 : -1.0) * (its_axis_M.dot(axis_M) < 0.0 ? -1.0 : 1.0)};
  }
  return std::nullopt;
}

std::optional<Coupling> read_gearbox(const Element* element, const Frames& frames, const Model& model,
                                     const std::string& scope, const ModelReading& reading) {
  const auto link_of = [&](const std::string& name) -> std::optional<std::size_t> {
    const auto found = std::ranges::find(model.links, scope + name, &Link::name);
    if (found != model.links.end()) return static_cast<std::size_t>(found - model.links.begin());
    reading.report.problem(element, "the model has no link '" + name + "'");
    return std::nullopt;
  };
  const Element* const body = element->child("gearbox_reference_body");
  if (body == nullptr) {
    reading.report.flaw(element, "missing: <gearbox_reference_body>", "the gearbox is ignored");
    return std::nullopt;
  }
  const auto reference = link_of(body->text());
  const auto parent = link_of(element->child("parent")->text());
  const auto child = link_of(element->child("child")->text());
  if (!reference || !parent || !child || !reading.frames_resolve) return std::nullopt;
  std::optional<Turn> turns[2];
  for (const unsigned place : {0u, 1u}) {
    const Element* axis = element->child(place == 0 ? "axis" : "axis2");
    if (axis == nullptr) axis = element->child("axis");
    const std::optional<Eigen::Vector3d> direction = axis != nullptr ? direction_of(*axis, frames) : std::nullopt;
    if (!direction) {
      reading.report.problem(element, "missing: the direction of the axis, <axis><xyz>", "axis");
      return std::nullopt;
    }
    const Pose X_LJ = resolved_pose(*element, frames, reading, element->child("child")->text());
    const std::size_t link = place == 0 ? *parent : *child;
    turns[place] =
        find_turn(model, *reference, link, model.links[*child].X_ML.orientation * (X_LJ.orientation * *direction));
    if (turns[place]) continue;
    reading.report.problem(element, "expected a revolute joint between '" + model.links[link].name +
                                        "' and the gearbox_reference_body '" + model.links[*reference].name + "'");
    return std::nullopt;
  }
  const double by = element->real("gearbox_ratio");
  return Coupling{turns[1]->joint, turns[0]->joint, -by * turns[0]->sense * turns[1]->sense, 0.0};
}

}  // namespace

std::vector<Coupling> read_couplings(const Frames& frames, const Model& model, const std::string& scope,
                                     const ModelReading& reading) {
  std::vector<Coupling> couplings;
  const auto add = [&](const std::optional<Coupling>& coupling, const Element* where) {
    if (!coupling) return;
    const auto follows = [&](const Coupling& other) { return other.follower == coupling->follower; };
    if (coupling->follower == coupling->leader)
      reading.report.problem(where, "a joint cannot follow itself");
    else if (std::ranges::any_of(couplings, follows))
      reading.report.problem(where,
                             "the joint '" + model.joints[coupling->follower].name + "' already follows another joint");
    else
      couplings.push_back(*coupling);
  };
  for (const Element* const joint : children_of(frames.owner(), "joint")) {
    if (joint->attribute("type") == "gearbox") add(read_gearbox(joint, frames, model, scope, reading), joint);
    const Element* const mimic = joint->child("cohort:mimic");
    if (mimic != nullptr) add(read_mimic(mimic, scope + name_of(*joint), model, scope, reading.report), mimic);
  }
  for (const Element* const inner : children_of(frames.owner(), "model"))
    for (const Coupling& coupling : read_couplings(*frames.of(*inner), model, scope + name_of(*inner) + "::", reading))
      couplings.push_back(coupling);
  return couplings;
}

}  // namespace cohort::parsing
