// SPDX-License-Identifier: Apache-2.0
#include "server/description/fingerprint.hpp"

#include "server/core/hash.hpp"
#include "server/core/state_visitors.hpp"

namespace cohort::description {
namespace {

void add_pose(StateHash& hash, const Pose& pose) {
  visit_pose(pose, [&](const double& number) { hash.add(number); });
}

void add_count(StateHash& hash, std::size_t count) { hash.add(static_cast<std::uint64_t>(count)); }

void add_link(StateHash& hash, const Link& link) {
  add_pose(hash, link.X_ML);
  add_pose(hash, link.inertial.X_LI);
  hash.add(link.inertial.mass);
  for (const double number : link.inertial.inertia.reshaped()) hash.add(number);
  if (link.inertial.added_mass)
    for (const double number : link.inertial.added_mass->reshaped()) hash.add(number);
  add_count(hash, link.collisions.size());
  for (const Collision& collision : link.collisions) {
    add_count(hash, collision.shape.index());
    add_pose(hash, collision.X_LC);
    hash.add(collision.surface.friction);
    hash.add(collision.surface.restitution);
  }
}

void add_joint(StateHash& hash, const Joint& joint) {
  hash.add(static_cast<std::uint64_t>(joint.type));
  add_count(hash, joint.parent);
  add_count(hash, joint.child);
  add_pose(hash, joint.X_LJ);
  for (const double number : joint.axis.direction) hash.add(number);
  for (const double number : {joint.axis.lower, joint.axis.upper, joint.axis.damping, joint.axis.friction})
    hash.add(number);
}

}  // namespace

std::uint64_t fingerprint(const Model& model) {
  StateHash hash;
  hash.add(static_cast<std::uint64_t>(model.is_static));
  add_count(hash, model.links.size());
  for (const Link& link : model.links) add_link(hash, link);
  for (const std::vector<Joint>* joints : {&model.joints, &model.loop_joints}) {
    add_count(hash, joints->size());
    for (const Joint& joint : *joints) add_joint(hash, joint);
  }
  for (const std::size_t count : {model.couplings.size(), model.devices.size(), model.emitters.size(),
                                  model.grip_rings.size(), model.fins.size(), model.drags.size()})
    add_count(hash, count);
  return hash.value();
}

}  // namespace cohort::description
