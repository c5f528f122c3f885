// SPDX-License-Identifier: Apache-2.0
#include "server/gripping/detachable_joints.hpp"

#include <algorithm>

namespace cohort::gripping {

DetachableJoints::DetachableJoints(const description::World& description, physics::World& world)
    : description_(description), world_(world) {
  for (std::size_t body = 0; body < description.instances.size(); ++body)
    add_body(BodyId{body}, description.models[description.instances[body].model]);
}

void DetachableJoints::add_body(BodyId body, const description::Model& model) {
  const auto& instances = description_.instances;
  for (std::size_t device = 0; device < model.devices.size(); ++device) {
    const auto its = description::held_child_of(model.devices[device]);
    if (!its) continue;
    const auto [known, is_new] =
        numbers_.try_emplace({world_.slot_of(body), DeviceId{device}}, static_cast<std::uint32_t>(joints_.size()));
    if (is_new) joints_.emplace_back();
    Joint& joint = joints_[known->second];
    joint = {.body = body, .link = LinkId{its->link}};
    const auto child = std::ranges::find(instances, its->child, &description::Instance::name);
    if (child == instances.end()) continue;
    const auto& links = description_.models[child->model].links;
    const auto link =
        its->child_link.empty() ? links.begin() : std::ranges::find(links, its->child_link, &description::Link::name);
    if (link == links.end()) continue;
    joint.child = BodyId{child - instances.begin()};
    joint.child_link = LinkId{link - links.begin()};
  }
}

bool DetachableJoints::holds(std::uint32_t joint) const {
  const ConnectionId connection = joints_[joint].connection;
  return connection != nothing && world_.connections().holds(connection);
}

void DetachableJoints::command(std::uint32_t number, double attached) {
  Joint& joint = joints_[number];
  if (joint.connection != nothing && !world_.connections().holds(joint.connection)) {
    joint.connection = nothing;
    joint.is_spent = 1;
  }
  if (attached <= holding) {
    if (joint.connection != nothing) world_.connections().disconnect(joint.connection);
    joint.connection = nothing;
    joint.is_spent = 0;
    return;
  }
  const bool may_hold = joint.connection == nothing && joint.is_spent == 0 && joint.child != nobody;
  if (!may_hold || !world_.is_active(joint.body) || !world_.is_active(joint.child)) return;
  const Pose X_LP =
      world_.link_pose(joint.body, joint.link).inverse() * world_.link_pose(joint.child, joint.child_link);
  joint.connection = world_.connections().connect({joint.body, joint.link}, X_LP, {joint.child, joint.child_link});
}

template <class Self, class Visit>
void DetachableJoints::visit_state(Self& self, Visit&& visit) {
  for (auto& joint : self.joints_) {
    visit(joint.connection.value);
    visit(joint.is_spent);
  }
}

void DetachableJoints::hash(StateHash& hash) const {
  visit_state(*this, [&](std::uint32_t value) { hash.add(std::uint64_t{value}); });
}

void DetachableJoints::save(SnapshotWriter& writer) const {
  visit_state(*this, [&](const auto& value) { writer.add(value); });
}

void DetachableJoints::restore(SnapshotReader& reader) {
  visit_state(*this, [&](auto& value) { reader.read(value); });
  for (const Joint& joint : joints_)
    if (joint.connection != nothing && joint.connection.value >= world_.connections().made())
      throw SnapshotError("snapshot: a detachable joint has an unknown connection");
}

}  // namespace cohort::gripping
