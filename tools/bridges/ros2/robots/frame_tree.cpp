// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ros2/robots/frame_tree.hpp"

#include <algorithm>
#include <optional>
#include <variant>

namespace cohort::ros2 {
namespace {

namespace ros = messages::ros;

// Where a joint's position is among the observed values; nothing without an encoder.
std::optional<std::size_t> position_of(const description::Model& model, const Start& robot, std::size_t joint) {
  for (const description::Device& device : model.devices) {
    const auto* encoder = std::get_if<description::JointEncoder>(&device);
    if (encoder == nullptr || encoder->joint != joint) continue;
    const auto channel =
        std::ranges::find(robot.observation_channels, encoder->name + "/0/position", &ChannelInfo::name);
    if (channel != robot.observation_channels.end()) return channel->offset;
  }
  return std::nullopt;
}

ros::TransformStamped stamped(const std::string& parent, const std::string& child, const Pose& pose,
                              const ros::Time& stamp) {
  return {{stamp, parent}, child, to_transform(pose)};
}

}  // namespace

ros::Transform to_transform(const Pose& pose) {
  const Eigen::Vector3d& p = pose.position;
  const Eigen::Quaterniond& q = pose.orientation;
  return {{p.x(), p.y(), p.z()}, {q.x(), q.y(), q.z(), q.w()}};
}

FrameTree::FrameTree(const description::Model& model, const Start& robot, const std::string& base,
                     const std::string& prefix, const std::vector<SensorFrame>& sensors)
    : base_(prefix + base), prefix_(prefix) {
  const auto name_of_link = [&](std::size_t link) { return link == 0 ? base_ : prefix + model.links[link].name; };
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const description::Joint& joint = model.joints[i];
    if (joint.parent == description::Joint::world) continue;
    const Pose X_PC = model.links[joint.parent].X_ML.inverse() * model.links[joint.child].X_ML;
    const Edge edge{name_of_link(joint.parent), name_of_link(joint.child), X_PC};
    const bool slides = joint.type == description::JointType::prismatic;
    if (joint.type == description::JointType::fixed)
      fixed_.push_back(edge);
    else if (const auto offset = position_of(model, robot, i);
             offset && (slides || joint.type == description::JointType::revolute))
      moving_.push_back({edge, X_PC * joint.X_LJ, joint.X_LJ.inverse(), joint.axis.direction, slides, *offset});
  }
  for (const SensorFrame& sensor : sensors)
    fixed_.push_back({name_of_link(sensor.link), prefix + sensor.name, sensor.X_LS});
}

ros::TFMessage FrameTree::fixed(const ros::Time& stamp) const {
  ros::TFMessage message;
  for (const Edge& edge : fixed_) message.transforms.push_back(stamped(edge.parent, edge.child, edge.X_PC, stamp));
  return message;
}

void FrameTree::add_moving(std::span<const double> observation, const ros::Time& stamp, ros::TFMessage& to) const {
  for (const MovingEdge& edge : moving_) {
    const double position = observation[edge.offset];
    Pose X_JJ;
    if (edge.slides)
      X_JJ.position = position * edge.axis;
    else
      X_JJ.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(position, edge.axis));
    to.transforms.push_back(stamped(edge.parent, edge.child, edge.X_PJ * X_JJ * edge.X_JC, stamp));
  }
}

}  // namespace cohort::ros2
