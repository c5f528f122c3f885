// SPDX-License-Identifier: Apache-2.0
#include "server/run/model_tree.hpp"

#include <algorithm>
#include <variant>

namespace cohort::session {
namespace {

static_assert(static_cast<int>(description::JointType::fixed) == static_cast<int>(JointInfo::Type::fixed));
static_assert(static_cast<int>(description::JointType::screw) == static_cast<int>(JointInfo::Type::screw));

Vector3 to_info(const Eigen::Vector3d& vector) { return {vector.x(), vector.y(), vector.z()}; }

FramePose to_info(const Pose& pose) {
  const Eigen::Quaterniond& q = pose.orientation;
  return {to_info(pose.position), {q.x(), q.y(), q.z(), q.w()}};
}

AxisInfo to_info(const description::JointAxis& axis) {
  return {to_info(axis.direction), axis.lower, axis.upper, axis.max_velocity, axis.max_effort};
}

bool is_of_joint(const description::Device& device, std::size_t joint) {
  const bool has_it = std::visit(
      [&](const auto& kind) {
        if constexpr (requires { kind.joint; }) return kind.joint == joint;
        return false;
      },
      device);
  const auto moves_it = [&](const description::MotorLimits& motor) { return motor.joint == joint; };
  return has_it || std::ranges::any_of(description::motor_limits(device), moves_it);
}

JointInfo to_info(const description::Model& model, std::size_t index) {
  const description::Joint& joint = model.joints[index];
  const bool is_of_world = joint.parent == description::Joint::world;
  const Pose& X_MC = model.links[joint.child].X_ML;
  JointInfo info{.name = joint.name,
                 .type = static_cast<JointInfo::Type>(joint.type),
                 .parent = is_of_world ? JointInfo::world : static_cast<std::uint32_t>(joint.parent),
                 .child = static_cast<std::uint32_t>(joint.child),
                 .pose = to_info(is_of_world ? X_MC : model.links[joint.parent].X_ML.inverse() * X_MC),
                 .frame = to_info(joint.X_LJ),
                 .axes = {},
                 .thread_pitch = joint.thread_pitch,
                 .devices = {}};
  const int axes = description::facts_of(joint.type).axes;
  if (axes > 0) info.axes.push_back(to_info(joint.axis));
  if (axes > 1) info.axes.push_back(to_info(joint.second_axis));
  for (const description::Device& device : model.devices)
    if (is_of_joint(device, index)) info.devices.push_back(description::name_of(device));
  return info;
}

struct AddSensor {
  std::vector<SensorInfo>& sensors;

  template <class Kind>
  void operator()(const Kind& kind) const {
    if constexpr (requires { kind.readout, kind.link, kind.X_LS; })
      sensors.push_back({kind.name, static_cast<std::uint32_t>(kind.link), to_info(kind.X_LS)});
  }
};

}  // namespace

KinematicTree tree_of(const description::Model& model) {
  KinematicTree tree;
  for (const description::Link& link : model.links)
    tree.links.push_back({link.name, link.inertial.mass, to_info(link.inertial.X_LI.position)});
  for (std::size_t i = 0; i < model.joints.size(); ++i) tree.joints.push_back(to_info(model, i));
  for (const description::Device& device : model.devices) std::visit(AddSensor{tree.sensors}, device);
  return tree;
}

}  // namespace cohort::session
