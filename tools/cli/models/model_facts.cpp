// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/models/model_facts.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

namespace cohort::tool {
namespace {

using description::Joint;
using description::JointType;
using description::Model;
using Json = nlohmann::ordered_json;

constexpr std::string_view shape_kinds[] = {"box",     "sphere",    "cylinder", "plane",
                                            "capsule", "ellipsoid", "mesh",     "heightmap"};
static_assert(std::size(shape_kinds) == std::variant_size_v<description::Shape>);

std::string_view type_of(const Joint& joint) { return facts_of(joint.type).name; }

std::string name_of_link(const Model& model, std::size_t link) {
  return link == Joint::world ? "world" : model.links[link].name;
}

Json numbers(const Eigen::Vector3d& vector) { return {vector.x(), vector.y(), vector.z()}; }

Json numbers(const Pose& pose) {
  const Eigen::Quaterniond& q = pose.orientation;
  return {pose.position.x(), pose.position.y(), pose.position.z(), q.x(), q.y(), q.z(), q.w()};
}

Json limit(double value) { return std::isfinite(value) ? Json(value) : Json(); }

/// An object of a simulation.
struct Seen {
  const Simulation& simulation;
  BodyId body;
  const Model& model;

  Pose pose_of(std::size_t link) const { return simulation.world().link_pose(body, LinkId{link}); }
};

Json facts_of(const Seen& seen, std::size_t index) {
  const description::Link& link = seen.model.links[index];
  const description::Inertial& inertial = link.inertial;
  const Eigen::Matrix3d R_LI = inertial.X_LI.orientation.toRotationMatrix();
  const Eigen::Matrix3d inertia_L = R_LI * inertial.inertia * R_LI.transpose();
  Json collisions = Json::array();
  for (const description::Collision& collision : link.collisions)
    collisions.push_back({{"name", collision.name},
                          {"shape", shape_kinds[collision.shape.index()]},
                          {"pose", numbers(collision.X_LC)},
                          {"friction", collision.surface.friction}});
  Json facts = {{"name", link.name}, {"pose", numbers(link.X_ML)}};
  if (!seen.model.is_static) {
    facts["mass"] = inertial.mass;
    facts["centre"] = numbers(inertial.X_LI.position);
    Json rows = Json::array();
    for (int row = 0; row < 3; ++row) rows.push_back(numbers(Eigen::Vector3d(inertia_L.row(row).transpose())));
    facts["inertia"] = std::move(rows);
  }
  facts["collisions"] = std::move(collisions);
  facts["pose_in_world"] = numbers(seen.pose_of(index));
  const physics::Twist twist = seen.simulation.world().link_twist(seen.body, LinkId{index});
  facts["velocity"] = numbers(twist.linear_W);
  facts["angular_velocity"] = numbers(twist.angular_W);
  return facts;
}

Json facts_of(const Seen& seen, const Joint& joint) {
  const Pose X_WJ = seen.pose_of(joint.child) * joint.X_LJ;
  Json facts = {{"name", joint.name},
                {"type", type_of(joint)},
                {"parent", name_of_link(seen.model, joint.parent)},
                {"child", name_of_link(seen.model, joint.child)},
                {"pose_in_world", numbers(X_WJ)}};
  const auto add_axis = [&](const char* name, const description::JointAxis& axis) {
    facts[name] = {{"direction_in_world", numbers(Eigen::Vector3d(X_WJ.orientation * axis.direction))},
                   {"lower", limit(axis.lower)},
                   {"upper", limit(axis.upper)},
                   {"max_effort", limit(axis.max_effort)},
                   {"max_velocity", limit(axis.max_velocity)},
                   {"damping", axis.damping},
                   {"friction", axis.friction},
                   {"spring_stiffness", axis.spring_stiffness},
                   {"spring_reference", axis.spring_reference}};
  };
  if (facts_of(joint.type).axes > 0) add_axis("axis", joint.axis);
  if (facts_of(joint.type).axes > 1) add_axis("second_axis", joint.second_axis);
  if (joint.type == JointType::screw) facts["thread_pitch"] = joint.thread_pitch;
  return facts;
}

Json facts_of(const Seen& seen, const std::string& name) {
  const physics::World& world = seen.simulation.world();
  Json facts = {{"name", name},
                {"model", seen.model.name},
                {"static", seen.model.is_static},
                {"active", world.is_active(seen.body)},
                {"asleep", world.is_asleep(seen.body)}};
  Json links = Json::array();
  for (std::size_t link = 0; link < seen.model.links.size(); ++link) links.push_back(facts_of(seen, link));
  Json joints = Json::array();
  for (std::size_t i = 0; i < seen.model.joints.size(); ++i) {
    const Joint& joint = seen.model.joints[i];
    Json of_joint = facts_of(seen, joint);
    if (of_joint.contains("axis")) {
      const physics::JointState state = world.joint_state(seen.body, JointId{i});
      of_joint["position"] = state.position;
      of_joint["velocity"] = state.velocity;
    }
    joints.push_back(std::move(of_joint));
  }
  Json loops = Json::array();
  for (const Joint& joint : seen.model.loop_joints) loops.push_back(facts_of(seen, joint));
  Json followers = Json::array();
  const auto name_of_axis = [](bool is_second) { return is_second ? "axis2" : "axis"; };
  for (const description::Coupling& coupling : seen.model.couplings)
    followers.push_back({{"joint", seen.model.joints[coupling.follower].name},
                         {"axis", name_of_axis(coupling.moves_second_axis)},
                         {"follows", seen.model.joints[coupling.leader].name},
                         {"followed_axis", name_of_axis(coupling.follows_second_axis)},
                         {"multiplier", coupling.multiplier},
                         {"offset", coupling.offset}});
  facts["links"] = std::move(links);
  facts["joints"] = std::move(joints);
  facts["loop_joints"] = std::move(loops);
  facts["followers"] = std::move(followers);
  return facts;
}

template <class Take>
void for_each_object(const Simulation& simulation, Take take) {
  const description::World& world = simulation.description();
  for (std::uint32_t body = 0; body < world.instances.size(); ++body) {
    const description::Instance& instance = world.instances[body];
    take(Seen{simulation, BodyId{body}, world.models[instance.model]}, instance.name);
  }
}

std::string range_of(const description::JointAxis& axis) {
  const bool is_free = std::isinf(axis.lower) && std::isinf(axis.upper);
  return is_free ? "without limits" : fmt::format("from {:g} to {:g}", axis.lower, axis.upper);
}

}  // namespace

std::string facts_as_json(const Simulation& simulation) {
  const description::World& world = simulation.description();
  Json objects = Json::array();
  for_each_object(simulation,
                  [&](const Seen& seen, const std::string& name) { objects.push_back(facts_of(seen, name)); });
  Json warnings = Json::array();
  for (const description::Problem& warning : world.warnings)
    warnings.push_back({{"file", warning.file.string()},
                        {"line", warning.line},
                        {"element", warning.element},
                        {"text", warning.message}});
  const Json facts = {{"step_s", std::chrono::duration<double>(world.step).count()},
                      {"time_s", std::chrono::duration<double>(simulation.time()).count()},
                      {"gravity", numbers(world.gravity)},
                      {"objects", std::move(objects)},
                      {"warnings", std::move(warnings)}};
  return facts.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string facts_as_text(const Simulation& simulation) {
  std::string text;
  for_each_object(simulation, [&](const Seen& seen, const std::string& name) {
    double mass = 0.0;
    for (const description::Link& link : seen.model.links) mass += link.inertial.mass;
    const std::string weight = seen.model.is_static ? "static" : fmt::format("{:g} kg", mass);
    text += fmt::format("{}: {}\n", name, weight);
    for (std::size_t i = 0; i < seen.model.links.size(); ++i) {
      const description::Link& link = seen.model.links[i];
      const Eigen::Vector3d at = seen.pose_of(i).position;
      const std::string of_link = seen.model.is_static ? "" : fmt::format("  {:g} kg", link.inertial.mass);
      text += fmt::format("  link {}{}  at {:g} {:g} {:g}  collisions {}\n", link.name, of_link, at.x(), at.y(), at.z(),
                          link.collisions.size());
    }
    const auto add = [&](const Joint& joint, const char* kind) {
      const bool has_range = facts_of(joint.type).axes > 0;
      text += fmt::format("  {} {}  {}  {} to {}{}\n", kind, joint.name, type_of(joint),
                          name_of_link(seen.model, joint.parent), name_of_link(seen.model, joint.child),
                          has_range ? "  " + range_of(joint.axis) : "");
    };
    for (const Joint& joint : seen.model.joints) add(joint, "joint");
    for (const Joint& joint : seen.model.loop_joints) add(joint, "loop joint");
  });
  return text;
}

}  // namespace cohort::tool
