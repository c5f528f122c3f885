// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/experiment/joint_motors.hpp"

#include <algorithm>
#include <cmath>

#include "server/core/text.hpp"

namespace cohort::parsing {
namespace {

using description::Device;
using description::Joint;
using description::JointType;
using description::Model;

constexpr double usual_turn = 3.14;    // [rad/s]
constexpr double usual_slide = 1.0;    // [m/s]
constexpr double usual_effort = 10.0;  // in weights of the model, at 1 m if the joint turns

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char each : text) {
    switch (each) {
      case '&': safe += "&amp;"; break;
      case '<': safe += "&lt;"; break;
      case '>': safe += "&gt;"; break;
      case '"': safe += "&quot;"; break;
      default: safe += each;
    }
  }
  return safe;
}

bool drives(const Device& device) { return !motor_limits(device).empty() || output_count(device) > 0; }

bool is_movable(const Model& model, std::size_t joint) {
  return facts_of(model.joints[joint].type).axes == 1 &&
         std::ranges::find(model.couplings, joint, &description::Coupling::follower) == model.couplings.end();
}

double given_or(double limit, double usual) { return std::isfinite(limit) && limit > 0.0 ? limit : usual; }

std::string motor_text(const Joint& joint, double weight) {
  const double usual_velocity = facts_of(joint.type).slides ? usual_slide : usual_turn;
  const std::string name = escaped(joint.name);
  return "    <cohort:position_motor name=\"" + name + "\"><cohort:joint>" + name +
         "</cohort:joint><cohort:max_velocity>" + shortest_text(given_or(joint.axis.max_velocity, usual_velocity)) +
         "</cohort:max_velocity><cohort:max_effort>" +
         shortest_text(given_or(joint.axis.max_effort, usual_effort * weight)) +
         "</cohort:max_effort></cohort:position_motor>\n";
}

}  // namespace

std::optional<std::string> text_with_joint_motors(const World& world, const std::string& uri) {
  const Model* model = nullptr;
  for (const description::Instance& instance : world.instances) {
    const Model& each = world.models[instance.model];
    if (each.is_static) continue;
    if (model != nullptr) return std::nullopt;
    model = &each;
  }
  if (model == nullptr || std::ranges::any_of(model->devices, drives)) return std::nullopt;
  double mass = 0.0;
  for (const description::Link& link : model->links) mass += link.inertial.mass;
  std::string motors;
  for (std::size_t joint = 0; joint < model->joints.size(); ++joint)
    if (is_movable(*model, joint)) motors += motor_text(model->joints[joint], mass * world.gravity.norm());
  if (motors.empty()) return std::nullopt;
  const auto flag = [](bool value) { return value ? "true" : "false"; };
  return "<sdf version=\"1.9\" xmlns:cohort=\"https://cohort-sim.org/sdf/1\">\n  <model name=\"" +
         escaped(model->name) + "\">\n    <self_collide>" + flag(model->self_collide) +
         "</self_collide>\n    <allow_auto_disable>" + flag(model->may_sleep) +
         "</allow_auto_disable>\n    <include merge=\"true\"><uri>" + escaped(uri) + "</uri></include>\n" + motors +
         "  </model>\n</sdf>\n";
}

}  // namespace cohort::parsing
