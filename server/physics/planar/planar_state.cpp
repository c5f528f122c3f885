// SPDX-License-Identifier: Apache-2.0

// Hashing, saving and restoring the state of a planar world: all three visit the same numbers.

#include "server/core/state_visitors.hpp"
#include "server/physics/planar/planar_world.hpp"

namespace cohort::physics {

void PlanarWorld::hash_body(BodyId body, StateHash& hash) const {
  const std::uint32_t member = bodies_[body.value].member;
  hash_changes(bodies_[body.value], hash);
  if (member == Anchors::nobody) return;
  StateHasher{hash}(members_[member].is_active);
  PlanarBodies::visit_state(planar_, member, StateHasher{hash});
  PlanarGround::visit_state(grounds_[member], StateHasher{hash});
}

void PlanarWorld::hash_contacts(StateHash& hash) const {
  connections_.hash(hash);
  for (std::uint32_t member = 0; member < members_.size(); ++member) {
    for (const PlanarPair& pair : collision_.pairs_of(member)) {
      hash.add(static_cast<std::uint64_t>(pair.a) << 32 | pair.b);
      for (const PlanarPoint& point : pair.contact) PlanarPoint::visit_state(point, StateHasher{hash});
    }
  }
}

void PlanarWorld::save(SnapshotWriter& writer) const {
  const StateSaver save{writer};
  save_changes(bodies_, writer);
  for (std::uint32_t member = 0; member < members_.size(); ++member) {
    save(members_[member].is_active);
    save(members_[member].is_finite);
    save(members_[member].is_inside);
    save(members_[member].has_ground);
    PlanarBodies::visit_state(planar_, member, save);
    PlanarGround::visit_state(grounds_[member], save);
  }
  connections_.save(writer);
  collision_.save(writer);
}

void PlanarWorld::expect_sound(std::uint32_t member) const {
  const Member& its = members_[member];
  if (!its.is_finite || !its.is_inside || !planar_.is_sensible(member))
    throw SnapshotError("snapshot: invalid velocities of a body");
  for (std::uint32_t i = 0; i < its.part_count; ++i)
    expect_placed(planar_.segment_pose(member, parts_[its.first_part + i].segment));
}

void PlanarWorld::restore(SnapshotReader& reader) {
  using Numbers = StateRestorer::Numbers;
  const StateRestorer restore{reader};
  restore_changes(reader, *this);
  for (std::uint32_t member = 0; member < members_.size(); ++member) {
    bool is_active = true;
    restore(is_active);
    restore(members_[member].is_finite);
    restore(members_[member].is_inside);
    bool has_ground = true;
    restore(has_ground);
    if (has_ground && !members_[member].has_ground) put_on_ground(member);
    const StateRestorer restore_body{reader, is_active ? Numbers::finite : Numbers::broken};
    PlanarBodies::visit_state(planar_, member, restore_body);
    PlanarGround::visit_state(grounds_[member], restore_body);
    planar_.update_poses(member);
    find_parts_in_body(members_[member], member);
    if (is_active) {
      expect_sound(member);
      place_solids(member);
    } else {
      take_out(member);
    }
  }
  scene_.update();
  connections_.restore(reader, [this](const Connection::End& end) {
    return is_there(end, bodies_, description_.models, [this](std::uint32_t body, std::size_t link) {
      return planar_.model(bodies_[body].member).mechanism().link(link).segment;
    });
  });
  collision_.restore(reader);
  report_contacts();
}

}  // namespace cohort::physics
