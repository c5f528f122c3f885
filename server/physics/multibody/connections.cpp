#include "server/physics/multibody/connections.hpp"

#include "server/core/state_visitors.hpp"

namespace cohort::physics {
namespace {

template <class End, class Visit>
void visit_end(End& end, Visit&& visit) {
  visit(end.member);
  visit(end.segment);
  visit(end.link);
  visit_pose(end.X_SP, visit);
  visit(end.body);
}

}  // namespace

std::uint32_t Connections::add(const Connection::End& a, const Connection::End& b, const ConnectionLimits& limits) {
  const auto index = static_cast<std::uint32_t>(connections_.size());
  connections_.emplace_back(a, b, limits);
  if (of_member_.size() <= a.member) of_member_.resize(a.member + 1);
  of_member_[a.member].push_back(index);
  return index;
}

void Connections::release_of(std::uint32_t member) {
  for (Connection& connection : connections_)
    if (connection.a().member == member || connection.b().member == member) connection.release();
}

void Connections::release_of_body(std::uint32_t body) {
  for (Connection& connection : connections_)
    if (connection.a().body == body || connection.b().body == body) connection.release();
}

void Connections::break_overloaded(double step) {
  for (const std::uint32_t index : broken_) connections_[index].forget_break();
  broken_.clear();
  for (std::uint32_t index = 0; index < connections_.size(); ++index) {
    if (!connections_[index].holds() || !connections_[index].is_overloaded(step)) continue;
    connections_[index].break_now();
    broken_.push_back(index);
  }
}

void Connections::hash(StateHash& hash) const {
  for (const Connection& connection : connections_) Connection::visit_state(connection, StateHasher{hash});
}

void Connections::save(SnapshotWriter& writer) const {
  const StateSaver save{writer};
  writer.add_count(connections_.size());
  for (const Connection& connection : connections_) {
    visit_end(connection.a(), save);
    visit_end(connection.b(), save);
    save(connection.limits().force);
    save(connection.limits().torque);
    Connection::visit_state(connection, save);
  }
}

void Connections::restore(SnapshotReader& reader, std::size_t members) {
  const StateRestorer restore{reader};
  connections_.clear();
  of_member_.clear();
  broken_.clear();
  constexpr std::size_t least_bytes = 100;
  for (std::size_t count = reader.read_count(least_bytes); count > 0; --count) {
    Connection::End a;
    Connection::End b;
    ConnectionLimits limits;
    visit_end(a, restore);
    visit_end(b, restore);
    restore(limits.force);
    restore(limits.torque);
    if (a.member >= members || (b.member >= members && b.member != Anchors::nobody))
      throw SnapshotError("the snapshot has a connection of a body that is not there");
    Connection::visit_state(connections_[add(a, b, limits)], restore);
  }
}

}  // namespace cohort::physics
