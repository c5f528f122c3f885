// SPDX-License-Identifier: Apache-2.0

// Hashing, saving and restoring the state of a world: all three visit the same numbers.

#include "server/core/state_visitors.hpp"
#include "server/physics/islands/multibody_world.hpp"

namespace cohort::physics {

void MultibodyWorld::hash_body(BodyId body, StateHash& hash) const {
  hash_changes(bodies_[body.value], hash);
  if (is_static(body)) return;
  StateHasher{hash}(is_active(body));
  const Member& member = assembly_.members[bodies_[body.value].member];
  StateHasher{hash}.unusual(member.still_steps, 0u);
  StateHasher{hash}.unusual(member.is_asleep, false);
  Multibody::visit_state(multibody(body), StateHasher{hash});
  if (const FluidBody* fluid = member.fluid.get()) FluidBody::visit_state(*fluid, StateHasher{hash});
}

void MultibodyWorld::hash_contacts(StateHash& hash) const {
  assembly_.connections.hash(hash);
  for (std::uint32_t member = 0; member < assembly_.members.size(); ++member) {
    assembly_.for_each_pair(member, [&](const SolidPair& pair) {
      hash.add(static_cast<std::uint64_t>(pair.a) << 32 | pair.b);
      for (const ContactPoint& point : pair.contact) ContactPoint::visit_state(point, StateHasher{hash});
    });
  }
}

void MultibodyWorld::save(SnapshotWriter& writer) const {
  const StateSaver save{writer};
  save_changes(bodies_, writer);
  for (const Member& member : assembly_.members) {
    save(member.is_active);
    save(member.is_finite);
    save(member.is_inside);
    save(member.still_steps);
    save(member.is_asleep);
    save(member.next_asleep);
    Multibody::visit_state(*member.multibody, save);
    Multibody::visit_loads(*member.multibody, save);
    if (const FluidBody* fluid = member.fluid.get()) FluidBody::visit_state(*fluid, save);
  }
  assembly_.connections.save(writer);
  assembly_.collision.save(writer);
}

void MultibodyWorld::restore(SnapshotReader& reader) {
  using Numbers = StateRestorer::Numbers;
  const StateRestorer restore{reader};
  restore_changes(reader, *this);
  for (std::uint32_t index = 0; index < assembly_.members.size(); ++index) {
    bool is_active = true;
    bool is_asleep = false;
    restore(is_active);
    Member& member = assembly_.members[index];
    restore(member.is_finite);
    restore(member.is_inside);
    restore(member.still_steps);
    restore(is_asleep);
    restore(member.next_asleep);
    const StateRestorer restore_body{reader, is_active ? Numbers::finite : Numbers::broken};
    Multibody::visit_state(*member.multibody, restore_body);
    if (reader.layout() >= SnapshotLayout::with_belt_loads) Multibody::visit_loads(*member.multibody, restore_body);
    if (member.fluid) FluidBody::visit_state(*member.fluid, restore_body);
    member.multibody->motion().update_poses();
    if (is_active) {
      assembly_.expect_sound(member);
      assembly_.place_solids_of(member);
    } else {
      assembly_.take_out(index);
    }
    assembly_.set_asleep(index, is_asleep);
  }
  assembly_.scene.update();
  assembly_.connections.restore(reader, [this](const Connection::End& end) {
    return is_there(end, bodies_, description_.models, [this](std::uint32_t body, std::size_t link) {
      return multibody(BodyId{body}).mechanism().link(link).segment;
    });
  });
  assembly_.collision.restore(reader);
  sleep_.check_groups();
  find_awake();
  report_contacts();
}

}  // namespace cohort::physics
