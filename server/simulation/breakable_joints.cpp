#include "server/simulation/breakable_joints.hpp"

#include <algorithm>
#include <sstream>

namespace cohort {

BreakableJoints::BreakableJoints(const description::World& description, physics::World& world)
    : description_(description), world_(world) {
  for (const description::BreakableJoint& joint : description.breakable_joints) {
    const auto first = static_cast<std::uint32_t>(joint.first);
    const auto second = static_cast<std::uint32_t>(joint.second);
    const Pose X_WLa = world.link_pose(first, joint.first_link);
    const Pose X_WLb = world.link_pose(second, joint.second_link);
    const Pose X_WP = joint.X_LP ? X_WLa * *joint.X_LP : X_WLb;
    const physics::ConnectionLimits limits{joint.breaking_force, joint.breaking_torque};
    const bool is_swapped = description.models[description.instances[first].model].is_static;
    const std::uint32_t connection =
        is_swapped ? world.connect(second, joint.second_link, X_WLb.inverse() * X_WP, first, joint.first_link, limits)
                   : world.connect(first, joint.first_link, X_WLa.inverse() * X_WP, second, joint.second_link, limits);
    if (!world.is_active(first) || !world.is_active(second)) world.disconnect(connection);
    joints_.push_back({connection, is_swapped});
  }
}

physics::Wrench BreakableJoints::wrench_on_first(std::size_t joint) const {
  const Connected& its = joints_[joint];
  return its.is_swapped ? world_.connection_reaction(its.connection) : world_.connection_wrench(its.connection);
}

physics::Wrench BreakableJoints::wrench_on_second(std::size_t joint) const {
  const Connected& its = joints_[joint];
  return its.is_swapped ? world_.connection_wrench(its.connection) : world_.connection_reaction(its.connection);
}

std::vector<std::string> BreakableJoints::broken() const {
  std::vector<std::string> sentences;
  for (std::size_t joint = 0; joint < joints_.size(); ++joint) {
    const auto now = world_.broken_connections();
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
