// The state of a world, hashed, saved and restored: all three see the same numbers.

#include "server/physics/state_visitors.hpp"
#include "server/physics/stepper.hpp"

namespace cohort::physics {

void Stepper::hash_body(std::uint32_t body, StateHash& hash) const {
  const Body& placed = bodies_[body];
  if (placed.is_placed_again) visit_pose(placed.X_WM, StateHasher{hash});
  if (placed.is_out) StateHasher{hash}(placed.is_out);
  if (placed.member == Anchors::nobody) return;
  StateHasher{hash}(members_[bodies_[body].member].is_active);
  Multibody::visit_state(*bodies_[body].multibody, StateHasher{hash});
}

void Stepper::hash_contacts(StateHash& hash) const {
  for (const Connection& connection : connections_) Connection::visit_state(connection, StateHasher{hash});
  for (const Member& member : members_) {
    for (const Part& part : member.parts) {
      for (const SolidPair& pair : collision_.pairs_of(part.solid)) {
        if (pair.contact.count == 0) continue;
        hash.add(static_cast<std::uint64_t>(pair.a) << 32 | pair.b);
        for (const ContactPoint& point : pair.contact) ContactPoint::visit_state(point, StateHasher{hash});
      }
    }
  }
}

void Stepper::save(SnapshotWriter& writer) const {
  const StateSaver save{writer};
  writer.add_count(description_.instances.size());
  writer.add_count(bodies_.size());
  for (std::size_t body = description_.instances.size(); body < bodies_.size(); ++body) {
    writer.add_count(bodies_[body].model);
    visit_pose(bodies_[body].X_WM, save);
  }
  for (const Body& body : bodies_) {
    save(body.is_placed_again);
    if (body.is_placed_again) visit_pose(body.X_WM, save);
    save(body.is_out);
  }
  for (const Member& member : members_) {
    save(member.is_active);
    save(member.is_finite);
    save(member.is_inside);
    Multibody::visit_state(of(member), save);
  }
  writer.add_count(connections_.size());
  for (const Connection& connection : connections_) {
    visit_end(connection.a(), save);
    visit_end(connection.b(), save);
    save(connection.limits().force);
    save(connection.limits().torque);
    Connection::visit_state(connection, save);
  }
  collision_.save(writer);
}

void Stepper::restore(SnapshotReader& reader) {
  const StateRestorer restore{reader};
  reader.expect_count(description_.instances.size(), "models in its world");
  constexpr std::size_t least_bytes = 1;
  const std::size_t body_count = reader.read_count(least_bytes);
  while (bodies_.size() < body_count) {
    const std::size_t model = reader.read_count(least_bytes);
    if (model >= description_.models.size()) throw SnapshotError("the snapshot has a model that is not there");
    Pose X_WM;
    visit_pose(X_WM, restore);
    create_body(model, X_WM);
  }
  scene_.build();
  for (std::uint32_t body = 0; body < bodies_.size(); ++body) {
    bool is_placed_again = false;
    restore(is_placed_again);
    Pose X_WM;
    if (is_placed_again) visit_pose(X_WM, restore);
    if (is_placed_again) place_body(body, X_WM);
    bool is_out = false;
    restore(is_out);
    if (is_out) remove_body(body);
    if (!is_out) put_back_body(body);
  }
  for (Member& member : members_) {
    bool is_active = true;
    restore(is_active);
    restore(member.is_finite);
    restore(member.is_inside);
    Multibody& multibody = of(member);
    Multibody::visit_state(multibody, restore);
    multibody.update_poses();
    place_solids_of(member);
    if (!is_active) take_out(member);
  }
  scene_.update();
  constexpr std::size_t connection_bytes = 100;
  for (std::size_t count = reader.read_count(connection_bytes); count > 0; --count) {
    Connection::End a;
    Connection::End b;
    ConnectionLimits limits;
    visit_end(a, restore);
    visit_end(b, restore);
    restore(limits.force);
    restore(limits.torque);
    if (a.member >= members_.size() || (b.member >= members_.size() && b.member != Anchors::nobody))
      throw SnapshotError("the snapshot has a connection of a body that is not there");
    members_[a.member].connections.push_back(static_cast<std::uint32_t>(connections_.size()));
    Connection::visit_state(connections_.emplace_back(a, b, limits), restore);
  }
  collision_.restore(reader);
  report_contacts();
}

}  // namespace cohort::physics
