// SPDX-License-Identifier: Apache-2.0
#include "server/simulation/breakable_joints.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <sstream>

namespace cohort {
namespace {

// About the z axis of a connection, or about all of its axes.
physics::ConnectionGive give_of(const description::BreakableJoint& joint) {
  physics::ConnectionGive give;
  for (int axis = joint.type == description::JointType::ball ? 0 : 2; axis < 3; ++axis) {
    give.angular_stiffness[axis] = 0.0;
    give.angular_damping[axis] = joint.damping;
  }
  return give;
}

}  // namespace

BreakableJoints::BreakableJoints(const description::World& description, physics::World& world)
    : description_(description), world_(world) {
  for (const description::BreakableJoint& joint : description.breakable_joints) {
    const physics::BodyLink first{BodyId{joint.first}, LinkId{joint.first_link}};
    const physics::BodyLink second{BodyId{joint.second}, LinkId{joint.second_link}};
    const Pose X_WLa = world.link_pose(first.body, first.link);
    const Pose X_WLb = world.link_pose(second.body, second.link);
    Pose X_WP = joint.X_LP ? X_WLa * *joint.X_LP : X_WLb;
    X_WP.orientation *= Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), joint.axis_P);
    const physics::ConnectionLimits limits{joint.breaking_force, joint.breaking_torque};
    const bool is_swapped = description.models[description.instances[joint.first].model].is_static;
    physics::WorldConnections& connections = world.connections();
    const ConnectionId connection = is_swapped ? connections.connect(second, X_WLb.inverse() * X_WP, first, limits)
                                               : connections.connect(first, X_WLa.inverse() * X_WP, second, limits);
    if (joint.type != description::JointType::fixed) connections.set_give(connection, give_of(joint));
    if (!world.is_active(first.body) || !world.is_active(second.body)) connections.disconnect(connection);
    joints_.push_back({connection, is_swapped});
  }
}

physics::Wrench BreakableJoints::wrench_on_first(std::size_t joint) const {
  const Connected& its = joints_[joint];
  using End = physics::ConnectionEnd;
  return world_.connections().wrench(its.connection, its.is_swapped ? End::b : End::a);
}

physics::Wrench BreakableJoints::wrench_on_second(std::size_t joint) const {
  const Connected& its = joints_[joint];
  using End = physics::ConnectionEnd;
  return world_.connections().wrench(its.connection, its.is_swapped ? End::a : End::b);
}

std::vector<std::string> BreakableJoints::broken() const {
  std::vector<std::string> sentences;
  for (std::size_t joint = 0; joint < joints_.size(); ++joint) {
    const auto now = world_.connections().broken();
    if (std::find(now.begin(), now.end(), joints_[joint].connection) == now.end()) continue;
    const physics::Wrench wrench = wrench_on_first(joint);
    const double force = wrench.force_W.norm();
    std::ostringstream text;
    text.precision(4);
    text << "joint '" << name(joint) << "' broke at ";
    if (force > description_.breakable_joints[joint].breaking_force)
      text << force << " N";
    else
      text << wrench.torque_W.norm() << " N m";
    sentences.push_back(text.str());
  }
  return sentences;
}

}  // namespace cohort
