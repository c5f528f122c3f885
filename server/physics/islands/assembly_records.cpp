// SPDX-License-Identifier: Apache-2.0

// External forces on bodies that are recorded.

#include "server/physics/islands/assembly.hpp"

namespace cohort::physics {

void Assembly::record(std::uint32_t index) {
  Member& member = members[index];
  if (member.record) return;
  has_records = true;
  const Mechanism& mechanism = member.multibody->mechanism();
  const std::vector<description::Link>& links = mechanism.model().links;
  std::vector<std::size_t> links_of_parts;
  for (std::size_t link = 0; link < links.size(); ++link)
    if (mechanism.link(link).collides) links_of_parts.insert(links_of_parts.end(), links[link].collisions.size(), link);
  const std::uint32_t first = member.parts.empty() ? 0 : member.parts.front().solid;
  member.record = std::make_unique<ForceRecord>(mechanism, first, std::move(links_of_parts));
}

void Assembly::record_outside() {
  if (!has_records) return;
  for (std::uint32_t index = 0; index < members.size(); ++index) {
    const Member& member = members[index];
    if (!member.is_awake()) continue;
    if (!member.is_finite) {  // the solver left it out
      if (member.record) member.record->forget();
      continue;
    }
    for_each_pair(index, [&](const SolidPair& pair) { record_pair(pair); });
    connections.for_each_of(index, [&](const Connection& connection) { record_connection(connection); });
    for (const TrackRows& treel : member.multibody->treels()) {
      treel.for_each_impulse(
          [&](std::uint32_t solid, const Eigen::Vector3d& point_W, const Eigen::Vector3d& impulse_W) {
            const Eigen::Vector3d none = Eigen::Vector3d::Zero();
            if (member.record) member.record->add_outside(treel.link(), point_W, impulse_W, none);
            if (ForceRecord* under = record_of(anchors.member(solid)))
              under->add_outside(under->link_of(solid), point_W, -impulse_W, none);
          });
    }
    if (!member.record) continue;
    member.multibody->loops().for_each_impulse([&](std::size_t parent, std::size_t child,
                                                   const Eigen::Vector3d& point_W, const Eigen::Vector3d& linear_W,
                                                   const Eigen::Vector3d& angular_W) {
      member.record->add_outside(child, point_W, linear_W, angular_W);
      if (parent != child) member.record->add_outside(parent, point_W, -linear_W, -angular_W);
    });
    pushes.for_each_of(index, [&](const Pushes::Push& push) {
      member.record->add_outside(push.link, push.point_W, step * push.wrench.force_W, step * push.wrench.torque_W);
    });
    for (const WeightlessLink& link : member.weightless) {
      const description::Inertial& inertial = member.multibody->mechanism().model().links[link.link].inertial;
      const Eigen::Vector3d centre_W = member.record->motion().pose_before(link.link) * inertial.X_LI.position;
      member.record->add_outside(link.link, centre_W, -step * link.mass * gravity, Eigen::Vector3d::Zero());
    }
    if (!member.fluid) continue;
    for (const FluidBody::Impulse& impulse : member.fluid->impulses())
      member.record->add_outside(impulse.link, impulse.point_W, impulse.impulse_W.linear, impulse.impulse_W.angular);
  }
}

void Assembly::record_pair(const SolidPair& pair) const {
  const std::uint32_t member_b = anchors.member(pair.b);
  ForceRecord* const a = record_of(anchors.member(pair.a));
  ForceRecord* const b = record_of(member_b);
  if (a == nullptr && b == nullptr) return;
  if (member_b != Anchors::nobody && !members[member_b].is_finite) return;
  for (const ContactPoint& point : pair.contact) {
    const ContactImpulse impulse = impulse_of(pair.contact, point);
    if (a != nullptr) a->add_outside(a->link_of(pair.a), point.position_W, impulse.linear_W, impulse.angular_W);
    if (b != nullptr) b->add_outside(b->link_of(pair.b), point.position_W, -impulse.linear_W, -impulse.angular_W);
  }
}

// The load of a belt is the reaction to the force along its surface on others. The belt of a sleeping body keeps its
// last load.
void Assembly::load_belts() {
  if (!has_belts) return;
  for (const Member& member : members)
    if (!member.is_asleep) member.multibody->unload_belts();
  for (std::uint32_t index = 0; index < members.size(); ++index) {
    const Member& member = members[index];
    if (!member.is_awake() || !member.is_finite) continue;
    for_each_pair(index, [&](const SolidPair& pair) {
      const std::uint32_t member_b = anchors.member(pair.b);
      if (member_b != Anchors::nobody && !members[member_b].is_finite) return;
      for (const ContactPoint& point : pair.contact) {
        const Eigen::Vector3d impulse_W = impulse_of(pair.contact, point).linear_W;
        load_belt(pair.a, -point.normal_W, impulse_W);
        load_belt(pair.b, point.normal_W, -impulse_W);
      }
    });
    for (const TrackRows& treel : member.multibody->treels()) {
      const Eigen::Vector3d up_W = treel.up();
      treel.for_each_impulse([&](std::uint32_t solid, const Eigen::Vector3d&, const Eigen::Vector3d& impulse_W) {
        load_belt(solid, up_W, -impulse_W);
      });
    }
  }
}

void Assembly::load_belt(std::uint32_t solid, const Eigen::Vector3d& outward_W, const Eigen::Vector3d& impulse_W) {
  if (!anchors.moves(solid)) return;
  members[anchors.member(solid)].multibody->load_belt(scene.solid(solid).link(), outward_W, impulse_W / step);
}

void Assembly::record_connection(const Connection& connection) const {
  const Connection::End& end_a = connection.a();
  const Connection::End& end_b = connection.b();
  if (end_b.member != Anchors::nobody && !members[end_b.member].is_finite) return;
  const Connection::Impulses& impulses = connection.impulses();
  const Eigen::Vector3d linear_W(impulses[0], impulses[1], impulses[2]);
  const Eigen::Vector3d angular_W(impulses[3], impulses[4], impulses[5]);
  if (ForceRecord* const a = record_of(end_a.member))
    a->add_outside(end_a.link, connection.point(), linear_W, angular_W);
  if (ForceRecord* const b = record_of(end_b.member))
    b->add_outside(end_b.link, connection.point(), -linear_W, -angular_W);
}

}  // namespace cohort::physics
