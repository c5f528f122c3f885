// The state of a planar world, hashed, saved and restored: all three see the same numbers.

#include "server/physics/planar_engine.hpp"
#include "server/physics/state_visitors.hpp"

namespace cohort::physics {

void PlanarEngine::hash_body(std::uint32_t body, StateHash& hash) const {
  const std::uint32_t member = bodies_[body].member;
  if (bodies_[body].is_placed_again) visit_pose(bodies_[body].X_WM, StateHasher{hash});
  if (bodies_[body].is_out) StateHasher{hash}(bodies_[body].is_out);
  if (member == Anchors::nobody) return;
  StateHasher{hash}(members_[member].is_active);
  PlanarBodies::visit_state(planar_, member, StateHasher{hash});
  PlanarGround::visit_state(grounds_[member], StateHasher{hash});
}

void PlanarEngine::hash_contacts(StateHash& hash) const {
  for (const Connection& connection : connections_) Connection::visit_state(connection, StateHasher{hash});
  for (std::uint32_t member = 0; member < members_.size(); ++member) {
    for (const PlanarPair& pair : collision_.pairs_of(member)) {
      hash.add(static_cast<std::uint64_t>(pair.a) << 32 | pair.b);
      for (const PlanarPoint& point : pair.contact) PlanarPoint::visit_state(point, StateHasher{hash});
    }
  }
}

void PlanarEngine::save(SnapshotWriter& writer) const {
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
  for (std::uint32_t member = 0; member < members_.size(); ++member) {
    save(members_[member].is_active);
    save(members_[member].is_finite);
    save(members_[member].is_inside);
    PlanarBodies::visit_state(planar_, member, save);
    PlanarGround::visit_state(grounds_[member], save);
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

void PlanarEngine::restore(SnapshotReader& reader) {
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
  for (std::uint32_t member = 0; member < members_.size(); ++member) {
    if (members_[member].body >= description_.instances.size()) put_on_ground(member);
  }
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
  for (std::uint32_t member = 0; member < members_.size(); ++member) {
    bool is_active = true;
    restore(is_active);
    restore(members_[member].is_finite);
    restore(members_[member].is_inside);
    PlanarBodies::visit_state(planar_, member, restore);
    PlanarGround::visit_state(grounds_[member], restore);
    planar_.update_poses(member);
    find_parts_in_body(members_[member], member);
    place_solids(member);
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
